"""Subscriptions."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import TYPE_CHECKING, Any, Generic, TypedDict, TypeVar

from aionode._concurrency import SLICE_NS, checkpoint
from aionode.clock import perf_ns
from aionode.content_filter import ContentFilterOptions, compile_filter
from aionode.endpoints._core.callback_runner import (
    CallbackRunner,
    accepts,
    checked_concurrency,
    consume,
)
from aionode.endpoints._core.endpoint import Endpoint
from aionode.endpoints._core.message_queue import MessageQueue
from aionode.endpoints._qos.event_hub import is_limited
from aionode.endpoints._qos.subscription_monitor import SubscriptionMonitor
from aionode.endpoints.stats import NOTED_CALLS, CallbackStats
from aionode.errors import DecodeError, EntityDestroyedError
from aionode.message import Message
from aionode.qos import HistoryPolicy, depth_of, is_unlimited
from aionode.transport.base import ReaderRegistration, SampleInfo

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Sequence

    from aionode.clock import TimeBase
    from aionode.endpoints._core.callback_runner import OnError
    from aionode.endpoints._core.endpoint import EndpointSetup
    from aionode.endpoints.events import (
        EventStream,
        SubscriptionEvent,
        SubscriptionEventCallbacks,
    )
    from aionode.graph import EndpointInfo
    from aionode.transport.base import Registration

__all__ = ["MessageInfo", "Subscription", "SubscriptionCallback"]

ItemT = TypeVar("ItemT")

REMEMBERED_PUBLISHERS = 1024
"""For how many publishers a subscription keeps the last sequence number."""


class MessageInfo(TypedDict):
    """What is known about a message besides its content, with rclpy's keys.

    Times are in nanoseconds since 1970; sequence numbers start at 1 and increase by 1.
    """

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int
    reception_sequence_number: int
    publisher_gid: bytes


SubscriptionCallback = Callable[[ItemT], object] | Callable[[ItemT, MessageInfo], object]
"""What a subscription calls, sync or async; an awaitable that it returns is awaited."""


class Subscription(Endpoint, Generic[ItemT]):
    """Receives the messages of one topic. Made by `Node.create_subscription`.

    A callback is called with each message while the node runs. Without one, the subscription is an
    async iterator: ``async for msg in subscription``. If several tasks read it, each message goes
    to one of them.

    Attributes:
        msg_type: The class of its messages.
        qos_profile: Its profile.
        raw: Whether it receives CDR bytes instead of messages.
        callback: The callback, or None.
        stats: Counts and durations of its messages.
    """

    def __init__(
        self,
        setup: EndpointSetup,
        msg_type: type[Message],
        callback: SubscriptionCallback[ItemT] | None,
        time_base: TimeBase,
        *,
        concurrent: bool | int,
        raw: bool,
        on_error: OnError,
        offload: bool,
        event_callbacks: SubscriptionEventCallbacks | None = None,
    ) -> None:
        super().__init__(f"subscription of {setup.endpoint.name}", setup)
        self.msg_type = msg_type
        self.raw = raw
        self.callback = callback
        self.stats = CallbackStats()
        self._registrations: list[Registration] = []  # one for each transport
        self._content_filter: ContentFilterOptions | None = None
        self._concurrent = checked_concurrency(concurrent, self._subject)
        self._turn_ends_ns = 0
        self._runner: CallbackRunner | None = None
        wants = 1
        if callback is not None:
            wants = accepts(
                callback, 1, 2, subject=self._subject, wanted="(message) or (message, info)"
            )
            self._runner = setup.callbacks.make_runner(
                callback, self, self.stats, on_error=on_error, offload=offload
            )
        self._reader = _Reader(
            setup.endpoint, self.stats, time_base, raw=raw, wants_info=wants == 2
        )
        if self._runner is not None:
            self._reader.runner = self._runner
        self._time_base = time_base
        self._runs = False
        self._monitor: SubscriptionMonitor | None = None  # if a policy or the program needs one
        qos = self.qos_profile
        limits = qos.deadline, qos.lifespan, qos.liveliness_lease_duration
        if event_callbacks is not None or is_limited(*limits):
            self._make_monitor(event_callbacks)
        else:
            self._watch(self._note_publisher)

    def __repr__(self) -> str:
        return (
            f"<Subscription {self.topic_name} {self._endpoint.type_name} "
            f"{self.qos_profile} "
            f"received={self.stats.received} dropped={self.stats.dropped}>"
        )

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        return self._endpoint.name

    topic = topic_name

    def get_publisher_count(self) -> int:
        """Return how many publishers are matched, in this process and in others."""
        return self._count_matched()

    # Content filter

    @property
    def is_cft_enabled(self) -> bool:
        """Whether a content filter is set."""
        options = self._content_filter
        return options is not None and bool(options.filter_expression)

    def set_content_filter(
        self, filter_expression: str, expression_parameters: Sequence[str] = ()
    ) -> None:
        """Receive only messages that pass a filter, from now on.

        Messages that are already in the queue stay there. Publishers of aionode in other processes
        learn of the filter as soon as the network allows, and then leave out what no subscription
        wants, unless a liveliness lease makes every message a sign of life; `stats.filtered` counts
        what arrived and did not pass.

        Args:
            filter_expression: A condition over the fields of the message, as described in
                `aionode.content_filter`; an empty one lets all messages pass.
            expression_parameters: The literals that ``%0`` and the following stand for, as text.

        Raises:
            ContentFilterError: the expression is malformed, or does not fit the type (a
                ValueError). The filter before it stays.
            TypeError: a parameter is not a str.
            EntityDestroyedError: the subscription was destroyed (a RuntimeError).
        """
        if self._affinity.is_other_thread():
            self._affinity.wait_for(
                self.set_content_filter, filter_expression, expression_parameters
            )
            return
        self._refuse_if_destroyed("set content filter")
        accepts = None
        options = ContentFilterOptions(filter_expression, list(expression_parameters))
        if filter_expression:
            accepts = compile_filter(self.msg_type, filter_expression, expression_parameters)
            if self.raw:
                accepts = decoding(self.msg_type, accepts)
        self._content_filter = options
        self._reader.set_filter(accepts)
        self._announce_filter(options)

    def get_content_filter(self) -> ContentFilterOptions:
        """Return the content filter; its expression is empty if there is none."""
        given = self._content_filter or ContentFilterOptions()
        return ContentFilterOptions(given.filter_expression, list(given.expression_parameters))

    # Events

    @property
    def events(self) -> EventStream[SubscriptionEvent]:
        """The events of the subscription: ``async for event in subscription.events``.

        It is the same stream each time; it begins with what has happened so far.
        """
        return (self._monitor or self._make_monitor()).events()

    def _note_publisher(self, publisher: EndpointInfo, present: bool) -> None:
        """Have messages expire if a publisher says so."""
        limited = present and is_limited(publisher.qos.lifespan)
        if limited and self._monitor is None and self._endpoint.matches(publisher):
            self._make_monitor()

    def _make_monitor(
        self, event_callbacks: SubscriptionEventCallbacks | None = None
    ) -> SubscriptionMonitor:
        monitor = SubscriptionMonitor(self, self._reader, self._time_base, event_callbacks)
        self._monitor = self._reader.monitor = monitor
        if self._runs:
            monitor.start()
        if self.destroyed:
            monitor.close()
        return monitor

    # Reading without a callback

    def __aiter__(self) -> AsyncIterator[ItemT]:
        """Iterate over the messages as they arrive, until the subscription is destroyed."""
        self._refuse_if_it_has_a_callback()
        return self

    async def __anext__(self) -> ItemT:
        """Wait for the next message; end the iteration once destroyed and empty."""
        try:
            return await self.receive()
        except EntityDestroyedError:
            raise StopAsyncIteration from None

    async def receive(self) -> ItemT:
        """Wait for the next message and take it. Cancelling loses nothing.

        Raises:
            EntityDestroyedError: the subscription is destroyed, and all messages have been read.
            RuntimeError: the subscription has a callback, which gets the messages.
        """
        self._refuse_if_it_has_a_callback()
        if perf_ns() >= self._turn_ends_ns:
            # With a full queue this never waits, so nothing else would run.
            await checkpoint()
            self._turn_ends_ns = perf_ns() + SLICE_NS
        while not self._reader:
            self._refuse_if_destroyed("read messages")
            await self._reader.wait()
        entered_ns, item = self._reader.pop()
        self.stats.received += 1
        self.stats.queue_wait.record(perf_ns() - entered_ns)
        taken: ItemT = item
        return taken

    def _refuse_if_it_has_a_callback(self) -> None:
        if self._runner is not None:
            raise RuntimeError(
                f"{self._subject}: its callback gets the messages; to read them yourself, create "
                "the subscription without a callback"
            )

    # Called by the node

    def _add_registrations(self, registrations: Sequence[Registration]) -> None:
        """Keep what the transports returned for this reader, to be closed with it."""
        self._registrations.extend(registrations)
        if self._content_filter is not None:
            self._announce_filter(self._content_filter)

    def _announce_filter(self, content_filter: ContentFilterOptions) -> None:
        """Tell publishers of the filter, unless their messages are awaited as signs of life."""
        if not is_unlimited(self.qos_profile.liveliness_lease_duration):
            return
        for registration in self._registrations:
            if isinstance(registration, ReaderRegistration):
                registration.set_content_filter(content_filter)

    def _run(self) -> Coroutine[Any, Any, None] | None:
        """Return the coroutine that calls the callback; None without a callback."""
        self._runs = True
        if self._monitor is not None:
            self._monitor.start()
        if self._runner is None:
            return None
        receive: Callable[[int, Any], Coroutine[Any, Any, None] | None] = self._runner.receive
        if self._reader.wants_info:
            with_info = self._runner.receive
            receive = lambda entered_ns, item: with_info(entered_ns, *item)  # noqa: E731
        return consume(self._reader, receive, self._concurrent, inline=self._runner.is_sync)

    def _close(self) -> None:
        """Withdraw the subscription; unread messages can still be read, without a callback."""
        if self._monitor is not None:
            self._monitor.close()
        self._leave_graph()
        for registration in self._registrations:
            registration.close()
        self._reader.close(discard=self._runner is not None)


def decoding(msg_type: type[Message], accepts: Callable[[Any], bool]) -> Callable[[Any], bool]:
    """Return a filter for messages that are delivered as CDR bytes."""
    from aionode.wire import cdr  # few subscriptions are raw

    decode = cdr.decoder(msg_type)

    def accepts_bytes(data: Any) -> bool:
        try:
            return accepts(decode(data))
        except DecodeError:
            return True  # a raw subscription gets malformed messages, too

    return accepts_bytes


class _Reader(MessageQueue[Any]):
    """The queue of a subscription, into which transports deliver: their `Reader`.

    Args:
        endpoint: The subscription in the graph.
        stats: Where lost, dropped and invalid messages are counted.
        time_base: Where the arrival time in a `MessageInfo` comes from.
        raw: Whether messages come as CDR bytes.
        wants_info: Whether the items are pairs of a message and its `MessageInfo`.

    Attributes:
        monitor: Is told which publishers are alive; None without one.
        on_arrival: Called with each message; returns whether to deliver it. None for all.
        on_lost: Called with the number of messages that are found missing; None for nothing.
        runner: Runs the callback; not set without one.
    """

    __slots__ = (
        "_accepts",
        "_closed",
        "_last_sequences",
        "_now_ns",
        "_reception_sequence",
        "endpoint",
        "monitor",
        "on_arrival",
        "on_lost",
        "raw",
        "runner",
        "wants_info",
    )

    def __init__(
        self,
        endpoint: EndpointInfo,
        stats: CallbackStats,
        time_base: TimeBase,
        *,
        raw: bool,
        wants_info: bool,
    ) -> None:
        keep_all = endpoint.qos.history is HistoryPolicy.KEEP_ALL
        super().__init__(depth_of(endpoint.qos), stats, keep_all=keep_all)
        self.endpoint = endpoint
        self.raw = raw
        self.wants_info = wants_info
        self._now_ns = time_base.system_ns
        self._closed = False
        self._accepts: Callable[[Any], bool] | None = None  # the content filter
        self.monitor: SubscriptionMonitor | None = None
        self.on_arrival: Callable[[SampleInfo], bool] | None = None
        self.on_lost: Callable[[int], None] | None = None
        self.runner: CallbackRunner
        # By the gid of the publisher; the one known for longest is first.
        self._last_sequences: dict[bytes, int] = {}
        self._reception_sequence = 0

    def deliver(  # noqa: C901  # fewer calls for each message, see below
        self,
        msg: Any,
        gid: bytes,
        sequence: int,
        source_ns: int,
        inline_deadline_ns: int = 0,
        arrived_ns: int = 0,
    ) -> None:
        """Take one message from a transport; see `Reader` for the arguments."""
        if self._accepts is not None or self.on_arrival is not None or self.wants_info:
            sample_info = SampleInfo(gid, sequence, source_ns, arrived_ns)
            self._deliver_with(msg, sample_info, inline_deadline_ns)
            return
        last_sequences = self._last_sequences
        if last_sequences.get(gid) == sequence - 1:
            last_sequences[gid] = sequence
        else:
            self._note_sequence(gid, sequence)
        waiter = self._inline_waiter
        if (
            inline_deadline_ns
            and waiter is not None
            and not waiter.done()
            and (began_ns := perf_ns()) < inline_deadline_ns
        ):
            # `take_inline` and `CallbackRunner.receive` written out: five calls fewer.
            runner, stats = self.runner, self.stats
            stats.received += 1
            self._inline_waiter = None
            try:
                outcome = self._context.run(runner.callback, msg)  # type: ignore[union-attr]  # `consume` has set it
                took_ns = perf_ns() - began_ns
                if outcome is None and took_ns <= runner.budget_ns:
                    noted = stats._inline_ns
                    noted.append(took_ns)
                    if len(noted) >= NOTED_CALLS:
                        stats._record_noted()
                    return
                done = self.run(runner.conclude, 0, took_ns, outcome)
            except BaseException as error:  # noqa: BLE001  # handled as if the task had called
                done = self.run(runner.conclude, 0, perf_ns() - began_ns, None, error)
            finally:
                self._inline_waiter = waiter
            if not done and not waiter.done():
                waiter.set_result(None)
            return
        # `put` written out.
        queue = self.items
        if len(queue) >= self.depth:
            self.stats.dropped += 1
            if self.keep_all:
                return
            queue.popleft()
        queue.append((perf_ns(), msg))
        if self._readers:
            self.wake_readers()

    def handle_items(
        self,
        handle: Callable[[int, Any], Coroutine[object, object, None] | None],
        turn_ends_ns: int,
    ) -> Coroutine[object, object, None] | None:
        """Call the callback with each message until one leaves something to await.

        `CallbackRunner.receive` written out, with one reading of the clock for the end of a call
        and the start of the next: half of what a message in a burst costs here.
        """
        runner, stats = self.runner, self.stats
        if self.wants_info or runner.offload:
            return super().handle_items(handle, turn_ends_ns)
        callback, budget_ns = runner.callback, runner.budget_ns
        waited, took = stats._waited_ns, stats._took_ns
        began_ns = perf_ns()
        while self.items:
            entered_ns, msg = self.items.popleft()
            if self._writers:
                self.wake_writers()
            stats.received += 1
            try:
                outcome = callback(msg)
            except Exception as error:  # noqa: BLE001  # the policy decides, see `fail`
                return runner.conclude(began_ns - entered_ns, perf_ns() - began_ns, None, error)
            ended_ns = perf_ns()
            took_ns = ended_ns - began_ns
            if outcome is not None or took_ns > budget_ns:
                return runner.conclude(began_ns - entered_ns, took_ns, outcome)
            waited.append(began_ns - entered_ns)
            took.append(took_ns)
            if len(took) >= NOTED_CALLS:
                stats._record_noted()
            if ended_ns >= turn_ends_ns:
                return None
            began_ns = ended_ns
        return None

    def _deliver_with(self, msg: Any, sample_info: SampleInfo, inline_deadline_ns: int) -> None:
        """Deliver a message to a filter, a monitor, or a callback that takes its info."""
        if self._accepts is not None:
            if not self._accepts(msg):
                self.stats.filtered += 1
                if self.monitor is not None:
                    self.monitor.note_filtered(sample_info.gid)
                return
        else:
            self._note_sequence(sample_info.gid, sample_info.sequence)
        if self.on_arrival is not None and not self.on_arrival(sample_info):
            return
        item = (msg, self._info(sample_info)) if self.wants_info else msg
        if not (inline_deadline_ns and self.take_inline(item, inline_deadline_ns)):
            self.put(item)

    def set_filter(self, accepts: Callable[[Any], bool] | None) -> None:
        """Deliver only what `accepts` is true of, or everything.

        Gaps are not counted with a filter: publishers may leave out what does not pass.
        """
        self._accepts = accepts
        self._last_sequences.clear()

    def note_alive(self, gid: bytes) -> None:
        """Take the assertion of a publisher that it is alive."""
        if self.monitor is not None:
            self.monitor.note_alive(gid)

    def reject(self, error: DecodeError) -> None:  # noqa: ARG002  # the transport has logged it
        """Count bytes that are not a message of the subscription's type."""
        self.stats.errors += 1

    async def wait_for_room(self) -> None:
        """Wait until `has_room`, or until the subscription is destroyed."""
        while not (self._closed or self.has_room()):
            await super().wait_for_room()

    def close(self, *, discard: bool) -> None:
        """Take no more messages, wake all that wait, and drop unread messages if `discard`."""
        self._closed = True
        self._accepts = None
        self.on_arrival = refuse
        self.on_lost = None
        if discard:
            self.discard()
        self.wake()

    def _note_sequence(self, gid: bytes, sequence: int) -> None:
        """Take the number of a message, and count those before it that are missing."""
        last_sequences = self._last_sequences
        last = last_sequences.get(gid)
        if last is None:
            if len(last_sequences) >= REMEMBERED_PUBLISHERS:
                del last_sequences[next(iter(last_sequences))]
        elif sequence <= last:  # an old one again
            return
        elif sequence > last + 1:
            self.stats.lost += sequence - last - 1
            if self.on_lost is not None:
                self.on_lost(sequence - last - 1)
        last_sequences[gid] = sequence

    def _info(self, sample_info: SampleInfo) -> MessageInfo:
        self._reception_sequence += 1
        return MessageInfo(
            source_timestamp=sample_info.source_ns,
            received_timestamp=sample_info.arrived_ns or self._now_ns(),
            publication_sequence_number=sample_info.sequence,
            reception_sequence_number=self._reception_sequence,
            publisher_gid=sample_info.gid,
        )


def refuse(sample_info: SampleInfo) -> bool:  # noqa: ARG001  # as `on_arrival`
    """Deliver nothing: the subscription is closed."""
    return False
