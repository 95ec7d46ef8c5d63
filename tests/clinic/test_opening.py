from __future__ import annotations

import stat
from pathlib import Path

import pytest

from gaitlab.clinic.audit import verify_chain
from gaitlab.clinic.clinic import Clinic, ClinicSettings
from gaitlab.errors import Misconfigured
from tests.databases import raw


def test_a_new_clinic_keeps_its_data_and_key_to_its_owner(tmp_path: Path) -> None:
    folder = tmp_path / "deep" / "data"
    clinic = Clinic.open(ClinicSettings(folder))
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert stat.S_IMODE((folder / "secret.key").stat().st_mode) == 0o600
    assert (folder / "gaitlab.sqlite3").is_file()
    clinic.close()


def test_a_clinic_opened_again_has_the_same_keys_and_records(tmp_path: Path) -> None:
    first = Clinic.open(ClinicSettings(tmp_path))
    key = first.form_key()
    first.close()
    second = Clinic.open(ClinicSettings(tmp_path))
    assert second.form_key() == key
    assert len(key) == 32
    assert verify_chain(second).ok
    assert verify_chain(second).n_events == 1
    second.close()


def test_keys_for_different_purposes_differ(clinic: Clinic) -> None:
    assert clinic.form_key() != clinic.secret("audit")


def test_a_damaged_key_is_refused_and_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "secret.key").write_bytes(b"short")
    with pytest.raises(Misconfigured, match="damaged"):
        Clinic.open(ClinicSettings(tmp_path))
    assert (tmp_path / "secret.key").read_bytes() == b"short"


def test_a_folder_that_cannot_be_made_is_misconfigured(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(Misconfigured, match="data folder"):
        Clinic.open(ClinicSettings(tmp_path / "file" / "data"))


def test_a_newer_database_is_refused_on_opening(tmp_path: Path) -> None:
    clinic = Clinic.open(ClinicSettings(tmp_path))
    raw(clinic.database.engine)("UPDATE alembic_version SET version_num = 'future'")
    clinic.close()
    with pytest.raises(Misconfigured, match="future"):
        Clinic.open(ClinicSettings(tmp_path))


def test_a_clinic_is_ready_until_its_database_falls_behind(clinic: Clinic) -> None:
    assert clinic.ready()
    raw(clinic.database.engine)("DELETE FROM alembic_version")
    assert not clinic.ready()


def test_settings_come_from_the_environment(tmp_path: Path) -> None:
    settings = ClinicSettings.from_environment(
        {
            "GAITLAB_DATA_DIR": str(tmp_path),
            "GAITLAB_DATABASE_URL": "postgresql://h/d",
            "GAITLAB_IDLE_MINUTES": "30",
        }
    )
    assert settings == ClinicSettings(tmp_path, "postgresql://h/d", idle_minutes=30)
    assert ClinicSettings.from_environment({}) == ClinicSettings(Path("gaitlab-data"))


@pytest.mark.parametrize("minutes", ["", "0", "61", "-15", "15.0", "١٥", "many"])
def test_an_impossible_idle_time_is_refused(minutes: str) -> None:
    with pytest.raises(Misconfigured):
        ClinicSettings.from_environment({"GAITLAB_IDLE_MINUTES": minutes})
