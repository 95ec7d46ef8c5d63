"""Importing the room stays cheap: every command line call pays for it."""

from __future__ import annotations

import subprocess
import sys


def test_import_loads_neither_pandas_nor_scipy() -> None:
    code = "import sys, gaitlab.recording; print(sorted({'pandas', 'scipy', 'zipfile'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
