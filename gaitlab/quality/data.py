"""What a reader of a result should know about the data behind it, and what stops an analysis."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from gaitlab.errors import InputError
from gaitlab.gait.knees import KneeGait
from gaitlab.gait.measurement import Measurement
from gaitlab.gait.strides import FootGait
from gaitlab.motion.model import FootMotion, KneeMotion, LegPlace, Motion
from gaitlab.motion.offset import STANDARD_GRAVITY_MPS2
from gaitlab.motion.rest import find_rests, restlessness, unrest
from gaitlab.quality.trial import invalid_strides
from gaitlab.recording.model import Finding, Placement, Recording, Side
from gaitlab.settings import Settings


@dataclass(frozen=True)
class QualityParams:
    """When data want attention.

    Attributes
    ----------
    min_duration_s : float
        A shorter recording holds no gait cycle.
    swap_ratio, swap_min : float
        Foot and knee are swapped where the "foot" is at least so much more restless than the "knee", and restless
        at all; see ``restlessness``.
    restless_foot : float
        A foot above this does not come to rest as feet do.
    lost_share : float
        Share of lost samples from which lengths want attention.
    gravity_share : float
        Gravity read wrong by more than this share.
    both_in_air_share, same_leg_share : float
        Share of the shorter swinging time in which both feet are in the air, from which the two are no one walk, and from
        which they are one leg. At most 0.08 in the 46 trials of ``mtw-10m-walk``, 0.13 and more in 37 of 40 mixtures of
        different trials, 0.997 for foot and ankle of one leg.
    partly_s : float
        A foot that starts or ends more than this apart from the other is recorded in part.
    rest_share : float
        Fewer rests than this share of the gait cycles are too few.
    residual_mps : float
        Median residual velocity at the rests above which the path wants attention.
    """

    min_duration_s: float = 1.0
    swap_ratio: float = 1.5
    swap_min: float = 0.11
    restless_foot: float = 0.13
    lost_share: float = 0.10
    gravity_share: float = 0.06
    both_in_air_share: float = 0.12
    same_leg_share: float = 0.9
    partly_s: float = 1.0
    rest_share: float = 0.8
    residual_mps: float = 0.5


PARAMS = QualityParams()
_LENGTHS = (
    "stride_length",
    "step_length",
    "step_width",
    "steady_speed",
    "stride_velocity",
    "traversed_distance",
)
_TIMES = ("stride_time", "step_time", "cadence", "stance_share", "swing_share", "double_support_share")
_TURNS = ("turn_duration", "turn_angle")
_TESTS = ("walk_time", "walk_speed", "course_check")
_PATHS = (*_LENGTHS, *_TESTS, "path_deviation", "closing_distance", "knee_sway")
_ALL = (*_PATHS, *_TIMES, "stop_duration", *_TURNS, "knee_residual")
RESERVES: dict[str, tuple[tuple[str, ...], str]] = {
    "no_standing": (_PATHS, "Nobody stood still, so the sensors' offsets are less certain."),
    "few_straight": ((*_LENGTHS[:4], *_TIMES), "First and last strides are in it."),
    "not_one_walk": (_ALL, "The two feet do not alternate as in one walk."),
    "few_rests": (_ALL, "The method found too few rests."),
    "many_lost": ((*_PATHS, *_TIMES, *_TURNS), "Many samples were lost."),
    "long_gap": ((*_PATHS, *_TIMES, *_TURNS), "A long part of the recording was lost."),
    "partly_recorded": (
        ("traversed_distance", "closing_distance", *_TESTS),
        "A foot was not recorded throughout.",
    ),
    "restless_foot": ((*_PATHS, *_TIMES), "The foot hardly comes to rest."),
    "large_residual": (_PATHS, "The path drifted much between rests."),
    "most_strides_invalid": ((*_PATHS, *_TIMES), "Most strides are invalid."),
    "knee_of_other_leg": (("knee_sway", "knee_residual"), "The sensor moves as no knee of this leg does."),
    "course_used": (("closing_distance", "course_check", "traversed_distance"), "It was used for the path."),
    "rate_assumed": (_ALL, "The sampling rate is assumed."),
    "rate_contradiction": (_ALL, "The sampling rate is in doubt."),
}
"""Finding → names of the parameters that want attention for it, and the reason."""


def check_length(recording: Recording) -> None:
    """Refuse a recording in which some sensor has less than a second."""
    for sensor in recording.sensors.values():
        if sensor.n_samples < max(PARAMS.min_duration_s * sensor.rate_hz, 20):
            noun = "sample" if sensor.n_samples == 1 else "samples"
            raise InputError(
                "too_short",
                f"The {sensor.placement.label} has {sensor.n_samples} {noun}, which is less than a second.",
                "Upload the whole recording of a walk.",
                file=sensor.source.name,
            )


def check_placements(feet: Mapping[Side, FootMotion], knees: Mapping[Side, KneeMotion]) -> None:
    """Refuse a recording in which foot and knee of a side are swapped: the foot rests in every cycle, the knee
    never does."""
    for side in knees:
        foot, knee = _restlessness(feet[side]), _restlessness(knees[side])
        if foot is None or knee is None:
            continue
        if foot > PARAMS.swap_min and foot > PARAMS.swap_ratio * knee:
            raise InputError(
                "placement_swapped",
                f"The {side} foot and the {side} knee seem to be swapped: the sensor given as the knee comes to rest in"
                " every gait cycle, the one given as the foot does not.",
                f"Exchange the files of {Placement.foot(side).label} and {Placement.knee(side).label}.",
            )


def _restlessness(motion: Motion) -> float | None:
    if isinstance(motion, FootMotion):
        return motion.restlessness
    return restlessness(unrest(motion.acceleration_mps2, motion.rate_radps, motion.rate_hz))


def merged(read: Sequence[Finding], analysed: Sequence[Finding]) -> tuple[Finding, ...]:
    """What the reader found and what the analysis found, without the reader's weaker word on the same matter."""
    stronger = {"lost_samples": "many_lost", "saturated": "saturated"}
    said = {(one.code, one.placement) for one in analysed}
    kept = [one for one in read if (stronger.get(one.code, ""), one.placement) not in said]
    return (*kept, *analysed)


