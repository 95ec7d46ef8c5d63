"""From bytes to plain text: byte-order marks, UTF-16 and line ends undone, binary files refused by name."""

from __future__ import annotations

import codecs

from gaitlab.errors import InputError
from gaitlab.recording.file import InputFile

_HEAD = 4096
_CONTROL = bytes(set(range(32)) - set(b"\t\n\r\f"))
_BINARY = (
    (b"\xfa\xff", "an MT Manager binary log (.mtb)"),
    (b"%PDF", "a PDF document"),
    (b"\xd0\xcf\x11\xe0", "an old Office document"),
    (b"PK\x03\x04", "a zip or Office document"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"\x89PNG", "a picture"),
    (b"\xff\xd8\xff", "a picture"),
    (b"\x89HDF", "an HDF5 file"),
    (b"MATLAB", "a MATLAB file"),
)


def plain_text(file: InputFile) -> bytes:
    """The file's text as bytes that are ASCII-compatible: no BOM, lines ended by one line feed, no quotes.

    Latin text beyond ASCII may stay in whatever 8-bit encoding it has: it occurs in comments only.

    Raises
    ------
    InputError
        ``empty_file``, ``binary_file``.
    """
    for mark, kind in _BINARY:
        if file.content.startswith(mark):
            raise _binary(file, kind)
    content = _undo_utf16(file)
    if content.startswith(codecs.BOM_UTF8):
        content = content[3:]
    if not content.strip():
        raise InputError(
            "empty_file", "The file is empty.", "Export or copy the recording again.", file=file.name
        )
    _refuse_binary(file, content)
    if b"\r" in content:
        content = content.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    if b'"' in content:
        content = content.replace(b'"', b"")
    return content if content.endswith(b"\n") else content + b"\n"


def head_text(content: bytes, n_bytes: int) -> str:
    """The beginning of a file as text, for looking at its header; never fails."""
    head = content[:n_bytes]
    encoding = _utf16(head)
    if encoding:
        return head.decode(encoding, errors="replace").lstrip("\ufeff")
    return line_text(head.removeprefix(codecs.BOM_UTF8))


def line_text(line: bytes) -> str:
    """Text of a line in UTF-8, else Windows' Western encoding (MT Manager writes the system's)."""
    try:
        return line.decode("utf-8")
    except UnicodeDecodeError:
        return line.decode("cp1252", errors="replace")


def _utf16(head: bytes) -> str | None:
    if head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    sample = head[:512]
    if len(sample) >= 8 and sample[1::2].count(0) > 0.4 * len(sample):
        return "utf-16-le"
    if len(sample) >= 8 and sample[0::2].count(0) > 0.4 * len(sample):
        return "utf-16-be"
    return None


def _undo_utf16(file: InputFile) -> bytes:
    encoding = _utf16(file.content[:_HEAD])
    if encoding is None:
        return file.content
    try:
        return file.content.decode(encoding).lstrip("\ufeff").encode("utf-8")
    except UnicodeError:
        raise _binary(file, "a binary file") from None


def _refuse_binary(file: InputFile, content: bytes) -> None:
    head = content[:_HEAD]
    n_control = len(head) - len(head.translate(None, _CONTROL))
    if b"\x00" in content or n_control > 0.05 * len(head):
        raise _binary(file, "a binary file")


def _binary(file: InputFile, kind: str) -> InputError:
    return InputError(
        "binary_file",
        f"This is {kind}, not text.",
        "Open the recording in MT Manager and export it as text (ASCII).",
        file=file.name,
    )
