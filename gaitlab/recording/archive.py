"""Unpack a zip in memory after checking its table of contents: nothing is believed and nothing touches the
disk.

Python's ``zipfile`` reads entries that share one local header (CVE-2024-0450) in versions still in use, so
the checks here do not lean on it: number, declared size, ratio, method, name and place of every entry come
first, and the bytes are counted while they come out.
"""

from __future__ import annotations

import io
import re
import stat
import struct
import zipfile
import zlib
from itertools import pairwise
from pathlib import PurePosixPath

from gaitlab.errors import InputError, TooLarge
from gaitlab.recording.file import MIB, InputFile, Limits, check_size, clean_name

_END = struct.Struct("<4s4H2LH")
_END_MARK, _LOCATOR_MARK = b"PK\x05\x06", b"PK\x06\x07"
_LOCATOR_BYTES = 20
_LOCAL_HEADER_BYTES = 30
_DIRECTORY_ENTRY_BYTES = 2048
_ENCRYPTED_FLAGS = 0x1 | 0x40 | 0x2000
_ARCHIVE_SUFFIXES = {".zip", ".gz", ".bz2", ".xz", ".7z", ".rar", ".tar", ".tgz", ".zst"}
_BAD_NAME = re.compile("[\x00-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")
_CHUNK = 256 * 1024
_BROKEN = (zipfile.BadZipFile, zlib.error, struct.error, EOFError, ValueError, NotImplementedError,
           RuntimeError, OverflowError, OSError, IndexError)  # fmt: skip


def unpack(archive: InputFile, limits: Limits) -> list[InputFile]:
    """Return the files in a zip, without folders and without what operating systems add.

    Raises
    ------
    InputError
        ``zip_broken``, ``zip_path`` (a name that leads out of the archive, a link), ``zip_encrypted``,
        ``zip_nested``, ``zip_method``, ``zip_duplicate``, ``zip_empty``.
    TooLarge
        ``zip_entries``, ``zip_bomb`` (declared or real size, ratio, overlapping entries).
    """
    _check_directory_size(archive, limits)
    try:
        with zipfile.ZipFile(io.BytesIO(archive.content)) as opened:
            entries = opened.infolist()
            _check_entries(archive, entries, limits)
            wanted = [entry for entry in entries if not entry.is_dir() and not _is_clutter(entry.filename)]
            if not wanted:
                raise _refuse(archive, "zip_empty", "The zip holds no file.", "Pack the files of one trial.")
            return _extract(archive, opened, wanted, limits)
    except _BROKEN as error:
        raise _refuse(
            archive, "zip_broken", "The zip is damaged or not a zip at all.", "Pack the files again."
        ) from error


def _refuse(archive: InputFile, code: str, message: str, hint: str) -> InputError:
    return InputError(code, message, hint, file=archive.name)


def _bomb(archive: InputFile, message: str) -> TooLarge:
    return TooLarge(
        "zip_bomb", message, "Pack only the sensor files of one trial, in an ordinary zip.", file=archive.name
    )


def _check_directory_size(archive: InputFile, limits: Limits) -> None:
    """Refuse by the end record alone, before a table of contents of a million entries is read."""
    content = archive.content
    at = content.rfind(_END_MARK, max(0, len(content) - _END.size - 0xFFFF))
    if at < 0 or at + _END.size > len(content):
        raise _refuse(
            archive,
            "zip_broken",
            "The zip is incomplete: its table of contents is missing.",
            "Pack it again.",
        )
    _, _, _, _, count, directory_bytes, _, _ = _END.unpack_from(content, at)
    too_many = count > limits.zip_entries or directory_bytes > limits.zip_entries * _DIRECTORY_ENTRY_BYTES
    before = max(0, at - _LOCATOR_BYTES)
    if too_many or content.startswith(_LOCATOR_MARK, before):  # ZIP64 is for more than is read here
        raise TooLarge(
            "zip_entries",
            f"The zip holds too many files; at most {limits.zip_entries} are read.",
            "Pack only the sensor files of one trial.",
            file=archive.name,
        )


def _check_entries(archive: InputFile, entries: list[zipfile.ZipInfo], limits: Limits) -> None:
    if len(entries) > limits.zip_entries:
        raise TooLarge(
            "zip_entries",
            f"The zip holds {len(entries)} files; at most {limits.zip_entries} are read.",
            "Pack only the sensor files of one trial.",
            file=archive.name,
        )
    for entry in entries:
        _check_name(archive, entry)
        _check_kind(archive, entry)
        _check_ratio(archive, entry, limits)
    if sum(entry.file_size for entry in entries) > limits.unpacked_bytes:
        raise _bomb(archive, f"The zip unpacks to more than {limits.unpacked_bytes / MIB:.0f} MiB.")
    _check_overlap(archive, entries)
    seen: set[str] = set()
    for entry in entries:
        key = entry.filename.casefold()
        if key in seen:
            name = clean_name(entry.filename)
            raise _refuse(
                archive,
                "zip_duplicate",
                f"The zip holds two files named “{name}”.",
                "Rename one and pack again.",
            )
        seen.add(key)


