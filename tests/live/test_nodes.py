"""aionode's nodes and a node of ROS 2's: everything in both directions."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from collections.abc import AsyncIterator
from typing import Any

import pytest

from aionode import Context, Node
from aionode.action import CancelResponse, GoalStatus
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.parameter import Parameter
from aionode.parameter_client import AsyncParameterClient
from aionode.qos import DurabilityPolicy, QoSProfile
from tests.live.conftest import PEER, PYTHON, Run, running

KEPT = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
async def node(peer: subprocess.Popen[str]) -> AsyncIterator[Node]:
    """A node of aionode's that knows the one of ROS 2's."""
    async with Context() as context, Node("aionode_peer", context=context) as node:
        async with asyncio.timeout(20):
            while not node.count_subscribers("/ask"):
                await node.graph.changed()
        yield node


async def answer(node: Node, wanted: str) -> str:
    """Tell the node of ROS 2's to ask for something, and return its answer."""
    answers = node.create_subscription(String, "heard_by_ros", None, 10)
    publisher = node.create_publisher(String, "ask", 10)
    async with asyncio.timeout(20):
        await publisher.wait_for_subscribers()
        while not answers.get_publisher_count():
            await node.graph.changed()
        publisher.publish(String(data=wanted))
        return (await answers.receive()).data


async def test_messages_of_ros_are_heard_in_order(node: Node) -> None:
    """None is missing, and none comes twice."""
    subscription = node.create_subscription(String, "from_ros", None, 10)

    numbers = [int((await subscription.receive()).data) for _ in range(20)]

    assert numbers == list(range(numbers[0], numbers[0] + 20))


async def test_ros_hears_messages(node: Node) -> None:
    """It publishes again what it hears."""
    echoed = node.create_subscription(String, "heard_by_ros", None, 10)
    publisher = node.create_publisher(String, "to_ros", 10)
    async with asyncio.timeout(20):
        await publisher.wait_for_subscribers()
        while not echoed.get_publisher_count():
            await node.graph.changed()
        for number in range(5):
            publisher.publish(String(data=f"hello {number}"))

        heard = [(await echoed.receive()).data for _ in range(5)]

    assert heard == [f"hello {number}" for number in range(5)]


async def test_a_late_joiner_gets_what_ros_keeps(node: Node) -> None:
    """The last three of five."""
    subscription = node.create_subscription(String, "kept_by_ros", None, KEPT)

    async with asyncio.timeout(20):
        kept = [(await subscription.receive()).data for _ in range(3)]

    assert kept == ["kept 2", "kept 3", "kept 4"]


async def test_ros_gets_what_was_kept_for_it(node: Node) -> None:
    """It has subscribed before the publisher exists, and gets all of it once."""
    echoed = node.create_subscription(String, "heard_by_ros", None, 10)
    async with asyncio.timeout(20):
        while not echoed.get_publisher_count():
            await node.graph.changed()
        publisher = node.create_publisher(String, "kept_by_aionode", KEPT)
        publisher.publish(String(data="kept"))

        assert (await echoed.receive()).data == "kept"


async def test_a_service_of_ros_answers(node: Node) -> None:
    """Ten calls at once."""
    client = node.create_client(AddTwoInts, "ros_add")
    async with asyncio.timeout(20):
        await client.wait_for_service()
        calls = [client.call(AddTwoInts.Request(a=n, b=1)) for n in range(10)]
        sums = [response.sum for response in await asyncio.gather(*calls)]

    assert sums == list(range(1, 11))


async def test_ros_calls_a_service(node: Node) -> None:
    """With rclpy's call_async."""

    def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        response.sum = request.a + request.b
        return response

    node.create_service(AddTwoInts, "aionode_add", add)

    assert await answer(node, "call") == "sum 42"


async def test_an_action_of_ros_runs(node: Node) -> None:
    """Goal, feedback, result."""
    client = node.create_action_client(Fibonacci, "ros_fibonacci")
    feedback: list[Any] = []
    async with asyncio.timeout(20):
        await client.wait_for_server()
        goal = await client.send_goal(Fibonacci.Goal(order=4), feedback_callback=feedback.append)
        result = await goal.result()

    assert result.status == GoalStatus.STATUS_SUCCEEDED
    assert list(result.result.sequence) == [0, 1, 1, 2]


async def test_an_action_of_ros_is_canceled(node: Node) -> None:
    """By the cancel request of a client of aionode's."""
    client = node.create_action_client(Fibonacci, "ros_fibonacci")
    async with asyncio.timeout(20):
        await client.wait_for_server()
        goal = await client.send_goal(Fibonacci.Goal(order=0))
        await goal.cancel()
        result = await goal.result()

    assert result.status == GoalStatus.STATUS_CANCELED


@pytest.mark.parametrize(
    ("wanted", "expected"), [("goal", "goal 4 [0, 1, 1, 2]"), ("cancel", "goal 5 []")]
)
async def test_ros_sends_a_goal(node: Node, wanted: str, expected: str) -> None:
    """It also cancels one."""

    async def execute(goal: Any) -> Fibonacci.Result:
        if goal.request.order == 0:
            try:
                await asyncio.Event().wait()
            finally:
                goal.canceled()
        goal.succeed()
        return Fibonacci.Result(sequence=[0, 1, 1, 2])

    node.create_action_server(
        Fibonacci, "aionode_fibonacci", execute, cancel_callback=lambda _: CancelResponse.ACCEPT
    )

    assert await answer(node, wanted) == expected


async def test_parameters_of_ros_are_read_and_set(node: Node) -> None:
    """By the parameter client."""
    client = AsyncParameterClient(node, "/ros_peer")
    async with asyncio.timeout(20):
        await client.wait_for_services()
        (before,) = await client.get_parameters(["speed"])
        await client.set_parameters([Parameter("speed", value=4)])
        (after,) = await client.get_parameters(["speed"])
        await client.set_parameters([Parameter("speed", value=3)])

    assert (before.value, after.value) == (3, 4)


async def test_a_killed_node_of_ros_is_gone(node: Node, environment: dict[str, str]) -> None:
    """A new node of its name is there within seconds."""
    for _ in range(2):
        with running(
            [*PYTHON, str(PEER), "--ros-args", "-r", "__node:=killed"], environment
        ) as ros:
            async with asyncio.timeout(20):
                while "killed" not in node.get_node_names():
                    await node.graph.changed()
            ros.kill()
            async with asyncio.timeout(20):
                while "killed" in node.get_node_names():
                    await node.graph.changed()


PROGRAM = """
import aionode
aionode.run(lambda: aionode.Node("killed_aionode"))
"""


def test_ros_sees_a_killed_node_of_aionode_go(
    peer: subprocess.Popen[str], ros2: Run, environment: dict[str, str]
) -> None:
    """Nothing of it stays in the graph."""
    with subprocess.Popen([sys.executable, "-c", PROGRAM], env=environment) as program:
        try:
            while "/killed_aionode" not in ros2("node", "list").split():
                assert program.poll() is None
        finally:
            program.kill()
    while "/killed_aionode" in ros2("node", "list").split():
        pass