def findings(
    recording: Recording, settings: Settings, feet: Mapping[Side, FootGait], knees: Mapping[Side, KneeGait]
) -> list[Finding]:
    """What to know about the data, in words; placements in their usual order."""
    found = _of_recording(recording, feet)
    ours = settings.method == "gaitlab"
    if settings.anchor is not None:
        found.append(Finding("course_used", _course_used(settings)))
    if ours:  # a method that misses rests takes several strides for one swing
        found += check_alternation(feet)
    for side, foot in feet.items():
        found += _of_foot(Placement.foot(side), foot)
        if not ours:
            found += _of_rests(Placement.foot(side), foot)
    found += invalid_strides(feet)
    for side, knee in knees.items():
        found += _of_sensor(Placement.knee(side), knee.motion)
        if not len(knee.motion.residual_m) and feet[side].walking.any():
            message = f"The {side} knee was not recorded while its foot walked: it cannot be corrected."
            found.append(Finding("knee_without_cycle", message, Placement.knee(side)))
        if knee.motion.link is not None and knee.motion.link.place is LegPlace.UNKNOWN:
            message = (
                f"The sensor given as the {side} knee moves like neither shank nor thigh over the {side} foot: it may be on"
                " the other leg, on the trunk, or loose."
            )
            found.append(Finding("knee_of_other_leg", message, Placement.knee(side)))
    return found


def _course_used(settings: Settings) -> str:
    """What was told of the course and went into the path."""
    told = ["each foot ended where it began"] if settings.closed else []
    if settings.way_m is not None:
        told.append(f"the farthest place lies {settings.way_m:g} m from the start")
    return (
        f"As asked, the path uses that {' and that '.join(told)}: against these it can no longer be checked."
    )


def _of_recording(recording: Recording, feet: Mapping[Side, FootGait]) -> list[Finding]:
    """What is missing, and who is recorded for a part only."""
    found: list[Finding] = []
    for side in Side:
        if side not in feet:
            found.append(
                Finding(
                    "one_foot",
                    f"The {side} foot was not recorded: whatever joins the two feet is not determinable.",
                    Placement.foot(side),
                )
            )
    begin = min(float(foot.motion.time_s[0]) for foot in feet.values())
    end = max(float(foot.motion.time_s[-1]) for foot in feet.values())
    walks = any(foot.walking.any() for foot in feet.values())
    for side, foot in feet.items():
        late, early = float(foot.motion.time_s[0]) - begin, end - float(foot.motion.time_s[-1])
        if max(late, early) > PARAMS.partly_s:
            message = f"The {side} foot starts {late:.1f} s after the other and ends {early:.1f} s before it."
            found.append(Finding("partly_recorded", message, Placement.foot(side)))
        if walks and not foot.walking.any():
            message = (
                f"The {side} foot makes no stride while the other walks: its sensor may have lain still."
            )
            found.append(Finding("foot_without_stride", message, Placement.foot(side)))
    for placement in recording.sensors:
        if not placement.is_foot and placement.side not in feet:
            message = (
                f"The {placement.label} was left out: without its foot there is nothing to correct it by."
            )
            found.append(Finding("knee_without_foot", message, placement))
    if not walks:
        found.append(Finding("no_walking", "Nobody walks in this recording: no stride was found.", None))
    return found


def _of_sensor(placement: Placement, motion: Motion) -> list[Finding]:
    found = []
    offsets = motion.offsets
    if not offsets.standing:
        message = (
            f"The {placement.label} never stands still for a second: the gyroscope's offset is left to the orientation"
            " filter and the accelerometer's to the path."
        )
        found.append(Finding("no_standing", message, placement))
    elif not offsets.as_in_paper:
        at = motion.time_s[offsets.start]
        message = f"The {placement.label} does not stand from 2 s to 3 s; its offsets come from its standing at {at:.1f} s."
        found.append(Finding("standing_elsewhere", message, placement))
    error = offsets.gravity_mps2 / STANDARD_GRAVITY_MPS2 - 1.0
    if offsets.standing and abs(error) > PARAMS.gravity_share:
        message = (
            f"The {placement.label} reads {offsets.gravity_mps2:.2f} m/s² while standing, {100 * error:+.0f} % off gravity:"
            " the sensor wants calibrating, and lengths carry that doubt."
        )
        found.append(Finding("gravity", message, placement))
    lost = 1.0 - np.count_nonzero(motion.received) / motion.n_samples
    if lost > PARAMS.lost_share:
        message = (
            f"The {placement.label} lost {100 * lost:.0f} % of its samples: its lengths are less certain."
        )
        found.append(Finding("many_lost", message, placement))
    return found


