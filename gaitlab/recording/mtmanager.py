"""MT Manager text exports in all their variants, and the 10 m walk set that was written after them.

The header is found by ``PacketCounter``; columns are known by name, never by place; time columns may be
empty.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from gaitlab.errors import InputError
from gaitlab.recording import attitude as rotation
from gaitlab.recording import heading as h
from gaitlab.recording import units
from gaitlab.recording.columns import Columns
from gaitlab.recording.decoding import plain_text
from gaitlab.recording.file import LIMITS, InputFile, Limits
from gaitlab.recording.foreign import not_mt_manager, refuse_foreign
from gaitlab.recording.heading import Header, find_header
from gaitlab.recording.model import Bools, Finding, Floats
from gaitlab.recording.packets import unwrap
from gaitlab.recording.rates import rate_from_stamps
from gaitlab.recording.samples import Packets, Rates, Samples
from gaitlab.recording.table import read_table

FAMILY = "MT Manager text export"
_DEVICE_IN_NAME = re.compile(r"_([0-9A-F]{8})\.[A-Za-z]+$", re.IGNORECASE)
_ORIENTATIONS = {h.QUATERNION: "quaternions", h.MATRIX: "rotation matrices", h.EULER: "Euler angles"}
_GROUPS = (h.ACC, h.GYR, h.MAG, h.FREE_ACC, *_ORIENTATIONS, h.PRESSURE)


@dataclass(frozen=True)
class ReaderParams:
    """When numbers are missing or an orientation is none."""

    most_nan_share: float = 0.10
    """More rows without numbers than this, and the file is refused: what fills them would be invention."""
    norm_tolerance: float = 0.02
    """How far a quaternion's norm or an element of R Rᵀ may be off; files round to 4 to 6 digits."""


PARAMS = ReaderParams()


def read(file: InputFile, limits: Limits = LIMITS) -> Samples:
    """Read one sensor's samples as they were sent.

    Raises
    ------
    InputError
        With file, line and column. From here ``not_mt_manager``, ``movella_dot``, ``missing_columns``,
        ``infinite``, ``empty_column``, ``too_many_nan``, ``bad_orientation``; further those of
        :func:`plain_text`, :func:`find_header`, :func:`read_table`, :func:`unwrap` and :func:`units.check`.
    """
    content = plain_text(file)
    header = find_header(file.name, content, limits)
    refuse_foreign(file, header)
    if header is None:
        raise not_mt_manager(file)
    units.check_headings(header)
    names = [h.COUNTER, *_stamp(header, content), *(name for group in _groups(header) for name in group)]
    names.sort(key=header.index.__getitem__)
    table = read_table(content, header, [header.index[name] for name in names], limits)
    return _samples(file, Columns.of(header, table, names))


def device_in_name(name: str) -> str | None:
    """The device number that MT Manager puts at the end of a file's name."""
    match = _DEVICE_IN_NAME.search(name)
    return match[1].upper() if match else None


def _groups(header: Header) -> list[tuple[str, ...]]:
    """The complete groups of columns to read; the header must hold enough to reconstruct a movement."""
    present = [group for group in _GROUPS if header.has(group)]
    orientation = next((group for group in _ORIENTATIONS if group in present), None)
    incomplete = [
        group
        for group in (h.ACC, h.GYR)
        if group not in present and not header.index.keys().isdisjoint(group)
    ]
    enough = h.FREE_ACC in present or (h.ACC in present and (h.GYR in present or orientation is not None))
    if incomplete or not enough:
        wanted = incomplete or [h.ACC, h.GYR]
        missing = [h.SPELLING[name] for group in wanted for name in group if name not in header.index]
        raise InputError(
            "missing_columns",
            f"Columns are missing: {', '.join(missing)}.",
            "Export accelerometer and gyroscope (Acc_X … Gyr_Z), best with the orientation too.",
            file=header.file,
            line=header.line,
            column=missing[0],
        )
    return [group for group in present if group not in _ORIENTATIONS or group == orientation]


