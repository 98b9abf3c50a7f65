"""Round trips and calls from the measuring process, over each route."""

from __future__ import annotations

import asyncio
import mmap
import time
from collections.abc import Awaitable, Callable
from typing import Any, Protocol

from aionode import Node
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Int32, String
from benchmarks.ipc_parts.common import IMAGE_BYTES, SIZE, TEXT


class Player(Protocol):
    """One route, there and back."""

    async def play(self, count: int, pause_s: float) -> list[int]:
        """Return the times of some round trips in nanoseconds, with a sleep before each."""


class Ball:
    """Callbacks on both sides: `send` sends, and the receiver of the answer calls `back`."""

    send: Callable[[], object]

    def __init__(self) -> None:
        self._times: list[int] = []
        self._left = 0
        self._began_ns = 0
        self._done: asyncio.Future[None] | None = None

    def back(self) -> None:
        """Record one round trip, and start the next."""
        self._times.append(time.perf_counter_ns() - self._began_ns)
        self._left -= 1
        if self._left:
            self._throw()
        else:
            assert self._done is not None  # noqa: S101  # a round trip is under way
            self._done.set_result(None)

    def _throw(self) -> None:
        self._began_ns = time.perf_counter_ns()
        self.send()

    async def _go(self, count: int) -> None:
        self._left = count
        self._done = asyncio.get_running_loop().create_future()
        self._throw()
        await self._done

    async def play(self, count: int, pause_s: float) -> list[int]:
        """Return the times of some round trips in nanoseconds, with a sleep before each."""
        self._times = []
        if not pause_s:
            await self._go(count)
            return self._times
        for _ in range(count):
            await asyncio.sleep(pause_s)
            await self._go(1)
        return self._times


class Caller:
    """One coroutine that awaits one answer after another."""

    def __init__(self, call: Callable[[], Awaitable[object]]) -> None:
        self._call = call

    async def play(self, count: int, pause_s: float) -> list[int]:
        """Return the times of some calls in nanoseconds, with a sleep before each."""
        times = []
        for _ in range(count):
            if pause_s:
                await asyncio.sleep(pause_s)
            began_ns = time.perf_counter_ns()
            await self._call()
            times.append(time.perf_counter_ns() - began_ns)
        return times


class SocketBall(Ball, asyncio.Protocol):
    """A bare Unix socket."""

    def connection_made(self, transport: Any) -> None:
        """Keep the transport."""
        self.send = lambda: transport.write(bytes(SIZE))

    def data_received(self, data: bytes) -> None:  # noqa: ARG002  # its time counts
        """Take the answer."""
        self.back()


class SocketAsk(asyncio.Protocol):
    """A bare Unix socket whose answers are awaited."""

    def connection_made(self, transport: Any) -> None:
        """Keep the transport."""
        self._write = transport.write

    def ask(self) -> asyncio.Future[None]:
        """Send, and return a future for the answer."""
        self._answer: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._write(bytes(SIZE))
        return self._answer

    def data_received(self, data: bytes) -> None:  # noqa: ARG002  # its time counts
        """Take the answer."""
        self._answer.set_result(None)


class NodeBall(Ball):
    """A publisher, and a subscription that calls back."""

    def __init__(self, node: Node) -> None:
        super().__init__()
        self.publisher = node.create_publisher(String, "ping", 10)
        node.create_subscription(String, "pong", lambda _: self.back(), 10)
        self.send = lambda: self.publisher.publish(String(data=TEXT))


class ImageBall(Ball):
    """A publisher of images, and a subscription for the answers."""

    def __init__(self, node: Node) -> None:
        super().__init__()
        self.publisher = node.create_publisher(Image, "images", 10)
        node.create_subscription(Int32, "seen", lambda _: self.back(), 10)
        msg = Image(height=1000, width=4000, step=4000, data=bytes([1]) * IMAGE_BYTES)
        self.send = lambda: self.publisher.publish(msg)


class MemoryBall(SocketBall):
    """Bare memory mapped by both, and a bare Unix socket."""

    def __init__(self, buffer: mmap.mmap) -> None:
        super().__init__()
        self._memory = buffer
        self._data = bytes([1]) * IMAGE_BYTES

    def connection_made(self, transport: Any) -> None:
        """Copy the data, and send a notification."""

        def send() -> None:
            self._memory[:] = self._data
            transport.write(bytes(SIZE))

        self.send = send
