"""The end of tasks that wait for an entity while it is destroyed."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Coroutine
from typing import Any

import pytest

from aionode.clock import Duration
from aionode.endpoints.core.node_core import core_of
from aionode.engine.context import Context
from aionode.errors import EntityDestroyedError, QueueFullError
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.parameter_client import AsyncParameterClient
from aionode.qos import HistoryPolicy, QoSProfile
from aionode.testing import settle

Wait = Callable[[Node], Coroutine[Any, Any, object]]

KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)

END = EntityDestroyedError, asyncio.CancelledError


async def call(node: Node) -> object:
    """Call a service that does not answer."""
    return await node.create_client(AddTwoInts, "/slow").call(AddTwoInts.Request())


async def call_with_a_limit(node: Node) -> object:
    """Call it with a time limit."""
    return await node.create_client(AddTwoInts, "/slow").call(AddTwoInts.Request(), timeout_sec=9)


async def await_a_future(node: Node) -> object:
    """Await the future of a call."""
    return await node.create_client(AddTwoInts, "/slow").call_async(AddTwoInts.Request())


async def wait_for_service(node: Node) -> object:
    """Wait for a service that nobody offers."""
    return await node.create_client(AddTwoInts, "/none").wait_for_service()


async def wait_for_subscribers(node: Node) -> object:
    """Wait for a subscription that nobody has."""
    await node.create_publisher(String, "/none", 1).wait_for_subscribers()
    return None


async def drain(node: Node) -> object:
    """Wait until a reader that keeps everything has room."""
    publisher = node.create_publisher(String, "/full", KEEP_ALL)
    with contextlib.suppress(QueueFullError):
        while True:
            publisher.publish(String())
    await publisher.drain()
    return None


async def wait_for_node(node: Node) -> object:
    """Wait for a node that does not come."""
    return await node.wait_for_node("/none")


async def wait_for_parameters(node: Node) -> object:
    """Wait for the parameters of a node that does not come."""
    return await AsyncParameterClient(node, "/none").wait_for_services()


async def sleep(node: Node) -> object:
    """Sleep on the node's clock, which stands still in these tests."""
    await node.get_clock().sleep(9)
    return None


async def sleep_until(node: Node) -> object:
    """Sleep until a time on the node's clock."""
    clock = node.get_clock()
    await clock.sleep_until(clock.now() + Duration(seconds=9))
    return None


async def await_a_rate(node: Node) -> object:
    """Wait for the next turn of a rate."""
    await node.create_rate(0.1).sleep()
    return None


async def receive(node: Node) -> object:
    """Wait for a message."""
    return await node.create_subscription(String, "/none").receive()


WAITS: list[Wait] = [
    call,
    call_with_a_limit,
    await_a_future,
    wait_for_service,
    wait_for_subscribers,
    drain,
    wait_for_node,
    wait_for_parameters,
    sleep,
    sleep_until,
    await_a_rate,
]
every_wait = pytest.mark.parametrize("wait", WAITS)


@pytest.fixture(autouse=True)
def others(node: Node) -> None:
    """A service that does not answer, and a reader that does not read."""

    async def never(_request: AddTwoInts.Request) -> AddTwoInts.Response:
        await asyncio.Event().wait()
        raise AssertionError

    node.create_service(AddTwoInts, "/slow", never)
    node.create_subscription(String, "/full", qos_profile=KEEP_ALL)


async def ended(waiting: asyncio.Task[object]) -> BaseException | None:
    """Return the exception that `waiting` has raised."""
    with pytest.raises(END):
        await asyncio.wait_for(waiting, 5)
    return None if waiting.cancelled() else waiting.exception()


