"""Step lengths, thigh navigation and calibrations of every method against cameras."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gaitlab.analysis import analyze
from gaitlab.comparison.inputs import Inputs, inputs_of, missing
from gaitlab.errors import InputError
from gaitlab.methods.calibration_signals import Pair, calibration_pairs
from gaitlab.methods.catalogue import of
from gaitlab.methods.ground_truth import ground_truth_errors
from gaitlab.methods.length_factors import KnownWalk as Known
from gaitlab.methods.length_factors import LengthClass, by_class, calibrate
from gaitlab.methods.model import Method, Question
from gaitlab.methods.steps_signals import Person, StepSignals
from gaitlab.recording import Placement, Recording, Side, read_recording
from gaitlab.recording.model import Floats
from gaitlab.validation.folder import files_in
from gaitlab.validation.foot_mocap_files import heels_of, is_imu, read_feet, read_heel
from gaitlab.validation.leg_vicon_check import optical_files, read_optical, sensors_of
from gaitlab.validation.methods_model import PAPER, PaperTable
from gaitlab.validation.model import Cell, Column, Problem
from gaitlab.validation.truth import OpticalPath

TRAIN_SHARE = 28 / 41
"""The first so much of a stretch trains a calibration: "a size of 28 for the train set and 13 for the test set", §2.2."""


@dataclass(frozen=True, eq=False)
class SeenFoot:
    """A foot under cameras: its path by a point of it, and the knee's where that was seen."""

    name: str
    side: Side
    inputs: Inputs
    point: OpticalPath
    knee: OpticalPath | None = None


def seen_feet(homes: Sequence[Path]) -> tuple[list[SeenFoot], list[Problem]]:
    """All feet under cameras in some folders."""
    feet: list[SeenFoot] = []
    problems: list[Problem] = []
    for home in homes:
        for read in (_shoes, _legs):
            try:
                feet += read(home)
            except InputError as error:
                problems.append(Problem(home.name, str(error)))
    return feet, problems


def _shoes(home: Path) -> list[SeenFoot]:
    """Walks of ``foot-mocap``; staircases are not for models of level walking."""
    files = files_in(home)
    recordings = {path: read_feet(path) for path in files if is_imu(path)}
    durations = {path: _duration(recording) for path, recording in recordings.items()}
    found = []
    for path, heels in heels_of(files, durations).items():
        inputs = inputs_of(analyze(recordings[path]), Person(), None)
        found += [
            SeenFoot(path.stem, side, inputs, read_heel(heel, side))
            for side, heel in heels
            if side in inputs.feet
        ]
    return found


def _duration(recording: Recording) -> float:
    return max(sensor.n_samples / sensor.rate_hz for sensor in recording.sensors.values())


def _legs(home: Path) -> list[SeenFoot]:
    """Legs of ``leg-vicon``, the thigh's sensor as the knee's."""
    cameras = optical_files(home)
    if not cameras or not any(path.suffix.lower() == ".txt" for path in files_in(home)):
        return []
    sensors = sensors_of(home)
    places = {Placement.foot(side): sensors.get(f"{side}_foot") for side in Side}
    places |= {Placement.knee(side): sensors.get(f"{side}_thigh") for side in Side}
    analysis = analyze(read_recording(placements={k: path for k, path in places.items() if path is not None}))
    inputs = inputs_of(analysis, Person(), None)
    found = []
    for side in inputs.feet:
        for path in cameras:
            optical = read_optical(path, analysis.recording, side)
            if optical:
                found.append(SeenFoot(home.name, side, inputs, optical["MIDFOOT"], optical["KNEE"]))
    return found


def lengths_by_class(feet: Sequence[SeenFoot]) -> PaperTable:
    """Table II of Sun et al. 2015."""
    rows: list[tuple[Cell, ...]] = []
    for method in of(Question.LENGTH):
        pairs = [_step_lengths(foot, method) for foot in feet]
        estimated, real = (np.concatenate([pair[k] for pair in pairs] or [np.zeros(0)]) for k in (0, 1))
        classes = by_class(estimated, real)
        cells = [_class_cell(one) for one in classes[:-1]]
        whole = classes[-1]
        paper = _SUN.get(method.name, "")
        rows.append((method.name, *cells, whole.rmse_m, whole.deviation_percent, whole.n, paper))
    names = [f"{one.low_m:.1f}–{one.high_m:.1f} m" for one in by_class(np.zeros(0), np.zeros(0))[:-1]]
    columns = (
        Column("method"),
        *(Column(name) for name in names),
        Column("RMSE", "m", 4),
        Column("deviation", "%", 2),
        Column("strides", "", 0),
        PAPER,
    )
    return PaperTable(
        "length_classes",
        "Step length by class of length (Sun et al. 2015, table II)",
        "Half of each stride of one foot against the optical heel (`foot-mocap`, level walk) or mid-foot"
        " (`mtw-leg-vicon`): RMSE in metres, average deviation in %, and how many. Each walk is its own test walk: the"
        " factor sees its length as a whole, not the strides. The paper: steps of its own volunteers, sensor at"
        " the body; averages of its columns. The last figures hold strides outside the classes too.",
        columns,
        tuple(rows),
    )


_SUN = {
    "weinberg": "0.1009 m, 15.79 %",
    "kim": "0.1066 m, 16.34 %",
    "scarlett": "0.1734 m, 28.11 %",
    "xu": "0.1166 m, 15.24 %",
    "frequency_linear": "0.2642 m, 40.71 %",
    "shin": "0.2400 m, 35.99 %",
    "bylemans": "0.1084 m, 16.16 %",
    "sun2015": "0.0768 m, 10.90 %",
}
"""Average columns; its "frequency model" is taken for the linear one."""


