"""The house stands: rooms import downwards only, and the package is whole when it is installed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def test_rooms_import_only_from_rooms_below_them() -> None:
    command = [
        sys.executable,
        "-c",
        "from importlinter.cli import lint_imports_command; lint_imports_command()",
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_command_line_offers_only_methods_that_exist() -> None:
    from gaitlab.cli.parser import METHODS as OFFERED
    from gaitlab.cli.parser import PLACEMENTS
    from gaitlab.recording.model import Placement
    from gaitlab.settings import METHODS

    assert tuple(METHODS) == OFFERED
    assert tuple(placement.value for placement in Placement) == PLACEMENTS


def test_help_loads_no_numerics() -> None:
    """``gaitlab --help`` answers at once: it imports neither numpy nor the web."""
    code = (
        "import sys\nfrom gaitlab.cli import main\n"
        "try:\n    main(['--help'])\nexcept SystemExit:\n    pass\n"
        "sys.exit(any(name in sys.modules for name in ('numpy', 'scipy', 'fastapi', 'sqlalchemy')))"
    )
    assert (
        subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, check=False).returncode
        == 0
    )


def test_nothing_in_the_project_names_a_machine_or_a_registry() -> None:
    listed = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False
    ).stdout.split()
    words = ("/wor" + "k/", "/roo" + "t/", "index-" + "url", "/simp" + "le/")
    for name in listed:
        path = ROOT / name
        if (
            path.suffix in (".py", ".toml", ".txt", ".md", ".html", ".css", ".js", ".typ", "")
            and path.is_file()
        ):
            text = path.read_text(encoding="utf-8", errors="ignore")
            assert not [word for word in words if word in text], name
