"""A rest is a rest at any pace, any rate and in any gait."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from gaitlab.motion.foot import track_foot
from gaitlab.motion.rest import cycle_time, find_rests
from gaitlab.recording import read_recording
from gaitlab.recording.model import Placement, Side
from gaitlab.simulation import TYPICAL_MTW, simulate
from gaitlab.simulation import presets as gaits
from gaitlab.simulation.walk import Gait

Change = Callable[[np.ndarray, np.ndarray, float], tuple[np.ndarray, np.ndarray, float, float]]


def _walked(pace: float) -> Change:
    """The same walk at another pace: lengths stay, so the rate goes with the pace and the acceleration with its square."""
    return lambda acceleration, rate, hz: (acceleration * pace**2, rate * pace, hz * pace, 1.0)


def _sampled(factor: int) -> Change:
    """The same walk sampled ``factor`` times as often, or 1/−factor times: straight lines, or means over whole rows."""

    def change(
        acceleration: np.ndarray, rate: np.ndarray, hz: float
    ) -> tuple[np.ndarray, np.ndarray, float, float]:
        if factor < 0:
            n = len(rate) // -factor * -factor
            fewer = [x[:n].reshape(-1, -factor, 3).mean(axis=1) for x in (acceleration, rate)]
            return fewer[0], fewer[1], hz / -factor, float(-factor)
        at = np.arange(len(rate) * factor) / factor
        more = [
            np.stack([np.interp(at, np.arange(len(x)), x[:, k]) for k in range(3)], axis=1)
            for x in (acceleration, rate)
        ]
        return more[0], more[1], hz * factor, 1.0 / factor

    return change


@pytest.mark.parametrize(
    ("change", "differ"),
    [
        (_walked(0.5), 0.0),
        (_walked(0.7), 0.0),
        (_walked(1.3), 0.0),
        (_walked(1.6), 0.0),
        (_sampled(-2), 0.01),
        (_sampled(2), 0.01),
        (_sampled(4), 0.01),
    ],
    ids=["pace 0.5", "pace 0.7", "pace 1.3", "pace 1.6", "50 Hz", "200 Hz", "400 Hz"],
)
def test_real_feet_have_the_same_rests_at_another_pace_or_rate(
    data_dir: Path, change: Change, differ: float
) -> None:
    """Each rest is found again, once: its moment within the rest, give or take a tenth of a gait cycle."""
    rests = lost = 0
    for path in sorted((data_dir / "mtw-10m-walk").glob("*-[36]_*f.txt")):
        sensor = read_recording(placements={Placement.LEFT_FOOT: path}).sensors[Placement.LEFT_FOOT]
        foot = track_foot(sensor, np.arange(sensor.n_samples) / sensor.rate_hz)
        plain = find_rests(foot.acceleration_mps2, foot.rate_radps, foot.rate_hz)
        acceleration, rate, hz, rows = change(foot.acceleration_mps2, foot.rate_radps, foot.rate_hz)
        moment = find_rests(acceleration, rate, hz).moment * rows
        slack = 0.1 * (cycle_time(foot.rate_radps, foot.rate_hz) or 1.0) * foot.rate_hz
        within = (moment[:, None] >= plain.start - slack) & (moment[:, None] < plain.end + slack)
        rests += len(plain)
        lost += int(np.sum(within.sum(axis=0) != 1)) + max(0, len(moment) - int(within.sum()))
    assert rests > 500
    assert lost <= differ * rests


@pytest.mark.parametrize(
    "gait",
    [gaits.COMFORTABLE, gaits.FAST, gaits.SLOW, gaits.SHUFFLING, gaits.LIMPING, gaits.ATAXIC],
    ids=["comfortable", "fast", "slow", "shuffling", "limping", "ataxic"],
)
def test_every_gait_rests_once_a_cycle_stops_and_turns_included(gait: Gait) -> None:
    for plan in (gaits.ten_metre_and_back(gait), gaits.stop_and_go(gait)):
        walk = simulate(plan, TYPICAL_MTW, knees=False)
        for side in Side:
            placement = Placement.foot(side)
            foot = track_foot(walk.recording.sensors[placement], walk.recording.time_s(placement))
            found, truth = foot.time_s[foot.rests.moment], walk.truth.feet[side].rests_s
            assert len(found) == len(truth)
            assert np.all((found >= truth[:, 0]) & (found <= truth[:, 1]))
