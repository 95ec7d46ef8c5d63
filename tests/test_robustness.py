"""Recordings that were cut, lost parts or lack channels: a result without nonsense, or one clear refusal."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitlab.analysis import Settings, analyze
from gaitlab.errors import InputError
from gaitlab.recording.model import Recording, Sensor
from gaitlab.simulation import TYPICAL_MTW, Plan, Simulation, Stand, Walk, simulate
from gaitlab.simulation.presets import stop_and_go, ten_metre_and_back, timed_25_foot_walk
from tests.walks import cut

PLANS = (
    timed_25_foot_walk(),
    ten_metre_and_back(),
    stop_and_go(),
    Plan((Stand(3.0), Walk(n_strides=1), Stand(2.0))),
)


@pytest.fixture(scope="module")
def walks() -> list[Simulation]:
    return [
        simulate(plan, TYPICAL_MTW, rate_hz=rate_hz, seed=k, sampling="mean", free_acceleration=True)
        for k, plan in enumerate(PLANS)
        for rate_hz in (50.0, 100.0)
    ]


def _damaged(sensor: Sensor, rng: np.random.Generator) -> Sensor:
    if rng.random() < 0.4:
        start, end = sorted(int(x) for x in rng.integers(0, sensor.n_samples, 2))
        sensor = cut(sensor, 0 if rng.random() < 0.5 else start, end)
    for channel in ("gyr_radps", "acc_mps2", "attitude", "free_acc_mps2"):
        if rng.random() < 0.12:
            sensor = replace(sensor, **{channel: None})
    return sensor


@pytest.mark.parametrize("seed", range(8))
def test_whatever_is_missing_gives_finite_numbers_or_a_refusal_with_a_hint(
    seed: int, walks: list[Simulation]
) -> None:
    rng = np.random.default_rng(seed)
    analysed, refused = 0, []
    for _ in range(12):
        sensors = walks[rng.integers(len(walks))].recording.sensors
        kept = {p: _damaged(s, rng) for p, s in sensors.items() if rng.random() < 0.85}
        kept = {p: s for p, s in kept.items() if s.n_samples}
        if not kept:
            continue
        course = [None, 7.62, 3.0][rng.integers(3)]
        method = "ikizoglu2018" if rng.random() < 0.3 else "gaitlab"
        try:
            analysis = analyze(Recording(kept), Settings(method=method, course_m=course))
        except InputError as error:
            refused.append(error)
            continue
        analysed += 1
        analysis.result.to_json()  # refuses a number that is none
        for series in analysis.series.values():
            assert np.isfinite(series.position_m).all()
        for parameter in analysis.result.parameters:
            assert (parameter.value is None) == (parameter.status == "not_determinable")
            assert parameter.status == "ok" or parameter.reason
    assert analysed > 0
    assert all(error.message and error.hint for error in refused)
