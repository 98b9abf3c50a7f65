"""``aionode action``."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
    ClientGoalHandle,
    GoalRejected,
    GoalResponse,
)
from aionode.cli._nouns.action import info, send_goal
from aionode.cli._support.nouns import ACTION
from aionode.errors import CommandError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.testing import settle

FIBONACCI = "example_interfaces/action/Fibonacci"


async def execute(goal_handle: Any) -> Fibonacci.Result:
    """Compute at once; order 0 never ends, a negative order fails."""
    order = goal_handle.request.order
    if order == 0:
        await asyncio.get_running_loop().create_future()
    sequence = [0, 1]
    for _ in range(1, order):
        sequence.append(sequence[-1] + sequence[-2])
        goal_handle.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        await settle()
    if order < 0:
        goal_handle.abort()
    else:
        goal_handle.succeed()
    return Fibonacci.Result(sequence=sequence)


@pytest.fixture
async def server(node_factory: Callable[..., Node]) -> Node:
    """A node that serves /fibonacci, but no order above 100."""

    def welcome(goal: Fibonacci.Goal) -> GoalResponse:
        return GoalResponse.REJECT if goal.order > 100 else GoalResponse.ACCEPT

    server = node_factory("fib_server")
    ActionServer(
        server,
        Fibonacci,
        "/fibonacci",
        execute,
        goal_callback=welcome,
        cancel_callback=lambda goal: CancelResponse.ACCEPT,
    )
    return server


async def test_send_goal_prints_what_ros2_prints(tool: Node, server: Node, screen: Any) -> None:
    """As recorded with ros2, apart from the id."""
    status = await send_goal(
        tool, "/fibonacci", FIBONACCI, values="{order: 3}", feedback=True, output=screen.output
    )

    head, _, rest = screen.text.partition("Goal accepted with ID: ")
    assert status == 0
    assert head == (
        "Waiting for an action server to become available...\nSending goal:\n     order: 3\n\n"
    )
    assert len(rest.partition("\n")[0]) == 32
    assert rest.partition("\n")[2] == (
        "\n"
        "Feedback:\n    sequence:\n- 0\n- 1\n- 1\n\n"
        "Feedback:\n    sequence:\n- 0\n- 1\n- 1\n- 2\n\n"
        "Result:\n    sequence:\n- 0\n- 1\n- 1\n- 2\n\n"
        "Goal finished with status: SUCCEEDED\n"
    )


async def test_json_prints_feedback_and_result(tool: Node, server: Node, screen: Any) -> None:
    """One record per line, each with the goal id."""
    await send_goal(
        tool, "/fibonacci", FIBONACCI, values="{order: 2}", feedback=True,
        output=screen.json_output,
    )  # fmt: skip

    first, last = screen.records
    assert first["feedback"] == {"sequence": [0, 1, 1]}
    assert last["status"] == "SUCCEEDED"
    assert first["goal_id"] == last["goal_id"]


async def test_a_rejected_goal_is_reported(tool: Node, server: Node, screen: Any) -> None:
    """ros2 returns 0, so a script would believe that the goal succeeded."""
    status = await send_goal(
        tool, "/fibonacci", FIBONACCI, values="{order: 101}", output=screen.output
    )

    assert status == 1
    assert screen.text.endswith("Goal was rejected.\n")


async def test_the_reason_of_a_rejection_is_printed(tool: Node, server: Node, screen: Any) -> None:
    """On one line, whatever the server writes."""

    def judge(_goal: Fibonacci.Goal) -> GoalResponse:
        raise GoalRejected("too far:\n\x1b[1m12 m")

    server.create_action_server(Fibonacci, "elsewhere", print, goal_callback=judge)

    status = await send_goal(tool, "/elsewhere", FIBONACCI, values="{}", output=screen.output)

    assert status == 1
    assert screen.text.endswith("Goal was rejected: too far:\\n\\x1b[1m12 m\n")


async def test_an_aborted_goal_is_no_success(tool: Node, server: Node, screen: Any) -> None:
    """The result is printed nevertheless."""
    status = await send_goal(
        tool, "/fibonacci", FIBONACCI, values="{order: -1}", output=screen.output
    )

    assert status == 1
    assert screen.text.endswith("Goal finished with status: ABORTED\n")


async def test_an_interrupted_wait_cancels_the_goal(tool: Node, server: Node, screen: Any) -> None:
    """Ctrl-C must not leave a robot driving; result and status are printed, as ros2 does."""
    async with asyncio.TaskGroup() as tasks:
        work = send_goal(tool, "/fibonacci", FIBONACCI, output=screen.output)
        task = tasks.create_task(work)
        await settle()
        assert screen.text.count("Goal accepted") == 1
        task.cancel()

    assert task.result() == 0
    assert screen.text.endswith(
        "\nCanceling goal...\nGoal canceled.\n"
        "Result:\n    sequence: []\n\nGoal finished with status: CANCELED\n"
    )


@pytest.mark.parametrize("code", [0, 1])
async def test_a_refused_cancel_is_an_error(
    code: int, tool: Node, node_factory: Callable[..., Node], screen: Any, monkeypatch: Any
) -> None:
    """A server of rclpy answers 0, one of aionode 1; either way the goal continues."""
    refusing = node_factory("fib_server")
    ActionServer(refusing, Fibonacci, "/fibonacci", execute)
    answer = ClientGoalHandle.cancel

    async def like_rclpy(self: Any) -> Any:
        response = await answer(self)
        response.return_code = code
        return response

    monkeypatch.setattr(ClientGoalHandle, "cancel", like_rclpy)

    async def interrupted() -> None:
        with pytest.raises(CommandError, match="Failed to cancel goal: the server refused"):
            await send_goal(tool, "/fibonacci", FIBONACCI, output=screen.output)

    async with asyncio.TaskGroup() as tasks:
        task = tasks.create_task(interrupted())
        await settle()
        task.cancel()

    assert "Goal canceled" not in screen.text


@pytest.mark.parametrize(
    ("action_type", "values", "says"),
    [
        ("example_interfaces/action/Fibonaci", "{}", f"did you mean {FIBONACCI}?"),
        ("std_msgs/msg/String", "{}", "not an action"),
        (FIBONACCI, "{ordr: 1}", "Failed to populate field: example_interfaces/action/Fibonacci"),
        (FIBONACCI, "{order: x}", "order: 'x'"),
    ],
)
async def test_what_does_not_fit_is_refused_before_it_waits(
    action_type: str, values: str, says: str, tool: Node, server: Node, screen: Any
) -> None:
    """The error names what was given and what is expected."""
    with pytest.raises(CommandError) as raised:
        await send_goal(tool, "/fibonacci", action_type, values=values, output=screen.output)

    assert says in str(raised.value)


async def test_a_limited_wait_says_what_may_be_meant(tool: Node, server: Node, screen: Any) -> None:
    """ros2 waits forever."""
    with pytest.raises(CommandError, match="No server of '/fibonaci' appeared within"):
        await send_goal(tool, "/fibonaci", FIBONACCI, timeout=0.001, output=screen.output)

    assert screen.errors == "No server of '/fibonaci' yet. Did you mean '/fibonacci'?\n"


async def test_list_info_type_and_find(tool: Node, server: Node, screen: Any) -> None:
    """As recorded with ros2."""
    await ACTION.list_names(tool, types=True, output=screen.output)
    await info(tool, "/fibonacci", types=True, output=screen.output)
    await info(tool, "/fibonacci", count=True, output=screen.output)
    await ACTION.print_type(tool, "/fibonacci", output=screen.output)
    await ACTION.find(tool, FIBONACCI, output=screen.output)

    assert screen.text == (
        f"/fibonacci [{FIBONACCI}]\n"
        "Action: /fibonacci\nAction clients: 0\nAction servers: 1\n"
        f"    /fib_server [{FIBONACCI}]\n"
        "Action: /fibonacci\nAction clients: 0\nAction servers: 1\n"
        f"{FIBONACCI}\n"
        "/fibonacci\n"
    )


async def test_clients_are_counted_by_node(
    tool: Node, server: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """A node with two clients is one, as ros2 counts."""
    users = [node_factory("driver"), node_factory("arm")]
    for user in (*users, users[0]):
        ActionClient(user, Fibonacci, "/fibonacci")

    await info(tool, "/fibonacci", output=screen.output)
    await info(tool, "/fibonacci", output=screen.json_output)

    *lines, record = screen.text.splitlines()
    assert lines[1:4] == ["Action clients: 2", "    /arm", "    /driver"]
    assert [client["node"] for client in json.loads(record)["clients"]] == ["/arm", "/driver"]


async def test_an_unknown_action_is_named(tool: Node, server: Node, screen: Any) -> None:
    """ros2 shows one without clients and servers."""
    with pytest.raises(CommandError, match=r"Unknown action '/fibonaci'\. Did you mean"):
        await info(tool, "/fibonaci", output=screen.output)
