"""Whether another process is stopped."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from aionode._process import stopped
from aionode._process.stopped import is_stopped, pid_space

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs /proc")


@pytest.fixture
def process() -> Iterator[subprocess.Popen[bytes]]:
    """Return a process that waits."""
    with subprocess.Popen(["/bin/cat"], stdin=subprocess.PIPE) as process:
        yield process
        process.kill()


def test_a_process_is_stopped_from_the_signal_until_it_goes_on(
    process: subprocess.Popen[bytes],
) -> None:
    """Others give its connections up meanwhile."""
    assert not is_stopped(process.pid)
    process.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, process.pid, os.WSTOPPED)
    assert is_stopped(process.pid)
    process.send_signal(signal.SIGCONT)
    os.waitid(os.P_PID, process.pid, os.WCONTINUED)
    assert not is_stopped(process.pid)


def test_a_process_that_has_ended_is_not_stopped(process: subprocess.Popen[bytes]) -> None:
    """Its sockets tell that it has ended."""
    process.kill()
    process.wait()

    assert not is_stopped(process.pid)


def test_pids_of_another_namespace_or_boot_are_told_apart(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """A container's process 7 is another one than the host's."""
    here = pid_space()
    other = tmp_path / "boot_id"
    other.write_text("another boot")
    monkeypatch.setattr(stopped, "BOOT_ID", other)

    assert here is not None
    assert pid_space() != here


def test_where_the_system_tells_nothing_pids_mean_nothing(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """As in a sandbox without /proc: then leases are short."""
    monkeypatch.setattr(stopped, "PID_NAMESPACE", tmp_path / "hidden")

    assert pid_space() is None
