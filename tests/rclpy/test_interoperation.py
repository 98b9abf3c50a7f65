"""Actions and managed nodes with rclpy's API on one side and aionode's on the other.

Both are in this process: a context with its own thread, and one in the test's loop.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import suppress
from typing import Any

import pytest

import rclpy
from aionode import Context, Node
from aionode.action import GoalRejected, GoalRejectedError, GoalStatus
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.lifecycle_msgs.msg import TransitionEvent
from aionode.interfaces.std_msgs.msg import String
from aionode.lifecycle import LifecycleManager, LifecycleNode, TransitionCallbackReturn
from rclpy import lifecycle as rclpy_lifecycle
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node as RclpyNode
from rclpy.qos import as_own
from rosidl_generator_py import action_class, message_class, service_class
from tests.support.peers import DOMAIN_ID, isolated_environment, kept, quiet_node
from tests.support.waiting import until

RclpyFibonacci = action_class("example_interfaces/action/Fibonacci")
RclpyString = message_class("std_msgs/msg/String")
ChangeState = service_class("lifecycle_msgs/srv/ChangeState")
GetState = service_class("lifecycle_msgs/srv/GetState")

PATIENCE_S = 20.0

pytestmark = pytest.mark.one_loop


@pytest.fixture(autouse=True)
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Isolated from everything else on the machine."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)


@pytest.fixture
async def native(alone: None) -> AsyncIterator[Node]:
    """A node of aionode, in the loop of the test."""
    async with Context(domain_id=DOMAIN_ID) as context, quiet_node("native", context) as node:
        yield node


class Side:
    """A context of rclpy's API whose nodes a thread spins."""

    def __init__(self) -> None:
        self.context = rclpy.Context()
        rclpy.init(args=[], context=self.context, domain_id=DOMAIN_ID)
        self.executor = MultiThreadedExecutor(4, context=self.context)
        self._thread = threading.Thread(target=self._spin)
        self._thread.start()

    def _spin(self) -> None:
        with suppress(ExternalShutdownException):
            self.executor.spin()

    def add(self, node: Any) -> Any:
        """Spin another node."""
        self.executor.add_node(node)
        return node

    def close(self) -> None:
        """End the thread."""
        self.executor.shutdown()
        self._thread.join(PATIENCE_S)
        rclpy.shutdown(context=self.context)


@pytest.fixture
def side(alone: None) -> Iterator[Side]:
    """The side with rclpy's API."""
    stop.clear()
    side = Side()
    yield side
    stop.set()
    side.close()


async def result_of(future: Any) -> Any:
    """Return the result of a future of rclpy's API."""
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    assert await asyncio.to_thread(done.wait, PATIENCE_S)
    return future.result()


stop = threading.Event()
"""Ends goals that wait for their cancellation, so that a failing test ends."""


def work(goal_handle: Any) -> Any:
    """Execute a goal: with order 99 until it is cancelled, with order 98 not at all."""
    if goal_handle.request.order == 98:
        raise LookupError("no such number")
    sequence = [0, 1]
    for _ in range(goal_handle.request.order - 1):
        sequence.append((sequence[-1] + sequence[-2]) % 2**31)
        goal_handle.publish_feedback(RclpyFibonacci.Feedback(sequence=sequence))
        while goal_handle.request.order == 99 and not stop.wait(0.01):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return RclpyFibonacci.Result(sequence=sequence)
    goal_handle.succeed()
    return RclpyFibonacci.Result(sequence=sequence)


@pytest.fixture
def serve(side: Side) -> Callable[..., ActionServer[Any, Any, Any]]:
    """Return a function that creates an action server with rclpy's API."""

    def make(**options: Any) -> ActionServer[Any, Any, Any]:
        node = side.add(RclpyNode("server", context=side.context))
        options = {
            "execute_callback": work,
            "cancel_callback": lambda _: CancelResponse.ACCEPT,
            "callback_group": ReentrantCallbackGroup(),
            **options,
        }
        return ActionServer(node, RclpyFibonacci, "fibonacci", **options)

    return make


