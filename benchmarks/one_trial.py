"""How long one trial takes: parse, analyse, figures, report. ``python benchmarks/one_trial.py FOOT_FILE FOOT_FILE``.

Each stage is run several times in one process; the median is printed, and beside it the time pandas needs to parse the same
text, which bounds what any reader can reach.
"""

from __future__ import annotations

import argparse
import datetime as dt
import io
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import pandas as pd

from gaitlab.analysis import Settings, analyze
from gaitlab.recording import read_files
from gaitlab.recording.intake import load
from gaitlab.recording.selection import place_files
from gaitlab.report import TrialReport, build_report, report_html, report_pdf


def median_ms(work: Callable[[], object], repeats: int) -> float:
    """Median duration in milliseconds after one warm-up."""
    work()
    spans = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()
        spans.append(time.perf_counter() - began)
    return 1000 * statistics.median(spans)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--repeats", type=int, default=20)
    chosen = parser.parse_args()
    files = place_files(load(chosen.files)).files
    recording = read_files(files)
    analysis = analyze(recording, Settings(course_m=7.62))
    now = dt.datetime.now(dt.UTC)
    trial = TrialReport(1, analysis.result, analysis.series)
    report = build_report(None, None, [trial], created_at=now)

    def pandas_only() -> None:
        for file in files.values():
            lines = file.content.split(b"\n", 40)
            header = next(i for i, line in enumerate(lines) if b"PacketCounter" in line)
            pd.read_csv(
                io.BytesIO(file.content),
                sep="," if b"," in lines[header] else "\t",
                skiprows=header,
                engine="c",
            )

    stages: dict[str, Callable[[], object]] = {
        "pandas parses the text": pandas_only,
        "read": lambda: read_files(files),
        "analyse": lambda: analyze(recording, Settings(course_m=7.62)),
        "word the report, draw the figures": lambda: build_report(None, None, [trial], created_at=now),
        "HTML": lambda: report_html(report),
        "PDF": lambda: report_pdf(report),
    }
    seconds = max(sensor.n_samples / sensor.rate_hz for sensor in recording.sensors.values())
    print(f"{len(files)} sensors, {seconds:.0f} s")
    for name, work in stages.items():
        print(f"{name:<36}{median_ms(work, chosen.repeats if 'PDF' not in name else 5):8.1f} ms")


if __name__ == "__main__":
    main()
