"""Steps, closing errors and known lengths of every method on ten metres and back, and on a loop."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from gaitlab.analysis import analyze
from gaitlab.comparison.cohorts import row_of
from gaitlab.comparison.inputs import inputs_of, missing
from gaitlab.methods import feliz2009_stance
from gaitlab.methods.catalogue import of
from gaitlab.methods.closing import Closing, closing_of
from gaitlab.methods.length_factors import Factors, KnownWalk, calibrate, distance_m
from gaitlab.methods.model import FootView, Method, Need, Question
from gaitlab.methods.steps_signals import Person, StepSignals
from gaitlab.recording.model import Floats
from gaitlab.validation.foot_loop import read_loop
from gaitlab.validation.methods_model import PAPER, PaperTable
from gaitlab.validation.methods_walks import WAY_M, LabelledFoot, trial_part
from gaitlab.validation.model import Cell, Column
from gaitlab.validation.ten_metres_events import LONG_STANCE_S
from gaitlab.validation.ten_metres_trials import OFF

_STEPS_OF_PAPER = {
    "jimenez2009_acceleration": "0.1 % of 955",
    "jimenez2009_gyroscope": "0.2 % of 955",
    "jimenez2009_magnetometer": "0.94 % of 955",
}
_CLOSING_OF_PAPER = {
    "jimenez2009_zupt": "5–15 m, below 5 % of 100–320 m",
    "jimenez2009_sl_zupt": "5–15 m, below 5 % of 100–320 m",
    "jimenez2009_sl_weinberg": "5–15 m, below 5 % of 100–320 m",
}
_HEADINGS_OF_PAPER = {
    "feliz2009_gyroscope": "7.8, 28.6, 9.2, 12.8 %",
    "feliz2009_compass": "1.8, 1.1, 2.3, 16.3, 3.1 %",
}
_LENGTHS_OF_PAPER = {
    (Question.POSITION, "ikizoglu2018"): "11.41 ± 0.36 m of 11.5 m, 0.8 %",
    (Question.POSITION, "jimenez2009_sl_weinberg"): "0.3–0.8 % of 360 m",
    (Question.POSITION, "jimenez2009_sl_zupt"): "0.6–1.2 % of 360 m",
}


def steps_table(feet: Sequence[LabelledFoot]) -> PaperTable:
    """Table III of Jiménez et al. 2009 against the hand-checked stances."""
    rows: list[tuple[Cell, ...]] = []
    for method in of(Question.STEP):
        real = missed = doubled = 0
        for foot in feet:
            if missing(method, foot.inputs, foot.side):
                continue
            counts = steps_in(np.asarray(method.run(foot.view)), foot)
            real += len(counts)
            missed += int(np.sum(counts == 0))
            doubled += int(np.sum(counts > 1))
        share = [100.0 * n / real if real else np.nan for n in (missed, doubled)]
        paper = _STEPS_OF_PAPER.get(method.name, "")
        rows.append((method.name, real, missed, share[0], doubled, share[1], paper))
    columns = (
        Column("method"),
        Column("real steps", "", 0),
        Column("missed", "", 0),
        Column("missed", "%", 2),
        Column("found twice", "", 0),
        Column("found twice", "%", 2),
        PAPER,
    )
    return PaperTable(
        "steps",
        "Steps missed (Jiménez et al. 2009, table III)",
        "A hand-checked swing of `mtw-10m-walk` makes a step; it is found where a detector tells of one between"
        " the middle of that swing and the middle of the next. Turns, first and last steps count. The paper: 955"
        " steps of its own.",
        columns,
        tuple(rows),
    )


def steps_in(found_s: Floats, foot: LabelledFoot) -> Floats:
    """How many detections belong to each labelled swing of the trial, shape (k,)."""
    middle = foot.swings.mean(axis=1)
    count = int(np.searchsorted(foot.swings[:, OFF], foot.labels.trial[1]))
    after = np.append(middle[1:], np.inf)[:count]
    after = np.minimum(after, middle[:count] + LONG_STANCE_S + 0.5)
    return np.asarray(np.searchsorted(found_s, after) - np.searchsorted(found_s, middle[:count]))


def closing_table(feet: Sequence[LabelledFoot], loops: Sequence[Path]) -> PaperTable:
    """Closing errors of every position method, as in §V.B of Jiménez et al. 2009."""
    loop_feet = [
        view for path in loops for view in inputs_of(analyze(read_loop(path)), Person(), None).feet.values()
    ]
    rows: list[tuple[Cell, ...]] = []
    for method in of(Question.POSITION):
        tracks = [foot.track(method) for foot in feet]
        closings = [closing_of(track) for track in tracks if track is not None]
        on_loops = [closing_of(method.run(view)) for view in loop_feet]
        cells = (*_closing_cells(closings), len(closings), *_loop_cells(on_loops))
        rows.append((method.name, *cells, _CLOSING_OF_PAPER.get(method.name, "")))
    columns = (
        Column("method"),
        Column("median", "m", 2),
        Column("P95", "m", 2),
        Column("median", "% of the path", 1),
        Column("P95", "% of the path", 1),
        Column("feet", "", 0),
        Column("loop", "m", 2),
        Column("loop", "%", 1),
        PAPER,
    )
    return PaperTable(
        "closing",
        "Closing error of every position method (Jiménez et al. 2009, §V.B)",
        "Horizontal distance from where a foot began a trial of `mtw-10m-walk` to where it ended it (20 m; a foot"
        " really ends 0.2 to 0.3 m beside, since after the turn the feet have changed sides), and the same on the"
        " loop of `foot-loop` (23 m). Feet whose method finds fewer than two places are not counted. The rests of"
        " ikizoglu2018 want the device's own orientation, which these files have not.",
        columns,
        tuple(rows),
    )


def _closing_cells(closings: Sequence[Closing]) -> tuple[float, ...]:
    """Median and 95th percentile, metres and percent."""
    found = np.array([(one.error_m, one.percent) for one in closings]).reshape(-1, 2)
    found = found[np.isfinite(found).all(axis=1)]
    if not len(found):
        return (np.nan,) * 4
    low, high = np.percentile(found, (50, 95), axis=0)
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def _loop_cells(closings: Sequence[Closing]) -> tuple[float, float]:
    known = [one for one in closings if np.isfinite(one.error_m)]
    if not known:
        return np.nan, np.nan
    return float(np.mean([one.error_m for one in known])), float(np.mean([one.percent for one in known]))


def heading_table(feet: Sequence[LabelledFoot]) -> PaperTable:
    """Closing errors of Feliz et al. 2009, §III: one path, each heading."""
    rows: list[tuple[Cell, ...]] = []
    for method in of(Question.HEADING):
        ready = [foot for foot in feet if not missing(method, foot.inputs, foot.side)]
        closings = [_closing_with(foot, method) for foot in ready]
        found = _closing_cells([one for one in closings if one is not None])
        rows.append((method.name, *found, len(ready), _HEADINGS_OF_PAPER.get(method.name, "")))
    columns = (
        Column("heading", "", None),
        Column("median", "m", 2),
        Column("P95", "m", 2),
        Column("median", "% of the path", 1),
        Column("P95", "% of the path", 1),
        Column("feet", "", 0),
        PAPER,
    )
    return PaperTable(
        "headings",
        "Closing error by heading (Feliz et al. 2009, §III)",
        "The paper's own path (eq. 1–6) with each heading, on the trials of `mtw-10m-walk`, indoors. The paper:"
        " walks of 23 to 680 m, one figure each, outdoors and indoors; its compass is best away from iron.",
        columns,
        tuple(rows),
    )


def _closing_with(foot: LabelledFoot, heading: Method) -> Closing | None:
    view: FootView = foot.view
    track = feliz2009_stance.position(view, heading_rad=np.asarray(heading.run(view)))
    part = trial_part(track, foot.labels, foot.side)
    return None if part is None else closing_of(part)


def lengths_table(feet: Sequence[LabelledFoot]) -> PaperTable:
    """Equations 4 to 6 of İkizoğlu et al. 2018 on the way out of ten metres."""
    rows: list[tuple[Cell, ...]] = []
    for question, measured in ((Question.POSITION, _way_out), (Question.LENGTH, _sum_out)):
        for method in of(question):
            found = row_of(method, measured(method, feet), WAY_M)
            paper = _LENGTHS_OF_PAPER.get((question, method.name), "")
            cells = (found.mean_m, found.sd_m, found.error_percent, found.n)
            rows.append((method.name, question.value, *cells, paper))
    columns = (
        Column("method"),
        Column("question"),
        Column("mean", "m", 2),
        Column("SD", "m", 2),
        Column("error", "%", 1),
        Column("feet", "", 0),
        PAPER,
    )
    return PaperTable(
        "known_length",
        "Measured against a known length (İkizoğlu et al. 2018, eq. 4–6; Jiménez et al. 2009, table IV)",
        "The way out of `mtw-10m-walk`, about 10 m by its authors. Position: from the start to the farthest"
        " place. Step length: the sum of the strides up to there, the person's factors from all other people. The"
        " paper: 42 people, 11.5 m.",
        columns,
        tuple(rows),
    )


def _way_out(method: Method, feet: Sequence[LabelledFoot]) -> Floats:
    tracks = [foot.track(method) for foot in feet]
    far = [np.nan if one is None else np.hypot(*one.place_m[:, :2].T).max() for one in tracks]
    return np.array(far)


def _sum_out(method: Method, feet: Sequence[LabelledFoot]) -> Floats:
    walks = [KnownWalk(strides_out(foot), WAY_M) for foot in feet]
    factors: dict[str, Factors] = {}
    for subject in dict.fromkeys(foot.subject for foot in feet):
        others = [walk for walk, foot in zip(walks, feet, strict=True) if foot.subject != subject]
        factors[subject] = calibrate(method, others, Person()) if others else Factors()
    found = []
    for walk, foot in zip(walks, feet, strict=True):
        alone = Need.KNOWN_LENGTH in method.needs and len(factors) < 2
        lengths = method.run(walk.steps, foot.inputs.person, factors[foot.subject])
        found.append(np.nan if alone else distance_m(lengths))
    return np.array(found)


def strides_out(foot: LabelledFoot) -> StepSignals:
    """The strides from where a trial began to the farthest place of our path."""
    steps, motion = foot.inputs.strides[foot.side], foot.view.motion
    place, moments = motion.rest_position_m[:, :2], motion.time_s[motion.rests.moment]
    first = max(int(np.searchsorted(moments, foot.swings[0, OFF])) - 1, 0)
    far = first + int(np.argmax(np.hypot(*(place[first:] - place[first]).T)))
    rows = np.arange(len(steps))
    return steps.only((rows >= first) & (rows < far))
