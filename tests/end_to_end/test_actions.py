"""Actions between processes: the normal case, and what is left when one end is killed."""

from __future__ import annotations

import signal
import time  # noqa: TID251  # how long it takes to notice is what is tested
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from tests.end_to_end.action_member import CLIENT_LOST_SEC
from tests.end_to_end.process import SOON_S, Process

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

PROGRAM = "tests/end_to_end/action_member.py"
LONG = "100000"
"""Steps of a goal that does not end by itself."""


@contextmanager
def ends(steps: str) -> Iterator[tuple[Process, Process]]:
    """A server, and a client whose goal was accepted."""
    with Process(PROGRAM, "server") as server:
        server.expect("open")
        with Process(PROGRAM, "client", steps) as client:
            client.expect("accepted")
            yield server, client


def expect_empty_tables(server: Process) -> None:
    """Ask the server for the sizes of its tables until all are zero."""
    for number in range(100):
        server.write(f"tables{number}")
        server.expect(f"tables{number} ")
        if server.lines[-1][1] == f"tables{number} 0 0 0":
            return
        time.sleep(0.05)
    raise AssertionError([line for _, line in server.lines[-3:]])


def test_a_goal_goes_from_process_to_process() -> None:
    """Feedback in order, the result, and nothing is left on either side."""
    with ends("5") as (server, client):
        client.expect("tables 0")
        lines = client.rest()
        expect_empty_tables(server)

    assert lines[lines.index("accepted") :] == [
        "accepted",
        *(f"feedback {number}" for number in range(1, 6)),
        "result SUCCEEDED ",
        "tables 0",
        "stopped",
    ]


def test_the_exception_of_a_server_is_told_in_the_other_process() -> None:
    """In a reply of its own, because ROS's result has no field for it."""
    with ends("13") as (server, client):
        client.expect("result ABORTED ValueError: thirteen")
        expect_empty_tables(server)


def test_a_killed_server_is_an_error_at_once() -> None:
    """After SIGKILL nothing is sent, and yet no caller waits forever."""
    with ends(LONG) as (server, client):
        client.expect("feedback")
        killed_s = time.monotonic()
        server.send(signal.SIGKILL)
        noticed_s = client.started_s + client.expect("error GoalLostError") - killed_s
        client.expect("tables 0")

    assert noticed_s < SOON_S


def test_a_stopped_server_is_an_error_at_once() -> None:
    """At Ctrl-C its goal ends, and its client is notified."""
    with ends(LONG) as (server, client):
        client.expect("feedback")
        _, status = server.stop()
        client.expect("error GoalLostError")

    assert status == 0
    assert "ended otherwise" in server.rest()


def test_the_goal_of_a_killed_client_goes_on_and_leaves_nothing_behind() -> None:
    """The robot reaches its goal; the result expires, and the request ends with its client."""
    with ends("60") as (server, client):
        client.expect("feedback")
        client.send(signal.SIGKILL)
        server.expect("ended SUCCEEDED")
        expect_empty_tables(server)


def kill(client: Process) -> None:
    """End the process at once."""
    client.send(signal.SIGKILL)


def freeze(client: Process) -> None:
    """Stop the process; its sockets stay open."""
    client.send(signal.SIGSTOP)


def let_it_block(client: Process) -> None:
    """Wait until its loop is blocked; its other threads continue."""
    client.expect("blocks")


@pytest.mark.parametrize(
    ("part", "lose", "link"),
    [
        (["client", LONG], kill, "on"),
        (["client", LONG], freeze, "on"),
        pytest.param(["client", LONG], freeze, "off", marks=pytest.mark.stress),
        (["blocked"], let_it_block, "on"),
    ],
    ids=["killed", "frozen", "frozen-zenoh", "blocked"],
)
def test_the_goal_of_a_lost_client_is_canceled(
    monkeypatch: pytest.MonkeyPatch,
    part: list[str],
    lose: Callable[[Process], None],
    link: str,
) -> None:
    """Soon after `client_lost_sec`; while it is alive, the goal goes on."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with Process(PROGRAM, "server", "cancel") as server:
        server.expect("open")
        with Process(PROGRAM, *part) as client:
            if part[0] == "client":
                client.expect("feedback 5")
            lose(client)
            lost_s = time.monotonic()
            ended_s = server.started_s + server.expect("ended CANCELED") - lost_s
            kill(client)
        lines = [line for _, line in server.lines]
        expect_empty_tables(server)

    assert ended_s < CLIENT_LOST_SEC + SOON_S
    assert [line for line in lines if line.startswith("ended")] == ["ended CANCELED"]


def test_ctrl_c_at_the_client_cancels_its_goal() -> None:
    """The task that awaits the goal is cancelled, and the server hears of it before the end."""
    with ends(LONG) as (server, client):
        client.expect("feedback")
        _, status = client.stop()
        server.expect("ended CANCELED")
        expect_empty_tables(server)

    assert status == 0


@pytest.mark.parametrize("link", [pytest.param("on", marks=pytest.mark.stress), "off"])
def test_a_client_that_leaves_its_call_cancels_its_goal(
    monkeypatch: pytest.MonkeyPatch, link: str
) -> None:
    """The request leaves the process before it ends, over a link or over Zenoh."""
    monkeypatch.setenv("AIONODE_LINK", link)
    with Process(PROGRAM, "server") as server:
        server.expect("open")
        with Process(PROGRAM, "impatient", "0.5") as client:
            server.expect("executing")
            server.expect("ended CANCELED")
            client.expect("stopped")
