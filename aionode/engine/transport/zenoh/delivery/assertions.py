"""Tells subscriptions of other contexts that a publisher is alive.

rmw_zenoh has no message for this. So publishers send their assertions on a key below their topic's,
to which contexts with a subscription that requests a lease subscribe. ROS nodes do not take part.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.engine.transport.zenoh.delivery.control_messages import ControlSubscribers
from aionode.engine.wire._key_expression import Side, side_key

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

    import zenoh

    from aionode.engine.transport.loop_waker import LoopWaker
    from aionode.engine.transport.zenoh.delivery.control_messages import ControlMessages

__all__ = ["Assertions"]

LIMIT = 10_000
"""Number of assertions that may wait for the loop; beyond it, the oldest are lost."""

GID_SIZE = 16


class Assertions:
    """The assertions that this context sends and receives."""

    def __init__(
        self,
        waker: LoopWaker,
        note_malformed: Callable[[str, str], None],
        control_messages: ControlMessages,
    ) -> None:
        self._control_messages = control_messages
        self._note_malformed = note_malformed
        self._subscribers: ControlSubscribers[Callable[[bytes], None]] = ControlSubscribers(
            waker, self._receive, LIMIT
        )
        self.start = self._subscribers.start
        self.stop = self._subscribers.stop

    def listen(self, key: str, listener: Callable[[bytes], None]) -> None:
        """Call `listener` with the gid of each publisher of a topic that asserts its liveliness."""
        self._subscribers.listen(key_of(key), listener, listener)

    def unlisten(self, key: str, listener: Callable[[bytes], None]) -> None:
        """Stop calling `listener`, if it is known."""
        self._subscribers.unlisten(key_of(key), listener)

    def send(self, key: str, gid: bytes) -> None:
        """Assert the liveliness of a publisher of this context."""
        self._control_messages.put(key_of(key), gid)

    def _receive(
        self, sample: zenoh.Sample, listeners: dict[Hashable, Callable[[bytes], None]]
    ) -> None:
        gid = sample.payload.to_bytes()
        if len(gid) != GID_SIZE:
            self._note_malformed(str(sample.key_expr), "an assertion of liveliness")
            return
        for listener in tuple(listeners.values()):
            listener(gid)


def key_of(key: str) -> str:
    """Return the key of the assertions of a topic's publishers."""
    return side_key(key, Side.PUBLISHERS, "alive")