async def test_aionode_s_client_gets_feedback_and_result(
    native: Node, serve: Callable[..., Any]
) -> None:
    """A program with aionode's API uses a server with rclpy's like any other."""
    serve()
    client = native.create_action_client(Fibonacci, "fibonacci")
    await client.wait_for_server(PATIENCE_S)

    goal = await client.send_goal(Fibonacci.Goal(order=5))
    feedback = [list(each.sequence) async for each in goal]
    result = await goal.result()

    assert feedback == [[0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3], [0, 1, 1, 2, 3, 5]]
    assert list(result.result.sequence) == [0, 1, 1, 2, 3, 5]


async def test_aionode_s_client_cancels_a_goal(native: Node, serve: Callable[..., Any]) -> None:
    """A goal handle of rclpy's API shows the request, and the client learns how it has ended."""
    serve()
    client = native.create_action_client(Fibonacci, "fibonacci")
    await client.wait_for_server(PATIENCE_S)
    goal = await client.send_goal(Fibonacci.Goal(order=99))

    await goal.cancel()

    assert (await goal.result()).status is GoalStatus.CANCELED


async def test_aionode_s_client_learns_that_a_goal_is_rejected(
    native: Node, serve: Callable[..., Any]
) -> None:
    """A goal callback of rclpy's API decides."""
    serve(goal_callback=lambda _: GoalResponse.REJECT)
    client = native.create_action_client(Fibonacci, "fibonacci")
    await client.wait_for_server(PATIENCE_S)

    with pytest.raises(GoalRejectedError):
        await client.send_goal(Fibonacci.Goal(order=1))


async def test_aionode_s_client_learns_why_a_goal_is_rejected(
    native: Node, serve: Callable[..., Any]
) -> None:
    """A goal callback of rclpy's API may raise the reason; other clients get a rejection."""

    def judge(_goal: Any) -> GoalResponse:
        raise GoalRejected("too far: 12 m of at most 5")

    serve(goal_callback=judge)
    client = native.create_action_client(Fibonacci, "fibonacci")
    await client.wait_for_server(PATIENCE_S)

    with pytest.raises(GoalRejectedError, match="was rejected: too far: 12 m of at most 5"):
        await client.send_goal(Fibonacci.Goal(order=1))


async def test_aionode_s_client_learns_that_a_goal_has_failed(
    native: Node, serve: Callable[..., Any]
) -> None:
    """An exception of an execute callback of rclpy's API aborts the goal."""
    serve()
    client = native.create_action_client(Fibonacci, "fibonacci")
    await client.wait_for_server(PATIENCE_S)
    goal = await client.send_goal(Fibonacci.Goal(order=98))

    result = await goal.result()

    assert result.status is GoalStatus.ABORTED
    assert "LookupError: no such number" in result.error_text


async def native_work(goal: Any) -> Any:
    """Execute a goal on aionode's side: with order 99 until it is cancelled."""
    sequence = [0, 1]
    while len(sequence) <= goal.request.order:
        if goal.request.order == 99:
            await asyncio.Event().wait()
        sequence.append(sequence[-1] + sequence[-2])
        goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
    goal.succeed()
    return Fibonacci.Result(sequence=sequence)


@pytest.fixture
def client(native: Node, side: Side) -> ActionClient[Any, Any, Any]:
    """A client of rclpy's API of an action that aionode's side serves."""
    native.create_action_server(
        Fibonacci, "fibonacci", native_work, cancel_callback=lambda _: CancelResponse.ACCEPT
    )
    node = side.add(RclpyNode("client", context=side.context))
    return ActionClient(node, RclpyFibonacci, "fibonacci")


