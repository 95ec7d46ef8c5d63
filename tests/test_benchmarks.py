"""The benchmarks run on any trial; what they time is for people to read."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from gaitlab.recording import Placement

from .recordings import short_walk

BENCHMARKS = Path(__file__).parent.parent / "benchmarks"


@pytest.fixture(scope="module")
def feet(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Left and right foot of a simulated walk, as files."""
    folder = tmp_path_factory.mktemp("walk")
    files = short_walk()
    paths = []
    for placement in (Placement.LEFT_FOOT, Placement.RIGHT_FOOT):
        path = folder / files[placement].name
        path.write_bytes(files[placement].content)
        paths.append(str(path))
    return paths


def run(name: str, *words: str) -> str:
    done = subprocess.run(
        [sys.executable, str(BENCHMARKS / name), *words], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_side_by_side_times_gaitlab_alone_where_gaitmap_is_missing(feet: list[str]) -> None:
    said = run("side_by_side.py", *feet, "--repeats", "3", "--cold", "1")
    assert "strides left" in said
    assert "gaitlab analyze, peak MB" in said
    assert "gaitmap" not in said


def test_side_by_side_says_which_side_failed(feet: list[str]) -> None:
    words = [sys.executable, str(BENCHMARKS / "side_by_side.py"), feet[0], "missing.txt"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=120)
    assert done.returncode != 0
    assert "side_ours.py" in done.stderr


def test_growth_finds_the_strides_of_every_part_laid_end_to_end() -> None:
    head, once, twice = run("growth.py", "--lengths", "30", "60").splitlines()
    assert head.split(",")[0] == "length"
    assert int(twice.split()[1]) == pytest.approx(2 * int(once.split()[1]), rel=0.1)


@pytest.mark.skipif(sys.platform == "win32", reason="no timer signals on Windows")
def test_the_profile_assigns_all_time_to_files_of_gaitlab(feet: list[str]) -> None:
    said = run("profile_trial.py", *feet, "--repeats", "20")
    table = said.split("of these")[0].splitlines()[1:]
    shares = {line.split()[-1]: float(line.split()[2]) for line in table}
    assert "recording/table.py" in shares
    assert sum(shares.values()) == pytest.approx(100.0, abs=3.0)
    assert shares.get("outside", 0.0) < 20.0
