"""From files to a recording: each placed and read, then all laid on one clock."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import combinations
from pathlib import Path

from gaitlab.errors import InputError
from gaitlab.recording.alignment import align
from gaitlab.recording.families import read_samples
from gaitlab.recording.file import InputFile
from gaitlab.recording.model import Finding, Placement, Recording, Sensor, Source
from gaitlab.recording.packets import regular_grid
from gaitlab.recording.quality import clock_findings
from gaitlab.recording.rates import Rate, assumed_rate, check_rate, decide_rate, same_rate
from gaitlab.recording.samples import Samples


def read_recording(
    *paths: Path | str, placements: Mapping[Placement, Path | str] | None = None, rate_hz: float | None = None
) -> Recording:
    """Read the sensors of one trial.

    Parameters
    ----------
    paths : Path or str
        Files, folders or zips. Where each sensor was worn is told by ``placements``, by a ``placement.json``
        among the files, by file names, or by the device numbers in it.
    placements : mapping, optional
        Files named outright; a name found among ``paths`` is enough.
    rate_hz : float, optional
        Wins over what the files say.

    Raises
    ------
    InputError
        One sentence on what is wrong, with file, line and column where there are such.
    """
    from gaitlab.recording.selection import select_files

    selection = select_files(paths, placements or {})
    recording = read_files(selection.files, rate_hz)
    return replace(recording, findings=recording.findings + selection.findings)


def read_files(files: Mapping[Placement, InputFile], rate_hz: float | None = None) -> Recording:
    """Read files whose placement is known into one recording.

    Raises
    ------
    InputError
        ``no_files``, ``same_content``, ``same_device``, ``different_rates``, ``no_overlap``, and those of the
        readers.
    """
    if not files:
        raise InputError("no_files", "There is no sensor file.", "Give at least the file of one foot.")
    if rate_hz is not None:
        check_rate(rate_hz)
    _refuse_same_content(files)
    samples = {placement: read_samples(files[placement]) for placement in Placement if placement in files}
    _refuse_same_device(samples)
    rates = _rates(samples, rate_hz)
    shifts = align(samples)
    findings: list[Finding] = []
    sensors: dict[Placement, Sensor] = {}
    for placement, one in samples.items():
        sensors[placement] = to_sensor(placement, one, rates[placement], shifts[placement])
        said = (*rates[placement].findings, *one.findings, *clock_findings(one, sensors[placement]))
        findings += [replace(finding, placement=placement) for finding in said]
    return Recording(sensors, tuple(findings))


def to_sensor(placement: Placement, samples: Samples, rate: Rate, shift: int = 0) -> Sensor:
    """Lay one sensor's samples on its regular packet clock and fill what was lost: by the next one where a sample is a
    mean since the one before it, else by straight lines."""
    grid = regular_grid(samples.packet, samples.file.name)
    saturated = ~grid.received
    saturated[:] = False
    saturated[grid.row] = samples.saturated
    fill = grid.hold_next if samples.averaged else grid.interpolate
    return Sensor(
        placement=placement,
        source=Source(samples.file.name, samples.file.sha256, len(samples.file.content)),
        rate_hz=rate.hz,
        first_packet=grid.first_packet + shift,
        received=grid.received,
        saturated=saturated,
        acc_mps2=fill(samples.acc_mps2),
        gyr_radps=fill(samples.gyr_radps),
        mag=grid.interpolate(samples.mag),
        free_acc_mps2=grid.interpolate(samples.free_acc_mps2),
        attitude=grid.interpolate_rotation(samples.attitude),
        pressure_pa=grid.interpolate(samples.pressure_pa),
        device=samples.device,
        averaged=samples.averaged,
    )


def _rates(samples: Mapping[Placement, Samples], rate_hz: float | None) -> dict[Placement, Rate]:
    known = {placement: decide_rate(one.rates, rate_hz) for placement, one in samples.items()}
    first = next(((placement, rate) for placement, rate in known.items() if rate), None)
    rates = {
        placement: rate or assumed_rate(first[1].hz if first else None, samples[placement].rates.refused_hz)
        for placement, rate in known.items()
    }
    for a, b in combinations(rates, 2):
        if not same_rate(rates[a].hz, rates[b].hz):
            raise InputError(
                "different_rates",
                f"The sensors were recorded at different rates: {_told(samples[a], a)} at {rates[a].hz:g} Hz, "
                f"{_told(samples[b], b)} at {rates[b].hz:g} Hz.",
                "Record all sensors together at one rate; if a header is wrong, give the rate.",
                file=samples[b].file.name,
            )
    return rates


def _refuse_same_content(files: Mapping[Placement, InputFile]) -> None:
    for a, b in combinations(files, 2):
        if files[a].sha256 == files[b].sha256:
            raise InputError(
                "same_content",
                f"{a.label.capitalize()} and {b.label} are the same file ({files[a].name}, {files[b].name}).",
                "Give each placement its own sensor's file.",
                file=files[b].name,
            )


def _refuse_same_device(samples: Mapping[Placement, Samples]) -> None:
    for a, b in combinations(samples, 2):
        if samples[a].device is not None and samples[a].device == samples[b].device:
            raise InputError(
                "same_device",
                f"{_told(samples[a], a)} and {_told(samples[b], b)} come from the same sensor, {samples[a].device}.",
                "Give each placement its own sensor's file of the same trial.",
                file=samples[b].file.name,
            )


def _told(samples: Samples, placement: Placement) -> str:
    return f"{placement.label} ({samples.file.name})"
