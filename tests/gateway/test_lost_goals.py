"""Goals whose client is lost: which servers end them, and who learns of those that continue."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest

from aionode.action import CancelResponse
from aionode.gateway import Session
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.testing import settle
from tests.support.gateway_bench import Bench
from tests.support.rosbridge import rosbridge_client


class Arm:
    """An action server that moves until its goal is cancelled."""

    def __init__(self, bench: Bench, **options: Any) -> None:
        self.moves = 0
        self.server = bench.node.create_action_server(Fibonacci, "/arm", self._move, **options)

    async def _move(self, _: Any) -> Fibonacci.Result:
        self.moves += 1
        try:
            await asyncio.Event().wait()
        finally:
            self.moves -= 1
        raise AssertionError("not reached")


async def lose_client(bench: Bench, session: Session) -> None:
    """Make a client send a goal, and then end its session."""
    async with session, asyncio.TaskGroup() as tasks:

        async def pursue() -> None:
            async with session.goal("/arm", {"order": 1}) as goal:
                await goal.result()

        pursuing = tasks.create_task(pursue())
        await settle()
        pursuing.cancel()
    await settle()


def cancels(bench: Bench) -> list[dict[str, Any]]:
    """Return the lines of the audit log about cancelling."""
    return [line for line in map(json.loads, bench.lines) if line["action"] == "cancel"]


def fail(_: object) -> CancelResponse:
    """Decide nothing."""
    raise RuntimeError("the arm does not answer")


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"cancel_callback": lambda _: CancelResponse.ACCEPT},
        {"on_client_lost": "cancel"},
        {"on_client_lost": "cancel", "cancel_callback": lambda _: CancelResponse.REJECT},
        {"on_client_lost": "cancel", "cancel_callback": fail},
    ],
    ids=["by default", "a callback", "on_client_lost", "beside one that rejects", "or fails"],
)
async def test_a_server_of_aionode_ends_the_goal_of_a_lost_client(
    bench: Bench, options: dict[str, Any], caplog: pytest.LogCaptureFixture
) -> None:
    """Nobody is left who could stop the arm."""
    arm = Arm(bench, **options)
    await settle()
    await lose_client(bench, bench.session("operator"))

    assert arm.moves == 0
    assert arm.server.stats.received == 1
    assert cancels(bench) == []
    assert "goes on" not in caplog.text


@pytest.mark.parametrize(
    "options",
    [
        {"on_client_lost": "continue"},
        {"cancel_callback": lambda _: CancelResponse.REJECT},
        {"cancel_callback": fail},
    ],
    ids=["a server as in rclpy", "a callback that rejects", "a callback that fails"],
)
async def test_a_goal_that_continues_is_reported(
    bench: Bench, options: dict[str, Any], caplog: pytest.LogCaptureFixture
) -> None:
    """Something moves that nobody watches: the operator of the robot has to learn of it."""
    arm = Arm(bench, **options)
    await bench.advance(5.0)  # at time 0 a rate-limited warning would be held back
    await lose_client(bench, bench.session("operator"))

    assert arm.moves == 1
    (line,) = cancels(bench)
    assert (line["who"], line["name"]) == ("operator", "/arm")
    assert line["result"] == "cancel was rejected: the goal goes on"
    assert "/arm: operator has left, and cancel was rejected: the goal goes on" in caplog.text


async def test_a_connected_client_is_told_that_its_cancel_was_rejected(bench: Bench) -> None:
    """The client decides then; a server without a callback accepts no cancel request."""
    arm = Arm(bench)
    await settle()
    async with rosbridge_client(bench.robot) as client:
        client.send("set_level", level="error")
        client.send("send_action_goal", id="1", action="/arm", args={"order": 1})
        await settle()
        client.send("cancel_action_goal", id="1", action="/arm")
        await settle()
        status = await client.receive()
        assert "/arm: cancel was rejected: the goal goes on" in status["msg"]
        assert arm.moves == 1
    await settle()

    assert arm.moves == 0  # it has left
