"""The publishers of a topic that leave, are lost, return, or send late messages."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from aionode.clock import Duration, SteadyClock, Time, perf_ns
from aionode.endpoints.core import silence_watch
from aionode.engine.context import Context
from aionode.engine.transport.local import LocalTransport
from aionode.engine.wire.typehash import type_hash
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.std_msgs.msg import Int32
from aionode.qos import HistoryPolicy, QoSProfile
from aionode.testing import FaultyTransport, ManualClock, settle
from tests.support.arrivals import reader_of
from tests.support.peers import quiet_node
from tests.support.waiting import until

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from aionode.endpoints.subscription import Subscription
    from aionode.node import Node

MACHINE = SteadyClock()


@pytest.fixture
def clock() -> ManualClock:
    """The time, stepped by the tests."""
    return ManualClock(Time(seconds=1000))


@pytest.fixture
def network(clock: ManualClock) -> FaultyTransport:
    """The transport of the messages; a test sets its faults."""
    return FaultyTransport(LocalTransport(), clock=clock)


@pytest.fixture
async def node(clock: ManualClock, network: FaultyTransport) -> AsyncIterator[Node]:
    """A node whose messages to itself use that transport."""
    async with quiet_node("node", Context(transport=network, clock=clock)) as node:
        yield node


# Messages that are late


async def test_a_message_of_before_the_silence_never_comes_after_it(
    node: Node, network: FaultyTransport, clock: ManualClock
) -> None:
    """It was delayed in transit; one that is published later is a new command."""
    log: list[object] = []
    subscription = node.create_subscription(
        Int32, "n", lambda msg: log.append(msg.data), on_silence=lambda: log.append("stop")
    )
    publisher = node.create_publisher(Int32, "n", 10)
    publisher.publish(Int32(data=1))
    await clock.advance(0.1)
    network.delay = 2
    for number in (2, 3):
        publisher.publish(Int32(data=number))
        await clock.advance(0.05)
    assert log == [1]
    await clock.advance(1)
    assert log == [1, "stop"]
    await clock.advance(0.98)
    assert log == [1, "stop"]
    assert subscription.stats.dropped == 2
    publisher.publish(Int32(data=4))
    await clock.advance(2)
    assert log == [1, "stop", 4]


@pytest.mark.parametrize("by_s", [-3600, 3600])
async def test_the_clock_of_another_host_may_be_wrong(
    node: Node, clock: ManualClock, by_s: int
) -> None:
    """What matters is how much later one message was published than another."""
    log: list[object] = []
    subscription = node.create_subscription(
        Int32, "n", lambda msg: log.append(msg.data), on_silence=lambda: log.append("stop")
    )

    def come(number: int, published_s: float) -> None:
        stamp = round((published_s + by_s) * 1e9)
        reader_of(subscription).deliver(Int32(data=number), b"g" * 16, number, stamp)

    began_s = clock.now().nanoseconds / 1e9
    for number in range(3):
        come(number, began_s + number * 0.1)
        await clock.advance(0.1)
    await clock.advance(5)
    assert log == [0, 1, 2, "stop"]
    come(3, began_s + 0.3)
    come(4, began_s + 0.4)
    come(5, began_s + 5)
    await settle()
    assert log == [0, 1, 2, "stop", 5]
    assert subscription.stats.dropped == 2


# Publishers of other processes


class Elsewhere:
    """A publisher in another context, which the graph shows."""

    def __init__(self, node: Node, subscription: Subscription[Int32]) -> None:
        self.graph = node.graph
        self.subscription = subscription
        self.node = NodeInfo("abcdef", 0, "teleop", "/")
        self.info = EndpointInfo(
            EndpointKind.PUBLISHER,
            self.node,
            1,
            "/n",
            "std_msgs/msg/Int32",
            type_hash(Int32),
            QoSProfile(depth=10).resolved(),
            b"g" * 16,
        )
        self.linked: bool | None = None
        self.looked = asyncio.Event()  # since the watch asked whether the publisher is linked
        self.appear()

    def is_linked(self, _: bytes) -> bool | None:
        """Answer the watch of the subscription."""
        self.looked.set()
        return self.linked

    def appear(self) -> None:
        """Announce it."""
        self.graph.add_node(self.node)
        self.graph.add_endpoint(self.info)

    def vanish(self) -> None:
        """Withdraw it, like a process whose connection has ended."""
        self.graph.remove_endpoint(self.info)
        self.graph.remove_node(self.node)

    async def command(self) -> None:
        """Publish a message, which is handled."""
        reader_of(self.subscription).deliver(Int32(), self.info.gid, 1, 0)
        await settle()


@pytest.fixture
def stops(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The calls of `on_silence`; waiting in real time takes a few milliseconds."""
    monkeypatch.setattr(silence_watch, "MOMENT_S", 0.005)
    monkeypatch.setattr(silence_watch, "RETURN_S", 0.05)
    return []


