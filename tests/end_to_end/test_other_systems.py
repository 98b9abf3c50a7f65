"""Python without the calls that Windows and macOS lack: aionode still runs."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.end_to_end.process import ROOT, Process
from tests.support.peers import isolated_environment

OTHER_SYSTEM = str(Path(__file__).with_name("other_system.py"))
MEMBER = str(Path(__file__).with_name("plain_member.py"))

pytestmark = pytest.mark.timeout(180)  # importing every module takes 5 s of processor time

both_systems = pytest.mark.parametrize("system", ["windows", "macos"])
one_system = pytest.mark.parametrize(
    "system", ["windows", pytest.param("macos", marks=pytest.mark.stress)]
)


@pytest.fixture(autouse=True)
def isolated(monkeypatch: pytest.MonkeyPatch) -> None:
    """The processes of a test hear each other, and nothing else that runs on the machine."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    monkeypatch.delenv("AIONODE_LINK", raising=False)


def output_of(system: str, *arguments: str) -> str:
    """Return a program's output there."""
    done = subprocess.run(
        [sys.executable, OTHER_SYSTEM, system, *arguments],
        capture_output=True,
        text=True,
        timeout=150,
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.slow
@one_system
def test_every_module_is_imported(system: str) -> None:
    """Even those that are not used there, such as those of links."""
    assert output_of(system, MEMBER, "import") == "imported\n"


@pytest.mark.slow
@both_systems
def test_two_nodes_of_one_process_talk(system: str) -> None:
    """With topics, timers and services."""
    assert output_of(system, MEMBER, "both").splitlines() == ["heard hello"] * 3 + ["answer True"]


@pytest.mark.slow
@one_system
def test_two_processes_and_the_command_line_talk_over_zenoh(system: str) -> None:
    """There are no links there, without any setting, and Ctrl-C ends a program as everywhere."""
    with Process(OTHER_SYSTEM, system, MEMBER, "talk") as talker:
        assert "answer True" in output_of(system, MEMBER, "listen")
        assert "/chatter" in output_of(system, "aionode", "topic", "list")
        assert "hello" in output_of(system, "aionode", "topic", "echo", "--once", "/chatter")
        assert talker.stop(signal.SIGINT)[1] == 0
