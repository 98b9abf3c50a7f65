"""Which way messages take, as statistics say it, and what contexts announce of their links."""

from __future__ import annotations

import asyncio

from aionode.context import Context
from aionode.interfaces.std_msgs.msg import Int32
from tests.peers import kept, quiet_node, raw_session
from tests.transport.test_link import (
    Counting,
    folder,
    link_of,
    two_nodes,
    writer_of,
)

__all__ = ["folder"]  # a fixture


async def test_a_subscription_of_another_context_is_reached_by_zenoh() -> None:
    """Beside one of this context, which is reached without."""
    async with (
        asyncio.timeout(30),
        Context(link=False) as first,
        Context(link=False) as second,
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        readers = [node.create_subscription(Int32, "n") for node in (a, b)]
        publisher = a.create_publisher(Int32, "n", 10)
        await publisher.wait_for_subscribers(2)
        assert publisher.stats.ways == {
            f"/a {readers[0].endpoint.gid.hex()[:8]}": "local",
            f"/b {readers[1].endpoint.gid.hex()[:8]}": "zenoh",
        }


async def test_a_linked_subscription_is_reached_both_ways_while_a_stranger_listens() -> None:
    """And by the link alone otherwise."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        assert list(numbers.publisher.stats.ways.values()) == ["link"]
        with raw_session():
            while not writer_of(numbers.publisher).update():
                await numbers.go()
            assert list(numbers.publisher.stats.ways.values()) == ["link and zenoh"]


async def test_what_late_readers_get_goes_by_zenoh() -> None:
    """Zenoh keeps it for them, whoever is linked."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        late = nodes.a.create_publisher(Int32, "late", kept(1))
        nodes.b.create_subscription(Int32, "late", None, kept(1))
        await late.wait_for_subscribers()
        await numbers.until_linked()
        assert list(late.stats.ways.values()) == ["zenoh"]


async def test_a_publisher_counts_what_a_slow_link_dropped() -> None:
    """The other end cannot: it has not seen it."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes, 10)
        await numbers.until_linked()
        assert numbers.publisher.stats.dropped == 0
        asyncio.get_running_loop().remove_reader(link_of(nodes.b)._fd)  # as if it were frozen
        numbers.publish(20_000)
        dropped = numbers.publisher.stats.dropped
        assert 0 < dropped < 20_000
        assert f"dropped={dropped}, ways={{'/b " in repr(numbers.publisher.stats)
