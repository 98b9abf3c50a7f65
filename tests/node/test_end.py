"""Tests of how a node ends: callbacks clean up with everything they need before it is gone."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import anyio
import pytest

import aionode
from aionode._process.concurrency import checkpoint, to_the_end
from aionode.action import CancelResponse
from aionode.endpoints.core import shutdown
from aionode.endpoints.core.entity import Entity
from aionode.engine.context import Context
from aionode.engine.transport.base import Registration, Writer
from aionode.engine.transport.local import LocalReader, LocalTransport, LocalWriter
from aionode.errors import EntityDestroyedError
from aionode.graph import NodeInfo
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import Float64
from aionode.node import Node
from aionode.testing import local_context, settle
from tests.support.living import living


def heard_in(node: Node) -> list[float]:
    """Return the speeds that `node` receives, in order."""
    heard: list[float] = []
    node.create_subscription(Float64, "speed", lambda msg: heard.append(msg.data))
    return heard


def by_destroy(node: Node) -> None:
    """End the node with its own method."""
    node.destroy_node()


def by_shutdown(node: Node) -> None:
    """End the node with its context."""
    node.context.shutdown()


@pytest.mark.parametrize("kind", ["timer", "subscription", "service", "goal", "sync"])
async def test_a_callback_can_publish_in_finally(context: Context, node: Node, kind: str) -> None:
    """A handler that drives stops the robot there, so that its last command is not its speed."""
    heard = heard_in(node)
    robot = Node("robot", context=context)
    speed = robot.create_publisher(Float64, "speed", 10)

    async def drive(*_: Any) -> Any:
        try:
            speed.publish(Float64(data=1.0))
            await asyncio.Event().wait()
        finally:
            await robot.get_clock().sleep(0.0)
            await checkpoint()
            speed.publish(Float64(data=0.0))

    def drive_and_end() -> None:
        try:
            speed.publish(Float64(data=1.0))
            robot.destroy_node()
        finally:
            speed.publish(Float64(data=0.0))

    async with robot:
        if kind == "timer":
            robot.create_timer(0.0, drive)
        elif kind == "sync":
            robot.create_timer(0.001, drive_and_end)
        elif kind == "subscription":
            robot.create_subscription(Float64, "go", drive)
            node.create_publisher(Float64, "go", 10).publish(Float64())
        elif kind == "service":
            robot.create_service(AddTwoInts, "go", drive)
            node.create_client(AddTwoInts, "go").call_async(AddTwoInts.Request())
        else:
            accept = CancelResponse.ACCEPT
            robot.create_action_server(Fibonacci, "go", drive, cancel_callback=lambda _goal: accept)
            await node.create_action_client(Fibonacci, "go").send_goal(Fibonacci.Goal())
        async with asyncio.timeout(10):
            while 1.0 not in heard:
                await checkpoint()

    await settle()
    assert heard == [1.0, 0.0]
    assert speed.destroyed


@pytest.mark.parametrize("end", [by_destroy, by_shutdown])
async def test_a_destroyed_node_refuses_at_once_and_leaves_when_callbacks_have_ended(
    end: Callable[[Node], None],
) -> None:
    """No new work begins, and running callbacks keep what they need."""
    async with local_context() as context, Node("robot", context=context) as robot:
        may_end = asyncio.Event()
        speed = robot.create_publisher(Float64, "speed", 10)

        async def drive() -> None:
            try:
                await asyncio.Event().wait()
            finally:
                await may_end.wait()

        robot.create_timer(0.0, drive)
        await settle()

        end(robot)
        await settle()

        with pytest.raises(EntityDestroyedError):
            robot.create_publisher(Float64, "other", 10)
        assert robot.get_node_names() == ["robot"]
        speed.publish(Float64())
        may_end.set()
        await settle()
        assert robot.get_node_names() == []
        with pytest.raises(EntityDestroyedError):
            speed.publish(Float64())


async def test_a_service_can_be_called_in_finally(context: Context, node: Node) -> None:
    """An example is a service that switches the motors off."""
    asked: list[int] = []

    def switch(request: AddTwoInts.Request) -> AddTwoInts.Response:
        asked.append(request.a)
        return AddTwoInts.Response()

    node.create_service(AddTwoInts, "switch", switch)
    async with Node("robot", context=context) as robot:
        client = robot.create_client(AddTwoInts, "switch")

        async def drive() -> None:
            try:
                await asyncio.Event().wait()
            finally:
                await client.call(AddTwoInts.Request(a=7))

        robot.create_timer(0.0, drive)
        await settle()

    assert asked == [7]


async def test_a_failing_callback_does_not_break_off_what_others_do_in_finally(
    context: Context, node: Node
) -> None:
    """The node ends because of one, and the others clean up."""
    heard = heard_in(node)
    robot = Node("robot", context=context)
    speed = robot.create_publisher(Float64, "speed", 10)

    async def drive() -> None:
        try:
            await asyncio.Event().wait()
        finally:
            for _ in range(5):
                await checkpoint()
            speed.publish(Float64(data=0.0))

    async def fail() -> None:
        await checkpoint()
        raise ValueError("broken")

    robot.create_timer(0.0, drive)
    robot.create_timer(0.001, fail)
    with pytest.raises(ExceptionGroup):
        await robot.run()

    await settle()
    assert heard == [0.0]


async def test_an_impatient_caller_does_not_break_off_the_end(context: Context, node: Node) -> None:
    """Scopes of anyio cancel in every iteration of the loop."""
    heard = heard_in(node)
    with anyio.CancelScope() as scope:
        async with Node("robot", context=context) as robot:
            speed = robot.create_publisher(Float64, "speed", 10)

            async def drive() -> None:
                asyncio.get_running_loop().call_soon(scope.cancel)
                try:
                    await asyncio.Event().wait()
                finally:
                    await robot.get_clock().sleep(0.05)
                    speed.publish(Float64(data=0.0))

            robot.create_timer(0.0, drive)
            await asyncio.Event().wait()

    await settle()
    assert heard == [0.0]
    assert not robot.is_running


async def test_a_context_is_closed_although_its_last_node_is_cancelled_again() -> None:
    """Otherwise its connections would stay open."""
    closed: list[bool] = []

    class Slow(LocalTransport):
        async def close(self) -> None:
            for _ in range(5):
                await checkpoint()
            closed.append(True)
            await super().close()

    with anyio.CancelScope() as scope:
        async with Node("robot", context=Context(transport=Slow())):
            scope.cancel()

    assert closed == [True]


async def test_callbacks_that_do_not_end_are_named_and_given_up(
    context: Context, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A program that hangs at its end must say why, and must not hang forever."""
    monkeypatch.setattr(shutdown, "NOTICE_S", 0.01)
    monkeypatch.setattr(shutdown, "CALLBACKS_S", 0.05)

    begun = asyncio.Event()

    async def stubborn() -> None:
        begun.set()
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            await asyncio.Event().wait()

    async with asyncio.timeout(10), Node("robot", context=context) as robot:
        robot.create_timer(1e-3, stubborn)
        await begun.wait()

    err = capsys.readouterr().err
    assert "waits up to 0.05 s for timer of 0.001 s (callback" in err
    assert "stubborn) in" not in err
    assert "the node ends without timer of 0.001 s (callback" in err


