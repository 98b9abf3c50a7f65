"""Handles of publishers and subscriptions, over the endpoints of a bare node."""

from __future__ import annotations

import logging
from collections import deque
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any

from aionode._process.recent import Recent
from aionode.clock import MachineTime
from aionode.engine.bare_node import BareEndpoint, BarePublisher
from aionode.engine.reports.limits import heavy_text
from aionode.engine.rules.lifespan import expires_ns
from aionode.engine.rules.missing_messages import REMEMBERED_PUBLISHERS
from aionode.engine.transport.base import SampleInfo
from aionode.engine.transport.drops import Drop
from aionode.errors import DecodeError, MessageError, QueueFullError
from aionode.qos import DEFAULT_DEPTH, KEEP_ALL_DEPTH, is_unlimited
from rclpy._impl.endpoint import EndpointHandle
from rclpy._impl.errors import RCLError
from rclpy._impl.typesupport import message_support
from rosidl_generator_py import aionode_class

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.graph import EndpointInfo
    from rclpy._impl.destroyable import Arrivals
    from rclpy._impl.node import NodeHandle

__all__ = ["PublisherHandle", "SubscriptionHandle"]

Feed = list["Callable[[SampleInfo | None], None]"]
"""Functions called with each message in the thread of the context, to watch for events."""

Sample = tuple[Any, bytes, int, int, int, int]
"""A message, its publisher's gid, number and time, its arrival time, and its number among the taken
ones."""

UNWEIGHED = 2
"""Number of messages that may wait whatever their size in bytes."""

logger = logging.getLogger("aionode.rclpy")

now_ns = MachineTime().system_ns


class PublisherHandle(EndpointHandle[BarePublisher]):
    """A publisher. `publish` encodes, and delivers within this context, in the calling thread."""

    def __init__(self, node: NodeHandle, msg_type: Any, topic: str, qos_profile: Any) -> None:
        super().__init__(node, topic, qos_profile, "Failed to create publisher", is_service=False)
        self.msg_type = msg_type
        self._support = message_support(msg_type)
        self.feed: Feed = []
        self.assertions: list[Callable[[bytes], None]] = []  # of subscriptions only
        self._announce(node.bare.create_publisher, self._support.wire_type)

    def publish(self, msg: Any) -> None:
        """Send a message."""
        support = self._support
        try:
            if msg.__class__ is self.msg_type:
                data = support.encode_exactly(msg)
            else:
                data = support.encode(msg)
        except MessageError as error:
            error.add_note(f"published to {self.name}")
            raise
        self.publish_raw(data)

    def publish_raw(self, data: bytes) -> None:
        """Send an encoded message.

        Subscriptions of this context have it when this returns.

        Raises:
            RCLError: the context is shut down, or one of its KEEP_ALL subscriptions is full.
            ForkedProcessError: the context belongs to the parent of this forked process.
        """
        if self._node.context_handle.is_shut_down:
            self._node.context_handle.refuse_to_publish()
        try:
            self.io.publish(self.bare, self._support.wire_type(data))
        except QueueFullError as error:
            raise RCLError(f"Failed to publish: {error}") from error
        if self.feed:
            self.io.post(self._tell_feed)

    def refuse_after_shutdown(self, failure: str) -> None:
        """Raise after shutdown, whatever caused it.

        Raises:
            RCLError: the context is shut down.
        """
        self._node.context_handle.refuse_after_shutdown(failure, "publisher")

    def _tell_feed(self) -> None:
        for listener in self.feed:
            listener(None)

    def get_subscription_count(self) -> int:
        """Return how many subscriptions are matched.

        Raises:
            RCLError: the context is shut down.
        """
        self.refuse_after_shutdown("failed to get subscription count")
        return self._count_matched()

    def assert_liveliness(self) -> None:
        """Show that the publisher is alive.

        Raises:
            RCLError: the context is shut down.
        """
        self.refuse_after_shutdown("Failed to assert liveliness on the Publisher")
        self.io.post(self._assert_liveliness)

    def _assert_liveliness(self) -> None:
        self._tell_feed()
        self.bare.assert_liveliness()

    def wait_for_all_acked(self, timeout: Any) -> bool:
        """Wait until everything is passed to the transports, which resend lost messages.

        Raises:
            RCLError: the context is shut down.
        """
        del timeout
        self.refuse_after_shutdown("Failed to wait for all acknowledgements")
        self.io.call(lambda: None)
        return True


