"""gaitlab and gaitmap on the same trial, in turn, on one core.

    python benchmarks/side_by_side.py LEFT.txt RIGHT.txt --gaitmap-python GM/bin/python

gaitmap 2.6.0 wants an environment of its own:

    python -m venv GM && GM/bin/pip install gaitmap==2.6.0 gaitmap_mad==2.6.0

Each side is a process that keeps the two files in memory and analyses them again whenever it is asked; the two are asked
in turn, the order swapped every time, and what is compared is each pair: a machine that is busy slows both alike. Without
``--gaitmap-python`` gaitlab is timed alone. The cold figures are new processes, from their start to the first result.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)


class Side:
    """One worker process."""

    def __init__(self, command: Sequence[str], environment: dict[str, str]) -> None:
        self.process = subprocess.Popen(  # noqa: S603
            list(command), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
        )
        self.first = self._answer()

    def again(self) -> dict[str, float]:
        """Times of one more repetition, milliseconds."""
        assert self.process.stdin is not None
        self.process.stdin.write("again\n")
        self.process.stdin.flush()
        return self._answer()

    def close(self) -> None:
        assert self.process.stdin is not None
        self.process.stdin.close()
        self.process.wait()

    def _answer(self) -> dict[str, Any]:
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        if not line:
            raise SystemExit(f"{self.process.args!r} ended before it answered.")
        answer: dict[str, Any] = json.loads(line)
        return answer


def spread(values: Sequence[float], digits: int = 1) -> str:
    """Median and quartiles."""
    if len(values) < 2:
        return f"{values[0]:8.{digits}f}"
    low, middle, high = statistics.quantiles(values, n=4, method="inclusive")
    return f"{middle:8.{digits}f}  ({low:.{digits}f} to {high:.{digits}f})"


def cold(command: Sequence[str], environment: dict[str, str]) -> tuple[float, Any]:
    """Seconds from the start of a new worker to its first answer, and the answer."""
    began = time.perf_counter()
    side = Side(command, environment)
    seconds = time.perf_counter() - began
    side.close()
    return seconds, side.first


def command_line(left: Path, right: Path, environment: dict[str, str]) -> tuple[float, float, float]:
    """Seconds, seconds of processor time and peak MB (NaN where the system does not say) of one ``gaitlab analyze``."""
    words = ["analyze", "--left-foot", str(left), "--right-foot", str(right), "--out", "-"]
    began = time.perf_counter()
    process = subprocess.Popen(  # noqa: S603
        [sys.executable, "-m", "gaitlab.cli", *words], stdout=subprocess.DEVNULL, env=environment
    )
    if not hasattr(os, "wait4"):
        process.wait()
        return time.perf_counter() - began, float("nan"), float("nan")
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - began
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit("gaitlab analyze failed.")
    peak = usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024) / 1e6
    return seconds, usage.ru_utime + usage.ru_stime, peak


def warm(commands: dict[str, list[str]], environment: dict[str, str], repeats: int) -> None:
    """Ask the sides in turn and print what each took."""
    sides = {name: Side(command, environment) for name, command in commands.items()}
    taken: dict[str, list[dict[str, float]]] = {name: [] for name in sides}
    for repeat in range(-5, repeats):  # five to warm up
        names = list(sides) if repeat % 2 else list(reversed(sides))
        for name in names:
            answer = sides[name].again()
            if repeat >= 0:
                taken[name].append(answer)
    for side in sides.values():
        side.close()
    for name, rows in taken.items():
        print(f"{name}: {sides[name].first['found']}")
        print(f"  {'analysis, ms':<34}{spread([r['analyse'] for r in rows])}")
        print(f"  {'reading and analysis, ms':<34}{spread([r['read'] + r['analyse'] for r in rows])}")
        print(f"  {'analysis, ms of processor time':<34}{spread([r['analyse_cpu'] for r in rows])}")
        print(f"  {'reading, ms of processor time':<34}{spread([r['read_cpu'] for r in rows])}")
    ours = taken["gaitlab"]
    print(f"  {'pandas parses the texts, ms of it':<34}{spread([r['other_cpu'] for r in ours])}")
    ratio = [r["read_cpu"] / max(r["other_cpu"], 1e-9) for r in ours]
    print(f"  {'reading over that':<34}{spread(ratio)}")
    if "gaitmap" in taken:
        pairs = list(zip(taken["gaitmap"], ours, strict=True))
        print("gaitmap's time over gaitlab's, pair by pair")
        print(f"  {'analysis':<34}{spread([g['analyse'] / o['analyse'] for g, o in pairs])}")
        both = [(g["read"] + g["analyse"]) / (o["read"] + o["analyse"]) for g, o in pairs]
        print(f"  {'reading and analysis':<34}{spread(both)}")
        print(
            f"  {'analysis, processor time':<34}{spread([g['analyse_cpu'] / o['analyse_cpu'] for g, o in pairs])}"
        )


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("left", type=Path)
    parser.add_argument("right", type=Path)
    parser.add_argument("--gaitmap-python", help="the Python of an environment with gaitmap")
    parser.add_argument("--repeats", type=int, default=50, help="warm repetitions of each")
    parser.add_argument("--cold", type=int, default=5, help="new processes of each")
    chosen = parser.parse_args()
    files = [str(chosen.left), str(chosen.right)]
    commands = {"gaitlab": [sys.executable, str(HERE / "side_ours.py"), *files]}
    if chosen.gaitmap_python:
        commands["gaitmap"] = [chosen.gaitmap_python, str(HERE / "side_gaitmap.py"), *files]
    with tempfile.TemporaryDirectory() as compiled:
        environment = os.environ | ONE_THREAD | {"NUMBA_CACHE_DIR": compiled, "PYTHONWARNINGS": "ignore"}
        print(f"Warm, median (quartiles) of {chosen.repeats} in turn, one core")
        timed = {**commands, "gaitlab": [*commands["gaitlab"], "--pandas"]}
        first = cold(commands["gaitmap"], environment)[0] if "gaitmap" in commands else None
        warm(timed, environment, chosen.repeats)
        print(f"Cold, a new process to its first result, median (quartiles) of {chosen.cold} in turn")
        runs: dict[str, list[tuple[float, float, float]]] = {}
        for _ in range(chosen.cold):
            runs.setdefault("gaitlab analyze", []).append(
                command_line(chosen.left, chosen.right, environment)
            )
            for name, command in commands.items():
                seconds, answer = cold(command, environment)
                runs.setdefault(f"{name} from Python", []).append(
                    (seconds, answer["cpu_s"], answer["peak_mb"])
                )
        for name, taken in runs.items():
            print(f"  {name + ', s':<34}{spread([seconds for seconds, _, _ in taken], 2)}")
            print(f"  {name + ', processor s':<34}{spread([seconds for _, seconds, _ in taken], 2)}")
            print(f"  {name + ', peak MB':<34}{spread([peak for _, _, peak in taken])}")
        if first is not None:
            print(f"  {'gaitmap, nothing compiled yet, s':<34}{first:8.1f}")


if __name__ == "__main__":
    main()
