"""From what was uploaded to one file per placement."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from starlette.datastructures import FormData, UploadFile

from gaitlab.clinic.clinic import Desk
from gaitlab.clinic.sessions import InspectedFile, inspect_upload
from gaitlab.errors import InputError
from gaitlab.recording.file import InputFile
from gaitlab.recording.intake import expand
from gaitlab.recording.model import Placement

MOST_PROBLEMS = 8
"""So many wrong files are told at once."""

NOT_USED = "not_used"
"""Chosen instead of a placement: the file stays out of the trial."""


class PlacementsUnknownError(InputError):
    """Some files' placement cannot be told; ``inspected`` says what is known of each."""

    def __init__(self, inspected: Sequence[InspectedFile]) -> None:
        names = ", ".join(one.name for one in inspected if one.placement is None and not one.left_out)
        super().__init__(
            "placement_unknown",
            f"It cannot be told where the sensor of {names} was worn.",
            "Say for each file whether it is the left or right foot or knee.",
        )
        self.inspected = inspected


def files_of(form: FormData, field: str) -> list[InputFile]:
    """The files of one field in the order they were sent; an input left empty sends a nameless, empty one."""
    sent = [item for item in form.getlist(field) if isinstance(item, UploadFile)]
    return [InputFile(one.filename, one.file.read()) for one in sent if one.filename]


def check_fields(form: FormData, known: Iterable[str]) -> None:
    """Refuse fields that mean nothing here, and two values for one field.

    Raises
    ------
    InputError
        With the field as ``column``.
    """
    seen: set[str] = set()
    for name, value in form.multi_items():
        if name not in known:
            raise InputError(
                "unknown_field", f"There is no field of the name {name}.", "See /docs.", column=name
            )
        if name in seen:
            raise InputError(
                "given_twice",
                f"The field {name} was sent twice.",
                "Send one file for each placement.",
                file=value.filename if isinstance(value, UploadFile) else None,
                column=name,
            )
        seen.add(name)


def inspect_all(desk: Desk, files: Sequence[InputFile]) -> tuple[list[InspectedFile], list[InputError]]:
    """What each file is, and what is wrong with those that cannot be read: one bad file does not hide the others."""
    errors: list[InputError] = []
    remaining = list(files)
    while remaining:
        try:
            remaining = expand(remaining)
            return inspect_upload(desk, remaining), errors
        except InputError as error:
            errors.append(error)
            good = [file for file in remaining if file.name != error.file]
            if len(good) == len(remaining) or len(errors) == MOST_PROBLEMS:
                break
            remaining = good
    return [], errors


def by_placement(form: FormData) -> dict[Placement, InputFile]:
    """Files sent under the name of their placement."""
    return {place: files[0] for place in Placement if (files := files_of(form, place.value))}


def chosen_placements(form: FormData) -> dict[str, str]:
    """What was chosen for each file, by its name: the fields ``placed_name`` and ``placed_as``, in pairs."""
    return dict(zip(map(str, form.getlist("placed_name")), map(str, form.getlist("placed_as")), strict=False))


def place(
    desk: Desk, files: Sequence[InputFile], chosen: Mapping[str, str] | None = None
) -> dict[Placement, InputFile]:
    """Unpack zips and give each file its placement: the chosen one, else the one that can be told.

    Raises
    ------
    PlacementsUnknownError
        If a file's placement was neither chosen nor can be told.
    InputError
        If nothing was sent, a file cannot be read, or two files have one placement.
    """
    if not files:
        raise InputError(
            "no_file", "No recording was chosen.", "Choose the files of one walk, or one zip.", column="files"
        )
    unpacked = expand(files)
    _check_names(unpacked)
    wanted = dict(chosen or {})
    _check_chosen(wanted)
    if any(wanted.get(file.name, "") not in {*Placement, NOT_USED} for file in unpacked):
        inspected = inspect_upload(desk, unpacked)
        open_ones = [one for one in inspected if not (one.placement or one.left_out or wanted.get(one.name))]
        if open_ones:
            raise PlacementsUnknownError(inspected)
        wanted = {one.name: wanted.get(one.name) or one.placement or NOT_USED for one in inspected}
    return _one_each(unpacked, wanted)


def _check_names(files: Sequence[InputFile]) -> None:
    """Placements go by file name, so a name must stand for one file."""
    seen: set[str] = set()
    for file in files:
        if file.name in seen:
            raise InputError(
                "same_name",
                f"Two files are called {file.name}.",
                "Rename one of them, or leave one out.",
                file=file.name,
                column="files",
            )
        seen.add(file.name)


def _check_chosen(chosen: Mapping[str, str]) -> None:
    for name, placement in chosen.items():
        if placement not in {*Placement, NOT_USED, ""}:
            raise InputError(
                "invalid_field",
                "There is no such placement.",
                "Choose the left or right foot or knee, or leave the file out.",
                file=name,
                column="placed_as",
            )


def _one_each(files: Sequence[InputFile], wanted: Mapping[str, str]) -> dict[Placement, InputFile]:
    placed: dict[Placement, InputFile] = {}
    for file in files:
        if wanted[file.name] == NOT_USED:
            continue
        where = Placement(wanted[file.name])
        if where in placed:
            raise InputError(
                "placement_twice",
                f"Two files are meant for the {where.label}: {placed[where].name} and {file.name}.",
                "Give each file its own placement, or leave one out.",
                file=file.name,
                column="files",
            )
        placed[where] = file
    if not placed:
        raise InputError(
            "no_file", "No file is used.", "Choose a placement for at least one foot.", column="files"
        )
    return placed
