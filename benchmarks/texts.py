"""The table in a sensor's text file, as pandas alone reads it: the bound of any reader, and what gaitmap is given."""

from __future__ import annotations

import io

import pandas as pd


def frame_of(content: bytes) -> pd.DataFrame:
    """The rows below the line that names the columns."""
    lines = content.split(b"\n", 40)
    header = next(i for i, line in enumerate(lines) if b"PacketCounter" in line)
    separator = next(mark for mark in (";", "\t", ",") if mark.encode() in lines[header])
    return pd.read_csv(io.BytesIO(content), sep=separator, skiprows=header, engine="c")
