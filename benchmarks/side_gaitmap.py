"""gaitmap's side of ``side_by_side.py``: its documented pipeline with its defaults, run by gaitmap's own environment.

The steps are those of "MaD DiGait Pipeline" in gaitmap's gallery: alignment to gravity, body frame, stride segmentation
(BarthDtw), events (RamppEventDetection), trajectory of each stride (StrideLevelTrajectory), temporal and spatial
parameters. How the sensor sits on the foot is found once, before the clock runs, by gaitmap's own alignment (gravity,
principal axis, sign of the way forward); to turn the data by it is part of the pipeline and is timed.
"""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import Any

from worker import one_core, serve

one_core()

import numpy as np  # noqa: E402 on its core before anything is loaded
from gaitmap.event_detection import RamppEventDetection  # noqa: E402
from gaitmap.parameters import SpatialParameterCalculation, TemporalParameterCalculation  # noqa: E402
from gaitmap.preprocessing.sensor_alignment import (  # noqa: E402
    ForwardDirectionSignAlignment,
    PcaAlignment,
    align_dataset_to_gravity,
)
from gaitmap.stride_segmentation import BarthDtw  # noqa: E402
from gaitmap.trajectory_reconstruction import StrideLevelTrajectory  # noqa: E402
from gaitmap.utils.coordinate_conversion import convert_to_fbf  # noqa: E402
from gaitmap.utils.rotations import rotate_dataset  # noqa: E402
from scipy.spatial.transform import Rotation  # noqa: E402
from texts import frame_of  # noqa: E402

RATE_HZ = 100.0
ACC, GYR = ["acc_x", "acc_y", "acc_z"], ["gyr_x", "gyr_y", "gyr_z"]
Data = dict[str, Any]


def frame(content: bytes) -> Any:
    """Accelerometer in m/s² and gyroscope in deg/s, under gaitmap's names."""
    table = frame_of(content)
    values = table[[f"{kind}_{axis}" for kind in ("Acc", "Gyr") for axis in "XYZ"]].to_numpy(copy=True)
    values[:, 3:] = np.rad2deg(values[:, 3:])
    return type(table)(values, columns=ACC + GYR)


def mounting(data: Data) -> dict[str, Rotation]:
    """Turn of each sensor into gaitmap's frame, by gaitmap's own steps."""
    level = align_dataset_to_gravity(data, RATE_HZ)
    along = PcaAlignment().align(level)
    forward = ForwardDirectionSignAlignment().align(along.aligned_data_, sampling_rate_hz=RATE_HZ)
    return {name: _turn(data[name], forward.aligned_data_[name]) for name in data}


def _turn(before: Any, after: Any) -> Rotation:
    """The rotation between two versions of the same signals."""
    return Rotation.align_vectors(after[ACC].to_numpy(), before[ACC].to_numpy())[0]


def pipeline(data: Data, turns: dict[str, Rotation]) -> tuple[Any, Any, Any]:
    """Events, temporal and spatial parameters of both feet."""
    turned = rotate_dataset(data, turns)
    level = align_dataset_to_gravity(turned, RATE_HZ)
    body = convert_to_fbf(level, left_like="left_", right_like="right_")
    strides = BarthDtw().segment(data=body, sampling_rate_hz=RATE_HZ)
    events = RamppEventDetection().detect(
        data=body, stride_list=strides.stride_list_, sampling_rate_hz=RATE_HZ
    )
    path = StrideLevelTrajectory().estimate(
        data=level, stride_event_list=events.min_vel_event_list_, sampling_rate_hz=RATE_HZ
    )
    temporal = TemporalParameterCalculation().calculate(
        stride_event_list=events.min_vel_event_list_, sampling_rate_hz=RATE_HZ
    )
    spatial = SpatialParameterCalculation().calculate(
        stride_event_list=events.min_vel_event_list_,
        positions=path.position_,
        orientations=path.orientation_,
        sampling_rate_hz=RATE_HZ,
    )
    return events, temporal, spatial


def main() -> None:
    warnings.simplefilter("ignore")
    contents = {
        f"{side}_sensor": Path(name).read_bytes()
        for side, name in zip(("left", "right"), sys.argv[1:3], strict=True)
    }
    turns: dict[str, Rotation] = {}

    def analysed(data: Any) -> str:
        if not turns:
            turns.update(mounting(data))
        events, _, _ = pipeline(data, turns)
        found = events.min_vel_event_list_
        return ", ".join(f"{len(found[f'{side}_sensor'])} strides {side}" for side in ("left", "right"))

    serve(lambda: {name: frame(content) for name, content in contents.items()}, analysed)


if __name__ == "__main__":
    main()
