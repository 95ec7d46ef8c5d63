"""How the cost grows with the length of the recording: ``python benchmarks/growth.py``.

A minute of simulated walking to and fro, from standing to standing, is cut or laid end to end to 10 s, 1 min, 10 min and
1 h of two feet. Each length is analysed in a process of its own on one core; the figures want a constant time per minute.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

from worker import one_core, peak_mb

LENGTHS_S = (10.0, 60.0, 600.0, 3600.0)
RATE_HZ = 100.0


def measure(length_s: float) -> dict[str, float]:
    """Processor time of reading and of analysing a recording of this length, the least of several, and peak memory."""
    one_core()
    import numpy as np

    from gaitlab.analysis import analyze
    from gaitlab.recording import InputFile, read_files
    from gaitlab.simulation import TYPICAL_MTW, Plan, Stand, Turn, Walk, simulate
    from gaitlab.simulation.mtmanager import FileStyle, mtmanager_text

    legs = [part for _ in range(4) for part in (Walk(10.0), Turn(np.pi))]
    minute = simulate(
        Plan((Stand(3.0), *legs, Stand(2.0))), TYPICAL_MTW, rate_hz=RATE_HZ, sampling="mean", knees=False
    )
    style = FileStyle(orientation=None, free_acceleration=False, pressure=False)
    files = {}
    for placement, sensor in minute.recording.sensors.items():
        rows = np.arange(round(length_s * RATE_HZ)) % sensor.n_samples
        longer = replace(
            sensor,
            received=sensor.received[rows],
            saturated=sensor.saturated[rows],
            acc_mps2=sensor.acc_mps2[rows] if sensor.acc_mps2 is not None else None,
            gyr_radps=sensor.gyr_radps[rows] if sensor.gyr_radps is not None else None,
            mag=sensor.mag[rows] if sensor.mag is not None else None,
            attitude=None,
            free_acc_mps2=None,
            pressure_pa=None,
        )
        files[placement] = InputFile(f"{placement}.txt", mtmanager_text(longer, style).encode())
    before = peak_mb()
    read, analysed = [], []
    for _ in range(10 if length_s <= 60.0 else 2):
        began = time.process_time()
        recording = read_files(files)
        had_read = time.process_time()
        strides = sum(len(foot.strides) for foot in analyze(recording).result.feet.values())
        analysed.append(time.process_time() - had_read)
        read.append(had_read - began)
    return {
        "seconds": length_s,
        "strides": strides,
        "read_ms": 1000 * min(read),
        "analyse_ms": 1000 * min(analysed),
        "files_mb": sum(len(file.content) for file in files.values()) / 1e6,
        "peak_before_mb": before,
        "peak_mb": peak_mb(),
    }


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--lengths", nargs="+", type=float, default=LENGTHS_S, help="seconds")
    parser.add_argument("--one", type=float, help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.one is not None:
        print(json.dumps(measure(chosen.one)))
        return
    print("length, s  strides  files, MB  read, ms  analyse, ms  analyse, ms a minute  peak, MB")
    for length in chosen.lengths:
        done = subprocess.run(  # noqa: S603
            [sys.executable, str(Path(__file__)), "--one", str(length)],
            stdout=subprocess.PIPE,
            check=True,
            env=os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
        )
        row = json.loads(done.stdout)
        print(
            f"{row['seconds']:9.0f}{row['strides']:9d}{row['files_mb']:11.1f}{row['read_ms']:10.1f}{row['analyse_ms']:13.1f}"
            f"{row['analyse_ms'] * 60 / row['seconds']:22.1f}{row['peak_mb']:10.0f}"
        )


if __name__ == "__main__":
    main()
