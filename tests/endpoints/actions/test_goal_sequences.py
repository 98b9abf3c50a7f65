"""Requests to an action server in any order: its node continues."""

from __future__ import annotations

import asyncio
from typing import Any

import hypothesis
import pytest
from hypothesis import strategies as st

from aionode._process.concurrency import checkpoint
from aionode.action import CancelResponse
from aionode.interfaces.action_msgs.msg import GoalInfo
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.node import Node
from aionode.testing import local_context, settle
from tests.support.actions import Goal, uuid_of

Impl = Fibonacci.Impl

STAMPS = st.builds(
    Time, sec=st.integers(-(2**31), 2**31 - 1), nanosec=st.integers(0, 2**32 - 1)
) | st.just(Time())
STEPS = st.one_of(
    st.tuples(st.just("goal"), st.integers(0, 3), st.integers(0, 3)),
    st.tuples(st.just("cancel"), st.integers(0, 3), STAMPS),
    st.tuples(st.just("result"), st.integers(0, 3), st.none()),
    st.tuples(st.just("turns"), st.integers(1, 4), st.none()),
)


async def send(robot: Node, client: Node, steps: list[tuple[str, int, Any]]) -> None:
    """Send the steps, some iterations of the loop apart, and check that the node still runs."""
    hidden = "go/_action"
    goals = client.create_client(Impl.SendGoalService, f"{hidden}/send_goal")
    cancels = client.create_client(Impl.CancelGoalService, f"{hidden}/cancel_goal")
    results = client.create_client(Impl.GetResultService, f"{hidden}/get_result")
    for kind, number, detail in steps:
        goal_id = uuid_of(number)
        if kind == "goal":
            goal = Fibonacci.Goal(order=detail)
            goals.call_async(Impl.SendGoalService.Request(goal_id=goal_id, goal=goal))
        elif kind == "cancel":
            info = GoalInfo(goal_id=goal_id, stamp=detail)
            cancels.call_async(Impl.CancelGoalService.Request(goal_info=info))
        elif kind == "result":
            results.call_async(Impl.GetResultService.Request(goal_id=goal_id))
        else:
            for _ in range(number):
                await checkpoint()
    await settle()
    assert robot.is_running
    assert not robot.destroyed


async def execute(goal: Goal) -> Fibonacci.Result:
    """End in one of the possible ways after some iterations of the loop."""
    for _ in range(goal.request.order):
        await checkpoint()
    if goal.request.order == 2:
        await asyncio.Event().wait()
    if goal.request.order == 3:
        goal.abort()
    else:
        goal.succeed()
    return Fibonacci.Result()


def run(steps: list[tuple[str, int, Any]], *, concurrent: bool | int) -> None:
    """Send `steps` to a new server."""

    async def main() -> None:
        async with (
            local_context() as context,
            Node("robot", context=context) as robot,
            Node("client", context=context) as client,
        ):
            robot.create_action_server(
                Fibonacci,
                "go",
                execute,
                cancel_callback=lambda _goal: CancelResponse.ACCEPT,
                concurrent=concurrent,
            )
            await send(robot, client, steps)

    asyncio.run(main())


@hypothesis.settings(max_examples=hypothesis.settings().max_examples * 3 // 2, deadline=None)
@hypothesis.given(
    steps=st.lists(STEPS, min_size=1, max_size=12), concurrent=st.sampled_from([True, False, 2])
)
def test_no_sequence_of_requests_ends_the_node(
    steps: list[tuple[str, int, Any]], *, concurrent: bool | int
) -> None:
    """Any process in the network may send them."""
    run(steps, concurrent=concurrent)


@pytest.mark.parametrize("turns", range(8))
@pytest.mark.parametrize("concurrent", [True, False, 2])
def test_a_cancel_request_soon_after_its_goal_leaves_the_node_alone(
    turns: int, *, concurrent: bool | int
) -> None:
    """Two turns after the goal it came between the goal's turn and the task that executes it."""
    pauses: list[tuple[str, int, Any]] = [("turns", turns, None)] if turns else []
    run([("goal", 1, 0), *pauses, ("cancel", 1, Time())], concurrent=concurrent)