async def test_rclpy_s_client_gets_feedback_and_result(
    client: ActionClient[Any, Any, Any],
) -> None:
    """A program with rclpy's API uses a server with aionode's like any other."""
    feedback: list[list[int]] = []
    assert await asyncio.to_thread(client.wait_for_server, PATIENCE_S)

    handle = await result_of(
        client.send_goal_async(
            RclpyFibonacci.Goal(order=3),
            feedback_callback=lambda message: feedback.append(list(message.feedback.sequence)),
        )
    )
    # A result may overtake feedback, and a client that has the result drops it, as in rclpy.
    await until(lambda: len(feedback) == 2)
    response = await result_of(handle.get_result_async())

    assert handle.accepted
    assert response.status == 4
    assert list(response.result.sequence) == [0, 1, 1, 2]
    assert feedback == [[0, 1, 1], [0, 1, 1, 2]]


async def test_rclpy_s_client_cancels_a_goal(client: ActionClient[Any, Any, Any]) -> None:
    """The answer names the goal, and its result says that it was cancelled."""
    assert await asyncio.to_thread(client.wait_for_server, PATIENCE_S)
    handle = await result_of(client.send_goal_async(RclpyFibonacci.Goal(order=99)))

    response = await result_of(handle.cancel_goal_async())
    result = await result_of(handle.get_result_async())

    assert [info.goal_id for info in response.goals_canceling] == [handle.goal_id]
    assert result.status == 5


async def test_aionode_s_manager_manages_a_node_of_rclpy_s_api(native: Node, side: Side) -> None:
    """Its callbacks run, its publisher works while active, and its transitions are published."""
    called: list[str] = []

    class Talker(rclpy_lifecycle.Node):
        def on_configure(self, state: Any) -> Any:
            called.append(f"configure from {state.label}")
            self.talk = self.create_lifecycle_publisher(RclpyString, "talk", as_own(kept(1)))
            return rclpy_lifecycle.TransitionCallbackReturn.SUCCESS

    talker = Talker("talker", context=side.context)
    side.add(talker)
    events: asyncio.Queue[str] = asyncio.Queue()
    heard: asyncio.Queue[str] = asyncio.Queue()
    native.create_subscription(
        TransitionEvent,
        "/talker/transition_event",
        lambda event: events.put_nowait(event.goal_state.label),
        10,
    )
    native.create_subscription(
        String, "talk", lambda message: heard.put_nowait(message.data), kept(1)
    )

    async with LifecycleManager(native, ["/talker"], timeout_sec=PATIENCE_S) as manager:
        assert await manager.get_state("/talker") == "active"
        talker.talk.publish(RclpyString(data="while active"))
        assert await heard.get() == "while active"
    talker.talk.publish(RclpyString(data="dropped"))

    assert await manager.get_state("/talker") == "unconfigured"
    assert called == ["configure from unconfigured"]
    assert heard.empty()
    while await events.get() != "cleaningup":
        pass  # the first may have come before the subscription was known
    assert await events.get() == "unconfigured"


async def test_a_program_with_rclpy_s_api_manages_a_node_of_aionode(
    native: Node, side: Side
) -> None:
    """Its services answer, and a label takes precedence over a number."""
    called: list[str] = []

    class Managed(LifecycleNode):
        async def on_configure(self, state: Any) -> TransitionCallbackReturn:
            called.append(state.label)
            return TransitionCallbackReturn.SUCCESS

    async with Managed("managed", context=native.context, enable_rosout=False):
        node = side.add(RclpyNode("manager", context=side.context))
        change = node.create_client(ChangeState, "/managed/change_state")
        ask = node.create_client(GetState, "/managed/get_state")
        assert await asyncio.to_thread(change.wait_for_service, PATIENCE_S)
        assert await asyncio.to_thread(ask.wait_for_service, PATIENCE_S)
        request = ChangeState.Request()
        request.transition.id, request.transition.label = 3, "configure"

        response = await result_of(change.call_async(request))
        state = await result_of(ask.call_async(GetState.Request()))

    assert response.success
    assert called == ["unconfigured"]
    assert state.current_state.label == "inactive"
