"""Tests of how another process is seen to be stopped."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from aionode._process import stopped
from aionode._process.stopped import WatchedProcess, is_stopped, pid_space

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs /proc")


@pytest.fixture
def asked_again() -> Iterator[None]:
    """Ask the system again in this test, and after it."""
    pid_space.cache_clear()
    yield
    pid_space.cache_clear()


@pytest.fixture
def process() -> Iterator[subprocess.Popen[bytes]]:
    """Return a process that waits."""
    with subprocess.Popen(["/bin/cat"], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        yield process
        process.kill()


def test_a_process_is_stopped_from_the_signal_until_it_goes_on(
    process: subprocess.Popen[bytes],
) -> None:
    """Others cut their connections to it meanwhile."""
    assert not is_stopped(process.pid)
    process.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, process.pid, os.WSTOPPED)
    assert is_stopped(process.pid)
    process.send_signal(signal.SIGCONT)
    os.waitid(os.P_PID, process.pid, os.WCONTINUED)
    assert not is_stopped(process.pid)


def test_a_process_that_has_ended_is_not_stopped(process: subprocess.Popen[bytes]) -> None:
    """Its closed sockets show that it has ended."""
    process.kill()
    process.wait()

    assert not is_stopped(process.pid)


def stop(process: subprocess.Popen[bytes]) -> None:
    """Stop a process, and wait until it is stopped."""
    process.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, process.pid, os.WSTOPPED)


def run_on(process: subprocess.Popen[bytes]) -> None:
    """Let a process run for a moment."""
    assert process.stdin is not None
    assert process.stdout is not None
    process.send_signal(signal.SIGCONT)
    process.stdin.write(b"x")
    process.stdin.flush()
    process.stdout.read(1)


def test_a_process_is_stopped_if_it_has_not_run_since_the_last_look(
    process: subprocess.Popen[bytes],
) -> None:
    """The first look after the signal cannot tell when the process last ran."""
    with closing(WatchedProcess(process.pid)) as watched:
        assert not watched.is_stopped()
        stop(process)
        watched.is_stopped()
        assert watched.is_stopped()
        assert watched.is_stopped()
        process.send_signal(signal.SIGCONT)
        os.waitid(os.P_PID, process.pid, os.WCONTINUED)
        assert not watched.is_stopped()


def test_a_process_that_is_stopped_at_each_look_but_runs_between_is_not_stopped(
    process: subprocess.Popen[bytes],
) -> None:
    """Under strace, each system call stops it, but it still answers."""
    with closing(WatchedProcess(process.pid)) as watched:
        for _ in range(4):
            run_on(process)
            stop(process)
            assert is_stopped(process.pid)
            assert not watched.is_stopped()


def test_where_processor_time_is_not_counted_the_state_alone_tells(
    process: subprocess.Popen[bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Some kernels are built without it."""
    real = os.open
    monkeypatch.setattr(
        "os.open", lambda path, flags: real(f"{path}".replace("sched", "no"), flags)
    )
    with closing(WatchedProcess(process.pid)) as watched:
        assert not watched.is_stopped()
        stop(process)
        assert watched.is_stopped()


def test_a_watched_process_that_has_ended_is_not_stopped(
    process: subprocess.Popen[bytes],
) -> None:
    """Another process may have its pid by then."""
    with closing(WatchedProcess(process.pid)) as watched:
        process.kill()
        process.wait()
        assert not watched.is_stopped()


@pytest.mark.usefixtures("asked_again")
def test_pids_of_another_namespace_or_boot_are_told_apart(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Process 7 of a container is not process 7 of the host."""
    here = pid_space()
    pid_space.cache_clear()
    other = tmp_path / "boot_id"
    other.write_text("another boot")
    monkeypatch.setattr(stopped, "BOOT_ID", other)

    assert here is not None
    assert pid_space() != here


@pytest.mark.usefixtures("asked_again")
def test_where_the_system_tells_nothing_pids_mean_nothing(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """In a sandbox without /proc, leases are short instead."""
    monkeypatch.setattr(stopped, "PID_NAMESPACE", tmp_path / "hidden")

    assert pid_space() is None


def test_a_process_asks_the_system_once_for_its_pid_space(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every peer that came or went cost each process of the domain three more system calls."""
    here = pid_space()
    monkeypatch.setattr(stopped, "OWN_PROCESS", Path("/nowhere"))

    assert pid_space() == here


@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded")
def test_a_forked_process_asks_for_its_own_pid_space(monkeypatch: pytest.MonkeyPatch) -> None:
    """The child may be the first process of a container."""
    pid_space()
    monkeypatch.setattr(stopped, "OWN_PROCESS", Path("/nowhere"))
    child = os.fork()
    if not child:
        os._exit(pid_space() is not None)

    assert os.waitpid(child, 0)[1] == 0


@pytest.mark.usefixtures("asked_again")
def test_where_proc_has_the_pids_of_others_pids_mean_nothing(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """After `unshare --pid` without `--mount-proc`, process 7 there is not process 7 here."""
    foreign = tmp_path / "self"
    foreign.symlink_to("4711")
    monkeypatch.setattr(stopped, "OWN_PROCESS", foreign)

    assert pid_space() is None
