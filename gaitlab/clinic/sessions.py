"""Sessions and trials: look at files, store and analyse a walk, analyse it again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from gaitlab.analysis import Settings
from gaitlab.clinic.clinic import Desk
from gaitlab.clinic.views import SessionForm, SessionSummary, SessionView, TrialView
from gaitlab.recording.model import Placement

if TYPE_CHECKING:
    from gaitlab.recording.intake import InputFile

__all__ = ["SessionForm", "SessionView", "TrialView", "add_session", "add_trial", "get_session", "get_trial"]


@dataclass(frozen=True)
class InspectedFile:
    """What an uploaded file is, before anything is stored.

    ``why`` says where the placement comes from: "file name", "header" or "earlier choice for this device"; empty
    where ``placement`` is None.
    """

    name: str
    device: str | None
    placement: Placement | None
    why: str
    samples: int
    rate_hz: float | None
    lost_share: float


def inspect_upload(desk: Desk, files: Sequence[InputFile]) -> list[InspectedFile]:
    """Read the files (zips are unpacked) and guess each one's placement; stores nothing. SESSION_WRITE.

    Raises
    ------
    InputError
        If a file is no recording; ``file`` and ``line`` say where.
    """
    raise NotImplementedError


def add_session(
    desk: Desk,
    patient_id: str,
    form: SessionForm,
    files: Mapping[Placement, InputFile],
    *,
    idempotency_key: str | None = None,
    settings: Settings | None = None,
) -> SessionView:
    """Read and analyse the files and store all as a session with its first trial; on any error nothing is stored.

    With the same ``idempotency_key`` and the same content, the session of the first call is returned again.

    Raises
    ------
    InputError
        If a file cannot be used; code ``idempotency_key_reused`` where the key came with another content before.
    TooLarge
        If the files are over ``max_upload_bytes``.
    """
    raise NotImplementedError


def add_trial(
    desk: Desk,
    session_id: str,
    files: Mapping[Placement, InputFile],
    *,
    idempotency_key: str | None = None,
    settings: Settings | None = None,
) -> TrialView:
    """Read and analyse the files and store them as a further trial of a session; errors as ``add_session``."""
    raise NotImplementedError


def get_session(desk: Desk, session_id: str) -> SessionView:
    """One session with its trials and their current results."""
    raise NotImplementedError


def list_sessions(desk: Desk, patient_id: str) -> list[SessionSummary]:
    """A patient's sessions, newest first, without results."""
    raise NotImplementedError


def get_trial(desk: Desk, trial_id: str) -> TrialView:
    """One trial with its current result."""
    raise NotImplementedError


def reanalyse(desk: Desk, trial_id: str, settings: Settings | None = None) -> TrialView:
    """Analyse a trial's stored files again: adds an analysis, which becomes the current one."""
    raise NotImplementedError


Why = Literal["file name", "header", "earlier choice for this device"]
