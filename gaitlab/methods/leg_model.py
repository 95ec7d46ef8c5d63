"""The leg as five joint angles and three links: Denavit–Hartenberg kinematics, there and back.

Bousdar Ahmed and Metzger 2017, §II-A, table I, eq. 1–2. Base frame at the hip: x forward, y to the left, z up. Axes:
θ1 roll and θ2 pitch of the hip, θ3 pitch of the knee, θ4 roll and θ5 pitch of the ankle; at zero the leg hangs
stretched and the foot points forward. Pitch is positive about y (to the left): a thigh that lies back, a knee that
bends, a toe that points down. Hip roll is positive about x: the leg goes to the left; the paper's axis of ankle roll
points backward, so that a positive θ4 lifts the left edge of the foot's link.

Segments have axes of the same kind: z of thigh and shank from the lower joint to the upper, x of the foot from ankle to
metatarsal, y to the left.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitlab.motion.model import Indices
from gaitlab.motion.quaternions import matrices
from gaitlab.recording.model import Floats

JOINTS = ("hip", "knee", "ankle", "metatarsal")


@dataclass(frozen=True)
class Links:
    """Lengths of thigh (hip to knee), shank (knee to ankle) and foot (ankle to metatarsal)."""

    thigh_m: float
    shank_m: float
    foot_m: float


ADULT = Links(0.42, 0.40, 0.17)
"""Where nothing is known of the person: 0.245 and 0.246 of a height of 1.7 m for thigh and shank (Drillis and Contini
1966), and the foot of the leg in ``mtw-leg-vicon``. Whether a posture is coherent does not depend on it."""


@dataclass(frozen=True, eq=False)
class LegAngles:
    """A leg in n rows.

    Attributes
    ----------
    angle_rad : ndarray (n, 5)
        θ1 to θ5.
    heading_rad : ndarray (n,)
        Of the base frame in the world, positive to the left. The model has no turn of the leg about its own axis, so
        the base turns with the thigh.
    start, end : ndarray (k,)
        Rows of the stances, ``[start, end)``.
    links : Links
    """

    angle_rad: Floats
    heading_rad: Floats
    start: Indices
    end: Indices
    links: Links = ADULT


@dataclass(frozen=True, eq=False)
class DhTable:
    """Denavit–Hartenberg parameters: of each row the offset of θ, the number of its joint angle, and α.

    d is 0 throughout; a is the length of thigh, shank and foot in rows 3, 4 and 6. The columns of table I are d, θ, a, α
    (the header of the third is misprinted as α).
    """

    offset_rad: tuple[float, ...]
    twist_rad: tuple[float, ...]


_RIGHT = np.pi / 2
_TWIST = (-_RIGHT, -_RIGHT, 0.0, -_RIGHT, -_RIGHT, -_RIGHT)
DH_AS_PRINTED = DhTable((-_RIGHT, _RIGHT, 0.0, np.pi, np.pi, _RIGHT), _TWIST)
"""Table I to the letter. At zero its shank lies folded up along the thigh and its foot points backward."""
DH = DhTable((-_RIGHT, _RIGHT, 0.0, 0.0, np.pi, _RIGHT), _TWIST)
"""Table I without the 180° of row 4, so that zero is the stretched leg of the paper's text and figures 1 to 3."""
_ANGLE_OF_ROW = (None, 0, 1, 2, 3, 4)


def link_matrices(theta_rad: Floats, length_m: float, twist_rad: float) -> Floats:
    """H from one axis to the next, eq. 1 with d = 0, shape (n, 4, 4)."""
    c, s = np.cos(theta_rad), np.sin(theta_rad)
    ca, sa = np.cos(twist_rad), np.sin(twist_rad)
    h = np.zeros((len(theta_rad), 4, 4))
    h[:, 0, 0], h[:, 0, 1], h[:, 0, 2], h[:, 0, 3] = c, -s * ca, s * sa, length_m * c
    h[:, 1, 0], h[:, 1, 1], h[:, 1, 2], h[:, 1, 3] = s, c * ca, -c * sa, length_m * s
    h[:, 2, 1], h[:, 2, 2] = sa, ca
    h[:, 3, 3] = 1.0
    return h


def joints_in_base(angle_rad: Floats, links: Links = ADULT, table: DhTable = DH) -> Floats:
    """Places of hip, knee, ankle and metatarsal in the base frame (eq. 2), shape (n, 4, 3), from angles (n, 5)."""
    n = len(angle_rad)
    lengths = (0.0, 0.0, links.thigh_m, links.shank_m, 0.0, links.foot_m)
    chain = np.broadcast_to(np.eye(4), (n, 4, 4))
    places = np.zeros((n, 4, 3))
    for row, (offset, twist, length, joint) in enumerate(
        zip(table.offset_rad, table.twist_rad, lengths, _ANGLE_OF_ROW, strict=True)
    ):
        theta = np.full(n, offset) if joint is None else offset + angle_rad[:, joint]
        chain = chain @ link_matrices(theta, length, twist)
        if length:
            places[:, {2: 1, 3: 2, 5: 3}[row]] = chain[:, :3, 3]
    return places


