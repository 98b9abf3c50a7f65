"""Telling the subscriptions of other contexts that a publisher is alive.

rmw_zenoh has no message for this. So publishers put their assertions on a key below that of their
topic, and contexts with a subscription that requests a lease subscribe to it. ROS nodes do not take
part.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import zenoh

from aionode.transport._loop_waker import ThreadsafeQueue
from aionode.transport.zenoh._handlers import LOOP_PRIORITY, direct
from aionode.wire._key_expression import Side, side_key

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.transport._loop_waker import LoopWaker
    from aionode.transport.zenoh._outlet import Outlet

__all__ = ["Assertions"]

LIMIT = 10_000
"""Number of assertions that wait for the loop; of more, the oldest are lost."""

GID_SIZE = 16


class Assertions:
    """The assertions that this context sends and receives."""

    def __init__(
        self, waker: LoopWaker, note_malformed: Callable[[str, str], None], outlet: Outlet
    ) -> None:
        self._waker = waker
        self._outlet = outlet
        self._note_malformed = note_malformed
        # By the key of the topic.
        self._listeners: dict[str, dict[Callable[[bytes], None], None]] = {}
        self._subscribers: dict[str, zenoh.Subscriber[None]] = {}
        self._session: zenoh.Session | None = None

    def start(self, session: zenoh.Session) -> None:
        """Begin to send, and to receive for those who listen."""
        self._session = session
        for key in self._listeners:
            self._update(key)

    def stop(self) -> None:
        """Send and receive nothing more."""
        self._session = None
        for key in self._listeners:
            self._update(key)

    def listen(self, key: str, listener: Callable[[bytes], None]) -> None:
        """Call `listener` with the gid of each publisher of a topic that asserts its liveliness."""
        self._listeners.setdefault(key, {})[listener] = None
        self._update(key)

    def unlisten(self, key: str, listener: Callable[[bytes], None]) -> None:
        """Call `listener` no more, if it is known."""
        listeners = self._listeners.get(key, {})
        listeners.pop(listener, None)
        self._update(key)
        if not listeners:
            self._listeners.pop(key, None)

    def send(self, key: str, gid: bytes) -> None:
        """Assert the liveliness of a publisher of this context."""
        self._outlet.send(partial(self._send, key, gid), len(gid))

    def _send(self, key: str, gid: bytes) -> None:
        session = self._session
        if session is not None:
            session.put(
                key_of(key),
                gid,
                congestion_control=zenoh.CongestionControl.DROP,
                priority=LOOP_PRIORITY,
                allowed_destination=zenoh.Locality.REMOTE,
            )

    def _update(self, key: str) -> None:
        """Subscribe while there are listeners of a topic and a session."""
        if self._session is not None and self._listeners.get(key):
            if key not in self._subscribers:
                queue = ThreadsafeQueue(self._waker, partial(self._take, key), LIMIT)
                self._subscribers[key] = self._session.declare_subscriber(
                    key_of(key), direct(queue.put), allowed_origin=zenoh.Locality.REMOTE
                )
        elif key in self._subscribers:
            self._subscribers.pop(key).undeclare()

    def _take(self, key: str, sample: zenoh.Sample) -> None:
        gid = sample.payload.to_bytes()
        if len(gid) != GID_SIZE:
            self._note_malformed(key_of(key), "an assertion of liveliness")
            return
        for listener in tuple(self._listeners.get(key, ())):
            listener(gid)


def key_of(key: str) -> str:
    """Return the key of the assertions of a topic's publishers."""
    return side_key(key, Side.PUBLISHERS, "alive")
