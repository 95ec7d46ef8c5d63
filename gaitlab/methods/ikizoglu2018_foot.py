"""Rests, path and knee of İkizoğlu et al. 2018, under the signatures of the catalogue.

İkizoğlu, Şahin, Ataş, Kara, Çakar, "IMU Acceleration Drift Compensation for Position Tracking in Ambulatory Gait
Analysis", 2018, §3.2 and §3.3.
"""

from __future__ import annotations

from gaitlab.methods.model import Constant, FootView, Method, Need, Question, Track
from gaitlab.methods.still import free_acceleration
from gaitlab.motion import ikizoglu2018
from gaitlab.motion.integration import position_of
from gaitlab.motion.knee import track_knee
from gaitlab.motion.model import FootMotion, KneeMotion, Rests
from gaitlab.recording.model import Floats, Sensor

PAPER = "İkizoğlu et al. 2018"


def rests(foot: FootView) -> Rests:
    """Rests: the resultant of the free acceleration below 0.15 m/s² for 5 successive samples (§3.3)."""
    return ikizoglu2018.find_rests(free_acceleration(foot.motion), foot.rate_hz)


def position(foot: FootView) -> Track:
    """Places in the middle of each rest: velocity reset at every rest, then integrated (§3.2, fig. 2, 3)."""
    return reset_position(foot, rests(foot))


def reset_position(foot: FootView, at: Rests) -> Track:
    """The same with rests from any detector."""
    velocity, _ = ikizoglu2018.reset_at_rests(free_acceleration(foot.motion), at, foot.rate_hz)
    place = position_of(velocity, foot.rate_hz)[at.moment]
    return Track(foot.time_s[at.moment], place - place[:1])


def paper_knee(sensor: Sensor, time_s: Floats, foot: FootMotion, shift: int) -> KneeMotion:
    """Path of a knee, a constant velocity offset removed in each gait cycle (§3.3, fig. 4, 5)."""
    return track_knee(sensor, time_s, foot, shift, "ikizoglu2018")


def leg_knee(sensor: Sensor, time_s: Floats, foot: FootMotion, shift: int) -> KneeMotion:
    """Path of a knee, joined to its foot all the time by the geometry of the leg (``gaitlab.motion.knee``)."""
    return track_knee(sensor, time_s, foot, shift, "gaitlab")


_P = ikizoglu2018.PaperParams()
_CONSTANTS = (
    Constant("rest_acceleration_mps2", _P.rest_acceleration_mps2, "m/s²", f"{PAPER}, §3.3"),
    Constant("rest_duration_s", _P.rest_duration_s, "s", f"{PAPER}, §3.3: 5 samples at 100 Hz"),
)
_FREE = (
    "The free acceleration is made with gaitlab's orientation, its offset that of the standing that was found; the paper"
    " takes the device's. So it finds 16 % of the stances of mtw-10m-walk; gaitlab analyze --method ikizoglu2018 takes the"
    " device's where the file has it."
)
METHODS = (
    Method(
        "ikizoglu2018",
        Question.REST,
        "Free acceleration below 0.15 m/s² for five samples",
        f"{PAPER}, §3.3",
        (Need.ACCELEROMETER, Need.GYROSCOPE),
        _CONSTANTS,
        (_FREE,),
        rests,
    ),
    Method(
        "ikizoglu2018",
        Question.POSITION,
        "Velocity reset at every rest, double integration",
        f"{PAPER}, §3.2, fig. 2, 3",
        (Need.ACCELEROMETER, Need.GYROSCOPE),
        _CONSTANTS,
        (_FREE,),
        position,
    ),
    Method(
        "ikizoglu2018",
        Question.KNEE,
        "A constant velocity offset removed in each gait cycle",
        f"{PAPER}, §3.3, fig. 4, 5",
        (Need.ACCELEROMETER, Need.GYROSCOPE, Need.KNEE),
        (),
        (
            (
                "The heading of the knee's sensor against the foot's comes from a rigid link: both are unknown without a"
                " magnetometer."
            ),
            "The last cycle ends when the foot comes to its last rest, which it does not leave.",
            "The height is treated as x and y are.",
        ),
        paper_knee,
    ),
    Method(
        "gaitlab",
        Question.KNEE,
        "Joined to its foot all the time by the geometry of the leg",
        "gaitlab, gaitlab/motion/knee.py",
        (Need.ACCELEROMETER, Need.GYROSCOPE, Need.KNEE),
        (),
        (),
        leg_knee,
    ),
)
