"""The end of a robot's program: the last command of each callback arrives in another process."""

from __future__ import annotations

import os
import signal
import threading

import pytest

from tests.end_to_end.process import SOON_S, Process

PROGRAM = "tests/end_to_end/stopping_member.py"
TOPICS = ("/timer", "/thread", "/goal")


@pytest.mark.parametrize(
    ("link", "end"),
    [
        ("on", "SIGINT"),
        ("off", "SIGTERM"),
        ("on", "leave"),
        pytest.param("off", "SIGINT", marks=pytest.mark.stress),
        pytest.param("on", "SIGTERM", marks=pytest.mark.stress),
        pytest.param("off", "leave", marks=pytest.mark.stress),
    ],
)
def test_what_callbacks_publish_in_finally_arrives(
    monkeypatch: pytest.MonkeyPatch, link: str, end: str
) -> None:
    """A robot whose program ends must not keep its last speed."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with Process(PROGRAM, "reader") as reader, Process(PROGRAM, "robot", end) as robot:
        robot.expect("driving")
        reader.expect(*(f"{topic} 1.0" for topic in TOPICS))

        if end == "leave":
            robot.write("leave")
        else:
            robot.send(signal.Signals[end])

        reader.expect(*(f"{topic} 0.0" for topic in TOPICS))
        robot.expect("stopped")
        assert not [line for _, line in robot.lines if "Error" in line or "Traceback" in line]


@pytest.mark.parametrize("link", [pytest.param("on", marks=pytest.mark.stress), "off"])
def test_a_destroyed_node_lets_its_callbacks_stop_the_robot(
    monkeypatch: pytest.MonkeyPatch, link: str
) -> None:
    """Even while the program goes on."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with Process(PROGRAM, "reader") as reader, Process(PROGRAM, "robot", "destroy") as robot:
        robot.expect("driving")
        reader.expect(*(f"{topic} 1.0" for topic in TOPICS))

        robot.write("destroy")

        reader.expect(*(f"{topic} 0.0" for topic in TOPICS))


def test_ctrl_c_stops_a_robot_that_is_run_by_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    """``aionode.run(Robot)`` ends in the same way."""
    with Process(PROGRAM, "reader") as reader, Process(PROGRAM, "robot", "run") as robot:
        reader.expect("/timer 1.0", "/thread 1.0")

        _, status = robot.stop()

        reader.expect("/timer 0.0", "/thread 0.0")
        assert status == 0


@pytest.mark.parametrize(
    ("link", "end", "begin"),
    [
        ("on", "sleep", "line"),
        pytest.param("off", "loop", "line", marks=pytest.mark.slow),
        ("on", "await", "signal"),
        pytest.param("on", "loop", "line", marks=pytest.mark.stress),
        pytest.param("off", "sleep", "signal", marks=pytest.mark.stress),
        pytest.param("off", "await", "signal", marks=pytest.mark.stress),
    ],
)
def test_what_was_published_is_sent_when_a_second_signal_ends_the_program(
    monkeypatch: pytest.MonkeyPatch, link: str, end: str, begin: str
) -> None:
    """Even if its loop is blocked, and had no time to send its buffers."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with Process(PROGRAM, "reader") as reader, Process(PROGRAM, "commander", end) as robot:
        reader.expect("/timer 1.0")
        if begin == "line":
            robot.write("stop")
            robot.expect("blocked")
        robot.send(signal.SIGINT)
        robot.expect("blocked")
        threading.Event().wait(1.1)

        took_s, status = robot.stop(signal.SIGINT)

        reader.expect("/timer 0.0")
        assert status == 130
        assert took_s < SOON_S


@pytest.mark.parametrize("pause_sec", [0.002, pytest.param(0.02, marks=pytest.mark.stress)])
@pytest.mark.parametrize("link", ["on", pytest.param("off", marks=pytest.mark.stress)])
def test_two_signals_a_few_milliseconds_apart_stop_a_robot(
    monkeypatch: pytest.MonkeyPatch, link: str, pause_sec: float
) -> None:
    """Parents forward a signal that the process group has already received."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with Process(PROGRAM, "reader") as reader, Process(PROGRAM, "robot", "run") as robot:
        reader.expect("/timer 1.0", "/thread 1.0")

        robot.send(signal.SIGINT)
        threading.Event().wait(pause_sec)
        robot.send(signal.SIGTERM)

        reader.expect("/timer 0.0", "/thread 0.0")
        assert robot.wait() == 0