class Inbox:
    """The queue of a subscription, its `Reader`.

    The thread of the context fills it, as do threads that publish in the same context.

    It does not know its handle, which becomes garbage once its user has dropped it.
    """

    raw = False
    endpoint: EndpointInfo

    def __init__(
        self,
        profile: Any,
        limit_bytes: int,
        arrivals: Arrivals,
        post: Callable[[Callable[[], object]], None],
        on_heavy: Callable[[], None],
    ) -> None:
        keep_all = profile.resolved().history.name == "KEEP_ALL"
        self.limit = KEEP_ALL_DEPTH if keep_all else (profile.depth or DEFAULT_DEPTH)
        self.keep_all = keep_all
        # Threads append and take in one atomic step; `arrivals` wakes a thread that found it empty.
        self.items: deque[tuple[bytes, bytes, int, int, int]] = deque(
            maxlen=None if keep_all else self.limit
        )
        self._limit_bytes = limit_bytes
        self._on_heavy: Callable[[], None] | None = on_heavy  # called once
        # The bytes of messages that wait, or waited while others did. Threads that deliver
        # concurrently may overwrite each other's number: then a message too many may wait.
        self._largest_bytes = 0
        self.accept: Callable[[bytes], bool] | None = None
        self.feed: Feed = []
        self.assertions: list[Callable[[bytes], None]] = []
        self._arrivals = arrivals
        self._post = post
        self.room_waiters: list[Callable[[], None]] = []

    def deliver(
        self,
        msg: Any,
        gid: bytes,
        sequence: int,
        source_ns: int,
        inline_deadline_ns: int = 0,
        arrived_ns: int = 0,
    ) -> None:
        """Take one message."""
        data = msg.data
        if self.feed:
            origin = SampleInfo(gid, sequence, source_ns, arrived_ns)
            self._post(partial(self._tell_feed, origin))
        if self.accept is not None and not self.accept(data):
            return
        items = self.items
        if len(items) < UNWEIGHED:
            self._largest_bytes = len(data)
        elif not self._make_room(len(data)):
            return
        if self.keep_all and len(items) == self.limit:
            return
        items.append((data, gid, sequence, source_ns, arrived_ns or now_ns()))
        self._arrivals.note()

    def note_alive(self, gid: bytes) -> None:
        """Take the assertion of a publisher that it is alive."""
        for listener in self.assertions:
            listener(gid)

    def _is_heavy(self, size_bytes: int) -> bool:
        """Return whether one more message of this size exceeds the limit in bytes."""
        self._largest_bytes = max(self._largest_bytes, size_bytes)
        if (len(self.items) + 1) * self._largest_bytes <= self._limit_bytes:
            return False  # nothing to add up, as nearly always
        waiting = self.items.copy()  # other threads take from it
        return sum(len(data) for data, *_ in waiting) + size_bytes > self._limit_bytes

    def _make_room(self, size_bytes: int) -> bool:
        """Drop the oldest messages until one of this size fits; return whether it does."""
        while self.items and self._is_heavy(size_bytes):
            if self._on_heavy is not None:
                on_heavy, self._on_heavy = self._on_heavy, None
                self._post(on_heavy)  # not here, where another thread may wait to deliver
            if self.keep_all:
                return False
            with suppress(IndexError):  # another thread has taken it
                self.items.popleft()
        return True

    def _tell_feed(self, sample_info: SampleInfo) -> None:
        for listener in self.feed:
            listener(sample_info)

    def reject(self, error: DecodeError) -> None:
        """Ignore a sample that is not a message of this type; the transport has logged it."""

    def has_room(self) -> bool:
        """Whether a message can be accepted without losing one that should be kept."""
        return not self.keep_all or (
            len(self.items) < self.limit and (len(self.items) < UNWEIGHED or not self._is_heavy(0))
        )

    @property
    def waiting(self) -> int:
        """The number of messages that wait to be taken."""
        return len(self.items)

    async def wait_for_room(self) -> None:
        """Return at once: publishers of this context drop messages for which there is no room."""

    def when_room(self, callback: Callable[[], None]) -> None:
        """Call `callback` once there is room; in the thread of the context only."""
        self.room_waiters.append(callback)
        if self.has_room():  # the last message was taken meanwhile, when nobody waited
            self._post(self.tell_of_room)

    def tell_of_room(self) -> None:
        """Call those who wait for room, once; in the thread of the context only."""
        waiters, self.room_waiters = self.room_waiters, []
        for waiter in waiters:
            waiter()


