"""Outputs go where they were asked to go, whole or not at all, and never over what was read."""

from __future__ import annotations

import os
import stat
import threading
from pathlib import Path

import pytest

from gaitlab.cli.files import write_files
from gaitlab.errors import InputError


def refusal(contents: dict[Path, bytes], inputs: tuple[Path, ...] = ()) -> str:
    with pytest.raises(InputError) as caught:
        write_files(contents, inputs)
    return caught.value.code


def test_a_link_is_followed_and_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    target = tmp_path / "real" / "result.json"
    target.write_text("old")
    target.chmod(0o600)
    link = tmp_path / "link.json"
    link.symlink_to(target)
    write_files({link: b"new"})
    assert link.is_symlink()
    assert target.read_bytes() == b"new"
    assert stat.S_IMODE(target.stat().st_mode) == 0o600


def test_a_fifo_is_written_to_and_stays_a_fifo(tmp_path: Path) -> None:
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    got: list[bytes] = []
    reader = threading.Thread(target=lambda: got.append(fifo.read_bytes()), daemon=True)
    reader.start()
    write_files({fifo: b"x" * 200_000})
    reader.join(30)
    assert got == [b"x" * 200_000]
    assert stat.S_ISFIFO(fifo.stat().st_mode)


def test_a_device_is_written_to_and_stays_a_device(tmp_path: Path) -> None:
    primary, secondary = os.openpty()
    link = tmp_path / "terminal"
    link.symlink_to(os.ttyname(secondary))
    try:
        write_files({link: b"told"})
        assert os.read(primary, 4) == b"told"
        assert stat.S_ISCHR(link.stat().st_mode)
        assert link.is_symlink()
    finally:
        os.close(primary)
        os.close(secondary)


def test_a_folder_is_refused(tmp_path: Path) -> None:
    assert refusal({tmp_path: b""}) == "not_a_file"


def test_what_was_read_is_not_overwritten(tmp_path: Path) -> None:
    zipped = tmp_path / "walk.zip"
    zipped.write_bytes(b"PK")
    link = tmp_path / "result.json"
    link.symlink_to(zipped)
    (tmp_path / "placement.json").write_text("{}")
    recording = tmp_path / "walk_lf.txt"
    recording.write_text("PacketCounter\tAcc_X\tAcc_Y\tAcc_Z\n1\t0\t0\t9.8\n")
    assert refusal({link: b"new"}, (zipped,)) == "output_is_input"
    assert refusal({tmp_path / "placement.json": b"new"}, (tmp_path,)) == "output_is_input"
    assert refusal({recording: b"new"}) == "output_is_input"
    assert zipped.read_bytes() == b"PK"


def test_one_file_under_two_names_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "b").symlink_to(tmp_path / "a")
    assert refusal({tmp_path / "a" / "r": b"1", tmp_path / "b" / "r": b"2"}) == "output_twice"
    assert list((tmp_path / "a").iterdir()) == []


def test_a_later_failure_leaves_nothing_of_the_earlier_ones(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("kept")
    (tmp_path / "old.json").write_text("old")
    contents = {tmp_path / "old.json": b"1", tmp_path / "new" / "a": b"2", tmp_path / "file" / "b": b"3"}
    assert refusal(contents) == "cannot_write"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "old.json"]
    assert (tmp_path / "old.json").read_text() == "old"


def test_a_path_that_is_too_long_is_a_message(tmp_path: Path) -> None:
    assert refusal({tmp_path / ("x" * 5000): b""}) == "cannot_write"
