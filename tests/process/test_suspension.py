"""Tests of Ctrl-Z in a program with open leases."""

from __future__ import annotations

import os
import signal
import sys
import threading
from pathlib import Path

import pytest

from aionode._process.suspension import SuspensionHandler
from tests.support.program import Program

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are looked at in /proc")

HOLDER = """
import signal
from aionode._process import sudden_end as _sudden_end
from aionode._process.suspension import suspension

_sudden_end.STOPS.append(lambda: print("stop", flush=True) or True)

async def main():
    suspension.install()
    print("ready", flush=True)
    while True:
        {step}

aionode.run(main, args=[])
print(signal.getsignal(signal.SIGTSTP), flush=True)
"""


def wait_until_handled(pid: int) -> None:
    """Wait until a process handles SIGTSTP."""
    bit = 1 << (signal.SIGTSTP - 1)
    status = Path(f"/proc/{pid}/status")
    while not any(
        int(line.split()[1], 16) & bit
        for line in status.read_text().splitlines()
        if line.startswith("SigCgt:")
    ):
        threading.Event().wait(0.01)


def wait_until_stopped(pid: int) -> None:
    """Wait until a process is suspended."""
    assert os.waitid(os.P_PID, pid, os.WSTOPPED) is not None


@pytest.mark.processes
@pytest.mark.parametrize("step", ["await asyncio.sleep(1)", "time.sleep(1)", "pass"])
def test_the_stop_is_sent_before_a_program_with_a_lease_is_suspended(step: str) -> None:
    """Nobody commands the robot meanwhile. The next Ctrl-Z does the same."""
    # A process group of its own: the system suspends no process whose parent nobody can ask.
    with Program(HOLDER.replace("{step}", step), process_group=0) as program:
        program.wait_until_ready()
        assert program.process.stdout is not None
        for _ in range(2):
            wait_until_handled(program.process.pid)
            program.send(signal.SIGTSTP)
            assert program.process.stdout.readline() == "stop\n"
            wait_until_stopped(program.process.pid)
            program.send(signal.SIGCONT)


def test_a_program_is_suspended_at_once_after_its_last_lease() -> None:
    """Without a lease, a program behaves as without aionode."""
    body = """
    import signal
    from aionode._process.suspension import suspension

    suspension.install()
    suspension.install()
    suspension.remove()
    print(signal.getsignal(signal.SIGTSTP) is signal.SIG_DFL)
    """
    with Program(body) as program:
        assert program.end() == (0, "True\n", "")


@pytest.mark.parametrize("own", [signal.SIG_IGN, lambda *_: None])
def test_a_handler_of_the_program_stays(own: signal.Handlers) -> None:
    """A shell without job control ignores SIGTSTP, and some programs restore their terminal."""
    handler = SuspensionHandler()
    before = signal.signal(signal.SIGTSTP, own)
    try:
        handler.install()
        assert signal.getsignal(signal.SIGTSTP) is own
        handler.remove()
        assert signal.getsignal(signal.SIGTSTP) is own
    finally:
        signal.signal(signal.SIGTSTP, before)


def test_a_lease_in_another_thread_handles_no_signals() -> None:
    """Python allows signal handlers in the main thread only."""
    handler = SuspensionHandler()
    thread = threading.Thread(target=handler.install)
    thread.start()
    thread.join()
    assert signal.getsignal(signal.SIGTSTP) is signal.SIG_DFL