@pytest.mark.parametrize("wait", [*WAITS, receive])
async def test_a_task_of_others_gets_an_error_with_that_of_the_node(
    context: Context, wait: Wait
) -> None:
    """Nobody has cancelled the task: a TaskGroup would drop it silently."""
    planner = Node("planner", context=context)
    may_fail = asyncio.Event()

    async def fail() -> None:
        await may_fail.wait()
        raise ValueError("no map")

    planner.create_timer(0.0, fail)
    loop = asyncio.get_running_loop()
    running = loop.create_task(planner.run())
    waiting = loop.create_task(wait(planner))
    await settle()
    may_fail.set()
    with pytest.raises(ExceptionGroup) as failed:
        await running

    error = await ended(waiting)
    assert isinstance(error, EntityDestroyedError)
    assert error.__cause__ is failed.value.exceptions[0]


@pytest.mark.parametrize("wait", [*WAITS, receive])
async def test_a_node_that_ends_well_is_no_cause(context: Context, wait: Wait) -> None:
    """A task that works with another owner's node learns that it has gone."""
    async with Node("planner", context=context) as planner:
        waiting = asyncio.get_running_loop().create_task(wait(planner))
        await settle()

    error = await ended(waiting)
    assert isinstance(error, EntityDestroyedError)
    assert error.__cause__ is None


@every_wait
async def test_the_body_of_a_node_is_cancelled(context: Context, wait: Wait) -> None:
    """It ends with its node."""

    async def work() -> None:
        async with Node("planner", context=context) as planner:
            asyncio.get_running_loop().call_soon(planner.destroy_node)
            await wait(planner)

    with pytest.raises(asyncio.CancelledError):
        await work()


@every_wait
async def test_a_callback_is_cancelled(context: Context, wait: Wait) -> None:
    """It ends with its node, whose end cancels it once and waits for what it does in finally."""
    ends: list[type[BaseException]] = []

    async def work() -> None:
        try:
            await wait(planner)
        except END as end:
            ends.append(type(end))
            raise

    async with Node("planner", context=context) as planner:
        planner.create_timer(0.0, work)
        await settle()

    assert ends == [asyncio.CancelledError]


@every_wait
@pytest.mark.parametrize("cancelled_first", [False, True])
async def test_a_cancellation_in_the_same_moment_counts(
    context: Context, wait: Wait, *, cancelled_first: bool
) -> None:
    """The one who cancels a task relies on it, even if what it waits for is destroyed just then."""
    async with Node("planner", context=context) as planner:
        waiting = asyncio.get_running_loop().create_task(wait(planner))
        await settle()

        if cancelled_first:
            waiting.cancel()
        for entity in list(core_of(planner).entities):
            entity.destroy()
        planner.get_clock().destroy()
        waiting.cancel()
        with pytest.raises(asyncio.CancelledError):
            await waiting


async def test_iterations_end(context: Context) -> None:
    """Items that have arrived are read first, even if the node has failed."""
    async with Node("planner", context=context) as planner:
        words = planner.create_subscription(String, "words")
        rate = planner.create_rate(1)
        events = planner.create_publisher(String, "none", 1).events

        async def all_of(iterable: Any) -> list[Any]:
            return [each async for each in iterable]

        loop = asyncio.get_running_loop()
        planner.create_publisher(String, "words", 1).publish(String(data="last"))
        tasks = [loop.create_task(all_of(each)) for each in (words, rate, events)]
        await checkpoint_of(words)

    assert await asyncio.gather(*tasks) == [[String(data="last")], [], []]


async def checkpoint_of(words: Any) -> None:
    """Let every task run that can."""
    await settle()
    assert words.stats.received == 1


async def test_a_shut_down_context_ends_the_waits_for_its_graph() -> None:
    """Its graph never changes again."""
    context = Context(transport="local")
    async with context:
        change = context.graph.changed("/none")
        loop = asyncio.get_running_loop()
        condition = loop.create_task(context.graph.until(lambda: False, "/none"))
        await settle()

    for wait in (change, condition, context.graph.changed()):
        with pytest.raises(EntityDestroyedError, match="context is destroyed"):
            await wait


async def test_the_end_of_a_node_leaves_the_waits_for_a_graph_that_others_change(
    context: Context, node: Node
) -> None:
    """The graph is the context's."""
    wait = context.graph.changed("/words")
    async with Node("planner", context=context):
        pass
    assert not wait.done()

    node.create_publisher(String, "/words", 1)
    await wait