class SubscriptionHandle(EndpointHandle[BareEndpoint]):
    """A subscription: messages wait in it until taken, the newest `depth` of them."""

    def __init__(
        self,
        node: NodeHandle,
        msg_type: Any,
        topic: str,
        qos_profile: Any,
        content_filter_options: Any = None,
    ) -> None:
        failure = "Failed to create subscription"
        super().__init__(node, topic, qos_profile, failure, is_service=False)
        self.msg_type = msg_type
        self._support = message_support(msg_type)
        self._filter: tuple[str, list[str]] | None = None
        limit_bytes = node.bare.context.network.queue_bytes
        text = heavy_text(self.name, limit_bytes, "dropped (logged once)")
        on_heavy = partial(logger.warning, text)
        self.inbox = Inbox(self.profile, limit_bytes, node.messages, node.io.post, on_heavy)
        self.feed = self.inbox.feed
        self.assertions = self.inbox.assertions
        if content_filter_options is not None:
            self.set_content_filter(
                content_filter_options.filter_expression,
                content_filter_options.expression_parameters,
            )
        # Used by the threads that take, one at a time unless the callback group is reentrant. With
        # several threads, two messages may get the same number, or a publisher may be looked up
        # twice.
        self._lifespans: Recent[bytes, int] = Recent(REMEMBERED_PUBLISHERS)
        self._received = 0
        self._announce(node.bare.create_subscription, self._support.wire_type, self.inbox)

    def ready(self) -> bool:
        """Return whether a message waits."""
        return bool(self.inbox.items) and not self._unwanted

    def take_message(self, msg_type: Any, raw: bool) -> tuple[Any, dict[str, Any]] | None:
        """Return the oldest waiting message and its origin, or None."""
        taken = self.take_sample(msg_type, raw)
        return None if taken is None else (taken[0], self.info_of(taken))

    def take_sample(self, msg_type: Any, raw: bool) -> Sample | None:
        """Return the oldest waiting message, for `info_of`, or None."""
        inbox = self.inbox
        while inbox.items:
            try:
                data, gid, sequence, source_ns, arrived_ns = inbox.items.popleft()
            except IndexError:  # another thread was faster
                return None
            if inbox.room_waiters:
                self.io.post(inbox.tell_of_room)
            # 0 for the messages of most publishers, which do not expire.
            if self._lifespans.get(gid) != 0 and self._has_expired(gid, source_ns, arrived_ns):
                continue
            message = data
            if not raw:
                support = self._support if msg_type is self.msg_type else message_support(msg_type)
                try:
                    message = support.decode(data)
                except DecodeError as error:
                    self._complain(error)
                    continue
            self._received += 1
            return message, gid, sequence, source_ns, arrived_ns, self._received
        return None

    def info_of(self, taken: Sample) -> dict[str, Any]:
        """Return the origin of a message, as rclpy's callbacks get it."""
        _, gid, sequence, source_ns, arrived_ns, received = taken
        return {
            "source_timestamp": source_ns,
            "received_timestamp": arrived_ns,
            "publication_sequence_number": sequence,
            "reception_sequence_number": received,
            "publisher_gid": {"implementation_identifier": "rmw_zenoh_cpp", "data": gid},
        }

    def _complain(self, error: DecodeError) -> None:
        self.io.context.drops.note(
            Drop.MALFORMED, self.name, f"not a message of this type ({error})"
        )

    def _has_expired(self, gid: bytes, source_ns: int, arrived_ns: int) -> bool:
        """Return whether the lifespan of its publisher or of this subscription has passed."""
        lifespan_ns = self._lifespans.get(gid)
        if lifespan_ns is None:
            lifespan_ns = self.io.call(self._lifespan_of, gid)
            self._lifespans.put(gid, lifespan_ns)
        if not lifespan_ns:
            return False
        return expires_ns(source_ns, arrived_ns, lifespan_ns) <= now_ns()

    def _lifespan_of(self, gid: bytes) -> int:
        limits = [each.qos.lifespan for each in self.bare.matched() if each.gid == gid]
        limits.append(self.profile.lifespan)
        return min((each.nanoseconds for each in limits if not is_unlimited(each)), default=0)

    def get_publisher_count(self) -> int:
        """Return how many publishers are matched."""
        return self._count_matched()

    # Content filters

    def is_cft_enabled(self) -> bool:
        """Return whether a filter is set."""
        return self.inbox.accept is not None

    def set_content_filter(self, filter_expression: str, expression_parameters: list[str]) -> None:
        """Receive only messages that match the expression; an empty one accepts all.

        Raises:
            RCLError: the expression cannot be used.
        """
        try:
            self._set_filter(filter_expression, expression_parameters)
        except ValueError as error:
            raise RCLError(str(error)) from error

    def _set_filter(self, expression: str, parameters: list[str]) -> None:
        if not expression:
            self.inbox.accept = self._filter = None
            return
        # Few subscriptions have a filter.
        from aionode.content_filter import compile_filter
        from aionode.engine.wire.byte_filter import decoding

        own_class = aionode_class(self.msg_type)
        self.inbox.accept = decoding(own_class, compile_filter(own_class, expression, parameters))
        self._filter = (expression, list(parameters))

    def get_content_filter(self) -> tuple[str, list[str]]:
        """Return the expression and its parameters.

        Raises:
            RCLError: no filter is set.
        """
        if self._filter is None:
            raise RCLError("Failed to get content filter: content filtered topic is not enabled")
        return self._filter
