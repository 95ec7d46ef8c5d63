"""The trials behind the rows of ten metres and back."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gaitlab.gait.strides import FootGait
from gaitlab.recording.model import Side
from gaitlab.validation.model import Cell, Column, Details
from gaitlab.validation.ten_metres_events import check_events, stride_time_errors
from gaitlab.validation.ten_metres_paths import way_of
from gaitlab.validation.ten_metres_trials import Trial, feet_of


def details_of(trials: Sequence[Trial]) -> tuple[Details, ...]:
    """One row a foot of each trial."""
    columns = (
        Column("trial"),
        Column("foot"),
        Column("lost", "%", 1),
        Column("out and back", "m", 3),
        Column("closing", "m", 3),
        Column("labelled swings", "", 0),
        Column("contacts found", "", 0),
        Column("contacts wrong", "", 0),
        Column("foot offs found", "", 0),
        Column("foot offs wrong", "", 0),
        Column("stride time MAE", "ms", 1),
    )
    rows = [_detail(trial, side, foot) for trial, side, foot in feet_of(trials)]
    return (Details("trials", columns, tuple(rows)),)


def _detail(trial: Trial, side: Side, foot: FootGait) -> tuple[Cell, ...]:
    way = way_of(foot, trial.labels, side)
    off, contact = check_events(foot, trial.labels, side)
    strides = stride_time_errors(contact, trial.labels.swings[side])
    return (
        trial.name,
        side.value,
        100.0 * float(np.mean(~foot.motion.received)),
        way.out_and_back_m if way else None,
        way.closing_length_m if way else None,
        len(contact.part),
        int(np.isfinite(contact.error_s).sum()),
        contact.wrong,
        int(np.isfinite(off.error_s).sum()),
        off.wrong,
        1000.0 * float(np.mean(np.abs(strides))) if len(strides) else None,
    )
