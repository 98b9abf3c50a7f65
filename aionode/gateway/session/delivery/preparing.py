"""Large messages of a subscription, which are encoded before their client gets them."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, Final, TypeAlias

from aionode.errors import AionodeError
from aionode.gateway.session.delivery.waiting import Waiting

if TYPE_CHECKING:
    from aionode.gateway.session.feed import Received
    from aionode.gateway.session.robot import Robot

__all__ = ["LARGE_BYTES", "Prepare", "Preparing", "prepared"]

logger = logging.getLogger("aionode.gateway")

Prepare: TypeAlias = Callable[["Received"], Awaitable[None]]
"""Encodes a message while the event loop runs; the result is kept in the message."""

LARGE_BYTES: Final = 128 << 10
"""Size up to which a message is encoded directly, in half a millisecond."""


class Preparing:
    """The messages of one subscription of a client that wait to be encoded, in order.

    The gateway encodes one message at a time, yielding to the event loop after each slice.

    Args:
        robot: Grants the turns, and runs the task.
        prepare: Encodes a message.
        deliver: Takes each message once it is encoded.
        depth: Maximum number of waiting messages.
        on_drop: Called when a message is dropped, unless only the newest was wanted.

    Attributes:
        dropped: Number of messages dropped.
    """

    def __init__(
        self,
        robot: Robot,
        prepare: Prepare,
        deliver: Callable[[Received], None],
        depth: int,
        on_drop: Callable[[], object] = bool,
    ) -> None:
        self.dropped = 0
        self._robot = robot
        self._prepare = prepare
        self._deliver = deliver
        self._depth = depth
        self._on_drop = on_drop
        self._waiting = Waiting(depth)
        self._task: asyncio.Task[None] | None = None

    def put(self, received: Received) -> None:
        """Add a message, which is delivered immediately if it is small and nothing waits."""
        if self._task is None and len(received.raw) <= LARGE_BYTES:
            self._deliver(received)
            return
        for _ in range(self._waiting.put(received)):
            self.dropped += 1
            if self._depth > 1:
                self._on_drop()
        if self._task is None:
            self._task = self._robot.tasks.create_task(self._run())

    def close(self) -> None:
        """Forget the waiting messages."""
        self._waiting.clear()
        if self._task is not None:
            self._task.cancel()

    async def _run(self) -> None:
        while self._waiting:
            received = self._waiting.take()
            try:
                await prepared(self._robot, self._prepare, received)
                self._deliver(received)
            except Exception:  # the task belongs to the gateway, which continues
                self.dropped += 1
                logger.exception("%s: a message could not be encoded", received.topic)
        self._task = None


async def prepared(robot: Robot, prepare: Prepare, received: Received) -> None:
    """Encode a message in its turn, if it is large.

    A message that is invalid for its type is left unchanged: `Received.once` raises its error.

    Args:
        robot: The robot, which has the turns.
        prepare: Encodes it.
        received: The message.
    """
    if len(received.raw) <= LARGE_BYTES:
        return
    async with robot.turn:
        with contextlib.suppress(AionodeError, ValueError):
            await prepare(received)
