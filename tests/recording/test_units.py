"""Units are judged by gravity, range and the device's orientation; what cannot be right is set aside or refused."""

from __future__ import annotations

import pytest

from gaitlab.errors import InputError
from gaitlab.recording import Placement, read_files
from tests.recording.texts import ACC, GYR, QUATERNION, Text, codes, mt_text


def upside_down(text: Text) -> Text:
    """The same text with each quaternion turned by π about the sensor's x axis."""
    places = [text.headings.index(heading) for heading in QUATERNION]
    for row, line in enumerate(text.cells):
        w, x, y, z = (float(line[place]) for place in places)
        for heading, value in zip(QUATERNION, (-x, w, z, -y), strict=True):
            text = text.put(row, heading, f"{value:.6f}")
    return text


def test_orientation_that_contradicts_gravity_is_set_aside_and_told() -> None:
    recording = read_files({Placement.LEFT_FOOT: upside_down(mt_text(ACC, GYR, QUATERNION)).file})
    assert recording.sensors[Placement.LEFT_FOOT].attitude is None
    assert codes(recording.findings) == ["attitude_contradicts_gravity"]


def test_without_gyroscope_such_an_orientation_is_refused() -> None:
    with pytest.raises(InputError) as caught:
        upside_down(mt_text(ACC, QUATERNION)).read()
    assert caught.value.code == "bad_orientation"


def test_orientation_that_agrees_is_kept() -> None:
    recording = read_files({Placement.LEFT_FOOT: mt_text(ACC, GYR, QUATERNION).file})
    assert recording.sensors[Placement.LEFT_FOOT].attitude is not None
    assert recording.findings == ()


@pytest.mark.parametrize("scale", [0.01, 10.0])
def test_pressure_in_another_unit_is_left_out_and_told(scale: float) -> None:
    text = mt_text(ACC, GYR, ("Pressure",), scale={"Pressure": scale})
    recording = read_files({Placement.LEFT_FOOT: text.file})
    assert recording.sensors[Placement.LEFT_FOOT].pressure_pa is None
    assert codes(recording.findings) == ["unit_pressure"]


def test_gyroscope_noise_of_a_sensor_at_rest_is_no_reason_to_refuse() -> None:
    still = mt_text(ACC, GYR, QUATERNION, scale={"Gyr_Z": 0.0})
    for row in range(60):
        for heading, value in zip(QUATERNION, ("1", "0", "0", "0"), strict=True):
            still = still.put(row, heading, value)
    assert still.read().n_samples == 60
