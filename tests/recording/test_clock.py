"""The packet counter is the clock: wraps undone, losses marked and filled, sensors aligned."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gaitlab.errors import InputError
from gaitlab.recording import Placement, Sensor, read_files
from gaitlab.recording.attitude import from_euler, slerp
from gaitlab.recording.packets import find_gaps, regular_grid
from tests.recording.texts import ACC, GYR, LONG_HEADER, MAG, QUATERNION, Floats, codes, mt_text, read_two

N = 60
WHOLE = mt_text(ACC, GYR, MAG, QUATERNION, n=N)
kept_rows = st.sets(st.integers(1, N - 2), min_size=10).map(lambda kept: sorted({0, N - 1, *kept}))


def signals(sensor: Sensor) -> list[Floats]:
    values = [sensor.acc_mps2, sensor.gyr_radps, sensor.mag, sensor.attitude]
    return [value for value in values if value is not None]


@settings(max_examples=60, deadline=None)
@given(kept_rows)
def test_received_samples_are_kept_exactly_whatever_is_lost(kept: list[int]) -> None:
    whole, lossy = WHOLE.read(), WHOLE.keep_rows(kept).read()
    assert lossy.n_samples == N
    assert np.flatnonzero(lossy.received).tolist() == kept
    for complete, filled in zip(signals(whole), signals(lossy), strict=True):
        np.testing.assert_allclose(filled[kept], complete[kept], atol=1e-15)
        assert np.isfinite(filled).all()


@settings(max_examples=60, deadline=None)
@given(kept_rows)
def test_a_gap_holds_the_next_sample_back_and_interpolates_the_others(kept: list[int]) -> None:
    sensor = WHOLE.keep_rows(kept).read()
    assert sensor.acc_mps2 is not None
    assert sensor.mag is not None
    for before, after in pairwise(kept):
        for lost in range(before + 1, after):
            assert np.array_equal(sensor.acc_mps2[lost], sensor.acc_mps2[after])
            share = (lost - before) / (after - before)
            line = (1 - share) * sensor.mag[before] + share * sensor.mag[after]
            np.testing.assert_allclose(sensor.mag[lost], line, atol=1e-12)


@settings(max_examples=40, deadline=None)
@given(st.integers(65_536 - N + 1, 65_535), kept_rows)
def test_a_wrap_anywhere_changes_nothing_but_the_first_packet(first: int, kept: list[int]) -> None:
    plain = WHOLE.keep_rows(kept).read()
    wrapped = mt_text(ACC, GYR, MAG, QUATERNION, n=N, first_packet=first).keep_rows(kept).read()
    assert wrapped.first_packet == first
    assert np.array_equal(wrapped.received, plain.received)
    for a, b in zip(signals(wrapped), signals(plain), strict=True):
        assert np.array_equal(a, b)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 65_535), st.integers(-30, 30))
def test_sensors_are_aligned_on_the_counter_wherever_it_wraps(first: int, offset: int) -> None:
    left = mt_text(first_packet=first)
    right = mt_text(first_packet=(first + offset) % 65_536)
    sensors = read_two(left, right.put(0, "Acc_X", "0.5")).sensors
    starts = [sensors[placement].first_packet for placement in (Placement.LEFT_FOOT, Placement.RIGHT_FOOT)]
    assert starts[1] - starts[0] == offset
    assert 0 <= min(starts) < 65_536


def test_each_sensor_keeps_its_whole_span() -> None:
    recording = read_two(mt_text(n=60), mt_text(n=90, first_packet=500))
    left, right = recording.sensors[Placement.LEFT_FOOT], recording.sensors[Placement.RIGHT_FOOT]
    assert (left.first_packet, left.n_samples, right.first_packet, right.n_samples) == (472, 60, 500, 90)
    assert recording.first_packet == 472
    assert recording.time_s(Placement.RIGHT_FOOT)[0] == pytest.approx(0.28)


def test_three_wraps_in_one_file() -> None:
    text = WHOLE.keep_rows(range(13))
    for row in range(13):
        text = text.put(row, "PacketCounter", str((60_000 + 20_000 * row) % 65_536))
    sensor = text.read()
    assert sensor.n_samples == 240_001
    assert np.flatnonzero(sensor.received).tolist() == list(range(0, 240_001, 20_000))


def test_counter_beyond_sixteen_bits_does_not_wrap() -> None:
    text = WHOLE
    for row in range(N):
        text = text.put(row, "PacketCounter", str(65_500 + row))
    sensor = text.read()
    assert (sensor.first_packet, sensor.n_lost) == (65_500, 0)


def test_rows_without_numbers_count_as_lost_and_are_told() -> None:
    text = WHOLE.put(20, "Acc_Y", "NaN").put(21, "Gyr_X", "").put(40, "Acc_X", "nan")
    recording = read_files({Placement.LEFT_FOOT: text.file})
    sensor = recording.sensors[Placement.LEFT_FOOT]
    assert np.flatnonzero(~sensor.received).tolist() == [20, 21, 40]
    assert sensor.acc_mps2 is not None
    assert np.array_equal(sensor.acc_mps2[20], sensor.acc_mps2[22])
    finding = recording.findings[0]
    assert (finding.code, finding.placement) == ("nan_rows", Placement.LEFT_FOOT)
    assert f"line {text.first_line + 20}, column Acc_Y" in finding.message


def test_error_after_dropped_rows_still_names_the_line() -> None:
    text = WHOLE.put(20, "Acc_Y", "NaN").put(45, "Quat_q0", "0.1")
    with pytest.raises(InputError) as caught:
        text.read()
    assert caught.value.line == text.first_line + 45


def test_missing_orientation_and_magnetometer_values_are_interpolated_not_lost() -> None:
    text = WHOLE.put(20, "Mag_X", "").put(30, "Quat_q0", "NaN")
    sensor, whole = text.read(), WHOLE.read()
    assert sensor.n_lost == 0
    assert sensor.mag is not None
    assert sensor.attitude is not None
    assert whole.attitude is not None
    np.testing.assert_allclose(sensor.mag[20], (sensor.mag[19] + sensor.mag[21]) / 2, atol=1e-12)
    np.testing.assert_allclose(sensor.attitude[30], whole.attitude[30], atol=1e-3)


def test_incomplete_optional_columns_are_told() -> None:
    recording = read_files({Placement.LEFT_FOOT: WHOLE.without("Mag_Y", "Quat_q2").file})
    sensor = recording.sensors[Placement.LEFT_FOOT]
    assert sensor.mag is None
    assert sensor.attitude is None
    assert codes(recording.findings) == ["incomplete_columns"] * 2
    assert "since Mag_Y is missing" in recording.findings[0].message
    assert "since Quat_q2 is missing" in recording.findings[1].message


def test_mostly_empty_magnetometer_is_left_out_and_told() -> None:
    text = WHOLE
    for row in range(20):
        text = text.put(row, "Mag_Z", "")
    recording = read_files({Placement.LEFT_FOOT: text.file})
    assert recording.sensors[Placement.LEFT_FOOT].mag is None
    assert "column_not_used" in codes(recording.findings)


def test_lost_orientation_turns_on_at_constant_rate() -> None:
    yaw_deg = np.linspace(0.0, 174.0, 30)
    turning = from_euler(np.zeros(30), np.zeros(30), yaw_deg)
    text = mt_text(ACC, GYR, QUATERNION, n=30)
    cells = [
        [*line[:7], *(f"{value:.9f}" for value in row)] for line, row in zip(text.cells, turning, strict=True)
    ]
    kept = [0, 1, 9, 10, 14, 29]
    attitude = replace(text, cells=cells).keep_rows(kept).read().attitude
    assert attitude is not None
    np.testing.assert_allclose(attitude, turning, atol=1e-7)


def test_slerp_takes_the_short_way_whatever_the_signs() -> None:
    angles = np.array([0.0, 90.0])
    ends = from_euler(np.zeros(2), np.zeros(2), angles)
    third = slerp(ends[:1], ends[1:], np.array([1 / 3]))
    np.testing.assert_allclose(third, from_euler(np.zeros(1), np.zeros(1), np.array([30.0])), atol=1e-12)
    np.testing.assert_allclose(slerp(ends[:1], -ends[1:], np.array([1 / 3])), third, atol=1e-12)
    np.testing.assert_allclose(slerp(ends[:1], ends[:1], np.array([0.5])), ends[:1], atol=1e-12)


@given(st.lists(st.integers(1, 9), min_size=1, max_size=50))
def test_gaps_account_for_every_lost_packet(steps: list[int]) -> None:
    packet = np.concatenate([[5], 5 + np.cumsum(steps)])
    gaps = find_gaps(packet)
    grid = regular_grid(packet, "a.txt")
    lost = np.flatnonzero(~grid.received) + grid.first_packet
    assert [
        p for gap in gaps for p in range(gap.start_packet, gap.start_packet + gap.n_lost)
    ] == lost.tolist()


def test_losses_and_long_gaps_are_told_with_their_meaning() -> None:
    text = mt_text(n=700).keep_rows([*range(100), *range(350, 700)])
    findings = read_files({Placement.LEFT_FOOT: text.file}).findings
    assert codes(findings) == ["lost_samples", "long_gap"]
    assert "35.7%" in findings[0].message
    assert "2.5 s begins 1.0 s" in findings[1].message


def test_few_losses_are_not_worth_a_word() -> None:
    text = mt_text(n=400).keep_rows([*range(100), *range(103, 400)])
    assert read_files({Placement.LEFT_FOOT: text.file}).findings == ()


def test_recordings_that_do_not_overlap() -> None:
    with pytest.raises(InputError) as caught:
        read_two(mt_text(), mt_text(first_packet=2000).put(0, "Acc_X", "0.5"))
    assert caught.value.code == "no_overlap"
    assert "left.txt" in caught.value.message
    assert "right.txt" in caught.value.message


def test_one_file_given_for_two_placements() -> None:
    with pytest.raises(InputError) as caught:
        read_two(mt_text(), mt_text())
    assert caught.value.code == "same_content"


def test_one_sensor_given_for_two_placements() -> None:
    text = replace(mt_text(), comments=LONG_HEADER)
    with pytest.raises(InputError) as caught:
        read_two(text, text.put(0, "Acc_X", "0.5"))
    assert caught.value.code == "same_device"
    assert "00B42D4B" in caught.value.message


def test_arrays_cannot_be_changed() -> None:
    sensor = WHOLE.read()
    assert sensor.acc_mps2 is not None
    with pytest.raises(ValueError, match="read-only"):
        sensor.acc_mps2[0, 0] = 1.0


def test_a_million_samples() -> None:
    rows = [line.split("\t", 1)[1] for line in mt_text(n=1000).text.splitlines()[6:]]
    body = "".join(
        f"{packet % 65_536}\t{rows[packet % 1000]}\n" for packet in range(1_000_000) if packet % 331
    )
    head = "Acquisition frequency: 100 Hz\nPacketCounter\tAcc_X\tAcc_Y\tAcc_Z\tGyr_X\tGyr_Y\tGyr_Z\n"
    file = replace(WHOLE.file, content=(head + body).encode())
    sensor = read_files({Placement.LEFT_FOOT: file}).sensors[Placement.LEFT_FOOT]
    assert sensor.n_samples == 999_999
    assert sensor.n_lost == 999_999 // 331
    assert sensor.first_packet == 1
