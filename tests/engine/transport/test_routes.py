"""The routes of messages in statistics, and what contexts announce about their links."""

from __future__ import annotations

from aionode._process.concurrency import checkpoint
from aionode.engine.context import Context
from aionode.engine.transport.base import LinkStatus
from aionode.engine.transport.local import LocalTransport
from aionode.interfaces.std_msgs.msg import Int32
from aionode.testing import FaultyTransport
from tests.support.arrivals import reader_of
from tests.support.links import (
    Counting,
    folder,
    freeze,
    link_of,
    manager_of,
    transport_of,
    two_nodes,
    writer_of,
)
from tests.support.peers import kept, raw_session

__all__ = ["folder"]  # a fixture


async def test_a_subscription_of_another_context_is_reached_by_zenoh() -> None:
    """A subscription in the same context is reached without Zenoh."""
    async with two_nodes(links=(False, False)) as nodes:
        readers = [node.create_subscription(Int32, "n") for node in nodes]
        publisher = nodes.a.create_publisher(Int32, "n", 10)
        await publisher.wait_for_subscribers(2)
        assert publisher.stats.routes == {
            f"/a {reader_of(readers[0]).endpoint.gid.hex()[:8]}": "local",
            f"/b {reader_of(readers[1]).endpoint.gid.hex()[:8]}": "zenoh",
        }


async def test_a_linked_subscription_is_reached_both_ways_beside_an_unannounced_peer() -> None:
    """Otherwise only the link is used."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        assert list(numbers.publisher.stats.routes.values()) == ["link"]
        with raw_session():
            await numbers.go_until(writer_of(numbers.publisher).routes.update)
            assert list(numbers.publisher.stats.routes.values()) == ["link and zenoh"]


async def test_what_late_readers_get_goes_by_zenoh() -> None:
    """Zenoh keeps the messages for late readers, with or without links."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        late = nodes.a.create_publisher(Int32, "late", kept(1))
        nodes.b.create_subscription(Int32, "late", None, kept(1))
        await late.wait_for_subscribers()
        await numbers.until_linked()
        assert list(late.stats.routes.values()) == ["zenoh"]


async def test_a_publisher_counts_what_a_slow_link_dropped() -> None:
    """The other end cannot count what it never received."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes, 10)
        await numbers.until_linked()
        assert numbers.publisher.stats.dropped == 0
        freeze(link_of(nodes.b))
        numbers.publish(20_000)
        dropped = numbers.publisher.stats.dropped
        assert 0 < dropped < 20_000
        assert f"dropped={dropped}, routes={{'/b " in repr(numbers.publisher.stats)


# What contexts announce


async def links_seen_by(context: Context) -> LinkStatus:
    """Return the links announced to a context."""
    _, transport, _ = context.transports
    return await transport.link_status()


async def test_contexts_that_ask_are_told_of_a_link_while_it_is_there() -> None:
    """Including a context that has no link itself."""
    async with Context(link=False) as aside, two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        both = frozenset(node.context.participant for node in nodes)
        while (seen := await links_seen_by(aside)).pairs != {both}:
            await numbers.go()
        assert {text.partition("/")[0] for text in seen.advertisements} == both
        assert await links_seen_by(nodes.a.context) == seen

        nodes.b.destroy_node()
        transport_of(nodes.b).manager.close()
        while (await links_seen_by(aside)).pairs:
            await checkpoint()


async def test_contexts_that_ask_are_told_of_a_link_that_comes_again() -> None:
    """By then both ends have noticed the end of the first one."""
    async with Context(link=False) as aside, two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        first = link_of(nodes.a)
        first.close()
        while first in [manager_of(nodes.a).linked(p) for p in manager_of(nodes.a).links]:
            await numbers.go()
        await numbers.until_linked()
        both = frozenset(node.context.participant for node in nodes)
        assert (await links_seen_by(aside)).pairs == {both}


async def test_a_context_that_is_closed_or_has_no_network_knows_of_no_links() -> None:
    """There is no other process to ask."""
    closed = Context(link=True)
    assert await links_seen_by(closed) == LinkStatus(set(), set())
    assert await FaultyTransport(LocalTransport()).link_status() == LinkStatus(set(), set())
