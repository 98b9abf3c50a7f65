"""The other process, which answers everything."""

from __future__ import annotations

import asyncio
import mmap
import time
from collections.abc import Callable
from typing import Any

from aionode import Node
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Int32, String
from benchmarks.ipc_parts.common import (
    BURST,
    SIZE,
    Run,
    lines,
    node_of,
    raw_session,
    read_all,
    shared_memory,
    zenoh_pair,
)


class SocketEcho(asyncio.Protocol):
    """The other end."""

    def connection_made(self, transport: Any) -> None:
        """Send back whatever arrives."""
        self.write = transport.write

    def data_received(self, data: bytes) -> None:
        """Send it back."""
        self.write(data)


class SocketThrow(SocketEcho):
    """The other end for bursts."""

    def data_received(self, data: bytes) -> None:  # noqa: ARG002  # anything begins
        """Send a burst."""
        for _ in range(BURST):
            self.write(bytes(SIZE))


class MemoryEcho(SocketEcho):
    """The other end for memory mapped by both."""

    def __init__(self, buffer: mmap.mmap) -> None:
        self._memory = buffer

    def data_received(self, data: bytes) -> None:
        """Read all of it, and answer."""
        read_all(self._memory)
        self.write(data)


async def echo(place: Run) -> None:
    """Answer everything until stdin is closed."""
    loop = asyncio.get_running_loop()
    buffer = shared_memory(place.folder)
    protocols: dict[str, Callable[[], Any]] = {
        "raw": SocketEcho,
        "throw": SocketThrow,
        "image": lambda: MemoryEcho(buffer),
    }
    servers = [
        await loop.create_unix_server(protocol, f"{place.folder}/{name}")
        for name, protocol in protocols.items()
    ]
    session = raw_session(place.port, listen=True)
    answer: list[Callable[[], object]] = []
    answer.append(zenoh_pair(session, "raw/ping", "raw/pong", lambda: answer[0]()))  # noqa: PLW0108  # made below
    throw: list[Callable[[], object]] = []
    throw.append(
        zenoh_pair(session, "raw/throw", "raw/burst", lambda: [throw[0]() for _ in range(BURST)])
    )
    async with (
        place.context(0, link=False) as plain,
        place.context(1, link=True) as linked,
        node_of("echo", plain) as first,
        node_of("echo", linked) as second,
    ):
        for node in (first, second):
            answer_all(node)
        await lines(lambda _: "")
    session.close()
    for server in servers:
        server.close()


def answer_all(node: Node) -> None:
    """Create the objects that answer the balls, calls, images and bursts of the other process."""
    pongs = node.create_publisher(String, "pong", 10)
    node.create_subscription(String, "ping", pongs.publish, 10)
    seen = node.create_publisher(Int32, "seen", 10)
    node.create_subscription(
        Image, "images", lambda msg: seen.publish(Int32(data=read_all(msg.data) % 2)), 10
    )
    node.create_service(AddTwoInts, "add", lambda _: AddTwoInts.Response(sum=3))
    burst = node.create_publisher(Int32, "burst", 2 * BURST)
    thrown = node.create_publisher(Int32, "thrown", 10)

    def throw(msg: Int32) -> None:
        began = time.perf_counter()
        for number in range(msg.data):
            burst.publish(Int32(data=number))
        thrown.publish(Int32(data=round(msg.data / (time.perf_counter() - began))))

    node.create_subscription(Int32, "throw", throw, 10)
