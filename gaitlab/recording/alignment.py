"""All sensors of a recording on one counter: the right multiple of 65536 for each."""

from __future__ import annotations

from collections.abc import Mapping

from gaitlab.errors import InputError
from gaitlab.recording.model import Placement
from gaitlab.recording.samples import Samples


def align(samples: Mapping[Placement, Samples]) -> dict[Placement, int]:
    """How many packets to add to each sensor's counter so that all run together.

    Sensors of one trial count the same packets but may wrap before their first sample or not; each is moved
    by the multiple of its modulus that overlaps most with the longest one. The earliest sensor then keeps its
    own counter.

    Raises
    ------
    InputError
        ``no_overlap`` where no packet is common to all.
    """
    spans = {placement: (int(one.packet[0]), int(one.packet[-1]) + 1) for placement, one in samples.items()}
    longest = max(spans, key=lambda placement: spans[placement][1] - spans[placement][0])
    shifts = {
        placement: _best_shift(spans[longest], spans[placement], one.modulus or samples[longest].modulus)
        for placement, one in samples.items()
    }
    moved = {
        placement: (start + shifts[placement], end + shifts[placement])
        for placement, (start, end) in spans.items()
    }
    latest = max(moved, key=lambda placement: moved[placement][0])
    earliest_end = min(moved, key=lambda placement: moved[placement][1])
    if moved[latest][0] >= moved[earliest_end][1]:
        raise InputError(
            "no_overlap",
            f"The recordings do not overlap: {earliest_end.label} ({samples[earliest_end].file.name}) ends at "
            f"packet {moved[earliest_end][1] - 1}, {latest.label} ({samples[latest].file.name}) begins at "
            f"{moved[latest][0]}.",
            "Give the files of one and the same trial.",
            file=samples[latest].file.name,
        )
    first = min(moved, key=lambda placement: moved[placement][0])
    return {placement: shift - shifts[first] for placement, shift in shifts.items()}


def _best_shift(reference: tuple[int, int], span: tuple[int, int], modulus: int | None) -> int:
    if modulus is None:
        return 0
    near = round((sum(reference) - sum(span)) / (2 * modulus))
    candidates = sorted(range(near - 1, near + 2), key=abs)
    return modulus * max(
        candidates, key=lambda k: _overlap(reference, (span[0] + k * modulus, span[1] + k * modulus))
    )


def _overlap(a: tuple[int, int], b: tuple[int, int]) -> int:
    return min(a[1], b[1]) - max(a[0], b[0])
