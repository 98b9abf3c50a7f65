"""Publishers and subscriptions."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from threading import get_ident
from typing import TYPE_CHECKING, Any, Generic, TypedDict, TypeVar

from aionode.clock import perf_ns
from aionode.endpoints.dispatch import (
    SLICE_NS,
    Dispatch,
    accepts,
    checked_concurrency,
    give_way,
    pump,
)
from aionode.endpoints.entity import EndStage, Entity
from aionode.endpoints.inbox import Inbox
from aionode.endpoints.shortcut import Shortcut
from aionode.endpoints.stats import CallbackStats, PublisherStats
from aionode.errors import EntityDestroyedError, MessageError, QueueFullError
from aionode.graph import EndpointKind
from aionode.message import Message, checker
from aionode.qos import HistoryPolicy
from aionode.transport.base import Origin

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Sequence

    from aionode.clock import TimeBase
    from aionode.endpoints.channel import Channel
    from aionode.endpoints.dispatch import OnError
    from aionode.errors import DecodeError
    from aionode.qos import QoSProfile
    from aionode.transport.base import Announcement, Writer

__all__ = ["MessageInfo", "Publisher", "Subscription", "SubscriptionCallback"]

MsgT = TypeVar("MsgT", bound=Message)
ItemT = TypeVar("ItemT")

KEEP_ALL_DEPTH = 10_000
"""How many messages a KEEP_ALL subscription holds at least."""

DEFAULT_DEPTH = 42
"""What a depth of 0 means (rmw_zenoh_cpp, src/detail/qos.cpp)."""


REMEMBERED_PUBLISHERS = 1024
"""Of how many publishers in other processes the last sequence number is kept."""


class MessageInfo(TypedDict):
    """What is known of a message besides its content, with rclpy's keys.

    Times are in nanoseconds since 1970, numbers rise by 1 from 1.
    """

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int
    reception_sequence_number: int
    publisher_gid: bytes


SubscriptionCallback = Callable[[ItemT], object] | Callable[[ItemT, MessageInfo], object]
"""What a subscription calls, sync or async; what it returns is awaited if it can be, and not used.
"""


class Publisher(Entity, Generic[MsgT]):
    """Sends messages of one type to one topic. Made by `Node.create_publisher`.

    Attributes:
        msg_type: The class of its messages.
        qos_profile: Its profile.
        stats: What it sent, and which way.
    """

    def __init__(
        self,
        channel: Channel,
        msg_type: type[MsgT],
        writers: Sequence[Writer],
        time_base: TimeBase,
    ) -> None:
        super().__init__(f"publisher of {channel.endpoint.name}", EndStage.LAST)
        self.msg_type = msg_type
        self.qos_profile: QoSProfile = channel.endpoint.qos
        self.stats = PublisherStats(writers, channel.matched)
        self._channel = channel
        self._writers = tuple(writers)
        self._gid = channel.endpoint.gid
        self._home = channel.home
        self._check: Callable[[Any], None] = checker(msg_type)
        self._now_ns = time_base.system_ns

    def __repr__(self) -> str:
        return (
            f"<Publisher {self.topic_name} {self._channel.endpoint.type_name} "
            f"{self.qos_profile} published={self.stats.published}>"
        )

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        return self._channel.endpoint.name

    topic = topic_name

    def publish(self, msg: MsgT | bytes | bytearray | memoryview) -> None:
        """Hand `msg` to every matched subscription; never blocks and never waits.

        The object may be changed and published again at once: readers have a snapshot. A full
        KEEP_LAST queue drops its oldest message and counts it. To wait for slow readers instead,
        subscribe with KEEP_ALL and `await drain()` before publishing on.

        In place of a message it takes one as CDR bytes, such as a subscription with ``raw=True``
        received.

        It may be called in any thread, such as that of an offloaded callback: outside the thread
        of the node's event loop it waits until that loop has taken the message.

        Raises:
            TypeError: `msg` is not of this publisher's type.
            MessageError: a value does not fit its field; nobody got the message.
            DecodeError: the bytes are no message of this publisher's type (a ValueError).
            QueueFullError: a reliable KEEP_ALL subscription of this process is full; nobody got
                the message.
            EntityDestroyedError: the publisher or its node was destroyed (a RuntimeError).
        """
        thread = self._home.thread
        if thread and thread != get_ident():
            self._home.wait_for(self.publish, msg)
            return
        if self.destroyed:
            raise EntityDestroyedError(self.subject)
        if type(msg) is not self.msg_type:
            msg = self._fitting(msg)
        for writer in self._writers:
            if writer.bounded and not writer.has_room():
                raise QueueFullError(self.topic_name, KEEP_ALL_DEPTH)
        stats = self.stats
        origin = Origin(self._gid, stats.published + 1, self._now_ns())
        used = False
        try:
            for writer in self._writers:
                if writer.active:
                    writer.write(msg, origin)
                    used = True
            if not used:
                self._check(msg)
        except MessageError as error:
            error.add_note(f"published by {self.subject}")
            raise
        stats.published += 1

    def _fitting(self, msg: Any) -> Any:
        """Return a message of another class, if it fits all the same; TypeError if it does not."""
        if isinstance(msg, bytes | bytearray | memoryview):
            from aionode.wire import cdr  # who publishes messages in process needs no codec

            return cdr.decode(self.msg_type, msg)
        self._check(msg)  # raises the TypeError; a subclass that fits may pass
        return msg

    async def drain(self) -> None:
        """Wait until every reliable KEEP_ALL reader has room and nothing is left to send.

        What goes to other processes has been handed to the transport then. It does not wait for
        callbacks. Cancelling is safe.
        """
        for writer in self._writers:
            await writer.drain()

    def get_subscription_count(self) -> int:
        """Return how many subscriptions are matched, in this process and in others."""
        return self._channel.count_matched(EndpointKind.SUBSCRIPTION)

    async def wait_for_subscribers(self, count: int = 1) -> None:
        """Wait until at least `count` subscriptions are matched; `asyncio.timeout` limits it."""
        await self._channel.until(lambda: self.get_subscription_count() >= count)

    def _close(self) -> None:
        """Withdraw the publisher."""
        self._channel.close()
        for writer in self._writers:
            writer.close()


class Subscription(Entity, Generic[ItemT]):
    """Receives the messages of one topic. Made by `Node.create_subscription`.

    With a callback, that is called with each message while the node runs. Without one, the
    subscription is an async iterator: ``async for msg in subscription``; each message goes to one
    reader.

    Attributes:
        msg_type: The class of its messages.
        qos_profile: Its profile.
        raw: Whether it receives CDR bytes instead of messages.
        stats: What became of the messages.
    """

    def __init__(
        self,
        channel: Channel,
        msg_type: type[Message],
        callback: SubscriptionCallback[ItemT] | None,
        time_base: TimeBase,
        *,
        concurrent: bool | int,
        raw: bool,
        on_error: OnError,
        offload: bool,
    ) -> None:
        super().__init__(f"subscription of {channel.endpoint.name}")
        self.endpoint = channel.endpoint
        self.msg_type = msg_type
        self.qos_profile: QoSProfile = channel.endpoint.qos
        self.raw = raw
        self.callback = callback
        self.stats = CallbackStats()
        keep_all = self.qos_profile.history is HistoryPolicy.KEEP_ALL
        depth = self.qos_profile.depth or DEFAULT_DEPTH
        self._inbox: Inbox[Any] = Inbox(
            max(depth, KEEP_ALL_DEPTH) if keep_all else depth, self.stats, keep_all=keep_all
        )
        self._channel = channel
        self._announcements: list[Announcement] = []
        self._last_sequences: dict[bytes, int] = {}
        self._reception_sequence = 0
        self._now_ns = time_base.system_ns
        self._concurrent = checked_concurrency(concurrent, self.subject)
        self._turn_ends_ns = 0
        self._dispatch: Dispatch | None = None
        self._shortcut: Shortcut[Any] | None = None
        self._wants_info = False
        if callback is not None:
            wants = accepts(
                callback, 1, 2, subject=self.subject, wanted="(message) or (message, info)"
            )
            self._wants_info = wants == 2  # the message and its info
            self._dispatch = channel.callbacks.dispatch(
                callback, self, self.stats, on_error=on_error, offload=offload
            )
            if self._dispatch.runs_through and self._concurrent is False:
                self._shortcut = Shortcut(self._inbox, self._handle())

    def __repr__(self) -> str:
        return (
            f"<Subscription {self.topic_name} {self.endpoint.type_name} {self.qos_profile} "
            f"received={self.stats.received} dropped={self.stats.dropped}>"
        )

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        return self.endpoint.name

    topic = topic_name

    def get_publisher_count(self) -> int:
        """Return how many publishers are matched, in this process and in others."""
        return self._channel.count_matched(EndpointKind.PUBLISHER)

    # Reading without a callback

    def __aiter__(self) -> AsyncIterator[ItemT]:
        """Iterate over the messages as they come, until the subscription is destroyed."""
        self._refuse_if_called_back()
        return self

    async def __anext__(self) -> ItemT:
        """Return the next message; ends the iteration when destroyed and empty."""
        try:
            return await self.receive()
        except EntityDestroyedError:
            raise StopAsyncIteration from None

    async def receive(self) -> ItemT:
        """Wait for the next message and take it. Cancelling loses nothing.

        Raises:
            EntityDestroyedError: the subscription was destroyed and everything was read.
            RuntimeError: the subscription has a callback, which gets the messages.
        """
        self._refuse_if_called_back()
        if perf_ns() >= self._turn_ends_ns:
            # A reader of a full queue never waits, and without this nothing else would run.
            await give_way()
            self._turn_ends_ns = perf_ns() + SLICE_NS
        while not self._inbox:
            self.refuse_if_destroyed("read")
            await self._inbox.wait()
        entered_ns, item = self._inbox.pop()
        self.stats.received += 1
        self.stats.queue_wait.record(perf_ns() - entered_ns)
        taken: ItemT = item
        return taken

    def _refuse_if_called_back(self) -> None:
        if self._dispatch is not None:
            raise RuntimeError(
                f"{self.subject}: its callback gets the messages; to read them yourself, create "
                "the subscription without a callback"
            )

    # What the transport calls

    def connect(self, announcements: Sequence[Announcement]) -> None:
        """Take what the transports returned for this reader, to be closed with it."""
        self._announcements.extend(announcements)

    def deliver(self, msg: Any, origin: Origin, until_ns: int = 0) -> None:
        """Take one message from a transport; see `Reader` for `until_ns`."""
        if self.destroyed:
            return
        if origin.remote:
            # The publisher becomes the last one, so that the first is silent for longest.
            sequences = self._last_sequences
            gid, sequence = origin.gid, origin.sequence
            last = sequences.pop(gid, sequence - 1)
            sequences[gid] = sequence
            if sequence != last + 1:
                self._note_gap(gid, last, sequence)
            elif len(sequences) > REMEMBERED_PUBLISHERS:
                del sequences[next(iter(sequences))]
        item = (msg, self._info(origin)) if self._wants_info else msg
        if until_ns and self._shortcut is not None and self._shortcut.take(item, until_ns):
            return
        self._inbox.put(item)

    def reject(self, error: DecodeError) -> None:  # noqa: ARG002  # the transport has logged it
        """Count something that is no message of this type."""
        self.stats.errors += 1

    def has_room(self) -> bool:
        """Whether a message can be taken without losing one that should be kept."""
        return self._inbox.has_room()

    def when_room(self, callback: Callable[[], None]) -> None:
        """Call `callback` soon after the next message was taken, or after it was destroyed."""
        self._inbox.when_room(callback)

    async def wait_for_room(self) -> None:
        """Wait until `has_room`, or until destroyed."""
        while not self.destroyed and not self._inbox.has_room():
            await self._inbox.wait_for_room()

    def _note_gap(self, gid: bytes, last: int, sequence: int) -> None:
        if sequence > last:
            self.stats.lost += sequence - last - 1
        else:  # an old one once more
            self._last_sequences[gid] = last

    def _info(self, origin: Origin) -> MessageInfo:
        self._reception_sequence += 1
        return MessageInfo(
            source_timestamp=origin.source_ns,
            received_timestamp=origin.arrived_ns or self._now_ns(),
            publication_sequence_number=origin.sequence,
            reception_sequence_number=self._reception_sequence,
            publisher_gid=origin.gid,
        )

    # Work

    def run(self) -> Coroutine[Any, Any, None] | None:
        """Return the loop that calls the callback; None without a callback."""
        if self._dispatch is None:
            return None
        return pump(self._inbox, self._handle(), self._concurrent, self._shortcut)

    def _handle(self) -> Callable[[int, Any], Coroutine[Any, Any, None] | None]:
        """Return what takes an item of the inbox to the callback."""
        assert self._dispatch is not None  # noqa: S101  # there is a callback
        receive = self._dispatch.receive
        if self._wants_info:
            return lambda entered_ns, item: receive(entered_ns, *item)
        return receive

    def _close(self) -> None:
        """Withdraw the subscription; unread messages are kept for a reader only."""
        self._channel.close()
        for announcement in self._announcements:
            announcement.close()
        if self._dispatch is not None:
            self._inbox.discard()
        self._inbox.wake()