def _incomplete(header: Header) -> list[Finding]:
    """Say which optional quantities cannot be used since a column of theirs is missing."""
    found = []
    for group in (h.MAG, h.FREE_ACC, *_ORIENTATIONS):
        there = [name for name in group if name in header.index]
        if there and len(there) < len(group):
            missing = ", ".join(h.SPELLING[name] for name in group if name not in header.index)
            message = (
                f"{header.heading(there[0])} and its companions are not used, since {missing} is missing."
            )
            found.append(Finding("incomplete_columns", message))
    return found


def _stamp(header: Header, content: bytes) -> list[str]:
    """The time stamps' column, unless it is empty from the start, as it often is."""
    if h.STAMP not in header.index:
        return []
    fields = content[header.body : content.find(b"\n", header.body)].split(header.delimiter.encode())
    position = header.index[h.STAMP]
    token = fields[position].strip() if position < len(fields) else b""
    return [h.STAMP] if re.fullmatch(rb"[0-9.]+", token) else []


def _samples(file: InputFile, columns: Columns) -> Samples:
    header = columns.header
    _refuse_infinite(columns)
    packet, modulus, n_wraps = unwrap(
        columns[h.COUNTER], file.name, header.heading(h.COUNTER), columns.line_of
    )
    stamps_hz = rate_from_stamps(packet, columns[h.STAMP]) if h.STAMP in columns else None
    said: list[Finding] = _incomplete(header)
    columns, packet = _usable(columns, packet, said)
    attitude = _attitude(columns, packet, said)
    mag = _optional(columns.group(h.MAG), packet, "magnetometer", said)
    free_acc = _optional(columns.group(h.FREE_ACC), packet, "device's free acceleration", said)
    pressure = _optional(columns.group(h.PRESSURE), packet, "pressure", said)
    samples = Samples(
        file=file,
        family=FAMILY,
        packet=packet,
        modulus=modulus,
        rates=Rates(header.rate_hz, stamps_hz, None if header.rate_hz else header.stated_hz),
        device=header.device or device_in_name(file.name),
        acc_mps2=columns.group(h.ACC),
        gyr_radps=columns.group(h.GYR),
        mag=mag,
        free_acc_mps2=free_acc,
        attitude=attitude,
        pressure_pa=None if pressure is None else pressure[:, 0],
        orientation_from=next((_ORIENTATIONS[group] for group in _ORIENTATIONS if group[0] in columns), None),
        n_wraps=n_wraps,
        findings=tuple(said),
    )
    return units.check(samples, header, columns.line_of)


def _refuse_infinite(columns: Columns) -> None:
    values = columns.table.values
    if not np.isinf(values).any():
        return
    row, place = np.argwhere(np.isinf(values))[0]
    name = next(name for name, at in columns.place.items() if at == place)
    raise InputError(
        "infinite",
        "The number is infinite.",
        "Correct the field or export the recording again.",
        file=columns.header.file,
        line=columns.line_of(int(row)),
        column=columns.header.heading(name),
    )