@pytest.fixture
async def elsewhere(node: Node, stops: list[str]) -> Elsewhere:
    """A publisher from which messages have arrived."""
    subscription = node.create_subscription(
        Int32, "n", lambda _: None, on_silence=lambda: stops.append("stop"), silence_sec=60
    )
    found = Elsewhere(node, subscription)
    assert subscription._silence_watch is not None
    subscription._silence_watch._is_linked = found.is_linked
    await found.command()
    return found


async def passes() -> None:
    """Wait for longer than a process may take to return."""
    await MACHINE.sleep(0.1)


async def test_a_publisher_that_is_withdrawn_stops_the_wheels(
    elsewhere: Elsewhere, stops: list[str]
) -> None:
    """Its node is still there, so nothing was lost in transit."""
    elsewhere.graph.remove_endpoint(elsewhere.info)
    await until(lambda: stops)
    assert stops == ["stop"]


async def test_a_process_that_is_lost_stops_the_wheels(
    elsewhere: Elsewhere, stops: list[str]
) -> None:
    """After the time in which it might return."""
    elsewhere.vanish()
    await elsewhere.looked.wait()
    assert stops == []
    await until(lambda: stops)
    assert stops == ["stop"]


async def test_a_process_whose_link_has_ended_too_stops_the_wheels_sooner(
    elsewhere: Elsewhere, stops: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A link only ends with its process, so there is nothing to wait for."""
    monkeypatch.setattr(silence_watch, "RETURN_S", 3600)
    elsewhere.linked = False
    elsewhere.vanish()
    await until(lambda: stops)
    assert stops == ["stop"]


async def test_a_process_that_is_linked_is_not_lost(elsewhere: Elsewhere, stops: list[str]) -> None:
    """Zenoh has lost it, but its commands arrive over the link."""
    elsewhere.linked = True
    elsewhere.vanish()
    await passes()
    assert stops == []


async def test_a_process_that_returns_was_not_lost(elsewhere: Elsewhere, stops: list[str]) -> None:
    """The recovery has cut its connection, and Zenoh has re-established it."""
    elsewhere.vanish()
    await elsewhere.looked.wait()
    elsewhere.appear()
    await passes()
    assert stops == []


@pytest.mark.parametrize("first", ["router", "process"])
async def test_a_process_that_goes_with_a_router_is_out_of_reach(
    elsewhere: Elsewhere, stops: list[str], first: str
) -> None:
    """The router is restarted: only silence counts."""
    if first == "router":
        elsewhere.graph.router_lost_ns = perf_ns()
    elsewhere.vanish()
    if first == "process":
        elsewhere.graph.router_lost_ns = perf_ns()
    await passes()
    assert stops == []


async def test_a_silence_ends_the_search_for_a_publisher(
    elsewhere: Elsewhere, stops: list[str], clock: ManualClock
) -> None:
    """It is noticed once: by the time that has passed, or by the loss."""
    elsewhere.vanish()
    await clock.advance(60)
    await passes()
    assert stops == ["stop"]


async def test_many_publishers_are_not_remembered(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Anything from the network is bounded."""
    monkeypatch.setattr(silence_watch, "REMEMBERED_PUBLISHERS", 3)
    subscription = node.create_subscription(
        Int32, "n", lambda _: None, on_silence=lambda: None, silence_sec=60
    )
    for number in range(10):
        reader_of(subscription).deliver(Int32(), bytes([number]) * 16, 1, 0)
    await settle()
    assert subscription._silence_watch is not None
    assert len(subscription._silence_watch._heard) == 3


async def test_a_lifespan_and_a_silence_go_together(node: Node, clock: ManualClock) -> None:
    """An expired message does not count; the policy's monitor is asked first."""
    log: list[object] = []
    profile = QoSProfile(depth=10, lifespan=Duration(seconds=1), history=HistoryPolicy.KEEP_LAST)
    subscription = node.create_subscription(
        Int32,
        "n",
        lambda msg: log.append(msg.data),
        profile,
        on_silence=lambda: log.append("stop"),
    )
    began_ns = clock.now().nanoseconds
    reader_of(subscription).deliver(Int32(data=1), b"g" * 16, 1, began_ns - 2 * 10**9)
    await clock.advance(1)
    assert log == []
    assert subscription.stats.expired == 1
    reader_of(subscription).deliver(Int32(data=2), b"g" * 16, 2, clock.now().nanoseconds)
    await clock.advance(0.3)
    assert log == [2, "stop"]
