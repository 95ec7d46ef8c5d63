"""Where the time of one trial goes: ``python benchmarks/profile_trial.py LEFT.txt RIGHT.txt``.

The stack is looked at every millisecond of processor time, and each look is counted for the innermost function of gaitlab
on it, so that numpy's time belongs to whoever called numpy, and the little helpers' (quaternions, windows) to their
callers. Nothing is instrumented, so the shares are those of an undisturbed run. Unix only.
"""

from __future__ import annotations

import argparse
import signal
import statistics
import time
from collections import Counter
from pathlib import Path
from types import FrameType

from worker import one_core

import gaitlab
from gaitlab.analysis import Settings, analyze
from gaitlab.recording import InputFile, Placement, read_files

ROOT = Path(gaitlab.__file__).parent
HELPERS = {"motion/quaternions.py", "motion/windows.py", "motion/extrema.py", "recording/model.py"}


def place_of(frame: FrameType | None) -> tuple[str, str]:
    """File and function, within gaitlab, to which the work done in this frame belongs."""
    while frame is not None:
        path = Path(frame.f_code.co_filename)
        if path.is_relative_to(ROOT):
            name = path.relative_to(ROOT).as_posix()
            if name not in HELPERS:
                return name, frame.f_code.co_qualname
        frame = frame.f_back
    return "outside", ""


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("left", type=Path)
    parser.add_argument("right", type=Path)
    parser.add_argument("--repeats", type=int, default=200)
    parser.add_argument("--functions", type=int, default=20, help="how many functions to list")
    chosen = parser.parse_args()
    one_core()
    files = {
        Placement.LEFT_FOOT: InputFile(chosen.left.name, chosen.left.read_bytes()),
        Placement.RIGHT_FOOT: InputFile(chosen.right.name, chosen.right.read_bytes()),
    }
    analyze(read_files(files), Settings())
    looks: Counter[tuple[str, str]] = Counter()
    signal.signal(signal.SIGPROF, lambda _, frame: looks.update([place_of(frame)]))
    spans = []
    signal.setitimer(signal.ITIMER_PROF, 0.001, 0.001)
    for _ in range(chosen.repeats):
        began = time.process_time()
        analyze(read_files(files), Settings())
        spans.append(time.process_time() - began)
    signal.setitimer(signal.ITIMER_PROF, 0.0)
    total_ms = 1000 * statistics.median(spans)
    n = max(sum(looks.values()), 1)
    modules: Counter[str] = Counter()
    for (module, _), count in looks.items():
        modules[module] += count
    print(f"{total_ms:.1f} ms of processor time, reading included; {n} looks")
    for module, count in modules.most_common():
        print(f"{total_ms * count / n:8.2f} ms  {100 * count / n:5.1f} %  {module}")
    print("of these, the functions that take most")
    for (module, function), count in looks.most_common(chosen.functions):
        print(f"{total_ms * count / n:8.2f} ms  {100 * count / n:5.1f} %  {module}  {function}")


if __name__ == "__main__":
    main()
