"""Put what was reconstructed into the form in which it is stored and sent."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from gaitlab import __version__, result
from gaitlab.gait.knees import KneeGait
from gaitlab.gait.lengths import distance_of
from gaitlab.gait.measurement import Measurement
from gaitlab.gait.model import Gait
from gaitlab.gait.strides import FootGait
from gaitlab.gait.timed_walk import START_RULE, TimedCourse
from gaitlab.motion.rest import rest_evidence
from gaitlab.quality import trial_quality
from gaitlab.recording.model import Floats, Placement, Recording
from gaitlab.settings import Settings


def result_of(recording: Recording, settings: Settings, gait: Gait) -> result.Result:
    """The result of an analysis, numbers rounded to what the interface promises (10 µs, 10 µm)."""
    chosen = settings.as_dict()
    judged = trial_quality(gait.findings)
    inputs = tuple(
        result.Input(placement=placement, name=sensor.source.name, sha256=sensor.source.sha256)
        for placement, sensor in recording.sensors.items()
    )
    return result.Result(
        provenance=result.Provenance(
            gaitlab=__version__,
            method=settings.method,
            settings=chosen,
            settings_sha256=result.settings_sha256(chosen),
            inputs=inputs,
        ),
        clock=result.Clock(rate_hz=recording.rate_hz, first_packet=recording.first_packet),
        sensors={
            placement.value: result.SensorQuality(
                samples=sensor.n_samples,
                lost=sensor.n_lost,
                saturated=sensor.n_saturated,
                device=sensor.device,
                heading=_heading(gait, placement),
            )
            for placement, sensor in recording.sensors.items()
        },
        feet={side.value: _foot(foot) for side, foot in gait.feet.items()},
        knees={side.value: _knee(knee) for side, knee in gait.knees.items()},
        walk=_walk(gait),
        parameters=tuple(parameter_of(one) for one in gait.parameters),
        warnings=tuple(
            result.ResultWarning(code=one.code, message=one.message, placement=one.placement)
            for one in gait.findings
        ),
        spreads=tuple(
            result.StrideSpread(
                name=name,
                side=side.value,
                n=one.n,
                freedom=one.freedom,
                mean=_r(one.mean),
                observed_sd=_r(np.sqrt(one.variance)),
                measurement_sd=_r(np.sqrt(one.measurement_variance)),
            )
            for name, sides in gait.spreads.items()
            for side, one in sides.items()
        ),
        quality=result.TrialQuality(status=judged.status.value, reasons=judged.reasons),
    )


def _r(value: float | np.floating[Any]) -> float:
    return round(float(value), 5)


def _column(values: Floats) -> list[float]:
    """Rounded as ``_r``, all at once: numbers one by one are most of the cost of a result."""
    rounded: list[float] = np.round(values, 5).tolist()
    return rounded


def _known(values: Floats) -> list[float | None]:
    """Rounded, None where not finite."""
    return [value if math.isfinite(value) else None for value in _column(values)]


def _foot(foot: FootGait) -> result.Foot:
    rests, times = foot.motion.rests, foot.motion.time_s
    motion = foot.motion
    shown = rest_evidence(motion.acceleration_mps2, motion.rate_radps, rests, motion.rate_hz)
    distance, distance_sd = distance_of(foot)
    walking = np.flatnonzero(foot.walking)
    duration = (foot.end_s - foot.start_s)[walking]
    return result.Foot(
        rests=tuple(
            result.Rest(
                start_s=start,
                end_s=end,
                residual_velocity_mps=speed,
                gyr_sd_radps=gyr,
                acc_sd_mps2=acc,
                implied_acc_error_mps2=implied,
            )
            for start, end, speed, gyr, acc, implied in zip(
                _column(times[rests.start]),
                _column(times[rests.end - 1] + 1.0 / motion.rate_hz),
                _column(shown.residual_mps),
                _known(shown.gyr_sd_radps),
                _known(shown.acc_sd_mps2),
                _known(shown.implied_acc_error_mps2),
                strict=True,
            )
        ),
        events=result.Events(
            foot_off_s=tuple(_column(foot.events.foot_off_s[walking])),
            initial_contact_s=tuple(_column(foot.events.initial_contact_s[walking])),
        ),
        strides=tuple(
            result.Stride(
                start_s=start,
                end_s=end,
                length_m=length,
                length_sd_m=sd,
                duration_s=lasted,
                speed_mps=speed,
                turning=turning,
                quality=quality.value,
                reason=reason,
            )
            for start, end, length, sd, lasted, speed, turning, (quality, reason) in zip(
                _column(foot.start_s[walking]),
                _column(foot.end_s[walking]),
                _column(foot.length_m[walking]),
                _column(foot.length_sd_m[walking]),
                _column(duration),
                _column(foot.length_m[walking] / duration),
                foot.turning[walking].tolist(),
                (foot.verdicts.of(k) for k in walking.tolist()),
                strict=True,
            )
        ),
        distance_m=_r(distance),
        distance_sd_m=_r(distance_sd),
    )


def _knee(knee: KneeGait) -> result.Knee:
    motion = knee.motion
    n = len(knee.sway_sd_m)
    steps = motion.position_m[motion.cycle_end] - motion.position_m[motion.cycle_start]
    return result.Knee(
        strides=tuple(
            result.KneeStride(
                start_s=_r(motion.time_s[a]),
                end_s=_r(motion.time_s[b]),
                length_m=_r(np.hypot(step[0], step[1])),
                residual_m=_r(residual),
            )
            for a, b, step, residual in zip(
                motion.cycle_start, motion.cycle_end, steps, motion.residual_m, strict=True
            )
        ),
        sway=result.KneeSway(
            lateral_sd_m=_r(np.sqrt(np.mean(knee.sway_sd_m**2))) if n else None,
            lateral_range_m=_r(np.mean(knee.sway_range_m)) if n else None,
            n=n,
        ),
        place=None if motion.link is None else motion.link.place.value,
        unexplained_share=None if motion.link is None else _r(motion.link.unexplained),
    )


def _heading(gait: Gait, placement: Placement) -> str | None:
    """What a foot's heading rests on, for people."""
    if not placement.is_foot or placement.side not in gait.feet:
        return None
    motion = gait.feet[placement.side].motion
    field, by = motion.field, motion.heading_from
    if field is None:
        return by
    seen = (
        f"at the rests its direction scatters by {np.degrees(field.scatter_rad):.0f}° and its strength by"
        f" {100.0 * field.strength_spread:.0f} %"
    )
    if field.used:
        return f"{by}, its drift corrected by the magnetometer, which agrees: {seen}"
    return f"{by}; the magnetometer was left out: {seen}"


