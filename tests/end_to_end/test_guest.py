"""Whatever happens, a program's own resources are left as they were."""

from __future__ import annotations

import asyncio
import signal
import sys
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

import pytest

from aionode.action import ServerGoalHandle
from aionode.engine.context import Context
from aionode.engine.transport.zenoh._defects import forgotten_peers, lingering
from aionode.engine.transport.zenoh._session_state import SessionState
from aionode.engine.transport.zenoh.connections import sockets as _sockets
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node
from tests.end_to_end.process import Process
from tests.support.guest import guest
from tests.support.links import Counting, Two, folder, link_of, two_nodes, writer_of
from tests.support.peers import quiet_node, ros_router

if TYPE_CHECKING:
    from collections.abc import AsyncIterator
    from pathlib import Path

__all__ = ["folder"]

pytestmark = [
    pytest.mark.one_loop,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc"),
]

Fibonacci.Result()  # loads numpy, which filters warnings of its own

ROUTES = ("local", "link", "zenoh")

PEER = """
import asyncio, sys
from aionode import Context
from tests.support.peers import quiet_node
async def main():
    async with Context(link=sys.argv[1] == "link") as context, quiet_node("peer", context) as node:
        from aionode.interfaces.std_msgs.msg import Int32
        node.create_subscription(Int32, "frozen", lambda _: None, 10)
        print("up", flush=True)
        await asyncio.Event().wait()
asyncio.run(main())
"""
"""Another process, with a subscription, until it is killed."""


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Check for sockets and lost peers as early as possible: no other process uses these ports."""
    monkeypatch.setattr(lingering, "SETTLE_S", 0.0)
    monkeypatch.setattr(forgotten_peers, "FIRST_S", 0.1)
    monkeypatch.setattr(forgotten_peers, "SURE_S", 0.05)


@asynccontextmanager
async def nodes_over(route: str) -> AsyncIterator[Two]:
    """Two nodes that are connected by one kind of transport."""
    if route != "local":
        async with two_nodes(links=(route == "link",) * 2) as nodes:
            yield nodes
        return
    async with (
        Context(transport="local") as context,
        quiet_node("a", context) as a,
        quiet_node("b", context) as b,
    ):
        yield Two(a, b)


async def exchange(nodes: Two) -> Counting:
    """Send messages, and call."""
    counting = Counting(nodes)
    await counting.publisher.wait_for_subscribers()
    await counting.go(5)
    service = nodes.b.create_service(AddTwoInts, "add", add)
    client = nodes.a.create_client(AddTwoInts, "add")
    await client.wait_for_service()
    assert (await client.call(AddTwoInts.Request(a=1, b=2))).sum == 3
    client.destroy()
    service.destroy()
    return counting


def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
    """Add two numbers."""
    response.sum = request.a + request.b
    return response


def fail(_: Int32) -> None:
    """Fail, as a callback of a program may."""
    raise RuntimeError("a mistake of the program")


def cut_connections(node: Node) -> None:
    """End all connections of a node's Zenoh session, as a network does."""
    transport: Any = node.context.transports[1]
    state: SessionState = getattr(transport, "zenoh", transport).session_state
    assert state.session is not None
    own = _sockets.connections(state.session)
    assert own
    _sockets.cut(own)


@pytest.mark.parametrize("route", ROUTES)
async def test_a_start_and_an_end_leave_the_process_as_it_was(route: str, tmp_path: Path) -> None:
    """Twice, since a context may be reopened."""
    with guest(tmp_path):
        for _ in range(2):
            async with nodes_over(route) as nodes:
                await exchange(nodes)


@pytest.mark.parametrize("route", ROUTES)
async def test_a_node_that_fails_leaves_the_process_as_it_was(route: str, tmp_path: Path) -> None:
    """Its error ends everything at once."""
    with guest(tmp_path), pytest.raises(ExceptionGroup):
        await fail_over(route)


async def work(_: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
    """Never finish by itself."""
    await asyncio.Event().wait()
    return Fibonacci.Result()


async def fail_over(route: str) -> None:
    """Run nodes, one of which fails at a message while a goal runs and a call is pending."""
    async with nodes_over(route) as nodes:
        await exchange(nodes)
        nodes.b.create_action_server(Fibonacci, "work", execute_callback=work)
        client = nodes.a.create_action_client(Fibonacci, "work")
        await client.wait_for_server()
        goal = await client.send_goal(Fibonacci.Goal(order=5))
        assert goal.accepted
        nodes.b.create_subscription(Int32, "mistakes", fail, 10)
        publisher = nodes.a.create_publisher(Int32, "mistakes", 10)
        await publisher.wait_for_subscribers()
        publisher.publish(Int32())
        await asyncio.Event().wait()


@pytest.mark.parametrize("route", ["link", "zenoh"])
async def test_a_lost_connection_and_its_recovery_leave_the_process_as_it_was(
    route: str, tmp_path: Path
) -> None:
    """Beside a router: after one lost connection, all locks of the process were gone."""
    router = await asyncio.to_thread(ros_router)
    try:
        with guest(tmp_path):
            async with nodes_over(route) as nodes:
                counting = await exchange(nodes)
                if route == "link":
                    await counting.go_until(lambda: writer_of(counting.publisher).linked)
                    link_of(nodes.a).close(ConnectionResetError())
                await asyncio.to_thread(cut_connections, nodes.a)
                await counting.go_until(lambda: True)
    finally:
        await asyncio.to_thread(router.close)


@pytest.mark.parametrize("route", ["link", pytest.param("zenoh", marks=pytest.mark.slow)])
async def test_an_end_beside_a_frozen_peer_leaves_the_process_as_it_was(
    route: str, tmp_path: Path
) -> None:
    """Only its connections are cut."""
    with Process("-c", PEER, route) as peer:
        await asyncio.to_thread(peer.expect, "up")
        with guest(tmp_path):
            async with nodes_over(route) as nodes:
                await exchange(nodes)
                publisher = nodes.a.create_publisher(Int32, "frozen", 10)
                await publisher.wait_for_subscribers()
                peer.send(signal.SIGSTOP)
                publisher.publish(Int32())


@pytest.mark.parametrize(
    "end",
    [
        "SIGINT",
        "return",
        *(pytest.param(end, marks=pytest.mark.slow) for end in ("SIGTERM", "failure")),
    ],
)
def test_a_program_is_left_as_it_was_when_run_returns(end: str, tmp_path: Path) -> None:
    """It may continue with its own signal handlers, `gc` settings and loggers."""
    with Process("tests/end_to_end/guest_member.py", str(tmp_path), end, fresh=True) as program:
        program.expect("runs")
        if end.startswith("SIG"):
            program.send(signal.Signals[end])
        program.expect("as before")
        assert program.wait() == 0
