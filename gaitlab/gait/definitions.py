"""What each parameter means: one definition for reports, pages, REST and help, with its source."""

from __future__ import annotations

from gaitlab.gait.measurement import Definition

IKIZOGLU = "İkizoğlu et al. 2018, table 1"
GAITRITE = "GAITRite technical reference WI-02-15"
OURS = "gaitlab"
VARIABILITY = "König et al. 2016; Front Aging Neurosci 2018 00435 (20 strides, none beside a turn)"

GROUPS: dict[str, str] = {
    "test": "Timed walk",
    "speed": "Speed and distance",
    "length": "Lengths",
    "time": "Times and phases",
    "variability": "Variability",
    "course": "Course",
    "knee": "Knee",
}
"""Groups of parameters in the order in which people read them."""


def _definition(
    name: str,
    label: str,
    unit: str,
    group: str,
    decimals: int,
    text: str,
    reference: str = OURS,
    signed: bool = False,
) -> Definition:
    return Definition(name, label, unit, group, text, reference, decimals, signed)


WALK_TIME = _definition(
    "walk_time",
    "Time over the course",
    "s",
    "test",
    2,
    "From the first foot off after standing to the instant the leading foot has come the length of the course forward from"
    " where it stood. The start rule is movement, not the word of command: reaction time is not in it.",
    "NINDS CDE T25-FW (start: instruction); start rule: gaitlab",
)
WALK_SPEED = _definition(
    "walk_speed",
    "Speed over the course",
    "m/s",
    "test",
    2,
    "Length of the course divided by the time over the course; contains the acceleration from standing.",
)
COURSE_CHECK = _definition(
    "course_check",
    "Straight walk against the course",
    "%",
    "test",
    1,
    "How far forward the leading foot's farthest place of rest lies, less the course, in % of the course: a check of"
    " scale where the person stopped at the end of the course. It is shown, never used.",
    signed=True,
)
STEADY_SPEED = _definition(
    "steady_speed",
    "Steady speed",
    "m/s",
    "speed",
    2,
    "Mean over the steady strides of stride length divided by stride time: straight parts only, without the first and"
    " the last stride of each.",
    "Phan-Ba et al. 2012 (static start hides the steady speed)",
)
STRIDE_VELOCITY = _definition(
    "stride_velocity",
    "Stride velocity",
    "m/s",
    "speed",
    2,
    "Mean over all strides on straight parts of stride length divided by stride time; the stride after standing has no"
    " stride time and is not in it.",
    IKIZOGLU,
)
DISTANCE = _definition(
    "traversed_distance",
    "Traversed distance",
    "m",
    "speed",
    2,
    "Sum of the foot's stride lengths over the whole recording, turns included.",
    IKIZOGLU,
)
STRIDE_LENGTH = _definition(
    "stride_length",
    "Stride length",
    "m",
    "length",
    3,
    "Horizontal distance between two successive rests of the same foot; mean of the steady strides.",
    IKIZOGLU,
)
STEP_LENGTH = _definition(
    "step_length",
    "Step length",
    "m",
    "length",
    3,
    "Distance along the line of walking from the other foot's place of rest to this foot's; mean of the steady steps of"
    " the first straight part. It assumes that the feet stood side by side before the walk and walk in the same direction.",
    GAITRITE,
    signed=True,
)
STEP_WIDTH = _definition(
    "step_width",
    "Step width",
    "m",
    "length",
    3,
    "Distance across the line of walking between the two feet's places of rest; mean of the steady steps of the first"
    " straight part. Sensors on the feet do not see each other: it assumes how far apart the feet stood before the walk.",
    "İkizoğlu et al. 2018, table 1; Rebula et al. 2013 (not directly observable)",
    signed=True,
)
FOOT_ANGLE = _definition(
    "foot_progression_angle",
    "Foot progression angle",
    "deg",
    "length",
    1,
    "Angle between the foot and the line of walking while it rests, toes outwards positive; mean of the straight strides."
    " What a sensor knows of its foot's direction is the axis about which the foot rolls, and no more.",
    "Egerton et al. 2014; axis of rolling: gaitlab",
    signed=True,
)
FOOT_ANGLE_SD = _definition(
    "foot_progression_sd",
    "Scatter of the foot's direction",
    "deg",
    "length",
    1,
    "Standard deviation, from stride to stride, of the angle between the foot while it rests and the line of walking, on"
    " straight parts. It needs no knowledge of how the sensor sits on the foot.",
)
CADENCE = _definition(
    "cadence",
    "Cadence",
    "steps/min",
    "time",
    1,
    "60 divided by the mean step time of both feet; steady steps only.",
    IKIZOGLU,
)
STRIDE_TIME = _definition(
    "stride_time",
    "Stride time",
    "s",
    "time",
    3,
    "From one initial contact to the next of the same foot; mean of the steady strides.",
    GAITRITE,
)
STEP_TIME = _definition(
    "step_time",
    "Step time",
    "s",
    "time",
    3,
    "From the other foot's initial contact to this foot's; mean of the steady steps.",
    IKIZOGLU,
)
STANCE = _definition(
    "stance_share",
    "Stance",
    "%",
    "time",
    1,
    "From initial contact to foot off, in % of the stride time; mean of the steady strides.",
    GAITRITE,
)
SWING = _definition(
    "swing_share",
    "Swing",
    "%",
    "time",
    1,
    "From foot off to initial contact, in % of the stride time; mean of the steady strides.",
    GAITRITE,
)
DOUBLE_SUPPORT = _definition(
    "double_support_share",
    "Double support",
    "%",
    "time",
    1,
    "Time with both feet on the ground, initial and terminal together, in % of the stride time; mean of the steady strides.",
    GAITRITE,
)
_WITHOUT_MEASUREMENT = (
    "Mid-walk: without the first and the last two strides of a straight part. The variance that the measurement adds is"
    " taken out; both: root of the mean of the two squares."
)
STRIDE_TIME_CV = _definition(
    "stride_time_cv",
    "Stride time variability",
    "%",
    "variability",
    1,
    f"Standard deviation (n − 1) of the stride times in mid-walk, in % of their mean. {_WITHOUT_MEASUREMENT}",
    VARIABILITY,
)
STRIDE_LENGTH_CV = _definition(
    "stride_length_cv",
    "Stride length variability",
    "%",
    "variability",
    1,
    f"Standard deviation (n − 1) of the stride lengths in mid-walk, in % of their mean. {_WITHOUT_MEASUREMENT}",
    VARIABILITY,
)
STRIDE_VELOCITY_CV = _definition(
    "stride_velocity_cv",
    "Stride velocity variability",
    "%",
    "variability",
    1,
    "Standard deviation (n − 1) of stride length divided by stride time in mid-walk, in % of its"
    " mean."
    f" {_WITHOUT_MEASUREMENT}",
    VARIABILITY,
)
DOUBLE_SUPPORT_SD = _definition(
    "double_support_sd",
    "Double support variability",
    "%",
    "variability",
    2,
    "Standard deviation (n − 1) of the double support in mid-walk, which is itself in % of the stride time."
    f" {_WITHOUT_MEASUREMENT}",
    f"Larsson et al. 2015 (rises with vestibular asymmetry); {VARIABILITY}",
)
STOP_DURATION = _definition(
    "stop_duration",
    "Stop duration",
    "s",
    "time",
    2,
    "Total time, between the first and the last stride, in which both feet rest at once for longer than 1 s.",
    IKIZOGLU,
)
TURN_DURATION = _definition(
    "turn_duration",
    "Turn duration",
    "s",
    "course",
    2,
    "From the first foot's leaving its place of rest to turn to the last one's coming to rest after it; mean of the"
    " turns.",
)
TURN_ANGLE = _definition(
    "turn_angle",
    "Turn angle",
    "deg",
    "course",
    0,
    "Change of the feet's heading over a turn; mean of the turns' sizes.",
)
STRAIGHTNESS = _definition(
    "path_deviation",
    "Deviation from the straight line",
    "m",
    "course",
    3,
    "Standard deviation, across the line of walking, of the points midway between the feet on the first straight part; the"
    " line is the straight one that fits them best, so a constant veer is not in it.",
    "İkizoğlu et al. 2018, §3.2 (linearity of the walk); line: gaitlab",
)
CLOSING_ERROR = _definition(
    "closing_distance",
    "Start to end",
    "m",
    "course",
    2,
    "Horizontal distance between the foot's first and last place of rest. Where the walk ends where it began it is an error"
    " of the path; else it is the way.",
)
KNEE_SWAY = _definition(
    "knee_sway",
    "Knee sway in stance",
    "m",
    "knee",
    3,
    "Standard deviation of the knee's movement across the line of walking while its foot rests, its straight drift over"
    " the rest (about 0.3 s) taken out, so that only fast sway is seen; root mean square over the rests on straight parts.",
    "İkizoğlu et al. 2018, §5 (sway of the legs); formula: gaitlab",
)
KNEE_RESIDUAL = _definition(
    "knee_residual",
    "Knee correction",
    "m",
    "knee",
    3,
    "Root mean square of the distance by which the knee, uncorrected, misses its foot's step length in a gait cycle: what"
    " the correction took away.",
    "İkizoğlu et al. 2018, §3.3",
)

DEFINITIONS: tuple[Definition, ...] = tuple(
    value for value in list(globals().values()) if isinstance(value, Definition)
)
"""All of them, in the order of this page."""
