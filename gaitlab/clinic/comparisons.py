"""A stored trial by every published method; nothing is stored, each look is audited."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from gaitlab.analysis import Settings
from gaitlab.clinic.access import Permission
from gaitlab.clinic.desk import Desk, not_found
from gaitlab.clinic.showing import patient_code
from gaitlab.comparison import Comparison, compare
from gaitlab.methods.steps_signals import Person, Sex
from gaitlab.recording import InputFile, Placement, read_files
from gaitlab.report.figures.model import Figure
from gaitlab.store import records
from gaitlab.store.tables import Patient

__all__ = ["Comparison", "Figure", "TrialComparison", "compare_trial"]

ACTION = "trial.compare"


@dataclass(frozen=True, eq=False)
class TrialComparison:
    """The methods on one trial, and whose it is."""

    trial_id: str
    number: int
    session_id: str
    patient_id: str
    patient_code: str
    person: Person
    comparison: Comparison

    def figures(self) -> Sequence[Figure]:
        """Paths, stride lengths and agreement."""
        from gaitlab.report.figures.methods import comparison_figures

        return comparison_figures(self.comparison)


def compare_trial(desk: Desk, trial_id: str, known_length_m: float | None = None) -> TrialComparison:
    """Run every method on the stored files of a trial. SESSION_READ.

    Raises
    ------
    InputError
        ``known_length`` where it cannot be one.
    GaitlabError
        ``file_missing`` or ``file_damaged`` where a stored file is not as it was stored.
    """
    scope = desk.reading(Permission.SESSION_READ, ACTION, trial_id)
    row = records.trial(scope, trial_id)
    if row is None:
        raise not_found()
    session = row.session
    desk.looked(ACTION, object_id=row.id, patient_id=session.patient_id)
    files = {
        Placement(one.placement): InputFile(one.name, desk.clinic.files.get(one.sha256)) for one in row.files
    }
    person = _person(session.patient)
    shown = (row.id, row.number, session.id, session.patient_id, patient_code(desk, session.patient))
    settings = Settings(course_m=session.course_m)
    desk.pause()
    return TrialComparison(*shown, person, compare(read_files(files), settings, known_length_m, person))


def _person(row: Patient) -> Person:
    sex = Sex(row.sex) if row.sex in set(Sex) else None
    return Person(row.height_m, sex)
