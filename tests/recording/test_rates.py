"""The rate: header, time stamps, the user; a contradiction is said, an assumption too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gaitlab.errors import InputError
from gaitlab.recording import Placement, read_files
from gaitlab.recording.rates import decide_rate, rate_from_stamps
from gaitlab.recording.samples import Rates
from tests.recording.texts import Text, codes, mt_text, read_two

WHOLE = mt_text()


def with_stamps(step: float, text: Text = WHOLE) -> Text:
    return text.with_column(
        "SampleTimeFine", [str(round(7_000 + step * row)) for row in range(len(text.cells))]
    )


def test_rate_from_the_header() -> None:
    assert replace(WHOLE, comments=("// Update Rate: 40.0Hz",)).read().rate_hz == 40.0


@pytest.mark.parametrize(
    ("step", "rate_hz"), [(10_000, 100.0), (16_666.667, 60.0), (100, 100.0), (166.667, 60.0)]
)
def test_rate_from_time_stamps_in_microseconds_or_ticks(step: float, rate_hz: float) -> None:
    text = replace(with_stamps(step), comments=())
    recording = read_files({Placement.LEFT_FOOT: text.file})
    assert recording.rate_hz == rate_hz
    assert recording.findings == ()


@pytest.mark.parametrize(
    "line", ["// Update Rate: 60.0Hz", "// Sample rate: 60", "Frequency: 60,0 Hz", "//  Update Rate: 60 Hz "]
)
def test_rate_lines(line: str) -> None:
    assert replace(WHOLE, comments=(line,)).read().rate_hz == 60.0


def test_rate_from_time_stamps_that_wrap_and_have_gaps() -> None:
    packet = np.delete(np.arange(1000), np.arange(300, 420))
    stamp = np.mod(2.0**32 - 4_000_000 + 10_000.0 * packet, 2.0**32).astype(np.float64)
    assert rate_from_stamps(packet, stamp) == 100.0


def test_header_that_contradicts_the_time_stamps_loses_and_is_told() -> None:
    text = with_stamps(16_667)
    recording = read_files({Placement.LEFT_FOOT: text.file})
    assert recording.rate_hz == 60.0
    assert codes(recording.findings) == ["rate_contradiction"]
    assert "100 Hz" in recording.findings[0].message


def test_rate_given_by_the_user_wins_and_says_so() -> None:
    recording = read_files({Placement.LEFT_FOOT: WHOLE.file}, rate_hz=50)
    assert recording.rate_hz == 50.0
    assert codes(recording.findings) == ["rate_overridden"]
    assert decide_rate(Rates(100.0, None), 100.0).findings == ()  # type: ignore[union-attr]


def test_unknown_rate_is_assumed_aloud() -> None:
    recording = read_files({Placement.LEFT_FOOT: replace(WHOLE, comments=()).file})
    assert recording.rate_hz == 100.0
    assert codes(recording.findings) == ["rate_assumed"]


def test_unknown_rate_is_taken_from_the_other_sensor() -> None:
    left = replace(mt_text(), comments=("// Update Rate: 60.0Hz",))
    recording = read_two(left, replace(mt_text(first_packet=480), comments=()))
    assert recording.rate_hz == 60.0
    assert [(finding.code, finding.placement) for finding in recording.findings] == [
        ("rate_assumed", Placement.RIGHT_FOOT)
    ]


def test_different_rates() -> None:
    with pytest.raises(InputError) as caught:
        read_two(mt_text(), replace(mt_text(first_packet=480), comments=("// Update Rate: 60.0Hz",)))
    assert caught.value.code == "different_rates"
    assert "60 Hz" in caught.value.message


@pytest.mark.parametrize("rate_hz", [0.0, -100.0, float("nan"), float("inf"), 1e9])
def test_impossible_rate(rate_hz: float) -> None:
    with pytest.raises(InputError) as caught:
        read_files({Placement.LEFT_FOOT: WHOLE.file}, rate_hz=rate_hz)
    assert caught.value.code == "bad_rate"
