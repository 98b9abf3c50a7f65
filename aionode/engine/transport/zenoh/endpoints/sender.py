"""Decides who passes the messages of one publisher to Zenoh: the event loop, or a thread."""

from __future__ import annotations

import logging
from enum import Enum
from functools import partial
from typing import TYPE_CHECKING, Final

import zenoh

from aionode.clock import perf_ns
from aionode.engine.transport.send_thread import SendQueue, SendThread
from aionode.engine.transport.zenoh._defects import history_lock
from aionode.engine.transport.zenoh.connections.handlers import (
    BLOCKING_PRIORITY,
    BULK_BYTES,
    reason,
)
from aionode.engine.transport.zenoh.delivery.delivery import (
    GIVEN_UP_NS,
    is_reliable,
    is_transient,
    send_bulk,
    withdraw,
)
from aionode.engine.transport.zenoh.delivery.expiry import unless_expired
from aionode.engine.transport.zenoh.delivery.kept_history import declare_plain
from aionode.errors import TransportError
from aionode.qos import depth_of, is_unlimited, keeps_all

if TYPE_CHECKING:
    from collections.abc import Callable

    from zenoh import ext

    from aionode.clock import SilenceAlarm
    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.qos import QoSProfile

    ZenohPublisher = zenoh.Publisher | ext.AdvancedPublisher

__all__ = ["SentBy", "ZenohSender"]

logger = logging.getLogger("aionode.transport.zenoh")

LATE: Final = 1_000
"""Number of messages of a KEEP_LAST publisher (or its depth, if greater) that may wait for Zenoh
while it answers a late reader, or in a crowd; otherwise none wait."""


class SentBy(Enum):
    """Who passes a message to Zenoh, each with a priority and so a queue of its own there.

    Attributes:
        LOOP: The event loop, which never waits; Zenoh may drop the message.
        BULK: The thread for large messages.
        BLOCKING: A thread of this publisher, which waits: for readers that do not acknowledge and
            must not lose the message, or, for a transient local publisher, for Zenoh, which answers
            a late reader with the history locked.
    """

    LOOP = 0
    BULK = 1
    BLOCKING = 2


