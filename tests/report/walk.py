"""A walk in closed form as Result and Series: 10 m out, a turn to the left, 10 m back."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence

import numpy as np

from gaitlab.recording.model import Floats, Placement, Side
from gaitlab.result import (
    Clock,
    Events,
    Foot,
    Input,
    Interval,
    Knee,
    KneeStride,
    KneeSway,
    Parameter,
    Provenance,
    Rest,
    Result,
    ResultWarning,
    SensorQuality,
    Stride,
    TimedWalk,
    Turn,
    Walk,
    settings_sha256,
)
from gaitlab.series import SensorSeries, Series

RATE_HZ = 100.0
STAND_S, SWING_S, STANCE_S, STRIDE_M = 3.0, 0.45, 0.65, 1.3
STRAIGHT_M, RADIUS_M = 10.0, 0.45


def _route(along_m: Floats, aside_m: float) -> tuple[Floats, Floats]:
    """Place on the floor of a point ``aside_m`` to the left of the line, ``along_m`` along it."""
    arc = math.pi * RADIUS_M
    angle = np.clip((along_m - STRAIGHT_M) / RADIUS_M, 0.0, math.pi)
    out, back = np.minimum(along_m, STRAIGHT_M), np.maximum(along_m - STRAIGHT_M - arc, 0.0)
    radius = RADIUS_M - aside_m
    return out - back + radius * np.sin(angle), RADIUS_M - radius * np.cos(angle)


def _swings(side: Side, half_walk: bool = False) -> list[tuple[float, float, float]]:
    """(start, end, length) of each swing: a short first one, whole ones, a short last one."""
    total = STRAIGHT_M if half_walk else 2 * STRAIGHT_M + math.pi * RADIUS_M
    period = SWING_S + STANCE_S
    start = STAND_S + (0.0 if side is Side.LEFT else period / 2)
    first = STRIDE_M / 2 if side is Side.LEFT else STRIDE_M
    lengths = [first]
    while sum(lengths) + STRIDE_M < total:
        lengths.append(STRIDE_M)
    lengths.append(total - sum(lengths))
    return [(start + i * period, start + i * period + SWING_S, length) for i, length in enumerate(lengths)]


def _along(t_s: Floats, swings: Sequence[tuple[float, float, float]]) -> tuple[Floats, Floats]:
    """Way along the line and height: minimum jerk in each swing."""
    along, height = np.zeros_like(t_s), np.zeros_like(t_s)
    for start, end, length in swings:
        u = np.clip((t_s - start) / (end - start), 0.0, 1.0)
        along += length * (10 * u**3 - 15 * u**4 + 6 * u**5)
        height += 0.14 * 64 * u**3 * (1 - u) ** 3
    return along, height


def _sensor(t_s: Floats, position_m: Floats, rest: Floats, bias: Floats, lost_share: float) -> SensorSeries:
    velocity = np.gradient(position_m, t_s, axis=0)
    acceleration = np.gradient(velocity, t_s, axis=0)
    t = (t_s - t_s[0])[:, None]
    lost = np.zeros(len(t_s), dtype=bool)
    if lost_share:
        lost[:: round(1 / lost_share)] = True
        lost[900:960] = True
    return SensorSeries(
        t_s,
        lost,
        rest.astype(bool),
        acceleration,
        velocity,
        position_m,
        velocity + bias * t,
        position_m + bias * t**2 / 2,
    )


def series(sides: Sequence[Side] = tuple(Side), knees: bool = True, duration_s: float = 25.0) -> Series:
    """Feet (and knees) of the closed-form walk."""
    t_s = np.arange(round(duration_s * RATE_HZ)) / RATE_HZ
    built: dict[Placement, SensorSeries] = {}
    for side in sides:
        aside = 0.09 if side is Side.LEFT else -0.09
        swings = _swings(side)
        along, height = _along(t_s, swings)
        x, y = _route(along, aside)
        rest = np.ones(len(t_s))
        for start, end, _ in swings:
            rest[(t_s >= start - 0.12) & (t_s < end + 0.08)] = 0
        bias = np.array([0.03, -0.02, 0.012]) * (1 if side is Side.LEFT else -0.7)
        built[Placement.foot(side)] = _sensor(
            t_s, np.column_stack((x, y, height)), rest, bias, 0.02 if side is Side.LEFT else 0.0
        )
        if knees:
            width = round(0.55 * RATE_HZ)
            kernel = np.hanning(width) / np.hanning(width).sum()
            smooth = np.convolve(np.pad(along, width, mode="edge"), kernel, mode="same")[width:-width]
            kx, ky = _route(smooth, aside)
            bob = 0.45 + 0.02 * np.sin(2 * math.pi * t_s / (SWING_S + STANCE_S) * 2)
            built[Placement.knee(side)] = _sensor(t_s, np.column_stack((kx, ky, bob)), rest, bias * 1.4, 0.0)
    return {p: built[p] for p in Placement if p in built}


def parameter(
    name: str,
    side: str,
    value: float | None,
    sd: float | None = None,
    *,
    unit: str = "m",
    label: str = "",
    group: str = "Space",
    n: int = 14,
    status: str = "",
    reason: str = "",
    decimals: int = 2,
) -> Parameter:
    """A parameter as an analysis stores it."""
    interval = None if value is None or sd is None else (value - 1.96 * sd, value + 1.96 * sd)
    return Parameter(
        name=name,
        side=side,
        unit=unit,
        value=value,
        sd=sd,
        ci95=interval,
        n=n,
        status=status or ("ok" if value is not None else "not_determinable"),
        reason=reason,
        definition=f"What {label or name} means, in one sentence.",
        label=label or name.replace("_", " ").capitalize(),
        group=group,
        reference="A. Author 2018, table 1",
        decimals=decimals,
    )


def parameters(sides: Sequence[Side] = tuple(Side)) -> tuple[Parameter, ...]:
    """Plausible parameters, some with reserve, some not determinable."""
    made: list[Parameter] = []
    for side in sides:
        shift = 0.01 if side is Side.LEFT else -0.01
        made += [
            parameter("stride_length", side, 1.304 + shift, 0.0127),
            parameter("stride_velocity", side, 1.182 + shift, 0.0113, unit="m/s"),
            parameter("stride_time", side, 1.1004, 0.0041, unit="s", group="Time"),
            parameter("stance", side, 61.3 + shift, 0.84, unit="%", group="Time", decimals=1),
        ]
    both = len(sides) == 2
    only = "" if both else "Only one foot was recorded; two are needed."
    made += [
        parameter("cadence", "both", 109.1, 0.93, unit="steps/min", group="Time", decimals=1),
        parameter(
            "step_length",
            "both",
            0.652 if both else None,
            0.021,
            reason=only or "The feet start side by side.",
        ),
        parameter(
            "step_width",
            "both",
            0.18 if both else None,
            0.055,
            reason=only or "The feet start side by side.",
            status="attention" if both else "",
        ),
        parameter("knee_sway", "left", None, None, n=0, reason="No knee was recorded on this side."),
    ]
    return tuple(made)


def _foot(side: Side, seed: int) -> Foot:
    chance = np.random.default_rng(seed)
    swings = _swings(side)
    edges = [0.0, *(t for start, end, _ in swings for t in (start - 0.12, end + 0.08)), 25.0]
    rests = tuple(
        Rest(
            start_s=round(a, 2),
            end_s=round(b, 2),
            residual_velocity_mps=round(float(chance.uniform(0.01, 0.06)), 4),
        )
        for a, b in zip(edges[::2], edges[1::2], strict=True)
    )
    strides = tuple(
        Stride(
            start_s=(before.start_s + before.end_s) / 2,
            end_s=(after.start_s + after.end_s) / 2,
            length_m=length,
            length_sd_m=0.02 + 0.01 * (i % 3),
            duration_s=1.1,
            speed_mps=length / 1.1,
            turning=8 <= i <= 9,
        )
        for i, (before, after, (_, _, length)) in enumerate(zip(rests, rests[1:], swings, strict=False))
    )
    return Foot(
        rests=rests,
        events=Events(
            foot_off_s=tuple(s for s, _, _ in swings), initial_contact_s=tuple(e for _, e, _ in swings)
        ),
        strides=strides,
        distance_m=sum(length for _, _, length in swings),
        distance_sd_m=0.11,
    )


def result(
    sides: Sequence[Side] = tuple(Side),
    knees: bool = True,
    *,
    chosen: tuple[Parameter, ...] | None = None,
    warnings: tuple[ResultWarning, ...] = (),
    names: dict[str, str] | None = None,
) -> Result:
    """The result that belongs to ``series``."""
    placements = [p for p in Placement if p.side in sides and (p.is_foot or knees)]
    settings: dict[str, object] = {"method": "gaitlab", "course_m": 10.0}
    return Result(
        provenance=Provenance(
            gaitlab="0.1.0",
            method="gaitlab",
            settings=settings,
            settings_sha256=settings_sha256(settings),
            inputs=tuple(
                Input(
                    placement=p,
                    name=(names or {}).get(p, f"1-1_{p.value}.txt"),
                    sha256=hashlib.sha256(p.encode()).hexdigest(),
                )
                for p in placements
            ),
        ),
        clock=Clock(rate_hz=RATE_HZ, first_packet=4711),
        sensors={
            p.value: SensorQuality(
                samples=2500, lost=110 if p is Placement.LEFT_FOOT else 0, saturated=3, device="00B40C55"
            )
            for p in placements
        },
        feet={side.value: _foot(side, 7) for side in sides},
        knees={
            side.value: Knee(
                strides=(KneeStride(start_s=3.0, end_s=4.1, length_m=1.31, residual_m=0.012),),
                sway=KneeSway(lateral_sd_m=0.011, lateral_range_m=0.052, n=14),
            )
            for side in sides
            if knees
        },
        walk=Walk(straights=(), turns=(), closing_error_m={})
        if not sides
        else Walk(
            straights=(Interval(start_s=3.0, end_s=11.2), Interval(start_s=13.0, end_s=22.0)),
            turns=(Turn(start_s=11.2, end_s=13.0, angle_deg=178.6),),
            closing_error_m={side.value: 0.12 for side in sides},
            timed=TimedWalk(
                course_m=10.0, start_s=3.0, end_s=11.04, rule="From the first movement of a foot."
            ),
        ),
        parameters=parameters(sides) if chosen is None else chosen,
        warnings=warnings,
    )
