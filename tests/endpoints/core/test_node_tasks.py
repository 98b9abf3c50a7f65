"""The tasks that belong to a node, and how their waits end."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from aionode.endpoints.core.node_core import core_of
from aionode.errors import EntityDestroyedError
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import settle

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine
    from typing import Any

    from aionode.engine.context import Context

End = asyncio.CancelledError | EntityDestroyedError


def end_in(node: Node) -> End:
    """Return how a wait of the current task ends."""
    return core_of(node).tasks.end_of_wait("client of /add")


async def end_of(node: Node) -> End:
    """Return how a wait of the task of this coroutine ends."""
    return end_in(node)


@pytest.mark.parametrize("concurrent", [False, True])
async def test_a_callback_and_the_body_are_cancelled(node: Node, *, concurrent: bool) -> None:
    """They end with their node, as a task of a TaskGroup does."""
    ends: list[End] = []

    async def take(_msg: String) -> None:
        ends.append(end_in(node))

    node.create_subscription(String, "words", take, concurrent=concurrent)
    node.create_publisher(String, "words", 1).publish(String())
    await settle()

    assert [str(end) for end in ends] == ["client of /add: destroyed"]
    assert isinstance(ends[0], asyncio.CancelledError)


async def test_a_task_that_a_callback_starts_is_cancelled(node: Node) -> None:
    """It would otherwise report an error at every end, for example after `asyncio.shield`."""
    ends: list[End] = []

    async def take(_msg: String) -> None:
        ends.extend(await asyncio.gather(asyncio.shield(end_of(node))))

    node.create_subscription(String, "words", take)
    node.create_publisher(String, "words", 1).publish(String())
    await settle()

    assert isinstance(ends[0], asyncio.CancelledError)


class Working(Node):
    """Starts a task in its constructor."""

    def __init__(self, context: Context) -> None:
        super().__init__("working", context=context)
        self.work = asyncio.get_running_loop().create_task(end_of(self))


class WorkingMore(Working):
    """Starts another one after that."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.more = asyncio.get_running_loop().create_task(end_of(self))


async def test_a_task_that_the_constructor_starts_is_cancelled(aionode_context: Context) -> None:
    """Otherwise a program that works in such a task would end every Ctrl-C with a traceback."""
    node = WorkingMore(aionode_context)

    assert isinstance(await node.work, asyncio.CancelledError)
    assert isinstance(await node.more, asyncio.CancelledError)
    assert isinstance(end_in(node), EntityDestroyedError)


async def test_a_callback_of_another_node_is_not_one_of_this_node(
    node: Node, node_factory: Callable[..., Node]
) -> None:
    """Even if the other node, or its subscription, was created in a callback of this one."""
    ends: list[End] = []

    def make(_msg: String) -> None:
        other = node_factory("other")
        other.create_subscription(String, "words", lambda _msg: ends.append(end_in(node)))

    node.create_subscription(String, "make", make)
    node.create_publisher(String, "make", 1).publish(String())
    await settle()
    node.create_publisher(String, "words", 1).publish(String())
    await settle()

    assert isinstance(ends[0], EntityDestroyedError)


async def test_the_body_of_a_node_is_cancelled(aionode_context: Context) -> None:
    """It is the task that runs the node."""
    async with Node("planner", context=aionode_context) as node:
        assert isinstance(end_in(node), asyncio.CancelledError)


async def test_other_tasks_get_an_error(aionode_context: Context) -> None:
    """Including those that the body starts: nobody has cancelled them."""
    async with Node("planner", context=aionode_context) as node, asyncio.TaskGroup() as tasks:
        asked = tasks.create_task(end_of(node))

    assert isinstance(asked.result(), EntityDestroyedError)
    assert asked.result().__cause__ is None


async def by_a_callback(node: Node) -> None:
    """Fail in a callback."""

    def fail() -> None:
        raise ValueError("no map")

    node.create_timer(0.0, fail)
    await node.until_destroyed()


async def by_the_body(_node: Node) -> None:
    """Fail in the body."""
    raise ValueError("no map")


@pytest.mark.parametrize("fail", [by_a_callback, by_the_body])
async def test_the_error_of_a_failed_node_is_the_cause(
    aionode_context: Context, fail: Callable[[Node], Coroutine[Any, Any, None]]
) -> None:
    """The one who waits learns why the node has gone, without the group around it."""
    node = Node("planner", context=aionode_context)
    with pytest.raises((ValueError, ExceptionGroup)):
        async with node:
            await fail(node)

    async with asyncio.TaskGroup() as tasks:
        asked = tasks.create_task(end_of(node))

    assert repr(asked.result().__cause__) == "ValueError('no map')"
