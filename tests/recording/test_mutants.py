"""Damaged files get an input error or a sound recording, and nothing else."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gaitlab.errors import GaitlabError
from gaitlab.recording import Placement, read_files
from tests.recording.texts import ACC, EULER, GYR, MAG, MATRIX, QUATERNION, TEN_METRE_HEADER, mt_text


def mutants() -> list[Callable[[random.Random, bytearray], None]]:
    def flip(rng: random.Random, data: bytearray) -> None:
        for _ in range(rng.randint(1, 5)):
            data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)

    def overwrite(rng: random.Random, data: bytearray) -> None:
        data[rng.randrange(len(data))] = rng.choice(b"\x00\n\r\t,;. -+eE\"'/\xff0\x1a|:nN")

    def insert(rng: random.Random, data: bytearray) -> None:
        at = rng.randrange(len(data))
        data[at:at] = rng.choice(
            [b"NaN", b"inf", b"\n", b"\t", b"1e308", b"\xef\xbb\xbf", b"\x00", b'"', b"\r", b"-", b"//"]
        )

    def delete(rng: random.Random, data: bytearray) -> None:
        at = rng.randrange(len(data))
        del data[at : at + rng.randint(1, 200)]

    def repeat(rng: random.Random, data: bytearray) -> None:
        at = rng.randrange(len(data))
        data[at:at] = data[at : at + rng.randint(1, 300)]

    def cut(rng: random.Random, data: bytearray) -> None:
        del data[rng.randrange(len(data)) :]

    return [flip, overwrite, insert, delete, repeat, cut]


@pytest.mark.parametrize("seed", range(40))
def test_mutated_files_raise_nothing_but_input_errors(seed: int) -> None:
    rng = random.Random(seed)
    originals = [
        mt_text(n=30).file,
        replace(mt_text(ACC, GYR, QUATERNION, n=30), delimiter=",").file,
        replace(mt_text(ACC, MATRIX, n=30), line_end="\r\n", encoding="utf-16").file,
        replace(mt_text(ACC, GYR, MAG, n=30), comments=TEN_METRE_HEADER).file,
        replace(mt_text(ACC, GYR, EULER, n=30), delimiter=" ").file,
    ]
    for original in originals:
        for mutate in mutants():
            data = bytearray(original.content)
            mutate(rng, data)
            try:
                recording = read_files({Placement.LEFT_FOOT: replace(original, content=bytes(data))})
            except GaitlabError:
                continue
            sensor = recording.sensors[Placement.LEFT_FOOT]
            for values in (sensor.acc_mps2, sensor.gyr_radps, sensor.attitude, sensor.mag):
                assert values is None or (np.isfinite(values).all() and len(values) == sensor.n_samples)