class ZenohSender:
    """Passes the messages of one publisher to Zenoh.

    Args:
        state: The state of the session.
        key: The key of the topic.
        qos: The profile of the publisher.
        lost: Called with the number of messages dropped.

    Attributes:
        publisher: The publisher declared by Zenoh; None if there is none. Set only by the loop. A
            thread uses the one that its job was given, and the same thread undeclares it after its
            last job (`withdraw`).
        large: Large messages, and small ones after them to keep the order.
        blocking: Messages sent by a thread of this publisher. None until there is one; from then on
            it sends everything, to keep the order.
        transient: Whether Zenoh keeps messages for late readers.
        expiry: Informed of each message that Zenoh keeps, if they expire.
        used_bulk: Whether a large message was sent since the stop of a lease was prepared, or then
            waited.
        puts_small_at_once: Whether `choose` is known to return LOOP for small messages.
    """

    def __init__(
        self, state: SessionState, key: str, qos: QoSProfile, lost: Callable[[int], None]
    ) -> None:
        self._state = state
        self._key = key
        self._lost = lost
        self._depth = depth_of(qos)
        self._bounded = keeps_all(qos)
        self._reliable = is_reliable(qos)
        self._lifespan_ns = 0 if is_unlimited(qos.lifespan) else qos.lifespan.nanoseconds
        self.publisher: ZenohPublisher | None = None
        self.transient = is_transient(qos)
        self.expiry: SilenceAlarm | None = None
        self.used_bulk = False
        self.large = self._queue(state.bulk, self._depth, keep_all=False)
        self.blocking: SendQueue | None = None
        self._blocking_thread = SendThread("aionode-blocking", state.waker)
        self._blocking_publisher: zenoh.Publisher | None = None
        self._given_up = state.queue(lost)  # from the thread that blocks to the loop
        self._needs_thread = history_lock.needs_thread(is_transient=self.transient)
        self._may_not_drop = self._reliable  # while there may be readers that do not acknowledge
        self.update()

    def _queue(self, send_thread: SendThread, limit: int, *, keep_all: bool) -> SendQueue:
        return send_thread.send_queue(
            limit, self._state.queue_bytes, keep_all=keep_all, lost=self._lost
        )

    # Who sends

    def choose(self, size_bytes: int) -> SentBy:
        """Return who sends the next message, given its size.

        A reader that must not lose any and does not acknowledge has a thread that waits for it,
        always with KEEP_ALL, and otherwise if there are many messages. While Zenoh may block, or a
        large message waits, the loop sends nothing.
        """
        large, is_crowded = self.large, self._state.control_messages.is_crowded
        is_large, large_waits = size_bytes >= BULK_BYTES, bool(len(large))
        if is_large or is_crowded:
            self.used_bulk = True
        if is_crowded or not large_waits:
            large.limit = max(self._depth, LATE) if is_crowded else self._depth
        if self.blocking is not None or self._needs_thread:
            return SentBy.BLOCKING
        if self._may_not_drop and (
            self._bounded or not (is_large or self._state.burst.spend(size_bytes))
        ):
            return SentBy.BLOCKING
        if is_large or is_crowded or large_waits:
            self.puts_small_at_once = False
            return SentBy.BULK
        self.puts_small_at_once = not self._may_not_drop
        return SentBy.LOOP

    def note_others(self, *, present: bool) -> None:
        """Record whether there are readers that do not acknowledge."""
        self._may_not_drop = self._reliable and present
        self.update()

    def update(self) -> None:
        """Determine whether small messages need no `choose`, as the loop sends them."""
        self.puts_small_at_once = not (
            self.blocking is not None
            or self._needs_thread
            or self._may_not_drop
            or self._state.control_messages.is_crowded
            or len(self.large)
        )

    # Messages

    def put(self, payload: bytes, extra: bytes) -> None:
        """Send a message to every reader.

        Raises:
            TransportError: Zenoh refuses it.
        """
        publisher = self.publisher
        if publisher is None:
            return
        if len(payload) >= BULK_BYTES or not self.puts_small_at_once:
            sent_by = self.choose(len(payload))
            if sent_by is SentBy.BLOCKING:
                self._put_blocking(publisher, payload, extra)
                return
            if sent_by is SentBy.BULK:
                send = partial(self._send, publisher, payload, extra)
                self.large.put(self.unless_expired(extra, send), len(payload))
                return
        try:
            publisher.put(payload, attachment=extra)
        except zenoh.ZError as error:
            raise TransportError(f"{self._key}: {reason(error)}") from error

    def _put_blocking(self, publisher: ZenohPublisher, payload: bytes, extra: bytes) -> None:
        """Send from the thread that waits for slow readers."""
        if self.blocking is None:
            self._state.send_threads.add(self._blocking_thread)
            limit = max(self._depth, LATE) if self.transient else self._depth
            self.blocking = self._queue(self._blocking_thread, limit, keep_all=self._bounded)
            self.update()
            if not self.transient and self._state.session is not None:
                self._blocking_publisher = declare_plain(
                    self._state.session, self._key, BLOCKING_PRIORITY, reliable=True, waits=True
                )
        if self.expiry is not None:
            self.expiry.note()
        send = partial(self._send_blocking, self._blocking_publisher or publisher, payload, extra)
        self.blocking.put(self.unless_expired(extra, send), len(payload))

    def unless_expired(self, extra: bytes, send: Callable[[], None]) -> Callable[[], None]:
        """Return a function that sends a message, unless it has expired by then."""
        return unless_expired(extra, self._lifespan_ns, self._state.now_ns, send)

    def _send_blocking(self, publisher: ZenohPublisher, payload: bytes, extra: bytes) -> None:
        """Send in the thread. Zenoh gives up after a while without an error, so time reveals it."""
        began_ns = perf_ns()
        try:
            publisher.put(payload, attachment=extra)
        except zenoh.ZError as error:
            logger.debug("%s: not sent: %s", self._key, reason(error))
        waits = self._bounded or not self.transient
        if waits and perf_ns() - began_ns >= GIVEN_UP_NS:
            self._given_up.put(1)

    def _send(self, publisher: ZenohPublisher, payload: bytes, extra: bytes) -> None:
        """Send from a thread."""
        send_bulk(self._state.session or publisher, self._key, payload, extra)

    # The stop of a lease

    def put_stop(self, payload: bytes, extra: bytes) -> None:
        """Send a message the same way as the last one."""
        publisher, blocking = self.publisher, self.blocking
        if publisher is None:
            return
        if blocking is not None or self.transient:
            if blocking is not None and len(blocking):
                self.put_now(payload, extra)  # its thread waits for a slow reader, others do not
            self._put_blocking(publisher, payload, extra)
        elif self.used_bulk:
            self.large.put(partial(self._send, publisher, payload, extra), len(payload))
        else:
            self.put_now(payload, extra)

    def put_now(self, payload: bytes, extra: bytes) -> None:
        """Send a message immediately, with the priority of those before it; from any thread."""
        publisher = self.publisher
        if publisher is None:
            return
        try:
            if self.used_bulk or self.transient:
                self._send(publisher, payload, extra)
            else:
                publisher.put(payload, attachment=extra)
        except zenoh.ZError as error:  # the session was closed meanwhile
            logger.debug("%s: not sent: %s", self._key, reason(error))

    def keep_past_loop(self, payload: bytes, extra: bytes) -> None:
        """Make Zenoh keep a message for late readers; any thread, while the loop is blocked."""
        if self.transient and self.publisher is not None:
            keep = partial(self._send_blocking, self.publisher, payload, extra)
            self._blocking_thread.submit_past_loop(keep)

    # What waits

    def abandon(self) -> None:
        """Drop what waits for a thread."""
        for send_queue in (self.large, self.blocking):
            if send_queue is not None:
                send_queue.abandon()

    def is_done(self) -> bool:
        """Return whether everything was passed to Zenoh."""
        return not len(self.large) and (self.blocking is None or not len(self.blocking))

    @property
    def sent(self) -> tuple[int, int]:
        """The numbers of messages sent by threads: the one for large ones, and the blocking one."""
        return self.large.sent, 0 if self.blocking is None else self.blocking.sent

    def has_room(self) -> bool:
        """Return whether another message can wait to be sent."""
        return self.blocking is None or self.blocking.has_room()

    async def drain(self) -> None:
        """Wait until everything was passed to Zenoh."""
        if self.blocking is not None:
            await self.blocking.drain()
        await self.large.drain()

    # Its publisher

    def replace(self, publisher: ZenohPublisher) -> None:
        """Send through another Zenoh publisher from now on; what the old one kept is forgotten."""
        before, self.publisher = self.publisher, publisher
        if before is not None:
            self._blocking_thread.submit(partial(withdraw, before))

    def withdraw(self) -> None:
        """Undeclare it in the thread that may be using it, as Zenoh locks it meanwhile."""
        publisher, self.publisher = self.publisher, None
        blocking, self._blocking_publisher = self._blocking_publisher, None
        if self.blocking is not None:
            self.blocking = None
            self.update()
            if blocking is not None:
                self._blocking_thread.submit(partial(withdraw, blocking))
            elif publisher is not None:  # it belongs to the thread
                self._blocking_thread.submit(partial(withdraw, publisher))
                publisher = None
        self._state.send_threads.discard(self._blocking_thread)
        self._blocking_thread.close()
        if publisher is None:
            return
        if len(self.large):
            self._state.bulk.submit(partial(withdraw, publisher))
        else:
            withdraw(publisher)
