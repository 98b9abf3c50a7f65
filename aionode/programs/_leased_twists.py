"""Commands that repeat until they change, under a lease whose end stops what they move."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, Final

from aionode import Node, Publisher
from aionode.errors import LeaseExpiredError
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped

__all__ = ["TTL_SEC", "LeasedCommands", "LeasedTwists"]

TTL_SEC: Final = 0.3
"""The time without `repeat` after which the wheels stop."""


class LeasedCommands:
    """Publishes commands under a lease. While there is no command, others may command the robot.

    Args:
        publisher: Publishes them.
        command: Returns the message of the command; None while there is none.
        stop: Returns the message that stops the robot.
        on_expired: Called when `repeat` was not called in time, and the robot was stopped.

    Attributes:
        is_leased: Whether the robot is being commanded, so that a stop follows automatically.
        has_stopped: Whether a stop was sent since the start.
    """

    def __init__(
        self,
        publisher: Publisher[Any],
        command: Callable[[], Any],
        stop: Callable[[], Any],
        on_expired: Callable[[LeaseExpiredError], object],
    ) -> None:
        self._publisher = publisher
        self._command = command
        self._stop = stop
        self._on_expired = on_expired
        self._is_due = asyncio.Event()
        self.is_leased = False
        self.has_stopped = False

    def repeat(self) -> None:
        """Let `drive` look at the command again, and publish it."""
        self._is_due.set()

    def stop(self) -> None:
        """Publish a command to stand still, whoever commands the robot."""
        self._publisher.publish(self._stop())
        self.has_stopped = True

    async def drive(self) -> None:
        """Publish commands until cancelled, which also sends a stop."""
        while True:
            await self._due()
            if self._command() is None:
                continue
            try:
                async with self._publisher.lease(self._stop(), TTL_SEC) as lease:
                    self.is_leased = True
                    while (command := self._command()) is not None:
                        lease.publish(command)
                        await self._due()
            except LeaseExpiredError as error:
                self._on_expired(error)
            finally:
                self.is_leased = False
                self.has_stopped = True

    async def _due(self) -> None:
        await self._is_due.wait()
        self._is_due.clear()


class LeasedTwists(LeasedCommands):
    """Commands for wheels, on `cmd_vel`.

    Args:
        node: Its node.
        command: Returns the command; None while there is none.
        on_expired: Called when `repeat` was not called in time, and the robot was stopped.
        is_stamped: Whether the robot takes commands with a header.
        frame_id: The frame in the header.
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
        clock = node.get_clock()

        def message(twist: Twist | None) -> Any:
            """Return a command in the message type of the robot."""
            if twist is None or not is_stamped:
                return twist
            stamped = TwistStamped(twist=twist)
            stamped.header.frame_id = frame_id
            stamped.header.stamp = clock.now().to_msg()
            return stamped

        kind: Any = TwistStamped if is_stamped else Twist
        super().__init__(
            node.create_publisher(kind, "cmd_vel", 10),
            lambda: message(command()),
            lambda: message(Twist()),
            on_expired,
        )
