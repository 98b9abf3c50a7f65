"""Leases whose holder's process is blocked, frozen, forked or ended."""

from __future__ import annotations

import os
import signal
import sys

import pytest

from tests.end_to_end.process import Process

pytestmark = pytest.mark.one_loop

PROGRAM = "tests/end_to_end/lease_member.py"
TTL_SEC = 0.3
LATE_SEC = 1.2
"""The additional time on a busy machine; the loop is blocked for longer than both."""

LONG = "60"


def speeds(wheels: Process, wait_s: float = 0.0) -> list[str]:
    """Return the speeds that the wheels have printed so far."""
    return [line for _, line in wheels.rest_after(wait_s) if line.startswith("speed")]


def assert_stopped(wheels: Process) -> None:
    """Check that the stop arrived once, as the last message."""
    told = speeds(wheels, 0.5)
    first = told.index("speed 0.0")
    assert set(told[:first]) == {"speed 1.0"}
    assert told[first:] == ["speed 0.0"]


@pytest.mark.parametrize(
    ("link", "what"),
    [
        pytest.param("on", "spin", marks=pytest.mark.slow),
        ("off", "sleep"),
        pytest.param("on", "sleep", marks=pytest.mark.stress),
    ],
)
def test_the_stop_of_a_blocked_loop_arrives(
    monkeypatch: pytest.MonkeyPatch, link: str, what: str
) -> None:
    """The loop sends nothing when it goes on, and its commands are refused."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with (
        Process(PROGRAM, "wheels") as wheels,
        Process(PROGRAM, "commander", str(TTL_SEC), what) as commander,
    ):
        commander.expect("driving")
        commander.write("go")
        commander.expect("blocked")
        wheels.expect("speed 0.0")
        commander.expect("LeaseExpiredError")

        assert_stopped(wheels)
        blocked_s = next(at_s for at_s, line in commander.lines if line == "blocked")
        stopped_s = next(at_s for at_s, line in wheels.lines if line == "speed 0.0")
        assert stopped_s - blocked_s < TTL_SEC + LATE_SEC


@pytest.mark.parametrize("link", ["on", pytest.param("off", marks=pytest.mark.stress)])
def test_the_last_command_is_the_stop_of_a_blocked_loop(
    monkeypatch: pytest.MonkeyPatch, link: str
) -> None:
    """Each command brings its own stop, which arrives once more while the loop is blocked."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with (
        Process(PROGRAM, "wheels") as wheels,
        Process(PROGRAM, "commander", str(TTL_SEC), "hang", "hold") as commander,
    ):
        commander.expect("driving")
        commander.write("go")
        commander.expect("blocked")
        told = speeds(wheels, TTL_SEC + LATE_SEC)
        assert told[-1] == told[-2] != told[-3]


@pytest.mark.parametrize("link", [pytest.param("on", marks=pytest.mark.stress), "off"])
def test_a_frozen_holder_sends_nothing_but_the_stop_when_it_wakes(
    monkeypatch: pytest.MonkeyPatch, link: str
) -> None:
    """Its time to live is over."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with (
        Process(PROGRAM, "wheels") as wheels,
        Process(PROGRAM, "commander", str(TTL_SEC)) as commander,
    ):
        commander.expect("driving")
        commander.send(signal.SIGSTOP)
        before = len(speeds(wheels, 1.0))
        commander.send(signal.SIGCONT)
        wheels.expect("speed 0.0")

        *late, last = speeds(wheels, 0.5)[before:]
        assert last == "speed 0.0"
        assert len(late) <= 1  # what was on its way out when the process was frozen


def test_a_forked_child_sends_nothing() -> None:
    """The lease belongs to its parent, which continues."""
    with (
        Process(PROGRAM, "wheels") as wheels,
        Process(PROGRAM, "commander", LONG, "fork") as commander,
    ):
        commander.expect("driving")
        commander.write("go")
        commander.expect("child ForkedProcessError", "child left", "sent")
        wheels.expect("speed 1.0")

        assert set(speeds(wheels)) == {"speed 1.0"}
        commander.send(signal.SIGINT)
        wheels.expect("speed 0.0")


def test_the_stop_is_sent_when_the_loop_has_ended() -> None:
    """Nothing ends the block, and its time to live has not run out."""
    with (
        Process(PROGRAM, "wheels") as wheels,
        Process(PROGRAM, "commander", LONG, "orphan") as commander,
    ):
        commander.expect("driving")
        commander.write("go")
        commander.expect("orphaned False")

        wheels.expect("speed 0.0")
        assert_stopped(wheels)


@pytest.mark.parametrize("link", ["on", pytest.param("off", marks=pytest.mark.stress)])
def test_a_second_signal_sends_the_stop_of_a_blocked_loop(
    monkeypatch: pytest.MonkeyPatch, link: str
) -> None:
    """The process ends at once, and yet the robot stops."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with (
        Process(PROGRAM, "wheels") as wheels,
        Process(PROGRAM, "commander", LONG, "hang") as commander,
    ):
        commander.expect("driving")
        commander.write("go")
        commander.expect("blocked")
        commander.send(signal.SIGINT)
        wheels.rest_after(1.2)
        commander.send(signal.SIGINT)

        wheels.expect("speed 0.0")
        assert_stopped(wheels)


@pytest.mark.skipif(sys.platform != "linux", reason="waits for a suspended child")
def test_ctrl_z_stops_the_robot_first() -> None:
    """After ``fg`` the lease has expired."""
    with (
        Process(PROGRAM, "wheels") as wheels,
        Process(PROGRAM, "commander", LONG) as commander,
    ):
        commander.expect("driving")
        commander.send(signal.SIGTSTP)
        assert os.waitid(os.P_PID, commander.pid, os.WSTOPPED) is not None
        wheels.expect("speed 0.0")
        assert_stopped(wheels)
        commander.send(signal.SIGCONT)

        commander.expect("LeaseExpiredError")
        assert_stopped(wheels)
