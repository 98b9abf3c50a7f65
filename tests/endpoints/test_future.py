"""rclpy's names for calls, goals and waits: futures, and awaitables that are not awaited."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from aionode.action import CancelResponse, GoalResponse, GoalStatus
from aionode.errors import EntityDestroyedError, GoalLostError, ServiceError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.node import Node
from aionode.parameter_client import AsyncParameterClient
from aionode.testing import settle
from tests.support.actions import Goal, Worker

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.context import Context

Request = AddTwoInts.Request
Response = AddTwoInts.Response


def add(request: AddTwoInts.Request) -> AddTwoInts.Response:
    """Return the sum."""
    return Response(sum=request.a + request.b)


# Calls


async def test_call_async_is_a_future_that_can_be_awaited(node: Node) -> None:
    """Both ways to write it work with the same object."""
    node.create_service(AddTwoInts, "add", add)
    client = node.create_client(AddTwoInts, "add")

    response = await client.call_async(Request(a=1, b=2))

    assert response.sum == 3


async def test_a_future_tells_of_its_end_as_rclpys_does(node: Node) -> None:
    """Programs of rclpy use `add_done_callback`, `done` and `result`."""
    node.create_service(AddTwoInts, "add", add)
    sums: list[int] = []

    future = node.create_client(AddTwoInts, "add").call_async(Request(a=1, b=2))
    future.add_done_callback(lambda done: sums.append(done.result().sum))
    assert not future.done()
    await settle()

    assert future.done()
    assert sums == [3]


async def test_a_future_raises_what_call_raises(node: Node) -> None:
    """The node continues: the error is raised where the future is awaited."""

    def fail(_request: Request) -> Response:
        raise ValueError("no")

    node.create_service(AddTwoInts, "add", fail)
    future = node.create_client(AddTwoInts, "add").call_async(Request())
    await settle()

    with pytest.raises(ServiceError, match="ValueError: no"):
        future.result()
    assert node.is_running


async def test_cancelling_the_future_forgets_the_call(node: Node) -> None:
    """Abandoning `await client.call()` does the same."""
    client = node.create_client(AddTwoInts, "add")
    future = client.call_async(Request())
    await settle()

    future.cancel()
    await settle()

    assert client.stats.errors == 1


async def test_a_time_limit_on_a_future_forgets_the_call(node: Node) -> None:
    """`asyncio.timeout` cancels the future that is awaited in it, and that the call."""
    client = node.create_client(AddTwoInts, "add")

    with pytest.raises(TimeoutError):
        async with asyncio.timeout(0.001):
            await client.call_async(Request())
    await settle()

    assert client.stats.errors == 1


async def test_a_call_of_a_constructor_is_made_once_the_node_runs(context: Context) -> None:
    """Programs for rclpy call before they spin."""
    node = Node("early", context=context)
    node.create_service(AddTwoInts, "add", add)
    future = node.create_client(AddTwoInts, "add").call_async(Request(a=1, b=2))
    await settle()
    assert not future.done()

    async with node:
        assert (await future).sum == 3


@pytest.mark.parametrize("runs", [False, True])
async def test_the_end_of_the_client_ends_its_futures(context: Context, *, runs: bool) -> None:
    """No task waits forever, whether the call had started or not."""
    node = Node("short", context=context)
    future = node.create_client(AddTwoInts, "add").call_async(Request())
    if runs:
        async with node:
            await settle()
    else:
        node.destroy_node()

    with pytest.raises(EntityDestroyedError, match="client of /add is destroyed"):
        await future


async def test_a_destroyed_client_refuses_at_once(node: Node) -> None:
    """The mistake is reported where it is made."""
    client = node.create_client(AddTwoInts, "add")
    client.destroy()

    with pytest.raises(EntityDestroyedError):
        client.call_async(Request())


def test_a_future_without_a_loop_says_where_one_is() -> None:
    """One for rclpy needs none, asyncio does."""
    from aionode.testing import local_context

    node = Node("early", context=local_context())
    client = node.create_client(AddTwoInts, "add")

    with pytest.raises(RuntimeError, match=r"needs the event loop.*aionode\.run"):
        client.call_async(Request())
    node.destroy_node()


# Goals


@pytest.fixture
def worker() -> Worker:
    """A worker that executes goals."""
    return Worker()


async def test_a_goal_goes_the_way_of_rclpys_tutorial(node: Node, worker: Worker) -> None:
    """Accepted, result, status: all by done callbacks."""
    node.create_action_server(Fibonacci, "fibonacci", worker)
    worker.may_end.set()
    client = node.create_action_client(Fibonacci, "fibonacci")
    ended: list[Any] = []

    def accepted(future: asyncio.Future[Any]) -> None:
        goal_handle = future.result()
        assert goal_handle.accepted
        goal_handle.get_result_async().add_done_callback(lambda done: ended.append(done.result()))

    client.send_goal_async(Fibonacci.Goal(order=2)).add_done_callback(accepted)
    await settle()

    assert [(each.status, list(each.result.sequence)) for each in ended] == [
        (GoalStatus.STATUS_SUCCEEDED, [0, 1, 2])
    ]


async def test_a_refused_goal_is_a_handle_that_says_so(node: Node, worker: Worker) -> None:
    """As in rclpy, whose programs ask `goal_handle.accepted`; its result is an error at once."""
    node.create_action_server(
        Fibonacci, "fibonacci", worker, goal_callback=lambda _: GoalResponse.REJECT
    )
    client = node.create_action_client(Fibonacci, "fibonacci")

    handle = await client.send_goal_async(Fibonacci.Goal())

    assert not handle.accepted
    with pytest.raises(GoalLostError, match="rejected"):
        await handle.get_result_async()


async def test_a_goal_is_cancelled_by_its_future_name(node: Node, worker: Worker) -> None:
    """The answer is the CancelGoal response, with the goals that are being cancelled."""
    asked: list[Goal] = []

    def decide(goal: Goal) -> CancelResponse:
        asked.append(goal)
        return CancelResponse.ACCEPT

    node.create_action_server(Fibonacci, "fibonacci", worker, cancel_callback=decide)
    client = node.create_action_client(Fibonacci, "fibonacci")
    handle = await client.send_goal_async(Fibonacci.Goal())
    await worker.begun.get()

    response = await handle.cancel_goal_async()

    assert len(response.goals_canceling) == 1
    assert (await handle.get_result_async()).status == GoalStatus.STATUS_CANCELED


# Waits without an await


WAITS: dict[str, Callable[[Node], Any]] = {
    "wait_for_service": lambda node: node.create_client(AddTwoInts, "add").wait_for_service(
        timeout_sec=1.0
    ),
    "wait_for_server": lambda node: node.create_action_client(
        Fibonacci, "fibonacci"
    ).wait_for_server(timeout_sec=1.0),
    "wait_for_services": lambda node: AsyncParameterClient(node, "other").wait_for_services(1.0),
    "wait_for_node": lambda node: node.wait_for_node("other", 1.0),
}


@pytest.mark.parametrize("name", list(WAITS))
async def test_a_wait_that_is_not_awaited_has_no_truth_value(node: Node, name: str) -> None:
    """A coroutine is true, so `while not client.wait_for_service():` would continue at once."""
    with pytest.raises(TypeError, match=rf"{name}\(\) was not awaited.*while not await"):
        bool(WAITS[name](node))


@pytest.mark.parametrize("name", list(WAITS))
async def test_a_wait_can_be_a_task(node: Node, name: str) -> None:
    """It is a coroutine in all other respects: a TaskGroup accepts it, and cancelling works."""
    async with asyncio.TaskGroup() as tasks:
        task = tasks.create_task(WAITS[name](node))
        await settle()
        task.cancel()

    assert task.cancelled()


async def test_a_node_that_does_not_come_is_waited_for_no_longer_than_said(node: Node) -> None:
    """True or False, as in rclpy."""
    assert await node.wait_for_node("node", 1.0)
    assert not await node.wait_for_node("other", 0.001)
