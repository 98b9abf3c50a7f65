"""Control messages: small messages between aionode contexts, apart from those of topics.

These are acknowledgements, assertions of liveliness and cancellations. Each may be lost, and uses a
key that ROS nodes neither subscribe nor publish to.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Hashable
from functools import partial
from typing import TYPE_CHECKING, Final, Generic, TypeVar

import zenoh

from aionode.engine.transport.loop_waker import ThreadsafeQueue
from aionode.engine.transport.zenoh.connections.handlers import (
    BULK_BYTES,
    BULK_PRIORITY,
    DROP,
    LOOP_PRIORITY,
    direct,
    reason,
    translated,
)

if TYPE_CHECKING:
    from aionode.engine.transport.loop_waker import LoopWaker
    from aionode.engine.transport.send_thread import SendThread

__all__ = ["ControlMessages", "ControlSubscribers"]

T = TypeVar("T")

logger = logging.getLogger("aionode.transport.zenoh")

LIMIT: Final = 10_000
"""Number of messages that may wait for the thread; the newest of each kind count, so the oldest may
be lost."""


class ControlMessages:
    """Sends control messages: immediately, or from a thread while Zenoh may block.

    Args:
        send_thread: The thread.
        limit_bytes: Maximum number of bytes that wait for it.

    Attributes:
        is_crowded: Whether others have announced so much that Zenoh may block: it drops everything
            that a connection has announced in one go, during which no send proceeds.
    """

    def __init__(self, send_thread: SendThread, limit_bytes: int) -> None:
        self.is_crowded = False  # only written by the loop
        self._queue = send_thread.send_queue(LIMIT, limit_bytes, keep_all=False)
        # Set only by the loop. Threads that send read it once, and sending after the session has
        # closed is an error that is logged.
        self._session: zenoh.Session | None = None

    def start(self, session: zenoh.Session) -> None:
        """Send messages through a session from now on; before that, they are dropped."""
        self._session = session

    def stop(self) -> None:
        """Drop messages that wait, and all later ones."""
        self._session = None
        self._queue.abandon()

    def put(self, key: str, payload: bytes, extra: bytes | None = None) -> None:
        """Send a message; from the thread if Zenoh would fragment it, as each fragment may wait."""
        if self.is_crowded or len(payload) >= BULK_BYTES:
            size_bytes = len(payload) + len(extra or b"")
            self._queue.put(partial(self._put, key, payload, extra), size_bytes)
        else:
            self._put(key, payload, extra)

    def _put(self, key: str, payload: bytes, extra: bytes | None) -> None:
        session = self._session
        if session is None:
            return
        try:
            session.put(
                key,
                payload,
                attachment=extra,
                congestion_control=DROP,
                priority=LOOP_PRIORITY if len(payload) < BULK_BYTES else BULK_PRIORITY,
                allowed_destination=zenoh.Locality.REMOTE,
            )
        except zenoh.ZError as error:
            logger.debug("%s: not sent: %s", key, reason(error))


class ControlSubscribers(Generic[T]):
    """Zenoh subscribers for control messages: one for each key that has listeners.

    Each is announced to every other process. A single one for all topics would be cheaper, but a
    router's access rule for one topic would refuse it.

    Args:
        waker: Wakes the event loop.
        handle: Called on the loop with each message and the listeners of its key, by name.
        limit: Maximum number of messages that wait for the loop; beyond it, the oldest are lost.
    """

    def __init__(
        self,
        waker: LoopWaker,
        handle: Callable[[zenoh.Sample, dict[Hashable, T]], None],
        limit: int,
    ) -> None:
        self._handle = handle
        self._listeners: dict[str, dict[Hashable, T]] = {}  # by key; none of them is empty
        self._subscribers: dict[str, zenoh.Subscriber[None]] = {}
        self._session: zenoh.Session | None = None
        self._queue: ThreadsafeQueue[zenoh.Sample] = ThreadsafeQueue(waker, self._receive, limit)

    def start(self, session: zenoh.Session) -> None:
        """Subscribe to all keys with listeners, and to further ones as they get listeners."""
        self._session = session
        for key in self._listeners:
            self._update(key)

    def stop(self) -> None:
        """Undeclare the subscribers; the listeners stay, for the next session."""
        self._session = None
        for key in list(self._subscribers):
            self._update(key)
        self._queue.clear()

    def listen(self, key: str, name: Hashable, listener: T) -> None:
        """Add a listener for a key, or replace the one with the same name."""
        self._listeners.setdefault(key, {})[name] = listener
        self._update(key)

    def unlisten(self, key: str, name: Hashable) -> None:
        """Remove a listener, if it is there."""
        listeners = self._listeners.get(key, {})
        listeners.pop(name, None)
        if not listeners:
            self._listeners.pop(key, None)
        self._update(key)

    def _update(self, key: str) -> None:
        """Subscribe to a key while it has listeners and there is a session."""
        if self._session is not None and key in self._listeners:
            if key not in self._subscribers:
                with translated(key):
                    self._subscribers[key] = self._session.declare_subscriber(
                        key, direct(self._queue.put), allowed_origin=zenoh.Locality.REMOTE
                    )
        elif key in self._subscribers:
            self._subscribers.pop(key).undeclare()

    def _receive(self, sample: zenoh.Sample) -> None:
        listeners = self._listeners.get(str(sample.key_expr))
        if listeners is not None:  # otherwise the last one has just gone
            self._handle(sample, listeners)