def check_alternation(feet: Mapping[Side, FootGait]) -> list[Finding]:
    """Whether the two feet walk one walk: in walking one of them is always on the ground.

    Raises
    ------
    InputError
        ``same_leg`` where both swing at the same times.
    """
    share = _both_in_air(feet)
    if share >= PARAMS.same_leg_share:
        raise InputError(
            "same_leg",
            "Both feet swing at the same times: the two sensors seem to be on one leg.",
            "Check which file is the left foot and which the right.",
        )
    if share < PARAMS.both_in_air_share:
        return []
    message = "The feet do not alternate as in walking: are both files of the same trial, one from each foot?"
    return [Finding("not_one_walk", message)]


def _both_in_air(feet: Mapping[Side, FootGait]) -> float:
    """Time with both feet in the air, as a share of the foot's swinging time that swings less; 0 for one foot."""
    if len(feet) < 2:
        return 0.0
    one, other = feet.values()
    off, contact = one.events.foot_off_s[one.walking], one.events.initial_contact_s[one.walking]
    knots = np.stack(
        [other.events.foot_off_s[other.walking], other.events.initial_contact_s[other.walking]], axis=1
    )
    durations = knots[:, 1] - knots[:, 0]
    total = min(float(np.sum(contact - off)), float(durations.sum()))
    if total <= 0:
        return 0.0
    swung = np.stack([np.cumsum(durations) - durations, np.cumsum(durations)], axis=1).ravel()
    shared = np.interp(contact, knots.ravel(), swung) - np.interp(off, knots.ravel(), swung)
    return float(shared.sum()) / total


def _of_rests(placement: Placement, foot: FootGait) -> list[Finding]:
    """A method of rest detection that misses gait cycles."""
    motion = foot.motion
    expected = len(find_rests(motion.acceleration_mps2, motion.rate_radps, motion.rate_hz))
    distinct = int(foot.walking.sum()) + 1
    if distinct >= PARAMS.rest_share * expected:
        return []
    message = (
        f"The {placement.label} walks from rest to rest {distinct - 1} times by this method and"
        f" makes {max(expected - 1, 0)} strides: lengths and times are partly those of several strides."
    )
    return [Finding("few_rests", message, placement)]


def _of_foot(placement: Placement, foot: FootGait) -> list[Finding]:
    found = _of_sensor(placement, foot.motion)
    restless = _restlessness(foot.motion)
    if restless is not None and restless > PARAMS.restless_foot:
        message = (
            f"The {placement.label} hardly comes to rest: the sensor may sit on a shank, or the foot shuffles. Check the"
            " placement."
        )
        found.append(Finding("restless_foot", message, placement))
    if foot.few_straight and foot.straight.any():
        message = f"The {placement.label} has no stride between the first and the last of a straight part: those two,"
        found.append(Finding("few_straight", f"{message} slower than others, are in the means.", placement))
    saturated = foot.motion.saturated
    if saturated.any():
        moments = foot.motion.rests.moment
        touched = sum(bool(saturated[a:b].any()) for a, b in itertools.pairwise(moments))
        message = f"The {placement.label} reached the end of its range in {touched} strides: their lengths are less certain."
        found.append(Finding("saturated", message, placement))
    residual = np.linalg.norm(foot.motion.rests.residual_mps[1:], axis=1)
    if len(residual) and float(np.median(residual)) > PARAMS.residual_mps:
        message = (
            f"The {placement.label} drifted by {np.median(residual):.2f} m/s between rests (median): its orientation or its"
            " offsets are poor."
        )
        found.append(Finding("large_residual", message, placement))
    return found


def with_reserve(parameters: Sequence[Measurement], found: Sequence[Finding]) -> tuple[Measurement, ...]:
    """The parameters, marked where a finding gives reason to use them with reserve."""
    marked = []
    for parameter in parameters:
        for finding in found:
            names, reason = RESERVES.get(finding.code, ((), ""))
            if (
                parameter.definition.name in names
                and _concerns(finding, parameter)
                and reason not in parameter.reason
            ):
                parameter = parameter.with_attention(reason)
        marked.append(parameter)
    return tuple(marked)


def _concerns(finding: Finding, parameter: Measurement) -> bool:
    """What is found of a knee concerns the knee alone; what is found of a foot, its side and both."""
    placement = finding.placement
    if placement is None:
        return True
    of_knee = parameter.definition.group == "knee"
    return parameter.side in ("both", placement.side) and (placement.is_foot or of_knee)
