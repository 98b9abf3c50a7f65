"""The stop of a lease over a link whose socket is full."""

from __future__ import annotations

import asyncio

from aionode.interfaces.std_msgs.msg import Int32
from tests.support.links import Counting, folder, link_of, two_nodes, writer_of

__all__ = ["folder"]

STOP = Int32(data=-1)


async def test_the_stop_passes_a_full_socket() -> None:
    """What waits before it is dropped and counted; Zenoh brings it past what the socket holds."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes, 20_000)
        await numbers.until_linked()
        (send_queue,) = writer_of(numbers.publisher)._send_queues.values()
        loop, other = asyncio.get_running_loop(), link_of(nodes.b)
        loop.remove_reader(other._fd)  # as a process that reads nothing
        async with numbers.publisher.lease(stop=STOP, ttl_sec=60.0) as lease:
            for number in range(20_000):
                lease.publish(Int32(data=number))
            assert send_queue.waits
        assert len(send_queue._waiting) == 1
        assert send_queue.dropped

        async for msg in numbers.subscription:
            if msg.data == STOP.data:
                break

        loop.add_reader(other._fd, other._on_readable)
        await numbers.publisher.drain()
        numbers.publisher.publish(Int32(data=7))
        async with asyncio.timeout(10):
            assert (await numbers.subscription.receive()).data == 7