def _usable(columns: Columns, packet: Packets, said: list[Finding]) -> tuple[Columns, Packets]:
    """Treat rows without accelerometer or gyroscope as lost; refuse where they are many."""
    needed = [*h.ACC, *h.GYR] if h.ACC[0] in columns else [*h.FREE_ACC, *h.GYR]
    missing = {name: np.isnan(columns[name]) for name in needed if name in columns}
    unusable = np.logical_or.reduce(list(missing.values()))
    n_unusable = int(np.count_nonzero(unusable))
    if not n_unusable:
        return columns, packet
    header = columns.header
    first = int(np.argmax(unusable))
    for name, nan in missing.items():
        if nan.all():
            raise InputError(
                "empty_column",
                "The column holds no numbers.",
                "Export the recording again with this quantity ticked.",
                file=header.file,
                line=columns.line_of(0),
                column=header.heading(name),
            )
    worst = max((name for name in missing if missing[name][first]), key=lambda name: int(missing[name].sum()))
    if n_unusable > PARAMS.most_nan_share * len(packet):
        raise InputError(
            "too_many_nan",
            f"{n_unusable} of {len(packet)} rows hold no number for accelerometer or gyroscope.",
            "Export the recording again; if it stays so, the sensor or its radio link failed.",
            file=header.file,
            line=columns.line_of(first),
            column=header.heading(worst),
        )
    message = (
        f"{n_unusable} of {len(packet)} rows hold no number (first in line {columns.line_of(first)}, column "
        f"{header.heading(worst)}); they are treated as lost samples, and strides there are less certain."
    )
    said.append(Finding("nan_rows", message))
    return columns.keep(~unusable), packet[~unusable]


def _attitude(columns: Columns, packet: Packets, said: list[Finding]) -> Floats | None:
    """The device's orientation as continuous unit quaternions (n, 4), in a world whose z axis points up."""
    names = next((group for group in _ORIENTATIONS if group[0] in columns), None)
    if names is None:
        return None
    values = _optional(columns.group(names), packet, "device's orientation", said, interpolate=False)
    if values is None:
        return None
    known = np.isfinite(values).all(axis=1)
    given = values if known.all() else values[known]
    _refuse_no_rotation(columns, names, given, np.flatnonzero(known))
    if names == h.EULER:
        quaternion = rotation.from_euler(*given.T)
    elif names == h.MATRIX:
        quaternion = rotation.from_matrix(given.reshape(-1, 3, 3))
    else:
        quaternion = rotation.unit(given)
    quaternion = rotation.continuous(quaternion)
    if not known.all():
        quaternion = rotation.unit(_interpolate(packet, packet[known], quaternion))
    return rotation.ned_to_enu(quaternion) if columns.header.frame == "NED" else quaternion


def _refuse_no_rotation(columns: Columns, names: tuple[str, ...], values: Floats, rows: Packets) -> None:
    if names == h.EULER:
        wrong = np.abs(values).max(axis=1) > 360.5
        what = "The angles are beyond a full turn"
    elif names == h.MATRIX:
        matrix = values.reshape(-1, 3, 3)
        product = np.einsum("nij,nkj->nik", matrix, matrix)
        wrong = np.abs(product - np.eye(3)).max(axis=(1, 2)) > PARAMS.norm_tolerance
        wrong |= np.linalg.det(matrix) < 0
        what = "The matrix is not a rotation"
    else:
        norm = np.sqrt(np.einsum("ij,ij->i", values, values))
        wrong = np.abs(norm - 1) > PARAMS.norm_tolerance
        what = "The quaternion's norm is not 1"
    if wrong.any():
        raise InputError(
            "bad_orientation",
            f"{what}.",
            "Export the recording again, or without its orientation.",
            file=columns.header.file,
            line=columns.line_of(int(rows[int(np.argmax(wrong))])),
            column=columns.header.heading(names[0]),
        )


def _optional(
    values: Floats | None, packet: Packets, what: str, said: list[Finding], *, interpolate: bool = True
) -> Floats | None:
    """Values with their few missing rows interpolated; None, and said, where too many are missing."""
    if values is None:
        return None
    known: Bools = np.asarray(np.isfinite(values).all(axis=1))
    if known.all():
        return values
    n_missing = len(known) - int(np.count_nonzero(known))
    if n_missing > PARAMS.most_nan_share * len(known):
        message = f"The {what} is missing in {n_missing} of {len(known)} rows and is not used."
        said.append(Finding("column_not_used", message))
        return None
    return _interpolate(packet, packet[known], values[known]) if interpolate else values


def _interpolate(packet: Packets, known: Packets, values: Floats) -> Floats:
    return np.stack([np.interp(packet, known, column) for column in values.T], axis=1)
