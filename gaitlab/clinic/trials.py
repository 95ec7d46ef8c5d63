"""Reading, analysing and storing the files of one trial, in the order that leaves nothing half stored.

Everything is read and analysed before anything is stored; then the contents go to the file store, then all rows
go to the database at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from gaitlab.analysis import Analysis, Settings, analyze
from gaitlab.clinic.desk import Desk
from gaitlab.errors import TooLarge
from gaitlab.recording import read_files
from gaitlab.recording.file import InputFile
from gaitlab.recording.model import Placement
from gaitlab.series import to_bytes
from gaitlab.store import records, tables
from gaitlab.store.base import new_id
from gaitlab.store.database import one_at_a_time
from gaitlab.store.files import sha256_of
from gaitlab.store.records import Scope

FILES_LOCK = "files"
"""Held shared while rows are added for contents, alone while contents without rows are swept away."""

MIB = 1024 * 1024


@dataclass(frozen=True, eq=False)
class Prepared:
    """An analysed trial whose contents are in the file store, by their hashes, and whose rows are still to come."""

    files: Mapping[Placement, InputFile]
    analysis: Analysis
    contents: Mapping[str, bytes]
    series_sha256: str


def prepare(desk: Desk, files: Mapping[Placement, InputFile], settings: Settings) -> Prepared:
    """Read, analyse, and put the contents into the file store.

    Raises
    ------
    InputError
        If a file cannot be used; then nothing is stored.
    TooLarge
    """
    limit = desk.clinic.settings.max_upload_bytes
    if sum(len(file.content) for file in files.values()) > limit:
        raise TooLarge(
            "upload_too_large",
            f"The files are larger than {limit / MIB:.0f} MiB together.",
            "Upload one walk at a time.",
        )
    desk.pause()
    analysis = analyze(read_files(files), settings)
    series = to_bytes(analysis.series)
    contents = {sha256_of(content): content for content in (*(f.content for f in files.values()), series)}
    for content in contents.values():
        desk.clinic.files.put(content)
    return Prepared(files, analysis, contents, sha256_of(series))


def keep_contents(desk: Desk, scope: Scope, prepared: Prepared) -> None:
    """Within the write transaction: no sweep from here on, and what one has just taken is put back."""
    one_at_a_time(scope.db, FILES_LOCK, shared=True)
    for sha256, content in prepared.contents.items():
        if not desk.clinic.files.has(sha256):
            desk.clinic.files.put(content)


def add_rows(
    desk: Desk, scope: Scope, trial_id: str, session_id: str, number: int, prepared: Prepared
) -> None:
    """Add a trial with its files and its first analysis."""
    now, by = desk.now(), desk.principal.user_id
    scope.db.add(
        tables.Trial(
            id=trial_id,
            site_id=scope.site_id,
            session_id=session_id,
            number=number,
            created_at=now,
            created_by=by,
        )
    )
    scope.db.flush()
    for position, (placement, sensor) in enumerate(prepared.analysis.recording.sensors.items()):
        source = sensor.source
        raw = tables.RawFile(
            site_id=scope.site_id, sha256=source.sha256, size_bytes=source.size_bytes, created_at=now
        )
        records.add_unless_there(scope, raw)
        scope.db.add(
            tables.TrialFile(
                site_id=scope.site_id,
                trial_id=trial_id,
                placement=placement.value,
                position=position,
                sha256=source.sha256,
                name=source.name[:255],
                device=sensor.device[:100] if sensor.device else None,
                created_at=now,
            )
        )
    add_analysis(desk, scope, trial_id, 1, prepared)


def add_analysis(desk: Desk, scope: Scope, trial_id: str, number: int, prepared: Prepared) -> str:
    """Add an analysis to a trial; the highest number is current."""
    result = prepared.analysis.result
    row = tables.Analysis(
        id=new_id(),
        site_id=scope.site_id,
        trial_id=trial_id,
        number=number,
        gaitlab=result.provenance.gaitlab,
        method=result.provenance.method,
        settings=result.provenance.settings,
        settings_sha256=result.provenance.settings_sha256,
        result_json=result.to_json(),
        series_sha256=prepared.series_sha256,
        created_at=desk.now(),
        created_by=desk.principal.user_id,
    )
    scope.db.add(row)
    scope.db.flush()
    return row.id
