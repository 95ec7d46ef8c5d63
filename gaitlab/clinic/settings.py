"""What the operator of an installation can choose."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from gaitlab.errors import Misconfigured


@dataclass(frozen=True)
class ClinicSettings:
    """Where the records lie, and the limits.

    Attributes
    ----------
    data_dir : Path
        Folder of database, files and keys; made with mode 0700 where it is missing.
    database_url : str or None
        ``postgresql://…``; None for SQLite in ``data_dir``.
    files_url : str or None
        Any fsspec URL for raw files; None for ``data_dir/files``.
    idle_minutes, absolute_hours : int
        When a web session ends: after so long without a request, and in any case.
    max_upload_bytes : int
        Bound of all files of one trial together.
    """

    data_dir: Path
    database_url: str | None = None
    files_url: str | None = None
    idle_minutes: int = 15
    absolute_hours: int = 10
    max_upload_bytes: int = 256 * 1024 * 1024
    attempts_per_account: int = 10
    attempts_per_address: int = 20
    attempt_window_minutes: int = 15
    setup_code_hours: int = 24
    max_token_days: int = 365
    idempotency_days: int = 7

    @classmethod
    def from_environment(cls, environment: Mapping[str, str] | None = None) -> ClinicSettings:
        """Read ``GAITLAB_DATA_DIR``, ``GAITLAB_DATABASE_URL``, ``GAITLAB_FILES_URL``, ``GAITLAB_IDLE_MINUTES``.

        Raises
        ------
        Misconfigured
            If a value cannot be used.
        """
        env = os.environ if environment is None else environment
        idle = env.get("GAITLAB_IDLE_MINUTES", "15")
        if not idle.isascii() or not idle.isdigit() or not 5 <= int(idle) <= 60:
            raise Misconfigured(
                "idle_minutes",
                "GAITLAB_IDLE_MINUTES is not a number of minutes from 5 to 60.",
                "Set it to 15, or leave it out.",
            )
        return cls(
            data_dir=Path(env.get("GAITLAB_DATA_DIR") or "gaitlab-data"),
            database_url=env.get("GAITLAB_DATABASE_URL") or None,
            files_url=env.get("GAITLAB_FILES_URL") or None,
            idle_minutes=int(idle),
        )
