"""Threads that borrow the event loop of a context and send over its links."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator
from concurrent.futures import Future
from contextlib import asynccontextmanager

from aionode import Context
from aionode._process.concurrency import checkpoint
from aionode._process.lendable_loop import LendableLoop
from aionode.engine.bare_node import BareNode, BarePublisher
from aionode.interfaces.std_msgs.msg import Int32
from aionode.qos import QoSProfile
from tests.support.arrivals import writers_of
from tests.support.links import folder
from tests.support.peers import quiet_node

__all__ = ["folder"]  # a fixture


@asynccontextmanager
async def publisher_elsewhere() -> AsyncIterator[tuple[LendableLoop, BarePublisher]]:
    """Run a context with a publisher in a separate thread, whose loop can be borrowed."""
    made: Future[tuple[LendableLoop, asyncio.Event, BarePublisher]] = Future()

    async def main() -> None:
        async with Context() as context:
            publisher = BareNode(context, "a").create_publisher(Int32, "/n", QoSProfile(depth=1000))
            loop, stop = asyncio.get_running_loop(), asyncio.Event()
            assert isinstance(loop, LendableLoop)
            made.set_result((loop, stop, publisher))
            await stop.wait()

    def run() -> None:
        with asyncio.Runner(loop_factory=LendableLoop) as runner:
            runner.run(main())

    thread = threading.Thread(target=run)
    thread.start()
    loop, stop, publisher = await asyncio.wrap_future(made)
    yield loop, publisher
    loop.call_soon_threadsafe(stop.set)
    await asyncio.to_thread(thread.join)


async def test_messages_of_a_borrower_arrive_in_order_over_whatever_route() -> None:
    """Even while the link is in use, in bursts, and while the socket is full."""
    async with (
        asyncio.timeout(30),
        publisher_elsewhere() as (loop, publisher),
        quiet_node("b", Context()) as b,
    ):
        subscription = b.create_subscription(Int32, "/n", None, 1000)
        sent = 0

        def send(count: int) -> None:
            nonlocal sent
            while not loop.borrow():
                threading.Event().wait(0.001)
            try:
                for _ in range(count):
                    publisher.publish(Int32(data=sent), 1)
                    sent += 1
            finally:
                loop.give_back()

        while not publisher.matched():
            await checkpoint()
        got: list[int] = []
        routes: set[str | None] = set()
        while not ("link" in routes and sent >= 3000):
            await asyncio.to_thread(send, 200)
            (reader,) = publisher.matched()
            routes.update(writer.route_of(reader) for writer in writers_of(publisher)[1:])
            while len(got) < sent:
                got.append((await subscription.receive()).data)

        assert got == list(range(sent))
