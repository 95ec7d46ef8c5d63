"""Whom the server answers before it is owned and protected, and that it really starts and stops."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from api.serving import check_exposure, serve
from api.settings import WebSettings
from gaitlab.clinic import accounts
from gaitlab.clinic.clinic import Clinic
from gaitlab.clinic.settings import ClinicSettings
from gaitlab.errors import Misconfigured

PROGRAM = (
    "import sys; from pathlib import Path; from api.serving import serve; "
    "from gaitlab.clinic.settings import ClinicSettings; serve(ClinicSettings(Path(sys.argv[1])), port=int(sys.argv[2]))"
)


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1", "[::1]", "127.3.2.1"])
def test_this_machine_alone_may_be_served_without_an_account(host: str) -> None:
    check_exposure(host, behind_proxy=False, has_account=False)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "gait.example.org", ""])
def test_other_machines_are_not_served_without_an_account_nor_without_tls(host: str) -> None:
    with pytest.raises(Misconfigured, match="no account"):
        check_exposure(host, behind_proxy=True, has_account=False)
    with pytest.raises(Misconfigured, match="TLS"):
        check_exposure(host, behind_proxy=False, has_account=True)
    check_exposure(host, behind_proxy=True, has_account=True)


def test_settings_come_from_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("GAITLAB_BEHIND_TLS", raising=False)
    monkeypatch.delenv("GAITLAB_ALLOWED_HOSTS", raising=False)
    assert WebSettings.from_environment() == WebSettings()
    monkeypatch.setenv("GAITLAB_BEHIND_TLS", "1")
    monkeypatch.setenv("GAITLAB_ALLOWED_HOSTS", "gait.example.org, other.example.org")
    settings = WebSettings.from_environment()
    assert settings.cookie_name == "__Host-gait"
    assert {"gait.example.org", "other.example.org", "127.0.0.1"} <= set(settings.allowed_hosts)


def test_the_first_start_prints_the_code_and_answers_and_stops(tmp_path: Path) -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [sys.executable, "-c", PROGRAM, str(tmp_path / "data"), str(port)]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment) as server:
        assert server.stderr is not None
        said = ""
        for line in server.stderr:
            said += line
            if "startup complete" in line or "startup failed" in line:
                break
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/setup", timeout=30) as answer:
                page = answer.read().decode()
        finally:
            server.send_signal(signal.SIGTERM)
            said += server.stderr.read()
    assert "Create the first account" in page
    assert re.search(rf"page   http://127\.0\.0\.1:{port}/setup\n  code   \S{{16,}}\n", said)
    assert '"route": "/setup"' in said
    assert "Traceback" not in said


def test_a_second_server_on_the_port_is_refused_and_leaves_the_code_valid(tmp_path: Path) -> None:
    settings = ClinicSettings(data_dir=tmp_path / "data")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        clinic = Clinic.open(settings)
        code = accounts.setup_code(clinic)
        assert code is not None
        with pytest.raises(Misconfigured, match="Cannot listen"):
            serve(settings, port=taken.getsockname()[1])
        accounts.create_first_account(
            clinic, code=code, email="ada@clinic.example", name="Ada", password="correct horse battery"
        )
        clinic.close()
