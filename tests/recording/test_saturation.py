"""Samples at the end of the range are marked; large ones within it are not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitlab.recording import Placement, read_files
from gaitlab.recording.saturation import find_saturation
from tests.recording.texts import mt_text

N = 200
PACKETS = np.arange(N)


def heel_strike(peak: float, width: float = 3.0) -> np.ndarray:
    signal = np.zeros((N, 3))
    signal[:, 2] = 9.81 + (peak - 9.81) * np.exp(-(((PACKETS - 100) / width) ** 2))
    return signal


@pytest.mark.parametrize("end", [156.9, 158.0, 160.0])
@pytest.mark.parametrize("sign", [1, -1])
def test_accelerometer_clipped_at_sixteen_g(end: float, sign: int) -> None:
    acc = sign * np.minimum(heel_strike(400.0), end)
    assert np.array_equal(find_saturation(PACKETS, acc, None), np.abs(acc[:, 2]) == end)


@pytest.mark.parametrize("end", [39.2, 78.45])
@pytest.mark.parametrize("sign", [1, -1])
def test_flat_top_betrays_a_narrower_range(end: float, sign: int) -> None:
    acc = np.minimum(heel_strike(200.0), end)
    noisy = sign * (acc + np.random.default_rng(0).normal(0, 0.001, acc.shape))
    assert np.array_equal(find_saturation(PACKETS, noisy, None), acc[:, 2] == end)


def test_gyroscope_clipped_at_two_thousand_degrees_a_second() -> None:
    gyr = np.minimum(heel_strike(60.0), np.deg2rad(2000))
    assert np.array_equal(find_saturation(PACKETS, None, gyr), gyr[:, 2] == np.deg2rad(2000))


@pytest.mark.parametrize("peak", [30.0, 60.0, 132.5, 150.0])
def test_a_large_peak_within_the_range_is_not_saturated(peak: float) -> None:
    assert not find_saturation(PACKETS, heel_strike(peak), heel_strike(30.0)).any()


def test_a_sensor_lying_still_is_not_saturated() -> None:
    still = np.tile([0.0, 0.0, 9.81], (N, 1))
    assert not find_saturation(PACKETS, still, np.zeros((N, 3))).any()


def test_equal_peaks_that_are_not_successive_packets_are_no_flat_top() -> None:
    acc = heel_strike(20.0)
    acc[[20, 60, 140], 2] = 80.0
    assert not find_saturation(PACKETS, acc, None).any()
    assert not find_saturation(PACKETS * 2, np.minimum(heel_strike(200.0), 78.45), None).any()


def test_saturation_is_counted_on_received_rows_and_told() -> None:
    text = mt_text(n=400)
    for row in (100, 101):
        text = text.put(row, "Acc_Z", "159.3")
    text = text.keep_rows([*range(98), *range(100, 400)])
    recording = read_files({Placement.LEFT_FOOT: replace(text, name="a.txt").file})
    sensor = recording.sensors[Placement.LEFT_FOOT]
    assert np.flatnonzero(sensor.saturated).tolist() == [100, 101]
    assert [finding.code for finding in recording.findings] == ["saturated"]
