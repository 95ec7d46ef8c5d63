"""Are the numbers in the units they should be in? Gravity, range and the device's orientation tell."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from gaitlab.errors import InputError
from gaitlab.recording import heading as h
from gaitlab.recording.attitude import rotation_angle_rad, up_component
from gaitlab.recording.heading import Header
from gaitlab.recording.model import Finding, Floats
from gaitlab.recording.rates import DEFAULT_HZ
from gaitlab.recording.samples import Samples

LineOf = Callable[[int], int]


@dataclass(frozen=True)
class UnitParams:
    """What is possible. Checked on 92 foot recordings of 8 people and 9 sensors of a walk."""

    gyr_limit_radps: float = 45.0
    """The MTw ends at 2000 deg/s = 34.9 rad/s; a quarter more for calibration and wider ranges."""
    acc_limit_mps2: float = 250.0
    """The MTw ends at 160 m/s²."""
    unit_share: float = 0.005
    """From this share of rows beyond the limit the unit is wrong; below it, single values are."""
    gravity_mps2: tuple[float, float] = (5.0, 20.0)
    """The median size of the accelerometer lies near 9.8 even in running (seen: 9.9 to 10.9)."""
    gravity_g: tuple[float, float] = (0.6, 1.6)
    turning_radps: float = 0.5
    """Rows turning faster than this, by the device's orientation, are compared with the gyroscope."""
    turning_rows: int = 20
    rate_ratio_deg: float = 15.0
    """Gyroscope over rotation of the orientation: 1 if both are in rad/s, 57 if in deg/s."""
    up_share: float = 0.7
    """The device's vertical must carry at least this share of gravity on average."""
    pressure_pa: tuple[float, float] = (30_000.0, 120_000.0)


PARAMS = UnitParams()
_ACC_HINT = (
    "The accelerometer is expected in m/s² with gravity: export calibrated data from MT Manager unchanged."
)
_GYR_HINT = (
    "The gyroscope is expected in rad/s: export from MT Manager unchanged, or multiply deg/s by 0.0174533."
)


def check_headings(header: Header) -> None:
    """Refuse headings that state another unit, such as ``Gyr_X (deg/s)``."""
    for names, expected, code, hint in (
        (h.ACC, r"m\s*[/·*]?\s*s", "unit_acc", _ACC_HINT),
        (h.GYR, r"rad", "unit_gyr", _GYR_HINT),
        (h.EULER, r"deg|°", "unit_orientation", "Angles are expected in degrees."),
    ):
        for name in names:
            column = header.columns[header.index[name]] if name in header.index else None
            if column and column.unit and not re.match(expected, column.unit, re.IGNORECASE):
                raise InputError(
                    code,
                    f"The heading states the unit {column.unit}.",
                    hint,
                    file=header.file,
                    line=header.line,
                    column=column.heading,
                )


def check(samples: Samples, header: Header, line_of: LineOf) -> Samples:
    """Refuse impossible units and values; set aside orientation or pressure that cannot be right.

    Raises
    ------
    InputError
        ``unit_acc``, ``unit_gyr``, ``out_of_range``.
    """
    if samples.acc_mps2 is not None:
        _check_acc(samples.acc_mps2, header, line_of)
    if samples.gyr_radps is not None:
        _check_gyr(samples, header, line_of)
    return _check_pressure(_check_attitude(samples))


def _check_acc(acc_mps2: Floats, header: Header, line_of: LineOf, params: UnitParams = PARAMS) -> None:
    median = _median_size(acc_mps2)
    low, high = params.gravity_mps2
    if not low <= median <= high:
        looks = ""
        if params.gravity_g[0] <= median <= params.gravity_g[1]:
            looks = " They look like g."
        elif median < low:
            looks = " Gravity seems to have been removed."
        message = (
            f"Acc_X, Acc_Y, Acc_Z are not in m/s²: their median size is {median:.3g}, not near 9.8.{looks}"
        )
        raise InputError(
            "unit_acc", message, _ACC_HINT, file=header.file, line=header.line, column=header.heading("acc_x")
        )
    _check_range(acc_mps2, params.acc_limit_mps2, "m/s²", h.ACC, header, line_of)


def _check_gyr(samples: Samples, header: Header, line_of: LineOf, params: UnitParams = PARAMS) -> None:
    gyr = samples.gyr_radps
    assert gyr is not None
    evidence = ""
    n_beyond = _rows_beyond(gyr, params.gyr_limit_radps)
    if n_beyond > 1 and n_beyond >= params.unit_share * len(gyr):
        evidence = (
            f"{n_beyond / len(gyr):.0%} of the rows lie beyond {params.gyr_limit_radps:g} rad/s, "
            "more than the sensor can measure"
        )
    elif (ratio := _ratio_to_orientation(samples, params)) is not None and ratio > params.rate_ratio_deg:
        evidence = f"they are {ratio:.0f} times the rotation of the file's own orientation"
    if evidence:
        message = f"Gyr_X, Gyr_Y, Gyr_Z are not in rad/s: {evidence}. They look like deg/s."
        raise InputError(
            "unit_gyr", message, _GYR_HINT, file=header.file, line=header.line, column=header.heading("gyr_x")
        )
    _check_range(gyr, params.gyr_limit_radps, "rad/s", h.GYR, header, line_of)


