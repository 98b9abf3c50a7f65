"""The stop of a lease over a link whose socket is full."""

from __future__ import annotations

import asyncio

from aionode.interfaces.std_msgs.msg import Int32
from tests.support.arrivals import gid_of
from tests.support.links import Counting, folder, freeze, link_of, thaw, two_nodes

__all__ = ["folder"]

STOP = Int32(data=-1)


async def test_the_stop_passes_a_full_socket() -> None:
    """Messages waiting before it are dropped and counted; Zenoh carries it past the socket."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes, 20_000)
        await numbers.until_linked()
        end, other = link_of(nodes.a), link_of(nodes.b)
        freeze(other)
        async with numbers.publisher.lease(stop=STOP, ttl_sec=60.0) as lease:
            for number in range(20_000):
                lease.publish(Int32(data=number))
            (waiting,) = end.queues
        assert waiting.unsent - end.unsent(gid_of(nodes.a, "/n")) == 1
        assert numbers.publisher.stats.dropped

        async for msg in numbers.subscription:
            if msg.data == STOP.data:
                break

        thaw(other)
        await numbers.publisher.drain()
        numbers.publisher.publish(Int32(data=7))
        async with asyncio.timeout(10):
            assert (await numbers.subscription.receive()).data == 7