def _check_name(archive: InputFile, entry: zipfile.ZipInfo) -> None:
    # zipfile cuts a name at a NUL and turns this system's separators into slashes; orig_filename is what was sent.
    name = entry.orig_filename
    parts = re.split(r"[/\\]", name)
    leads_out = name.startswith(("/", "\\")) or ".." in parts or re.match(r"[A-Za-z]:", name) is not None
    kind = stat.S_IFMT(entry.external_attr >> 16)
    special = kind not in (0, stat.S_IFREG, stat.S_IFDIR)
    if leads_out or special or not name or len(name) > 512 or _BAD_NAME.search(name):
        raise _refuse(
            archive,
            "zip_path",
            f"The zip holds an entry that is not a plain file inside it: “{clean_name(name)[:80]}”.",
            "Pack the sensor files themselves, without links or paths that lead elsewhere.",
        )


def _check_kind(archive: InputFile, entry: zipfile.ZipInfo) -> None:
    name = clean_name(entry.filename)
    if entry.flag_bits & _ENCRYPTED_FLAGS:
        raise _refuse(
            archive,
            "zip_encrypted",
            f"“{name}” in the zip is encrypted.",
            "Pack the files without a password.",
        )
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise _refuse(
            archive,
            "zip_method",
            f"“{name}” is packed by a method that is not read (number {entry.compress_type}).",
            "Pack the files as an ordinary zip (deflate).",
        )
    if PurePosixPath(entry.filename).suffix.lower() in _ARCHIVE_SUFFIXES and not _is_clutter(entry.filename):
        raise _nested(archive, name)


def _nested(archive: InputFile, name: str) -> InputError:
    return _refuse(
        archive,
        "zip_nested",
        f"The zip holds another archive, “{name}”.",
        "Unpack it and pack the sensor files directly.",
    )


def _check_ratio(archive: InputFile, entry: zipfile.ZipInfo, limits: Limits) -> None:
    over = entry.file_size > limits.ratio * max(entry.compress_size, 1)
    if over and entry.file_size > limits.ratio_floor_bytes:
        raise _bomb(
            archive, f"“{clean_name(entry.filename)}” unpacks to more than {limits.ratio:.0f} times its size."
        )
    if entry.file_size > limits.file_bytes:
        check_size(entry.filename, entry.file_size, limits)


def _check_overlap(archive: InputFile, entries: list[zipfile.ZipInfo]) -> None:
    spans = []
    for entry in entries:
        start = entry.header_offset
        if start < 0 or archive.content[start : start + 4] != b"PK\x03\x04":
            raise _refuse(
                archive, "zip_broken", "The zip's table of contents is wrong.", "Pack the files again."
            )
        name_bytes, extra_bytes = struct.unpack_from("<2H", archive.content, start + 26)
        spans.append((start, start + _LOCAL_HEADER_BYTES + name_bytes + extra_bytes + entry.compress_size))
    spans.sort()
    if any(end > start for (_, end), (start, _) in pairwise(spans)):
        raise _bomb(archive, "Entries of the zip overlap.")


def _extract(
    archive: InputFile, opened: zipfile.ZipFile, entries: list[zipfile.ZipInfo], limits: Limits
) -> list[InputFile]:
    files = []
    left = limits.unpacked_bytes
    for entry in entries:
        allowed = min(entry.file_size, limits.file_bytes, left)
        parts, size = [], 0
        with opened.open(entry) as stream:
            while chunk := stream.read(_CHUNK):
                size += len(chunk)
                if size > allowed:
                    raise _bomb(archive, f"“{clean_name(entry.filename)}” unpacks to more than it declares.")
                parts.append(chunk)
        left -= size
        content = b"".join(parts)
        if content[:4] == b"PK\x03\x04":
            raise _nested(archive, clean_name(entry.filename))
        files.append(InputFile(entry.filename, content))
    return files


def _is_clutter(name: str) -> bool:
    parts = PurePosixPath(name).parts
    return "__MACOSX" in parts or any(part.startswith(".") for part in parts) or parts[-1:] == ("Thumbs.db",)