def _walk(gait: Gait) -> result.Walk:
    closing = {}
    for side, foot in gait.feet.items():
        places = foot.motion.rest_position_m
        if len(places) > 1:
            closing[side.value] = _r(np.linalg.norm((places[-1] - places[0])[:2]))
    timed = gait.timed
    return result.Walk(
        straights=tuple(result.Interval(start_s=_r(a), end_s=_r(b)) for a, b in gait.course.straights),
        turns=tuple(
            result.Turn(
                start_s=_r(t.start_s), end_s=_r(t.end_s), angle_deg=round(float(np.degrees(t.angle_rad)), 2)
            )
            for t in gait.course.turns
        ),
        closing_error_m=closing,
        timed=result.TimedWalk(
            course_m=timed.course_m, start_s=_r(timed.start_s), end_s=_r(timed.end_s), rule=START_RULE
        )
        if isinstance(timed, TimedCourse)
        else None,
    )


def parameter_of(one: Measurement) -> result.Parameter:
    """A measurement as it is stored."""
    definition, ci = one.definition, one.ci95
    return result.Parameter(
        name=definition.name,
        side=one.side.value,
        unit=definition.unit,
        value=None if one.value is None else _r(one.value),
        sd=None if one.sd is None else _r(one.sd),
        ci95=None if ci is None else (_r(ci[0]), _r(ci[1])),
        n=one.n,
        status=one.status.value,
        reason=one.reason,
        definition=definition.text,
        label=definition.label,
        group=definition.group,
        reference=definition.reference,
        decimals=definition.decimals,
    )
