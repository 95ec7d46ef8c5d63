"""The file doctor: what a file is, how well it was recorded, and what each finding means for a result."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from gaitlab.errors import InputError
from gaitlab.recording.families import read_samples
from gaitlab.recording.file import InputFile
from gaitlab.recording.model import Finding, Placement
from gaitlab.recording.packets import Gap, find_gaps
from gaitlab.recording.placing import device_of
from gaitlab.recording.quality import clock_findings
from gaitlab.recording.rates import Rate, assumed_rate, check_rate, decide_rate
from gaitlab.recording.reading import to_sensor
from gaitlab.recording.samples import Rates, Samples
from gaitlab.recording.units import unit_evidence
from gaitlab.recording.useless import use_findings

_SHOWN_GAPS = 8
_MISSING = {
    "accelerometer": "Paths rest on the device's free acceleration, and rests are found by rotation alone.",
    "gyroscope": "Orientation comes from the device, and rests and foot contacts cannot be told by rotation.",
    "orientation": "It is estimated from accelerometer and gyroscope; headings are relative to the walk.",
    "magnetometer": "Headings rest on the gyroscope; over one walk that is usual and enough.",
    "free acceleration": "It is computed from accelerometer and orientation, as always.",
    "pressure": "Heights come from the motion alone, and floors of a building cannot be told.",
}


@dataclass(frozen=True)
class Problem:
    """Why a file cannot be used: the content of the :class:`InputError` its reader raised."""

    code: str
    message: str
    hint: str
    line: int | None
    column: str | None


@dataclass(frozen=True)
class Clock:
    """The packet clock: its rate, where that came from (user, header, stamps, assumed), and its span."""

    rate_hz: float
    rate_origin: str
    header_hz: float | None
    stamps_hz: float | None
    first_packet: int
    last_packet: int
    n_wraps: int
    duration_s: float


@dataclass(frozen=True)
class Losses:
    """Packets that did not arrive; ``gaps`` are in order, by the unwrapped counter."""

    n_gaps: int
    n_lost: int
    share: float
    longest_s: float
    gaps: tuple[Gap, ...]


@dataclass(frozen=True)
class Quantity:
    """One measured quantity: is it there, and what follows."""

    name: str
    present: bool
    meaning: str


@dataclass(frozen=True)
class FileReport:
    """All that can be told of one file. ``clock`` and ``losses`` are None where ``problem`` says why.

    ``size_bytes``, ``n_samples`` (received) and ``n_saturated`` are counts; ``units`` are sentences.
    """

    name: str
    sha256: str
    size_bytes: int
    family: str | None = None
    device: str | None = None
    clock: Clock | None = None
    n_samples: int = 0
    losses: Losses | None = None
    n_saturated: int = 0
    quantities: tuple[Quantity, ...] = ()
    units: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()
    problem: Problem | None = None


def examine(file: InputFile, rate_hz: float | None = None) -> FileReport:
    """Tell what a file is and how good; a file that cannot be used gets its reason, not an exception.

    Raises
    ------
    InputError
        ``bad_rate`` if the rate given is none.
    """
    if rate_hz is not None:
        check_rate(rate_hz)
    try:
        samples = read_samples(file)
        rate = decide_rate(samples.rates, rate_hz) or assumed_rate(refused_hz=samples.rates.refused_hz)
        sensor = to_sensor(Placement.LEFT_FOOT, samples, rate)
    except InputError as error:
        return unusable(file, error)
    gaps = tuple(find_gaps(samples.packet))
    longest = max((gap.n_lost for gap in gaps), default=0)
    return FileReport(
        name=file.name,
        sha256=file.sha256,
        size_bytes=len(file.content),
        family=samples.family,
        device=samples.device,
        clock=_clock(samples.rates, rate, samples, sensor.n_samples),
        n_samples=len(samples.packet),
        losses=Losses(len(gaps), sensor.n_lost, sensor.n_lost / sensor.n_samples, longest / rate.hz, gaps),
        n_saturated=sensor.n_saturated,
        quantities=_quantities(samples),
        units=unit_evidence(samples),
        findings=(
            *rate.findings,
            *samples.findings,
            *clock_findings(samples, sensor),
            *use_findings(samples, rate.hz),
        ),
    )


def unusable(file: InputFile, error: InputError) -> FileReport:
    """The report on a file that cannot be used, such as a zip that cannot be unpacked."""
    problem = Problem(error.code, error.message, error.hint, error.line, error.column)
    return FileReport(file.name, file.sha256, len(file.content), device=device_of(file), problem=problem)


def to_dict(report: FileReport) -> dict[str, Any]:
    """The report as plain data, ready for JSON."""
    return asdict(report)


def describe(report: FileReport) -> str:
    """The report as text for people: each fact, followed by what it means for the result."""
    lines = [report.name]
    if report.problem is not None:
        lines += _problem_lines(report.problem)
    else:
        lines += [
            *_clock_lines(report),
            *_loss_lines(report),
            *_quantity_lines(report),
            *_finding_lines(report),
        ]
    return "\n".join([lines[0], *(f"  {line}" for line in lines[1:])])


def _clock(rates: Rates, rate: Rate, samples: Samples, n_packets: int) -> Clock:
    first = int(samples.packet[0])
    last = int(samples.packet[-1])
    duration_s = (n_packets - 1) / rate.hz
    return Clock(
        rate.hz, rate.origin, rates.header_hz, rates.stamps_hz, first, last, samples.n_wraps, duration_s
    )


def _quantities(samples: Samples) -> tuple[Quantity, ...]:
    there = {
        "accelerometer": samples.acc_mps2,
        "gyroscope": samples.gyr_radps,
        "orientation": samples.attitude,
        "magnetometer": samples.mag,
        "free acceleration": samples.free_acc_mps2,
        "pressure": samples.pressure_pa,
    }
    return tuple(
        Quantity(name, values is not None, _present(name, samples) if values is not None else _MISSING[name])
        for name, values in there.items()
    )


def _present(name: str, samples: Samples) -> str:
    if name == "orientation" and samples.orientation_from:
        anew = "it can be used or estimated anew" if samples.gyr_radps is not None else "it is used"
        return f"Given by the device as {samples.orientation_from}; {anew}."
    return ""


def _problem_lines(problem: Problem) -> list[str]:
    place = ", ".join(
        part
        for part in (
            f"line {problem.line}" if problem.line is not None else "",
            f"column {problem.column}" if problem.column else "",
        )
        if part
    )
    lines = [f"Cannot be used: {problem.message}"]
    if place:
        lines.append(f"Where: {place}")
    return [*lines, f"What to do: {problem.hint}"] if problem.hint else lines


def _clock_lines(report: FileReport) -> list[str]:
    clock = report.clock
    assert clock is not None
    origin = {
        "user": "as given by you",
        "header": "from the header",
        "stamps": "from the device's time stamps",
        "assumed": "ASSUMED: the file does not say it, or not rightly",
    }[clock.rate_origin]
    if clock.rate_origin == "header" and clock.stamps_hz is not None:
        origin += ", confirmed by the device's time stamps"
    wraps = f", the counter wrapped {_times(clock.n_wraps)} (undone)" if clock.n_wraps else ""
    return [
        f"Kind: {report.family}, {report.size_bytes / 1000:.0f} kB",
        f"Sensor: {report.device or 'number not stated; the placement must come from the file name or from you'}",
        f"Rate: {clock.rate_hz:g} Hz, {origin}. Every time and length rests on it.",
        f"Clock: packets {clock.first_packet} to {clock.last_packet}, {clock.duration_s:.2f} s{wraps}.",
    ]


def _times(n: int) -> str:
    return "once" if n == 1 else f"{n} times"


def _loss_lines(report: FileReport) -> list[str]:
    losses = report.losses
    assert losses is not None
    if not losses.n_gaps:
        lines = [f"Samples: {report.n_samples}, none lost."]
    else:
        shown = ", ".join(f"{gap.start_packet} ({gap.n_lost})" for gap in losses.gaps[:_SHOWN_GAPS])
        more = f" and {losses.n_gaps - _SHOWN_GAPS} more" if losses.n_gaps > _SHOWN_GAPS else ""
        gaps = f"{losses.n_gaps} gap{'s' if losses.n_gaps != 1 else ''}, the longest {losses.longest_s:.2f} s"
        lost = f"{losses.n_lost} lost ({losses.share:.1%}) in {gaps}"
        lines = [
            f"Samples: {report.n_samples} received, {lost}. They are filled; strides with gaps are less certain.",
            f"Gaps at packet (length): {shown}{more}.",
        ]
    if report.n_saturated:
        lines.append(
            f"Saturated: {report.n_saturated} samples stood at the end of the range; the lengths of their strides "
            "are less certain."
        )
    else:
        lines.append("Saturated: none; the sensor's range was wide enough.")
    return lines


def _quantity_lines(report: FileReport) -> list[str]:
    lines = []
    for quantity in report.quantities:
        state = "present" if quantity.present else "missing"
        lines.append(f"{quantity.name.capitalize()}: {state}. {quantity.meaning}".rstrip())
    return lines + [f"Units: {sentence}" for sentence in report.units]


def _finding_lines(report: FileReport) -> list[str]:
    return [f"Note: {finding.message}" for finding in report.findings] or ["Note: nothing else stands out."]
