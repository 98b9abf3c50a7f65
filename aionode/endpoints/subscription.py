"""Subscriptions."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import TYPE_CHECKING, Any, Generic, TypedDict, TypeVar

from aionode._concurrency import SLICE_NS, checkpoint
from aionode.clock import perf_ns
from aionode.endpoints._core.callback_runner import (
    CallbackRunner,
    accepts,
    checked_concurrency,
    consume,
)
from aionode.endpoints._core.entity import Entity
from aionode.endpoints._core.inline_runner import InlineRunner
from aionode.endpoints._core.message_queue import MessageQueue
from aionode.endpoints.stats import CallbackStats
from aionode.errors import EntityDestroyedError
from aionode.graph import EndpointKind
from aionode.message import Message
from aionode.qos import DEFAULT_DEPTH, KEEP_ALL_DEPTH, HistoryPolicy
from aionode.transport.base import SampleInfo

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Sequence

    from aionode.clock import TimeBase
    from aionode.endpoints._core.callback_runner import OnError
    from aionode.endpoints._core.graph_entry import GraphEntry
    from aionode.errors import DecodeError
    from aionode.qos import QoSProfile
    from aionode.transport.base import Registration

__all__ = ["MessageInfo", "Subscription", "SubscriptionCallback"]

ItemT = TypeVar("ItemT")

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
        graph_entry: GraphEntry,
        msg_type: type[Message],
        callback: SubscriptionCallback[ItemT] | None,
        time_base: TimeBase,
        *,
        concurrent: bool | int,
        raw: bool,
        on_error: OnError,
        offload: bool,
    ) -> None:
        super().__init__(f"subscription of {graph_entry.endpoint.name}")
        self.endpoint = graph_entry.endpoint
        self.msg_type = msg_type
        self.qos_profile: QoSProfile = graph_entry.endpoint.qos
        self.raw = raw
        self.callback = callback
        self.stats = CallbackStats()
        keep_all = self.qos_profile.history is HistoryPolicy.KEEP_ALL
        depth = self.qos_profile.depth or DEFAULT_DEPTH
        self._message_queue: MessageQueue[Any] = MessageQueue(
            max(depth, KEEP_ALL_DEPTH) if keep_all else depth, self.stats, keep_all=keep_all
        )
        self._graph_entry = graph_entry
        self._registrations: list[Registration] = []
        self._last_sequences: dict[bytes, int] = {}
        self._reception_sequence = 0
        self._now_ns = time_base.system_ns
        self._concurrent = checked_concurrency(concurrent, self.subject)
        self._turn_ends_ns = 0
        self._runner: CallbackRunner | None = None
        self._inline_runner: InlineRunner[Any] | None = None
        self._wants_info = False
        if callback is not None:
            wants = accepts(
                callback, 1, 2, subject=self.subject, wanted="(message) or (message, info)"
            )
            self._wants_info = wants == 2  # the message and its info
            self._runner = graph_entry.callbacks.make_runner(
                callback, self, self.stats, on_error=on_error, offload=offload
            )
            if self._runner.is_sync and self._concurrent is False:
                self._inline_runner = InlineRunner(self._message_queue, self._handle())

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
        return self._graph_entry.count_matched(EndpointKind.PUBLISHER)

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
            await checkpoint()
            self._turn_ends_ns = perf_ns() + SLICE_NS
        while not self._message_queue:
            self.refuse_if_destroyed("read messages")
            await self._message_queue.wait()
        entered_ns, item = self._message_queue.pop()
        self.stats.received += 1
        self.stats.queue_wait.record(perf_ns() - entered_ns)
        taken: ItemT = item
        return taken

    def _refuse_if_called_back(self) -> None:
        if self._runner is not None:
            raise RuntimeError(
                f"{self.subject}: its callback gets the messages; to read them yourself, create "
                "the subscription without a callback"
            )

    # What the transport calls

    def add_registrations(self, registrations: Sequence[Registration]) -> None:
        """Take what the transports returned for this reader, to be closed with it."""
        self._registrations.extend(registrations)

    def deliver(self, msg: Any, sample_info: SampleInfo, inline_deadline_ns: int = 0) -> None:
        """Take one message from a transport; see `Reader` for `inline_deadline_ns`."""
        if self.destroyed:
            return
        if sample_info.remote:
            # The publisher becomes the last one, so that the first is silent for longest.
            sequences = self._last_sequences
            gid, sequence = sample_info.gid, sample_info.sequence
            last = sequences.pop(gid, sequence - 1)
            sequences[gid] = sequence
            if sequence != last + 1:
                self._note_gap(gid, last, sequence)
            elif len(sequences) > REMEMBERED_PUBLISHERS:
                del sequences[next(iter(sequences))]
        item = (msg, self._info(sample_info)) if self._wants_info else msg
        if (
            inline_deadline_ns
            and self._inline_runner is not None
            and self._inline_runner.take(item, inline_deadline_ns)
        ):
            return
        self._message_queue.put(item)

    def reject(self, error: DecodeError) -> None:  # noqa: ARG002  # the transport has logged it
        """Count something that is no message of this type."""
        self.stats.errors += 1

    def has_room(self) -> bool:
        """Whether a message can be taken without losing one that should be kept."""
        return self._message_queue.has_room()

    def when_room(self, callback: Callable[[], None]) -> None:
        """Call `callback` soon after the next message was taken, or after it was destroyed."""
        self._message_queue.when_room(callback)

    async def wait_for_room(self) -> None:
        """Wait until `has_room`, or until destroyed."""
        while not self.destroyed and not self._message_queue.has_room():
            await self._message_queue.wait_for_room()

    def _note_gap(self, gid: bytes, last: int, sequence: int) -> None:
        if sequence > last:
            self.stats.lost += sequence - last - 1
        else:  # an old one once more
            self._last_sequences[gid] = last

    def _info(self, sample_info: SampleInfo) -> MessageInfo:
        self._reception_sequence += 1
        return MessageInfo(
            source_timestamp=sample_info.source_ns,
            received_timestamp=sample_info.arrived_ns or self._now_ns(),
            publication_sequence_number=sample_info.sequence,
            reception_sequence_number=self._reception_sequence,
            publisher_gid=sample_info.gid,
        )

    # Work

    def run(self) -> Coroutine[Any, Any, None] | None:
        """Return the loop that calls the callback; None without a callback."""
        if self._runner is None:
            return None
        return consume(self._message_queue, self._handle(), self._concurrent, self._inline_runner)

    def _handle(self) -> Callable[[int, Any], Coroutine[Any, Any, None] | None]:
        """Return what takes an item of the inbox to the callback."""
        assert self._runner is not None  # noqa: S101  # there is a callback
        receive = self._runner.receive
        if self._wants_info:
            return lambda entered_ns, item: receive(entered_ns, *item)
        return receive

    def _close(self) -> None:
        """Withdraw the subscription; unread messages are kept for a reader only."""
        self._graph_entry.close()
        for registration in self._registrations:
            registration.close()
        if self._runner is not None:
            self._message_queue.discard()
        self._message_queue.wake()
