"""Bursts from the other process, over each route."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

from aionode import Node
from aionode.interfaces.std_msgs.msg import Int32
from benchmarks.ipc_parts.common import BURST, SILENCE_NS, SIZE


class Burst:
    """Bursts from the other process: `begin` requests one, `take` is called for each arrival."""

    begin: Callable[[], object]

    def __init__(self) -> None:
        self.sent: list[int] = []  # rates as well, if the other side reports them
        self.rates: list[float] = []
        self.lost = 0
        self._clear()

    def _clear(self) -> None:
        self._count = self._first = self._first_ns = self._last_ns = 0

    def take(self, count: int = 1) -> None:
        """Count arrived messages."""
        self._last_ns = time.perf_counter_ns()
        if not self._count:
            self._first, self._first_ns = count, self._last_ns
        self._count += count

    async def play(self) -> float:
        """Return the rate of arrival of one burst, in messages a second."""
        self._clear()
        began_ns = time.perf_counter_ns()
        self.begin()
        self._last_ns = time.perf_counter_ns()
        # Polled, because an event would cost time with each message.
        while self._count < BURST and time.perf_counter_ns() - self._last_ns < SILENCE_NS:  # noqa: ASYNC110
            await asyncio.sleep(0.02)
        self.lost += BURST - self._count
        if self._count == self._first:  # all of them arrived at once, or none did
            return self._count / (self._last_ns - began_ns) * 1e9
        return (self._count - self._first) / (self._last_ns - self._first_ns) * 1e9


class SocketBurst(Burst, asyncio.Protocol):
    """Over a bare Unix socket."""

    def connection_made(self, transport: Any) -> None:
        """Keep the transport."""
        self.begin = lambda: transport.write(b"x")
        self._rest = 0

    def data_received(self, data: bytes) -> None:
        """Count whole messages."""
        count, self._rest = divmod(self._rest + len(data), SIZE)
        self.take(count)


class NodeBurst(Burst):
    """Over aionode."""

    def __init__(self, node: Node) -> None:
        super().__init__()
        self.publisher = node.create_publisher(Int32, "throw", 10)
        self.begin = lambda: self.publisher.publish(Int32(data=BURST))
        node.create_subscription(Int32, "burst", lambda _: self.take(), 2 * BURST)
        node.create_subscription(Int32, "thrown", lambda msg: self.sent.append(msg.data), 10)