def _class_cell(one: LengthClass) -> str:
    return f"{one.rmse_m:.3f} / {one.deviation_percent:.0f} % ({one.n})" if one.n else "–"


def seen_steps(foot: SeenFoot) -> tuple[StepSignals, Floats]:
    """A foot's strides within sight and their optical lengths, shape (m,)."""
    steps = foot.inputs.strides[foot.side]
    gait = foot.inputs.gait(foot.side)
    truth = foot.point.horizontal_length(gait.start_s, gait.end_s)
    seen = gait.walking & np.isfinite(truth)
    return steps.only(seen), truth[seen]


def _step_lengths(foot: SeenFoot, method: Method) -> tuple[Floats, Floats]:
    """Estimated and optical step lengths of one foot, shapes (m,)."""
    steps, truth = seen_steps(foot)
    factors = calibrate(method, [Known(steps, float(truth.sum()))], Person())
    lengths = method.run(steps, Person(), factors)
    return np.asarray(lengths.length_m) / steps.steps_each, truth / steps.steps_each


def thigh_table(feet: Sequence[SeenFoot]) -> PaperTable:
    """Table II of Bousdar Ahmed and Metzger 2017."""
    rows: list[tuple[Cell, ...]] = []
    for method in of(Question.THIGH):
        distance: list[float] = []
        heading: list[float] = []
        for foot in feet:
            if foot.knee is None or missing(method, foot.inputs, foot.side):
                continue
            found = method.run(foot.inputs.thighs[foot.side])
            if found.reason:
                continue
            true = foot.knee.at(foot.inputs.thighs[foot.side].time_s[found.stride_row])
            seen = np.isfinite(true).all(axis=1)
            errors = ground_truth_errors(true[seen], found.place_m[1:][seen], aligned=True)
            distance += errors.distance_m.tolist()
            heading += np.degrees(errors.heading_rad[1:]).tolist()  # the first is 0 by definition
        cells = (*_mean_sd(distance), *_mean_sd(heading), len(distance))
        rows.append((method.name, *cells, _BOUSDAR.get(method.name, "")))
    columns = (
        Column("method"),
        Column("e_d", "m", 3),
        Column("SD", "m", 3),
        Column("e_ψ", "°", 1),
        Column("SD", "°", 1),
        Column("strides", "", 0),
        PAPER,
    )
    return PaperTable(
        "thigh",
        "Thigh navigation (Bousdar Ahmed and Metzger 2017, eq. 7–8, table II)",
        "Between successive instants at which the left thigh of `mtw-leg-vicon` is farthest forward, against the"
        " optical knee: errors of distance and of direction, the first direction being common. The paper: 149"
        " ground-truth points of 17 walks, many strides apart.",
        columns,
        tuple(rows),
    )


_BOUSDAR = {
    "bousdar2017_thigh": "0.4 ± 1.8 m, 14.9 ± 28.8°",
    "bousdar2017_thigh_corrected": "0.2 ± 1.2 m, 10.1 ± 31.3°",
}


def _mean_sd(values: Sequence[float]) -> tuple[float, float]:
    known = np.array([one for one in values if np.isfinite(one)])
    if not len(known):
        return np.nan, np.nan
    return float(known.mean()), float(known.std(ddof=1)) if len(known) > 1 else np.nan


def calibration_table(feet: Sequence[SeenFoot]) -> PaperTable:
    """Table 2 of İkizoğlu et al. 2018."""
    by_foot = [_pairs(foot) for foot in feet]
    pairs = [pair for found in by_foot for pair in found]
    kinds = list(dict.fromkeys(pair.name for pair in pairs))
    rows: list[tuple[Cell, ...]] = []
    for method in of(Question.CALIBRATION):
        cells: list[Cell] = []
        for kind in kinds:
            fits = [_fit(method, pair) for pair in pairs if pair.name == kind]
            known = np.array([one for one in fits if np.isfinite(one).all()]).reshape(-1, 2)
            cells += [float(np.median(known[:, k])) if len(known) else np.nan for k in (0, 1)]
        rows.append((method.name, *cells, _IKIZOGLU.get(method.name, "")))
    columns = (
        Column("model"),
        *(Column(f"{kind}, {part}", "%", 1) for kind in kinds for part in ("train", "test")),
        PAPER,
    )
    return PaperTable(
        "calibration",
        "Goodness of fit of calibrations (İkizoğlu et al. 2018, table 2)",
        f"A foot's sensor against the cameras along the walk, the first {100 * TRAIN_SHARE:.0f} % for training; median over"
        f" {sum(map(bool, by_foot))} feet. Position: integrated twice, nothing taken out; stride:"
        " begun anew at every rest; acceleration: as it is. The paper: an optical mouse on a desk, training and test.",
        columns,
        tuple(rows),
    )


_IKIZOGLU = {
    "armax": "65.80, 61.75",
    "box_jenkins": "65.90, 62.10",
    "state_space": "64.95, 61.20",
    "nonlinear_arx": "63.11, 57.68",
    "hammerstein_wiener": "67.48, 59.84",
    "correlation": "75.63, 71.71",
    "network": "74 for 5 m (§2.2)",
}


def _pairs(foot: SeenFoot) -> tuple[Pair, ...]:
    motion = foot.inputs.gait(foot.side).motion
    return calibration_pairs(motion, foot.point.at(motion.time_s))


def _fit(method: Method, pair: Pair) -> tuple[float, float]:
    found = method.run(pair.measured, pair.reference, round(TRAIN_SHARE * len(pair.measured)))
    return found.fit_train_percent, found.fit_test_percent
