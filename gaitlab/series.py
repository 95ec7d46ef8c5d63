"""The time series behind a result: what is drawn in the figures and written by ``--series``."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
import pandas as pd

from gaitlab.recording.model import Bools, Floats, Placement


@dataclass(frozen=True, eq=False)
class SensorSeries:
    """One sensor on the regular packet clock, in the recording's world frame: z up, x along the first straight part.

    Attributes
    ----------
    t_s : ndarray (n,)
        Seconds since the recording's first packet.
    lost, rest : ndarray (n,)
        True where the sample was lost; where the foot rests (for a knee: where its foot rests).
    acceleration_mps2, velocity_mps, position_m : ndarray (n, 3)
        Free acceleration after offset removal, corrected velocity, position.
    raw_velocity_mps, raw_position_m : ndarray (n, 3)
        The same without any reset, as the paper's figures 2, 3, 7 and 8 show them.
    """

    t_s: Floats
    lost: Bools
    rest: Bools
    acceleration_mps2: Floats
    velocity_mps: Floats
    position_m: Floats
    raw_velocity_mps: Floats
    raw_position_m: Floats

    def to_frame(self) -> pd.DataFrame:
        """The fixed columns of ``--series``."""
        columns: dict[str, object] = {
            "t_s": self.t_s,
            "lost": self.lost.astype(np.int8),
            "rest": self.rest.astype(np.int8),
        }
        for stem, unit, values in (
            ("a", "mps2", self.acceleration_mps2),
            ("v", "mps", self.velocity_mps),
            ("p", "m", self.position_m),
        ):
            for axis, name in enumerate("xyz"):
                columns[f"{stem}{name}_{unit}"] = values[:, axis] + 0.0  # no "-0"
        return pd.DataFrame(columns)


Series = Mapping[Placement, SensorSeries]


def to_csv(series: SensorSeries) -> str:
    """CSV text with the fixed columns, six decimals: microseconds and micrometres."""
    text: str = series.to_frame().to_csv(index=False, float_format="%.6f", lineterminator="\n")
    return text


def to_bytes(series: Series) -> bytes:
    """Pack for storage (compressed, single precision: better than 10 µm over 100 m)."""
    arrays: dict[str, np.ndarray] = {}
    for placement, one in series.items():
        for column in fields(one):
            values = getattr(one, column.name)
            keep = values.dtype == bool or column.name == "t_s"
            arrays[f"{placement}/{column.name}"] = values if keep else values.astype(np.float32)
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)  # type: ignore[arg-type]
    return buffer.getvalue()


def from_bytes(content: bytes) -> dict[Placement, SensorSeries]:
    """Unpack what ``to_bytes`` packed."""
    with np.load(io.BytesIO(content), allow_pickle=False) as packed:
        names = {key.split("/")[0] for key in packed.files}
        return {
            placement: SensorSeries(**{f.name: packed[f"{placement}/{f.name}"] for f in fields(SensorSeries)})
            for placement in Placement
            if placement.value in names
        }