def joints_in_world(leg: LegAngles, hip_m: Floats | None = None) -> Floats:
    """Places of the joints in the world, shape (n, 4, 3), for a hip at ``hip_m`` (n, 3), else at the origin."""
    base = joints_in_base(leg.angle_rad, leg.links)
    c, s = np.cos(leg.heading_rad)[:, None], np.sin(leg.heading_rad)[:, None]
    places = base.copy()
    places[..., 0] = c * base[..., 0] - s * base[..., 1]
    places[..., 1] = s * base[..., 0] + c * base[..., 1]
    return places if hip_m is None else places + hip_m[:, None, :]


def hip_angles(thigh: Floats) -> tuple[Floats, Floats, Floats]:
    """Heading of the base, θ1 and θ2, each (n,), of a thigh's orientation (n, 4), thigh to world.

    Exact for every orientation: R = Rz(heading) · Rx(θ1) · Ry(θ2), the model's own order. Roll and pitch of the usual
    Euler angles, which the paper takes for θ1 and θ2, are the same to second order (0.4° apart at 3.5° and 28°).
    """
    r = matrices(thigh)
    heading = np.arctan2(-r[0, 1], r[1, 1])
    return heading, np.arcsin(np.clip(r[2, 1], -1.0, 1.0)), np.arctan2(-r[2, 0], r[2, 2])


def angles_of_segments(thigh: Floats, shank: Floats, foot: Floats) -> tuple[Floats, Floats]:
    """Joint angles (n, 5) and heading of the base (n,) of segment orientations, each (n, 4), segment to world.

    What the model cannot do is left out: a turn of the shank against the thigh but about y, a foot that toes out.
    """
    heading, roll, pitch = hip_angles(thigh)
    axes = [matrices(q).transpose(2, 0, 1) for q in (thigh, shank, foot)]
    knee = (axes[0].transpose(0, 2, 1) @ axes[1][:, :, 2:])[..., 0]
    ankle = axes[1].transpose(0, 2, 1) @ axes[2]
    bend = np.arctan2(knee[:, 0], knee[:, 2])
    up, forward = ankle[:, :, 2], ankle[:, :, 0]
    ankle_roll = np.arctan2(up[:, 1], up[:, 2])
    across = np.cos(ankle_roll) * forward[:, 2] + np.sin(ankle_roll) * forward[:, 1]
    ankle_pitch = np.arctan2(-across, forward[:, 0])
    return np.stack([roll, pitch, bend, ankle_roll, ankle_pitch], axis=1), heading


def angles_of_joints(places_m: Floats, heading_rad: Floats) -> Floats:
    """Joint angles (n, 5) of joint places (n, 4, 3), world axes, for a known heading of the base (n,).

    The hip's roll is within ±90°, as is the ankle's. Where the foot's link lies along x of the shank its roll moves
    nothing and is returned as 0; a shank beside the plane of the hinge is taken by its shadow in it.
    """
    link = np.diff(places_m, axis=1)
    c, s = np.cos(heading_rad)[:, None], np.sin(heading_rad)[:, None]
    x, y, z = c * link[..., 0] + s * link[..., 1], c * link[..., 1] - s * link[..., 0], link[..., 2]
    roll = np.arctan(_ratio(-y[:, 0], z[:, 0]))
    cr, sr = np.cos(roll)[:, None], np.sin(roll)[:, None]
    y, z = cr * y + sr * z, cr * z - sr * y  # seen from axes that roll with the hip
    pitch, shank = np.arctan2(-x[:, 0], -z[:, 0]), np.arctan2(-x[:, 1], -z[:, 1])
    cs, ss = np.cos(shank), np.sin(shank)
    fx, fy, fz = cs * x[:, 2] - ss * z[:, 2], y[:, 2], ss * x[:, 2] + cs * z[:, 2]
    small = np.hypot(fy, fz) < 1e-9 * np.maximum(np.abs(fx), 1e-9)
    ankle_roll = np.where(small, 0.0, np.arctan(_ratio(fy, fz)))
    ankle_pitch = np.arctan2(-(np.cos(ankle_roll) * fz + np.sin(ankle_roll) * fy), fx)
    return np.stack([roll, pitch, _wrapped(shank - pitch), ankle_roll, ankle_pitch], axis=1)


def forward_of(heading_rad: Floats) -> Floats:
    """Horizontal unit vectors (n, 3) of headings (n,)."""
    ahead = np.zeros((len(heading_rad), 3))
    ahead[:, 0], ahead[:, 1] = np.cos(heading_rad), np.sin(heading_rad)
    return ahead


def _ratio(a: Floats, b: Floats) -> Floats:
    """a / b, and ± huge instead of a division by 0."""
    safe = np.where(np.abs(b) < 1e-300, 1e-300, b)
    with np.errstate(over="ignore"):
        ratio: Floats = np.where(a == 0.0, 0.0, a / safe)
    return ratio


def _wrapped(angle: Floats) -> Floats:
    wrapped: Floats = np.pi - np.mod(np.pi - angle, 2.0 * np.pi)
    return wrapped
