"""Contents outside the database, each under its own SHA-256: raw files and time series.

Files first, rows second: a crash can leave a file that no row names, never a row without its file. ``sweep`` clears
up after crashes.
"""

from __future__ import annotations

import datetime as dt
import hashlib
import os
import secrets
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, cast

import fsspec
from fsspec.implementations.local import LocalFileSystem

from gaitlab.errors import GaitlabError, Misconfigured
from gaitlab.store.base import SHA256_PATTERN

_TEMPORARY = "tmp"


def sha256_of(content: bytes) -> str:
    """Hexadecimal SHA-256."""
    return hashlib.sha256(content).hexdigest()


class Files:
    """A folder of contents under their hash, on this machine or anywhere fsspec reaches.

    On this machine a content is on the disk when ``put`` returns: written under a temporary name, synchronised,
    renamed, and its folder synchronised.
    """

    def __init__(self, url: str) -> None:
        try:
            fs, root = fsspec.core.url_to_fs(url)
        except (ValueError, ImportError) as problem:
            raise Misconfigured(
                "files_url",
                f"The raw files cannot be kept under the given address: {problem}.",
                "Correct GAITLAB_FILES_URL, or leave it out for a folder beside the database.",
            ) from None
        self._fs = fs
        self._root = str(root).rstrip("/")
        self._local = isinstance(fs, LocalFileSystem)
        if self._local:
            for folder in (Path(self._root), Path(self._root) / _TEMPORARY):
                folder.mkdir(mode=0o700, parents=True, exist_ok=True)

    def path(self, sha256: str) -> str:
        """Where a content lies. Only a hash can become a path."""
        if SHA256_PATTERN.fullmatch(sha256) is None:
            raise ValueError("not a SHA-256")
        return f"{self._root}/{sha256[:2]}/{sha256}"

    def put(self, content: bytes) -> str:
        """Keep a content and return its hash; what is there already and whole is only touched."""
        sha256 = sha256_of(content)
        path = self.path(sha256)
        if not self._local:
            self._fs.pipe_file(path, content)
        elif not _touched(path, sha256):
            _write_durably(Path(path), content, Path(self._root) / _TEMPORARY)
        return sha256

    def get(self, sha256: str) -> bytes:
        """The content of this hash.

        Raises
        ------
        GaitlabError
            If it is missing or is not what was stored.
        """
        try:
            content = cast(bytes, self._fs.cat_file(self.path(sha256)))
        except FileNotFoundError:
            raise GaitlabError(
                "file_missing",
                f"The stored file {sha256[:12]} is missing.",
                "Restore the files from a backup.",
            ) from None
        if sha256_of(content) != sha256:
            raise GaitlabError(
                "file_damaged",
                f"The stored file {sha256[:12]} is not as it was stored.",
                "Restore it from a backup.",
            )
        return content

    def has(self, sha256: str) -> bool:
        """Is there a content of this hash?"""
        return bool(self._fs.exists(self.path(sha256)))

    def delete(self, sha256: str) -> None:
        """Remove a content; a missing one is no error."""
        with suppress(FileNotFoundError):
            self._fs.rm_file(self.path(sha256))

    def older_than(self, instant: dt.datetime) -> Iterator[str]:
        """Hashes of contents last put before ``instant``."""
        for info in self._listing():
            name = str(info["name"]).rsplit("/", 1)[-1]
            if SHA256_PATTERN.fullmatch(name) and self._modified(info) < instant:
                yield name

    def clear_temporary(self, instant: dt.datetime) -> int:
        """Remove what interrupted writing left before ``instant``; returns how many."""
        if not self._local:
            return 0
        old = [
            p for p in (Path(self._root) / _TEMPORARY).iterdir() if p.stat().st_mtime < instant.timestamp()
        ]
        for path in old:
            path.unlink(missing_ok=True)
        return len(old)

    def _listing(self) -> list[dict[str, Any]]:
        with suppress(FileNotFoundError):
            return list(self._fs.find(self._root, detail=True).values())
        return []

    def _modified(self, info: dict[str, Any]) -> dt.datetime:
        modified = cast(dt.datetime, self._fs.modified(info["name"]))
        return modified if modified.tzinfo else modified.replace(tzinfo=dt.UTC)


def _touched(path: str, sha256: str) -> bool:
    """Is this content there and whole? Then make it young again, so that no sweep takes it."""
    try:
        if sha256_of(Path(path).read_bytes()) != sha256:
            return False
        os.utime(path)
    except FileNotFoundError:
        return False
    return True


def _write_durably(path: Path, content: bytes, temporary_folder: Path) -> None:
    temporary = temporary_folder / secrets.token_hex(16)
    try:
        descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o400)
        with os.fdopen(descriptor, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if not path.parent.is_dir():
            path.parent.mkdir(mode=0o700, exist_ok=True)
            _synchronise(path.parent.parent)
        temporary.replace(path)
        _synchronise(path.parent)
    except OSError as problem:
        temporary.unlink(missing_ok=True)
        raise GaitlabError(
            "storage_failed",
            f"The files cannot be stored: {os.strerror(problem.errno or 0)}.",
            "Nothing was stored. Free space on the data folder's disk, then send them again.",
        ) from problem


def _synchronise(folder: Path) -> None:
    if os.name == "nt":  # folders cannot be opened there, and renaming is journalled
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
