from __future__ import annotations

import datetime as dt
import os
import stat
from pathlib import Path

import pytest

from gaitlab.errors import GaitlabError, Misconfigured
from gaitlab.store import files as storage
from gaitlab.store.files import Files, sha256_of


@pytest.fixture(params=["folder", "memory"])
def files(request: pytest.FixtureRequest, tmp_path: Path) -> Files:
    """The file store in a folder, and on another file system that fsspec reaches."""
    return Files(
        str(tmp_path / "files") if request.param == "folder" else f"memory://{tmp_path.name}-{os.getpid()}"
    )


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "files"


@pytest.fixture
def local(folder: Path) -> Files:
    return Files(str(folder))


def test_a_content_comes_back_byte_for_byte(files: Files) -> None:
    content = bytes(range(256)) * 1000
    assert files.get(files.put(content)) == content


def test_an_empty_content_is_a_content(files: Files) -> None:
    assert files.get(files.put(b"")) == b""


def test_the_same_content_is_kept_once(local: Files, folder: Path) -> None:
    assert local.put(b"walk") == local.put(b"walk") == sha256_of(b"walk")
    assert len(_contents(folder)) == 1


def test_a_stored_file_may_be_read_by_its_owner_alone_and_written_by_nobody(
    local: Files, folder: Path
) -> None:
    local.put(b"walk")
    (path,) = _contents(folder)
    assert stat.S_IMODE(path.stat().st_mode) == 0o400
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


def test_nothing_temporary_is_left(local: Files, folder: Path) -> None:
    local.put(b"walk")
    assert list((folder / "tmp").iterdir()) == []


def test_one_changed_byte_is_noticed_on_reading(local: Files, folder: Path) -> None:
    sha256 = local.put(b"walk")
    (path,) = _contents(folder)
    path.chmod(0o600)
    path.write_bytes(b"wall")
    with pytest.raises(GaitlabError, match="not as it was stored") as refusal:
        local.get(sha256)
    assert refusal.value.code == "file_damaged"


def test_storing_again_mends_a_damaged_content(local: Files, folder: Path) -> None:
    sha256 = local.put(b"walk")
    (path,) = _contents(folder)
    path.chmod(0o600)
    path.write_bytes(b"wall")
    local.put(b"walk")
    assert local.get(sha256) == b"walk"


def test_a_missing_content_is_said_to_be_missing(files: Files) -> None:
    with pytest.raises(GaitlabError, match="missing") as refusal:
        files.get("0" * 64)
    assert refusal.value.code == "file_missing"


@pytest.mark.parametrize(
    "name", ["../secret.key", "0" * 63, "0" * 65, "G" * 64, "/etc/passwd", "0" * 64 + "\n", ""]
)
def test_only_a_hash_becomes_a_path(files: Files, name: str) -> None:
    for use in (files.get, files.has, files.delete):
        with pytest.raises(ValueError, match="SHA-256"):
            use(name)


def test_contents_are_listed_by_age(files: Files) -> None:
    sha256 = files.put(b"walk")
    now = dt.datetime.now(dt.UTC)
    assert list(files.older_than(now - dt.timedelta(hours=1))) == []
    assert list(files.older_than(now + dt.timedelta(hours=1))) == [sha256]


def test_storing_again_makes_a_content_young(local: Files, folder: Path) -> None:
    local.put(b"walk")
    (path,) = _contents(folder)
    os.utime(path, (0, 0))
    local.put(b"walk")
    assert list(local.older_than(dt.datetime.now(dt.UTC) - dt.timedelta(hours=1))) == []


def test_deleting_twice_is_no_error(files: Files) -> None:
    sha256 = files.put(b"walk")
    files.delete(sha256)
    files.delete(sha256)
    assert not files.has(sha256)


def test_a_full_disk_is_said_and_leaves_nothing(
    local: Files, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(storage.os, "fsync", full)
    with pytest.raises(GaitlabError, match="No space left") as refusal:
        local.put(b"walk")
    assert refusal.value.code == "storage_failed"
    assert _contents(folder) == []
    assert list((folder / "tmp").iterdir()) == []


def test_content_then_name_then_folder_reach_the_disk_in_this_order(
    local: Files, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    steps: list[str] = []
    fsync, replace = os.fsync, Path.replace

    def noted_fsync(descriptor: int) -> None:
        steps.append("folder" if stat.S_ISDIR(os.fstat(descriptor).st_mode) else "content")
        fsync(descriptor)

    def noted_replace(self: Path, target: Path) -> Path:
        steps.append("name")
        return replace(self, target)

    (folder / sha256_of(b"walk")[:2]).mkdir()
    monkeypatch.setattr(storage.os, "fsync", noted_fsync)
    monkeypatch.setattr(Path, "replace", noted_replace)
    local.put(b"walk")
    assert steps == ["content", "name", "folder"]


def test_an_address_nobody_can_reach_is_misconfigured() -> None:
    with pytest.raises(Misconfigured):
        Files("no-such-scheme://bucket")


def _contents(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.is_file() and path.parent.name != "tmp"]
