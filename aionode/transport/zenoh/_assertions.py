"""Telling the subscriptions of other contexts that a publisher is alive.

rmw_zenoh has no message for this. So each context publishes its assertions on a key of its own, and
contexts with a subscription that requests a lease subscribe to all of these. ROS nodes do not take
part.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import zenoh

from aionode.transport._loop_waker import ThreadsafeQueue
from aionode.transport.zenoh._handlers import LOOP_PRIORITY, direct

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.transport._loop_waker import LoopWaker

__all__ = ["Assertions"]

LIMIT = 10_000
"""How many assertions wait for the loop; then the oldest are lost, as newer ones have come."""

GID_SIZE = 16


class Assertions:
    """The assertions that this context sends and receives."""

    def __init__(
        self,
        participant: str,
        domain_id: int,
        waker: LoopWaker,
        note_malformed: Callable[[str, str], None],
    ) -> None:
        self._key = f"@aionode/{domain_id}/{participant}/alive"
        self._all_keys = f"@aionode/{domain_id}/*/alive"
        self._note_malformed = note_malformed
        self._listeners: dict[Callable[[bytes], None], None] = {}
        self._session: zenoh.Session | None = None
        self._publisher: zenoh.Publisher | None = None
        self._subscriber: zenoh.Subscriber[None] | None = None
        self._queue: ThreadsafeQueue[zenoh.Sample] = ThreadsafeQueue(waker, self._take, LIMIT)

    def start(self, session: zenoh.Session) -> None:
        """Begin to send, and to receive if there are listeners."""
        self._session = session
        self._update()

    def stop(self) -> None:
        """Send and receive nothing more."""
        self._session = None
        publisher, self._publisher = self._publisher, None
        if publisher is not None:
            publisher.undeclare()
        self._update()

    def listen(self, listener: Callable[[bytes], None]) -> None:
        """Call `listener` with the gid of each publisher that asserts its liveliness."""
        self._listeners[listener] = None
        self._update()

    def unlisten(self, listener: Callable[[bytes], None]) -> None:
        """Call `listener` no more, if it is known."""
        self._listeners.pop(listener, None)
        self._update()

    def send(self, gid: bytes) -> None:
        """Assert the liveliness of a publisher of this context."""
        if self._session is None:
            return
        if self._publisher is None:
            # Kept, so that without a listener nothing is sent.
            self._publisher = self._session.declare_publisher(
                self._key,
                congestion_control=zenoh.CongestionControl.DROP,
                priority=LOOP_PRIORITY,
                allowed_destination=zenoh.Locality.REMOTE,
            )
        self._publisher.put(gid)

    def _update(self) -> None:
        """Subscribe while there are listeners and a session."""
        if self._session is not None and self._listeners:
            if self._subscriber is None:
                self._subscriber = self._session.declare_subscriber(
                    self._all_keys,
                    direct(self._queue.put),
                    allowed_origin=zenoh.Locality.REMOTE,
                )
        elif self._subscriber is not None:
            subscriber, self._subscriber = self._subscriber, None
            subscriber.undeclare()
            self._queue.clear()

    def _take(self, sample: zenoh.Sample) -> None:
        gid = sample.payload.to_bytes()
        if len(gid) != GID_SIZE:
            self._note_malformed(self._all_keys, "an assertion of liveliness")
            return
        for listener in tuple(self._listeners):
            listener(gid)