def _rows_beyond(signal: Floats, limit: float) -> int:
    """How many rows (n, 3) hold a component beyond ± limit."""
    if max(signal.max(), -signal.min()) <= limit:
        return 0
    return int(np.count_nonzero((np.abs(signal) > limit).any(axis=1)))


def _check_range(
    signal: Floats, limit: float, unit: str, names: tuple[str, ...], header: Header, line_of: LineOf
) -> None:
    if not _rows_beyond(signal, limit):
        return
    row, axis = np.argwhere(np.abs(signal) > limit)[0]
    raise InputError(
        "out_of_range",
        f"{signal[row, axis]:.6g} {unit} is more than the sensor can measure.",
        "The row is damaged or in another unit; export the recording again.",
        file=header.file,
        line=line_of(int(row)),
        column=header.heading(names[axis]),
    )


def _ratio_to_orientation(samples: Samples, params: UnitParams = PARAMS) -> float | None:
    """Median of the gyroscope's rate over the orientation's; None where it cannot be told."""
    if samples.attitude is None or samples.gyr_radps is None or len(samples.packet) < 2:
        return None
    rate_hz = samples.rates.stamps_hz or samples.rates.header_hz or DEFAULT_HZ
    angle_rad = rotation_angle_rad(samples.attitude)
    turning_radps = angle_rad * rate_hz / np.diff(samples.packet)
    turning = turning_radps > params.turning_radps
    if np.count_nonzero(turning) < params.turning_rows:
        return None
    size = np.sqrt(np.einsum("ij,ij->i", samples.gyr_radps[1:], samples.gyr_radps[1:]))
    return float(np.median(size[turning] / turning_radps[turning]))


def _check_attitude(samples: Samples, params: UnitParams = PARAMS) -> Samples:
    """The mean of the accelerometer, turned into the world, must point up."""
    if samples.attitude is None or samples.acc_mps2 is None:
        return samples
    up = float(np.mean(up_component(samples.attitude, samples.acc_mps2)))
    if up >= params.up_share * _median_size(samples.acc_mps2):
        return samples
    contradiction = f"The device's orientation contradicts gravity: it puts {up:.1f} of 9.8 m/s² upwards"
    if samples.gyr_radps is None:
        raise InputError(
            "bad_orientation",
            f"{contradiction}.",
            "Export the recording again with the gyroscope, or with the orientation as quaternions.",
            file=samples.file.name,
        )
    message = f"{contradiction}; it is not used, and orientation is estimated from the other columns instead."
    return replace(samples, attitude=None).with_findings(Finding("attitude_contradicts_gravity", message))


def _check_pressure(samples: Samples, params: UnitParams = PARAMS) -> Samples:
    """Set aside a pressure that cannot be in pascal."""
    if samples.pressure_pa is None:
        return samples
    median = float(np.median(samples.pressure_pa))
    if params.pressure_pa[0] <= median <= params.pressure_pa[1]:
        return samples
    message = (
        f"The pressure column is not in pascal (median {median:.4g}) and is not used; heights come from the "
        "motion alone."
    )
    return replace(samples, pressure_pa=None).with_findings(Finding("unit_pressure", message))


def unit_evidence(samples: Samples) -> tuple[str, ...]:
    """What speaks for the units of samples that passed the checks: one sentence each."""
    said = []
    if samples.acc_mps2 is not None:
        said.append(
            f"the accelerometer's median size is {_median_size(samples.acc_mps2):.2f}; in m/s² it is near 9.8."
        )
    if samples.gyr_radps is not None:
        largest = float(np.abs(samples.gyr_radps).max())
        said.append(
            f"the gyroscope reaches {largest:.2f}; rad/s, as the sensor ends at 34.9 (in deg/s at 2000)."
        )
    ratio = _ratio_to_orientation(samples)
    if ratio is not None:
        said.append(f"the gyroscope turns {ratio:.2f} times as fast as the device's orientation; 1 is right.")
    if samples.attitude is not None and samples.acc_mps2 is not None:
        up = float(np.mean(up_component(samples.attitude, samples.acc_mps2)))
        said.append(f"the device's orientation puts {up:.2f} m/s² upwards on average; 9.8 is right.")
    return tuple(said)


def _median_size(vectors: Floats) -> float:
    return float(np.median(np.sqrt(np.einsum("ij,ij->i", vectors, vectors))))