async def test_what_runs_to_the_end_gives_its_result_and_its_error() -> None:
    """It behaves as if it were awaited directly."""

    async def fail() -> None:
        raise LookupError("lost")

    async def answer() -> int:
        return 42

    assert await to_the_end(answer()) == 42
    with pytest.raises(LookupError, match="lost"):
        await to_the_end(fail())


async def test_an_error_of_a_cleanup_comes_before_the_cancellation(context: Context) -> None:
    """In Python 3.13 a TaskGroup cancels its task again when it raises: the error was lost."""
    begun = asyncio.Event()

    async def fail_at_the_end() -> None:
        begun.set()
        try:
            await asyncio.Event().wait()
        finally:
            raise LookupError("lost")

    node = Node("robot", context=context)
    node.create_timer(1e-3, fail_at_the_end)
    running = asyncio.get_running_loop().create_task(node.run())
    await begun.wait()
    running.cancel()

    with pytest.raises(ExceptionGroup) as caught:
        await running
    assert caught.group_contains(LookupError)


# Nodes that cannot be made


class Refusing(LocalTransport):
    """Refuses to create one kind of object."""

    def __init__(self, refused: str) -> None:
        super().__init__()
        self.refused = refused

    def create_node(self, node: NodeInfo) -> Registration:
        """Refuse, or create it."""
        if self.refused == "node":
            raise ConnectionError("no more nodes")
        return super().create_node(node)

    def create_writer(self, *args: Any) -> Writer:
        """Refuse, or not."""
        if self.refused == "writer":
            raise ConnectionError("no more writers")
        return super().create_writer(*args)


@pytest.mark.parametrize("refused", ["node", "writer"])
async def test_half_a_node_does_not_stay_in_its_context(refused: str) -> None:
    """The cause is raised, and the context can be used and closed."""
    writers, readers = living(LocalWriter), living(LocalReader)
    first = LocalTransport()
    transport = Refusing(refused)
    async with Context(transport=[first, transport]) as context:
        with pytest.raises(ConnectionError, match=f"no more {refused}s"):
            Node("robot", context=context)
        assert "nodes=0" in repr(context)
        assert not context.graph.nodes()
        assert living(LocalWriter) <= writers
        assert living(LocalReader) <= readers

        transport.refused = ""
        async with Node("robot", context=context) as robot:
            assert robot.get_node_names() == ["robot"]


def test_entities_end_by_destroy_alone() -> None:
    """Completion would offer a second method that ends half of one, and people would use it."""
    kinds = [
        aionode.Publisher,
        aionode.Subscription,
        aionode.Service,
        aionode.Client,
        aionode.Timer,
        aionode.Rate,
        aionode.ActionServer,
        aionode.ActionClient,
    ]
    for kind in kinds:
        assert issubclass(kind, Entity)
        assert not hasattr(kind, "close"), kind


async def test_a_node_that_fails_in_a_task_of_its_own_logs_one_error(
    node: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """In a notebook, nobody awaits the task before the last cell."""

    def tick() -> None:
        raise ValueError("no map")

    robot = Node("robot", context=node.context)
    timer = robot.create_timer(0.0, tick)
    running = asyncio.create_task(robot.run())  # noqa: TID251  # as in a notebook
    await asyncio.wait([running])

    (line,) = caplog.records
    assert (line.levelname, line.name) == ("ERROR", "ros.robot")
    assert line.getMessage() == (
        "the node failed and has ended: ValueError: no map, in timer of 0 s (callback "
        f"{tick.__qualname__}) of node /robot. To get the exception, await the task of run()"
    )
    assert timer.destroyed
    assert running.exception() is not None


async def test_a_node_that_fails_in_the_task_of_its_caller_logs_nothing(
    node: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """The caller gets the exception."""
    robot = Node("robot", context=node.context)
    robot.create_timer(0.0, lambda: 1 / 0)

    with pytest.raises(ExceptionGroup):
        await robot.run()

    assert caplog.records == []