HOLDERS = [
    ("on", "sleep"),
    pytest.param("off", "loop", marks=pytest.mark.slow),
    ("on", "shield"),
    pytest.param("off", "sleep", marks=pytest.mark.stress),
    pytest.param("on", "loop", marks=pytest.mark.stress),
    pytest.param("off", "shield", marks=pytest.mark.stress),
]


@pytest.mark.parametrize(("link", "end"), HOLDERS)
def test_a_second_signal_sends_the_stop_of_a_lease(
    monkeypatch: pytest.MonkeyPatch, link: str, end: str
) -> None:
    """Long before its time to live runs out, even if the loop is blocked."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with Process(PROGRAM, "reader") as reader, Process(PROGRAM, "holder", end, "run") as robot:
        robot.expect("driving")
        reader.expect("/timer 2.0" if end != "shield" else "/timer 1.0")
        robot.send(signal.SIGINT)
        threading.Event().wait(1.1)

        took_s, status = robot.stop(signal.SIGINT)

        reader.expect("/timer 0.0")
        assert status == 130
        assert took_s < SOON_S
        assert reader.rest_so_far()[-1] == "/timer 0.0"


@pytest.mark.parametrize(("link", "end"), HOLDERS)
def test_ctrl_z_sends_the_stop_of_a_lease_before_it_suspends_the_program(
    monkeypatch: pytest.MonkeyPatch, link: str, end: str
) -> None:
    """Nobody commands the robot from then on, and nothing follows the stop."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with Process(PROGRAM, "reader") as reader, Process(PROGRAM, "holder", end, "run") as robot:
        robot.expect("driving")
        reader.expect("/timer 2.0" if end != "shield" else "/timer 1.0")

        robot.send(signal.SIGTSTP)

        reader.expect("/timer 0.0")
        os.waitid(os.P_PID, robot.pid, os.WSTOPPED)
        robot.send(signal.SIGCONT)
        robot.send(signal.SIGTERM)
        assert reader.rest_so_far()[-1] == "/timer 0.0"


@pytest.mark.parametrize("link", ["on", pytest.param("off", marks=pytest.mark.stress)])
def test_a_lease_that_is_open_when_the_interpreter_exits_sends_its_stop(
    monkeypatch: pytest.MonkeyPatch, link: str
) -> None:
    """Its event loop was stopped, and runs nothing any more."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with Process(PROGRAM, "reader") as reader, Process(PROGRAM, "holder", "exit") as robot:
        robot.expect("driving")
        robot.write("exit")

        reader.expect("/timer 0.0")
        assert robot.wait() == 0


def test_a_lease_in_a_program_of_asyncio_ends_with_each_kind_of_ctrl_c(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The second raises KeyboardInterrupt in a loop that is blocked, the third in `asyncio.run`."""
    monkeypatch.setenv("AIONODE_LINK", "on")
    for end, count in (("sleep", 2), ("shield", 3)):
        with (
            Process(PROGRAM, "reader") as reader,
            Process(PROGRAM, "holder", end, "asyncio") as robot,
        ):
            robot.expect("driving")
            reader.expect("/timer 1.0")
            for _ in range(count):
                robot.send(signal.SIGINT)
                threading.Event().wait(0.3)

            reader.expect("/timer 0.0")
            assert robot.wait() == -signal.SIGINT
