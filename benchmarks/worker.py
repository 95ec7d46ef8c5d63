"""One side of ``side_by_side.py``: a process that analyses the same trial again each time it is asked.

Standard library only: the other side's environment runs it too.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path


def one_core() -> None:
    """Keep this process on one core, where the system can."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def peak_mb() -> float:
    """Peak memory of this process in MB; NaN where the system does not say."""
    status = Path("/proc/self/status")
    if status.exists():  # ru_maxrss would count what the parent held before it started this process
        line = next(line for line in status.read_text().splitlines() if line.startswith("VmHWM"))
        return int(line.split()[1]) * 1024 / 1e6
    if sys.platform == "darwin":
        import resource

        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    return float("nan")


def serve(
    read: Callable[[], object],
    analyse: Callable[[object], str],
    other: Callable[[], object] | None = None,
) -> None:
    """Read and analyse once and say so; then once more for each line of standard input, with the milliseconds.

    Parameters
    ----------
    read : from the files' content in memory to what ``analyse`` takes.
    analyse : from there to a word on what was found.
    other : timed beside them, for comparison.
    """
    say({"found": analyse(read()), "peak_mb": peak_mb(), "cpu_s": time.process_time()})
    for _ in sys.stdin:
        began, began_cpu = time.perf_counter(), time.process_time()
        data = read()
        had_read, had_read_cpu = time.perf_counter(), time.process_time()
        analyse(data)
        done, done_cpu = time.perf_counter(), time.process_time()
        answer = {
            "read": 1000 * (had_read - began),
            "analyse": 1000 * (done - had_read),
            "read_cpu": 1000 * (had_read_cpu - began_cpu),
            "analyse_cpu": 1000 * (done_cpu - had_read_cpu),
        }
        if other is not None:
            began_cpu = time.process_time()
            other()
            answer["other_cpu"] = 1000 * (time.process_time() - began_cpu)
        say(answer)


def say(answer: Mapping[str, object]) -> None:
    """One line of JSON to whoever started this process."""
    print(json.dumps(answer), flush=True)
