"""Commands for wheels that repeat until they change, under a lease whose end stops the wheels."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, Final

from aionode import Node
from aionode.errors import LeaseExpiredError
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped

__all__ = ["TTL_SEC", "LeasedTwists"]

TTL_SEC: Final = 0.3
"""The time without `repeat` after which the wheels stop."""


class LeasedTwists:
    """A publisher on `cmd_vel`. While there is no command, others may command the robot.

    Args:
        node: Its node.
        command: Returns the command; None while there is none.
        on_expired: Called when `repeat` was not called in time, and the robot was stopped.
        is_stamped: Whether the robot takes commands with a header.
        frame_id: The frame in the header.

    Attributes:
        is_leased: Whether the robot is being commanded, so that a stop is sent by itself.
        has_stopped: Whether a stop was sent since the start.
    """

    def __init__(
        self,
        node: Node,
        command: Callable[[], Twist | None],
        on_expired: Callable[[LeaseExpiredError], object],
        *,
        is_stamped: bool,
        frame_id: str,
    ) -> None:
        self._clock = node.get_clock()
        self._command = command
        self._on_expired = on_expired
        self._is_stamped = is_stamped
        self._frame_id = frame_id
        kind: Any = TwistStamped if is_stamped else Twist
        self._publisher = node.create_publisher(kind, "cmd_vel", 10)
        self._is_due = asyncio.Event()
        self.is_leased = False
        self.has_stopped = False

    def repeat(self) -> None:
        """Let `drive` look at the command again, and publish it."""
        self._is_due.set()

    def stop(self) -> None:
        """Publish a command to stand still, whoever commands the robot."""
        self._publisher.publish(self._message(Twist()))
        self.has_stopped = True

    async def drive(self) -> None:
        """Publish commands until it is cancelled; then, too, a stop is sent."""
        while True:
            await self._due()
            if self._command() is None:
                continue
            try:
                async with self._publisher.lease(self._message(Twist()), TTL_SEC) as lease:
                    self.is_leased = True
                    while (twist := self._command()) is not None:
                        lease.publish(self._message(twist))
                        await self._due()
            except LeaseExpiredError as error:
                self._on_expired(error)
            finally:
                self.is_leased = False
                self.has_stopped = True

    async def _due(self) -> None:
        await self._is_due.wait()
        self._is_due.clear()

    def _message(self, twist: Twist) -> Any:
        """Return a command in the message type of the robot."""
        if not self._is_stamped:
            return twist
        stamped = TwistStamped(twist=twist)
        stamped.header.frame_id = self._frame_id
        stamped.header.stamp = self._clock.now().to_msg()
        return stamped
