"""How a system in a process of its own ends: signals, and what is left afterwards."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import threading
from typing import TYPE_CHECKING, Self
from uuid import uuid4

import pytest

from tests.support import fork_server
from tests.support.peers import isolated_environment
from tests.system.left import MARK, left

if TYPE_CHECKING:
    from pathlib import Path

MEMBER = """
import os, signal, sys, time
name, file = sys.argv[1:]
def end(*_):
    if name == "second":
        print("x" * 5000, flush=True)
        time.sleep(0.2)
    with open(file, "a") as out:
        out.write(name + " ")
    sys.exit(0)
signal.signal(signal.SIGINT, end)
if name == "second" and not os.fork():
    os.setsid()
    if not os.fork():
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        time.sleep(1000)
    os._exit(0)
print("up", flush=True)
while True:
    signal.pause()
"""
"""Writes its name when it is stopped. The second one prints before that, and has forked twice."""

SYSTEM = """
import sys
from aionode.system import System, run
async def main(system):
    for name in ("first", "second"):
        system.process(
            name, [sys.executable, "-S", "-c", MEMBER, name, FILE], term_after_sec=TERM
        )
    system.process("failing", ["sh", "-c", "exit 3"])
run(main)
"""


class Supervised:
    """A system in a process of its own, whose processes are marked.

    Args:
        text: The program.
        transport: How its nodes reach others.
    """

    def __init__(self, text: str, transport: str = "local") -> None:
        self.mark = uuid4().hex
        self.process = fork_server.start(
            ["-c", text],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=2,  # shown if the test fails
            env={**os.environ, MARK: self.mark, "AIONODE_TRANSPORT": transport},
        )
        self.lines: list[str] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        for pid in left(self.mark):  # of a test that has failed
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        self.process.wait()
        assert self.process.stdout is not None
        self.process.stdout.close()

    def wait_for(self, *texts: str) -> None:
        """Read its output until each of the texts has ended a line."""
        assert self.process.stdout is not None
        while not all(any(line.endswith(text) for line in self.lines) for text in texts):
            line = self.process.stdout.readline()
            assert line, self.lines
            self.lines.append(line.rstrip("\n"))

    def wait_until_nothing_is_left(self, limit_sec: float = 20.0) -> None:
        """Wait until none of its processes is left; fail after a while."""
        for _ in range(round(limit_sec / 0.05)):
            if not left(self.mark):
                return
            threading.Event().wait(0.05)
        pytest.fail(f"left: {left(self.mark)}")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_whatever_ends_the_supervisor_members_end_in_reverse_order_and_nothing_is_left(
    number: signal.Signals, tmp_path: Path
) -> None:
    """A commander can tell its driver to stop, even if nobody reads its output meanwhile."""
    file = tmp_path / "ends"
    text = SYSTEM.replace("MEMBER", repr(MEMBER)).replace("FILE", repr(str(file)))
    with Supervised(text.replace("TERM", "0.5")) as system:
        system.wait_for("first | up", "second | up", "failing ended with exit status 3")
        system.process.send_signal(number)
        status = system.process.wait()
        system.wait_until_nothing_is_left()

    assert file.read_text() == "second first "
    assert status == (-signal.SIGKILL if number == signal.SIGKILL else 3)


@pytest.mark.parametrize(
    "number",
    [
        pytest.param(signal.SIGKILL),
        pytest.param(signal.SIGINT, marks=pytest.mark.stress),
    ],
)
def test_wheels_get_the_stop_of_their_commander_before_they_are_ended(
    number: signal.Signals, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """These wheels do not stop by themselves."""
    record = tmp_path / "record"
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    monkeypatch.setenv("ROBOT_RECORD", str(record))
    text = (
        "from tests.system.robot import supervise\nfrom aionode.system import run\nrun(supervise)"
    )
    with Supervised(text, transport="zenoh") as system:
        system.wait_for("ready")
        system.wait_for("commander | driving")
        while not (record.exists() and "0.2" in record.read_text()):
            threading.Event().wait(0.01)
        system.process.send_signal(number)
        system.process.communicate()
        system.wait_until_nothing_is_left()

    assert record.read_text().split() == ["0.2", "0.0", "end"]


def test_a_second_ctrl_c_ends_all_at_once() -> None:
    """A user who presses it twice does not want to wait for programs that hang."""
    script = "trap '' INT TERM; echo up; while :; do sleep 1; done"
    text = (
        "from aionode.system import run\n"
        "async def main(system):\n"
        f"    system.process('deaf', ['sh', '-c', {script!r}])\n"
        "run(main)\n"
    )
    with Supervised(text) as system:
        system.wait_for("deaf | up")
        system.process.send_signal(signal.SIGINT)
        threading.Event().wait(1.2)  # a signal within a second counts as the same
        assert left(system.mark)
        system.process.send_signal(signal.SIGINT)

        assert system.process.wait(timeout=2) == 128 + signal.SIGINT
        system.wait_until_nothing_is_left(limit_sec=4.0)
