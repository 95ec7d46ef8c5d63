"""What uploaded files are, told before anything is stored."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass

from gaitlab.clinic.access import Permission
from gaitlab.clinic.clinic import Desk
from gaitlab.errors import InputError
from gaitlab.recording.families import read_samples
from gaitlab.recording.file import InputFile
from gaitlab.recording.foreign import is_sensor_text
from gaitlab.recording.intake import PLACEMENT_FILE, expand
from gaitlab.recording.model import Placement
from gaitlab.recording.packets import regular_grid
from gaitlab.recording.placing import Guess, device_of, guess_one
from gaitlab.recording.rates import decide_rate
from gaitlab.recording.selection import place_files
from gaitlab.store import records


@dataclass(frozen=True)
class InspectedFile:
    """What an uploaded file is, before anything is stored.

    Attributes
    ----------
    placement : Placement or None
        Where the sensor was worn, as far as it can be told.
    why : str
        One sentence: what the placement rests on (file name, ``placement.json``, an earlier choice for the
        device), or why there is none.
    left_out : bool
        The file is of no use for a trial (no sensor file, or a sensor worn elsewhere); leave it aside unless
        the person says otherwise.
    samples : int
        Packets from the first to the last, lost ones included.
    """

    name: str
    device: str | None
    placement: Placement | None
    why: str
    left_out: bool
    samples: int
    rate_hz: float | None
    lost_share: float


def inspect_upload(desk: Desk, files: Sequence[InputFile]) -> list[InspectedFile]:
    """Read the files (zips are unpacked) and guess each one's placement; stores nothing. SESSION_WRITE.

    The answer has one entry for each unpacked file, in their order, under the name it has there.

    Raises
    ------
    InputError
        If there is no sensor file, or one cannot be read; ``file``, ``line`` and ``column`` say where.
    """
    scope = desk.reading(Permission.SESSION_WRITE, "session.inspect")
    unpacked = expand(files)
    devices = [device for file in unpacked if (device := device_of(file)) is not None]
    chosen = records.placements_of_devices(scope, devices)
    desk.pause()
    known = {device: Placement(placement) for device, placement in chosen.items()}
    stated = _stated(unpacked)
    guesses = [guess_one(file, known) for file in unpacked]
    claimed = {guess.placement for guess in guesses if is_sensor_text(guess.file)}
    inspected = [_inspect(guess.file, guess, stated, claimed) for guess in guesses]
    if all(one.left_out for one in inspected):
        _refuse_all(unpacked)
    return inspected


def _stated(files: Sequence[InputFile]) -> dict[str, Placement] | None:
    """Placements by file name from a ``placement.json`` among the files; None where there is none."""
    if not any(file.basename.lower() == PLACEMENT_FILE for file in files):
        return None
    stated: dict[str, Placement] = {}
    for placement, file in place_files(files).files.items():
        if file.name in stated:
            first = stated[file.name].label.capitalize()
            raise InputError(
                "same_content",
                f"{first} and {placement.label} are the same file ({file.name}, {file.name}).",
                "Give each placement its own sensor's file.",
                file=next(one.name for one in files if one.basename.lower() == PLACEMENT_FILE),
            )
        stated[file.name] = placement
    return stated


def _inspect(
    file: InputFile, guess: Guess, stated: dict[str, Placement] | None, claimed: Set[Placement | None]
) -> InspectedFile:
    placement, why = guess.placement, guess.why
    if stated is not None:
        placement = stated.get(file.name)
        why = (
            f"{PLACEMENT_FILE} says {placement.label}."
            if placement
            else f"{PLACEMENT_FILE} does not name it."
        )
    # A damaged recording is refused by its reader; anything else beside the recordings is left aside.
    if not is_sensor_text(file) and (placement is None or (stated is None and placement in claimed)):
        return InspectedFile(file.name, None, None, "This is no sensor file.", True, 0, None, 0.0)
    left_out = placement is None and (stated is not None or guess.elsewhere is not None)
    samples = read_samples(file)
    received = regular_grid(samples.packet, file.name).received
    rate = decide_rate(samples.rates)
    return InspectedFile(
        name=file.name,
        device=samples.device,
        placement=placement,
        why=why,
        left_out=left_out,
        samples=len(received),
        rate_hz=rate.hz if rate else None,
        lost_share=float(1 - received.mean()),
    )


def _refuse_all(files: Sequence[InputFile]) -> None:
    """Say why none of the files is of use: of a single file its reader knows best."""
    if len(files) == 1:
        read_samples(files[0])
    raise InputError(
        "no_sensor_files",
        "None of the files is a recording of a sensor on a foot or knee.",
        "Upload the sensor files of one walk, or a zip of them.",
        file=files[0].name if files else None,
    )
