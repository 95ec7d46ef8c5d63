"""Uncertainty of mean times: contacts that two strides share cancel in the mean of both."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gaitlab.gait.timing import EventErrors, phases_of, runs_of
from gaitlab.recording.model import Side
from tests.walks import analysed


def test_runs_are_counted_by_their_gaps() -> None:
    assert runs_of(np.array([], dtype=np.intp)) == 0
    assert runs_of(np.array([3])) == 1
    assert runs_of(np.array([1, 2, 3, 7, 8, 12])) == 3


def test_the_mean_of_successive_stride_times_is_as_uncertain_as_its_first_and_last_contact() -> None:
    gait = analysed().gait
    for side in Side:
        phases = phases_of(gait.feet[side])
        runs, n = runs_of(phases.index), len(phases.index)
        assert runs == 2  # out and back
        mean = next(p for p in gait.parameters if p.definition.name == "stride_time" and p.side == side.value)
        assert mean.sd == pytest.approx(EventErrors.at(100.0).contact_sd_s * math.sqrt(2 * runs) / n)


def test_that_is_what_errors_of_events_do_to_a_mean() -> None:
    rng = np.random.default_rng(4)
    errors = EventErrors.at(100.0)
    contacts = 1.1 * np.arange(10) + errors.contact_sd_s * rng.standard_normal((20_000, 10))
    means = np.diff(contacts, axis=1)[:, [0, 1, 2, 5, 6, 7, 8]].mean(axis=1)  # strides 3 and 4 lie in a turn
    assert means.std() == pytest.approx(errors.contact_sd_s * math.sqrt(2 * 2) / 7, rel=0.03)


def test_a_slower_clock_reads_events_less_sharply() -> None:
    fast, slow = EventErrors.at(100.0), EventErrors.at(20.0)
    assert slow.contact_sd_s > fast.contact_sd_s
    assert EventErrors.at(400.0) == fast
