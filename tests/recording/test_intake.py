"""Files, folders and zips come in bounded; nothing hostile in an archive is unpacked."""

from __future__ import annotations

import io
import os
import stat
import struct
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import IO

import pytest

from gaitlab.errors import InputError, TooLarge
from gaitlab.recording import archive
from gaitlab.recording.file import InputFile, Limits, clean_name
from gaitlab.recording.intake import expand, load

TEXT = b"PacketCounter\tAcc_X\n1\t2.0\n" * 50


def zipped(entries: Mapping[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as archive:
        for name, content in entries.items():
            archive.writestr(zipfile.ZipInfo(name), content, method)
    return buffer.getvalue()


LONG_DIRECTORY = zipped({f"{number:0200d}": b"" for number in range(4000)})


def with_entry(info: zipfile.ZipInfo, content: bytes = TEXT) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr(info, content)
    return buffer.getvalue()


def refusal(content: bytes, limits: Limits | None = None) -> InputError:
    with pytest.raises(InputError) as caught:
        expand([InputFile("trial.zip", content)], *([limits] if limits else []))
    assert caught.value.file == "trial.zip"
    assert caught.value.hint
    return caught.value


def test_zip_becomes_its_files_without_folders_and_clutter() -> None:
    content = zipped(
        {
            "walk/": b"",
            "walk/1_lf.txt": TEXT,
            "walk/.DS_Store": b"x",
            "__MACOSX/walk/._1_lf.txt": b"x",
            "Thumbs.db": b"x",
            "walk/placement.json": b"{}",
        }
    )
    files = expand([InputFile("trial.zip", content), InputFile("other.txt", b"abc")])
    assert [(file.name, file.content) for file in files] == [
        ("walk/1_lf.txt", TEXT),
        ("walk/placement.json", b"{}"),
        ("other.txt", b"abc"),
    ]


def test_stored_entries_are_read() -> None:
    assert expand([InputFile("t.zip", zipped({"a.txt": TEXT}, zipfile.ZIP_STORED))])[0].content == TEXT


def test_zip_is_known_by_content_not_by_name() -> None:
    assert expand([InputFile("recording", zipped({"a.txt": TEXT}))])[0].name == "a.txt"


@pytest.mark.parametrize(
    "name",
    [
        "../a.txt",
        "walk/../../a.txt",
        "/etc/passwd",
        "C:\\Windows\\a.txt",
        "c:a.txt",
        "..\\a.txt",
        "\\\\server\\a.txt",
        "a\x1b[31m.txt",
        "a\u202etxt.exe",
        "x" * 600,
    ],
)
def test_names_that_lead_out_or_deceive(name: str) -> None:
    assert refusal(zipped({name: TEXT})).code == "zip_path"


def test_nul_in_a_name() -> None:
    content = zipped({"aXb.txt": TEXT}).replace(b"aXb.txt", b"a\x00b.txt")
    assert refusal(content).code == "zip_path"


@pytest.mark.parametrize("kind", [stat.S_IFLNK, stat.S_IFCHR, stat.S_IFIFO, stat.S_IFBLK])
def test_links_and_devices(kind: int) -> None:
    info = zipfile.ZipInfo("a.txt")
    info.external_attr = (kind | 0o644) << 16
    assert refusal(with_entry(info, b"/etc/passwd")).code == "zip_path"


def test_encrypted_entry() -> None:
    content = bytearray(zipped({"a.txt": TEXT}))
    for mark, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        at = content.index(mark) + offset
        content[at] |= 1
    assert refusal(bytes(content)).code == "zip_encrypted"


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_other_methods_than_stored_and_deflate(method: int) -> None:
    assert refusal(zipped({"a.txt": TEXT}, method)).code == "zip_method"


def test_names_twice() -> None:
    assert (
        refusal(zipped({"a.txt": TEXT, "b.txt": b"other"}).replace(b"b.txt", b"a.txt")).code
        == "zip_duplicate"
    )
    assert refusal(zipped({"a.txt": TEXT, "A.TXT": b"other"})).code == "zip_duplicate"


@pytest.mark.parametrize("name", ["inner.zip", "inner.tar.gz", "inner.7z"])
def test_archive_in_an_archive(name: str) -> None:
    assert refusal(zipped({name: zipped({"a.txt": TEXT})})).code == "zip_nested"


def test_archive_in_an_archive_under_another_name() -> None:
    assert refusal(zipped({"a.txt": zipped({"a.txt": TEXT})})).code == "zip_nested"


def test_too_many_entries() -> None:
    error = refusal(zipped({f"{number}.txt": b"" for number in range(201)}))
    assert isinstance(error, TooLarge)
    assert error.code == "zip_entries"


def test_a_hundred_thousand_entries_are_refused_before_they_are_listed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    content = zipped({f"{number}": b"" for number in range(20_000)})
    monkeypatch.setattr(zipfile, "ZipFile", None)  # whoever opens the archive fails
    assert refusal(content).code == "zip_entries"


def test_end_record_that_lies_about_the_number_of_entries(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zipfile, "ZipFile", None)
    content = bytearray(LONG_DIRECTORY)
    at = content.rindex(b"PK\x05\x06")
    struct.pack_into("<2H", content, at + 8, 1, 1)
    assert refusal(bytes(content)).code == "zip_entries"


def test_deflate_bomb_by_ratio() -> None:
    error = refusal(zipped({"a.txt": bytes(20_000_000)}))
    assert isinstance(error, TooLarge)
    assert error.code == "zip_bomb"


def test_small_file_of_blanks_is_no_bomb() -> None:
    assert len(expand([InputFile("t.zip", zipped({"a.txt": b" " * 50_000}))])[0].content) == 50_000


def test_bomb_by_total_size() -> None:
    content = zipped({f"{number}.txt": TEXT * 40 for number in range(10)}, zipfile.ZIP_STORED)
    assert refusal(content, Limits(unpacked_bytes=300_000)).code == "zip_bomb"


def test_overlapping_entries() -> None:
    """Many entries of the table of contents share one local header (the bomb of CVE-2024-0450)."""
    single = zipped({"a.txt": TEXT})
    start = single.index(b"PK\x01\x02")
    end = single.index(b"PK\x05\x06")
    entry = single[start:end]
    directory = b"".join(entry.replace(b"a.txt", f"{number:05d}".encode()) for number in range(50))
    record = bytearray(single[end:])
    struct.pack_into("<2H2L", record, 8, 50, 50, len(directory), start)
    assert refusal(single[:start] + directory + bytes(record)).code == "zip_bomb"


def test_forged_sizes_in_the_table_of_contents() -> None:
    content = bytearray(zipped({"a.txt": TEXT * 100}))
    at = content.index(b"PK\x01\x02")
    struct.pack_into("<L", content, at + 24, 10)  # declares 10 bytes
    assert refusal(bytes(content)).code in ("zip_bomb", "zip_broken")


def test_bytes_are_counted_while_they_come_out_whatever_was_declared() -> None:
    class Endless(zipfile.ZipFile):
        def open(self, *_: object, **__: object) -> IO[bytes]:
            return io.BytesIO(TEXT * 2)

    content = zipped({"a.txt": TEXT})
    with Endless(io.BytesIO(content)) as opened, pytest.raises(TooLarge) as caught:
        archive._extract(InputFile("trial.zip", content), opened, opened.infolist(), Limits())
    assert caught.value.code == "zip_bomb"


def test_zip64_end_record_is_refused() -> None:
    content = zipped({"a.txt": TEXT})
    at = content.index(b"PK\x05\x06")
    zip64 = b"PK\x06\x06" + struct.pack("<Q2H2L4Q", 44, 45, 45, 0, 0, 10**6, 10**6, 10**9, 0)
    locator = b"PK\x06\x07" + struct.pack("<LQL", 0, at, 1)
    assert refusal(content[:at] + zip64 + locator + content[at:]).code == "zip_entries"


@pytest.mark.parametrize("cut", [4, 30, 100, -30, -5])
def test_damaged_zip(cut: int) -> None:
    assert refusal(zipped({"a.txt": TEXT})[:cut]).code == "zip_broken"


def test_wrong_checksum() -> None:
    content = bytearray(zipped({"a.txt": TEXT}, zipfile.ZIP_STORED))
    content[content.index(TEXT[:20]) + 3] ^= 0xFF
    assert refusal(bytes(content)).code == "zip_broken"


def test_text_named_zip() -> None:
    assert refusal(b"this is no zip").code == "zip_broken"


def test_every_cut_and_flip_of_a_zip_raises_nothing_but_input_errors() -> None:
    content = zipped({"walk/1_lf.txt": TEXT, "1_rf.txt": TEXT})
    for at in range(len(content)):
        for changed in (content[:at], content[:at] + bytes([content[at] ^ 0x55]) + content[at + 1 :]):
            try:
                files = expand([InputFile("trial.zip", changed)])
            except InputError:
                continue
            assert all(len(file.content) <= len(content) * 100 for file in files)


def test_file_over_the_limit() -> None:
    with pytest.raises(TooLarge) as caught:
        expand([InputFile("a.txt", b"x" * 101)], Limits(file_bytes=100))
    assert (caught.value.code, caught.value.file) == ("file_too_large", "a.txt")
    assert (
        refusal(zipped({"a.txt": TEXT}, zipfile.ZIP_STORED), Limits(file_bytes=1000)).code == "file_too_large"
    )


def test_file_over_the_limit_is_not_even_read(tmp_path: Path) -> None:
    path = tmp_path / "huge.txt"
    with path.open("wb") as stream:
        stream.truncate(300 * 1024 * 1024)  # sparse
    with pytest.raises(TooLarge) as caught:
        load([path])
    assert caught.value.code == "file_too_large"


def test_folder_gives_its_text_files_and_no_hidden_ones(tmp_path: Path) -> None:
    for name in (
        "b_rf.txt",
        "a_lf.TXT",
        "placement.json",
        ".hidden.txt",
        "photo.jpg",
        "notes.pdf",
        "meta.json",
    ):
        (tmp_path / name).write_bytes(TEXT)
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "c.txt").write_bytes(TEXT)
    assert [file.name for file in load([tmp_path])] == ["a_lf.TXT", "b_rf.txt", "placement.json"]


def test_folder_over_the_limit(tmp_path: Path) -> None:
    for number in range(4):
        (tmp_path / f"{number}.txt").write_bytes(TEXT)
    with pytest.raises(TooLarge) as caught:
        load([tmp_path], Limits(folder_files=3))
    assert caught.value.code == "folder_too_large"


@pytest.mark.parametrize("name", ["missing.txt", "a\x00b.txt"])
def test_path_that_is_not_there(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError) as caught:
        load([str(tmp_path / name)])
    assert caught.value.code in ("no_such_file", "unreadable_file")
    assert caught.value.file == clean_name(str(tmp_path / name))  # as given, since base names repeat


def test_hash_is_of_the_content() -> None:
    file = InputFile("a.txt", b"abc")
    assert file.sha256 == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert InputFile("b.txt", b"abc").sha256 == file.sha256


def test_a_path_that_is_too_long_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        load([tmp_path / ("x" * 5000)])
    assert caught.value.code == "unreadable_file"


def test_a_pipe_is_refused_before_it_is_opened(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError) as caught:
        load([tmp_path / "pipe"])
    assert caught.value.code == "not_a_file"


@pytest.mark.parametrize("entries", [{}, {"walk/": b"", "__MACOSX/a": b"x"}], ids=["nothing", "clutter"])
def test_an_empty_zip_is_refused_by_name(entries: dict[str, bytes]) -> None:
    assert refusal(zipped(entries)).code == "zip_empty"
