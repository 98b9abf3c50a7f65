"""The reader of a subscription, to which transports deliver messages."""

from __future__ import annotations

from asyncio import CancelledError
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol, TypedDict

from msgspec import Struct

from aionode._process.recent import Recent
from aionode.clock import perf_ns
from aionode.endpoints.core.message_queue import UNWEIGHED, MessageQueue
from aionode.endpoints.stats import NOTED_CALLS, CallbackStats
from aionode.engine.causes import Party, Run, take
from aionode.engine.rules.missing_messages import REMEMBERED_PUBLISHERS, missing_before
from aionode.engine.transport.base import SampleInfo
from aionode.qos import HistoryPolicy, depth_of

if TYPE_CHECKING:
    from collections.abc import Coroutine

    from aionode.clock import TimeBase
    from aionode.endpoints.core.callback_runner import CallbackRunner
    from aionode.engine.causes import CauseLog
    from aionode.engine.transport.base import Raw
    from aionode.errors import DecodeError
    from aionode.graph import EndpointInfo

__all__ = [
    "CausalReader",
    "DirectReader",
    "MessageInfo",
    "Parts",
    "SubscriptionReader",
    "Take",
    "size_of_raw",
]

Parts = bytes | memoryview | list[bytes | memoryview]
"""A message as CDR bytes, as a list of parts, or in memory that its sender lends (see `Reader`)."""


def size_of_raw(raw: Parts) -> int:
    """Return the size of a message in bytes."""
    return sum(map(len, raw)) if isinstance(raw, list) else len(raw)


Take = Callable[[Parts, int, int, int], None]
"""Takes a message, its sequence number, and the times of publication and reception, in nanoseconds
since 1970.
"""


class MessageInfo(TypedDict):
    """Sender, times and sequence number of a message, with rclpy's keys.

    Times are in nanoseconds since 1970; sequence numbers start at 1 and increase by 1.
    """

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int
    reception_sequence_number: int
    publisher_gid: bytes


class Monitor(Protocol):
    """An observer that is told which publishers are alive."""

    def note_alive(self, gid: bytes) -> None:
        """Record that a publisher asserted its liveliness."""

    def note_filtered(self, gid: bytes) -> None:
        """Record a message that is not delivered."""


class Watch(Protocol):
    """An observer of arriving messages, which may reject them."""

    def admits(self, sample_info: SampleInfo) -> bool:
        """Record an arrived message; return whether to queue it."""


class SubscriptionReader(MessageQueue[Any]):
    """The queue of a subscription, into which transports deliver: their `Reader`.

    Args:
        endpoint: The subscription in the graph.
        stats: Where lost, dropped and invalid messages are counted.
        time_base: The source of the arrival time in a `MessageInfo`.
        raw: Whether messages are CDR bytes, possibly in parts.
        wants_info: Whether the items are pairs of a message and its `MessageInfo`.

    Attributes:
        is_concurrent: Whether several callbacks may run at once, each in a task of its own.
        monitor: Learns which publishers are alive, or None.
        on_arrival: Called with each message; returns whether to deliver it. None delivers all.
        on_lost: Called with the number of missing messages, or None.
        runner: Runs the callback; unset without one, see `set_runner`.
        watch: Sees arriving messages, and may reject them, or None. With one, messages do not
            bypass the queue.
    """

    __slots__ = (
        "_accepts",
        "_call",
        "_closed",
        "_last_sequences",
        "_now_ns",
        "_reception_sequence",
        "endpoint",
        "is_concurrent",
        "monitor",
        "on_arrival",
        "on_lost",
        "raw",
        "runner",
        "wants_info",
        "watch",
    )

    def __init__(
        self,
        endpoint: EndpointInfo,
        stats: CallbackStats,
        time_base: TimeBase,
        *,
        raw: Raw,
        wants_info: bool,
    ) -> None:
        keep_all = endpoint.qos.history is HistoryPolicy.KEEP_ALL
        super().__init__(
            depth_of(endpoint.qos), stats, keep_all=keep_all, slice_ns=time_base.slice_ns
        )
        self.endpoint = endpoint
        self.raw = raw
        self.wants_info = wants_info
        self._now_ns = time_base.system_ns
        self._closed = False
        self._accepts: Callable[[Any], bool] | None = None  # the content filter
        self.is_concurrent = False
        self.monitor: Monitor | None = None
        self.on_arrival: Callable[[SampleInfo], bool] | None = None
        self.on_lost: Callable[[int], None] | None = None
        self.runner: CallbackRunner
        self._call: Callable[[Any], Any]  # calls the callback with an item
        self.watch: Watch | None = None
        # By the gid of the publisher; the longest known one is first.
        self._last_sequences: Recent[bytes, int] = Recent(REMEMBERED_PUBLISHERS)
        self._reception_sequence = 0

    def deliver(
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
        if inline_deadline_ns:
            if not self.take_inline(msg, inline_deadline_ns):
                self.put(msg)
            return
        # `put` written out: a call fewer.
        queue = self.items
        count = len(queue)
        if (count >= self.own_from or count == self.weighed_from) and not self.make_room(msg):
            return
        queue.append((perf_ns(), msg))
        if self._readers:
            self.wake_readers()
        elif (waiter := self._inline_waiter) is not None:
            self._inline_waiter = None
            self._call_soon(self.take_turn, waiter, context=self.context)

    # The callback: `take_inline` and `handle_items` have `CallbackRunner.receive` inlined, which
    # handles what is concurrent, offloaded or watched. They have to agree:
    # tests/endpoints/core/test_ways_to_a_callback.py

    def take_inline(self, item: Any, inline_deadline_ns: int) -> bool:
        """Call the callback with `item` now, as `MessageQueue.take_inline` says.

        Five calls fewer than there, and no wait to record: an eighth of what a message costs.
        """
        waiter = self._inline_waiter
        if waiter is None or waiter.done() or (began_ns := perf_ns()) >= inline_deadline_ns:
            return False
        runner, stats, context = self.runner, self.stats, self.context
        stats.received += 1
        self._inline_waiter = None
        try:
            outcome = context.run(self._call, item)
            took_ns = perf_ns() - began_ns
            if outcome is None and took_ns <= runner.budget_ns:
                noted = stats._inline_ns
                noted.append(took_ns)
                if len(noted) >= NOTED_CALLS:
                    stats._record_noted()
                if began_ns >= runner.thread_time.due_ns:
                    runner.thread_time.read(began_ns)
            else:
                context.run(self.run, runner.conclude, 0, took_ns, outcome)
        except BaseException as error:  # noqa: BLE001  # handled as if the task had called
            context.run(self.run, runner.conclude, 0, perf_ns() - began_ns, None, error)
        finally:
            if self.items or self._rest is not None or self._error is not None:
                self._wait_on(waiter)
            else:
                self._inline_waiter = waiter
        return True

    def handle_items(
        self,
        handle: Callable[[int, Any], Coroutine[object, object, None] | None],
        now_ns: int,
        turn_ends_ns: int,
    ) -> Coroutine[object, object, None] | None:
        """Call the callback with each message until one leaves something to await.

        One reading of the clock serves for the end of a call and the start of the next: half of
        what a message in a burst costs here.
        """
        runner, stats = self.runner, self.stats
        if runner.offload or self.is_concurrent:
            return super().handle_items(handle, now_ns, turn_ends_ns)
        call, budget_ns = self._call, runner.budget_ns
        waited, took = stats._waited_ns, stats._took_ns
        began_ns = now_ns
        while self.items:
            entered_ns, item = self.items.popleft()
            if self._writers:
                self.wake_writers()
            stats.received += 1
            try:
                outcome = call(item)
            except (Exception, CancelledError) as error:  # noqa: BLE001  # the policy decides, see `fail`
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
                break
            began_ns = ended_ns
        if began_ns >= runner.thread_time.due_ns:
            runner.thread_time.read(began_ns)
        return None

    def _deliver_with(self, msg: Any, sample_info: SampleInfo, inline_deadline_ns: int) -> None:
        """Deliver a message past a filter or monitor, or to a callback that takes its info."""
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
        if self.watch is not None and not self.watch.admits(sample_info):
            return
        item = (msg, self._info(sample_info)) if self.wants_info else msg
        if not (inline_deadline_ns and self.take_inline(item, inline_deadline_ns)):
            self.put(item, is_own=not inline_deadline_ns)

    def set_runner(self, runner: CallbackRunner) -> None:
        """Call a callback with what arrives, from when `consume` runs."""
        self.runner = runner
        callback = runner.callback
        self._call = (lambda item: callback(*item)) if self.wants_info else callback

    def weigh_messages(
        self, size_of: Callable[[Any], int], limit_bytes: int, on_heavy: Callable[[], None]
    ) -> None:
        """Limit the total size of the queued messages; see `weigh`."""
        of_item = (lambda item: size_of(item[0])) if self.wants_info else size_of
        self.weigh(of_item, limit_bytes, on_heavy)

    def set_filter(self, accepts: Callable[[Any], bool] | None) -> None:
        """Deliver only messages that `accepts` returns true for, or all.

        With a filter gaps are not counted, as publishers may leave out messages that do not pass.
        """
        self._accepts = accepts
        self._last_sequences.clear()

    def set_watch(self, watch: Watch) -> None:
        """Ask `watch` about each message from now on."""
        self.watch = watch
        if self.on_arrival is None:
            self.on_arrival = admit  # `deliver` checks only this

    def note_alive(self, gid: bytes) -> None:
        """Record that a publisher asserted its liveliness."""
        if self.monitor is not None:
            self.monitor.note_alive(gid)

    def reject(self, error: DecodeError) -> None:  # noqa: ARG002  # already logged by the transport
        """Count bytes that are not a message of the subscription's type."""
        self.stats.errors += 1

    async def wait_for_room(self) -> None:
        """Wait until `has_room`, or until the subscription is destroyed."""
        while not (self._closed or self.has_room()):
            await super().wait_for_room()

    def close(self, *, discard: bool) -> None:
        """Stop accepting messages, wake all waiters, and drop unread messages if `discard`."""
        self._closed = True
        self._accepts = None
        self.on_arrival = refuse
        self.on_lost = None
        if discard:
            self.discard()
        self.wake()

    def _note_sequence(self, gid: bytes, sequence: int) -> None:
        """Record the sequence number of a message, and count missing ones before it."""
        missing = missing_before(self._last_sequences, gid, sequence)
        if missing:
            self.stats.lost += missing
            if self.on_lost is not None:
                self.on_lost(missing)

    def _info(self, sample_info: SampleInfo) -> MessageInfo:
        self._reception_sequence += 1
        return MessageInfo(
            source_timestamp=sample_info.source_ns,
            received_timestamp=sample_info.arrived_ns or self._now_ns(),
            publication_sequence_number=sample_info.sequence,
            reception_sequence_number=self._reception_sequence,
            publisher_gid=sample_info.gid,
        )


class Arrived(Struct, frozen=True):
    """An item of a queue with what identifies its message."""

    item: Any
    gid: bytes
    sequence: int


class CausalReader(SubscriptionReader):
    """Notes which message each callback works on, so that what it sends has a cause.

    A class of its own, so that it costs nothing where causes are not kept.

    Args:
        endpoint: The subscription in the graph.
        stats: Where lost, dropped and invalid messages are counted.
        time_base: The source of the arrival time in a `MessageInfo`.
        raw: Whether messages are CDR bytes.
        wants_info: Whether the items are pairs of a message and its `MessageInfo`.
        log: Where the runs of the callback are kept.
    """

    __slots__ = ("_arriving", "_log", "_party")

    def __init__(
        self,
        endpoint: EndpointInfo,
        stats: CallbackStats,
        time_base: TimeBase,
        *,
        raw: Raw,
        wants_info: bool,
        log: CauseLog,
    ) -> None:
        super().__init__(endpoint, stats, time_base, raw=raw, wants_info=wants_info)
        self._log = log
        self._party = Party.of(endpoint)
        self._arriving = (b"", 0)

    def set_runner(self, runner: CallbackRunner) -> None:
        """Call a callback with what arrives, from when `consume` runs."""
        super().set_runner(runner)
        self._party = runner.party_of(self.endpoint)

    def weigh(
        self,
        size_of: Callable[[Any], int],
        limit_bytes: int,
        on_heavy: Callable[[], None],
        unweighed: int = UNWEIGHED,
    ) -> None:
        """Limit the total size of the items; see `MessageQueue.weigh`."""
        super().weigh(lambda arrived: size_of(arrived.item), limit_bytes, on_heavy, unweighed)

    def deliver(
        self,
        msg: Any,
        gid: bytes,
        sequence: int,
        source_ns: int,
        inline_deadline_ns: int = 0,
        arrived_ns: int = 0,
    ) -> None:
        """Take one message from a transport; see `Reader` for the arguments."""
        self._arriving = (gid, sequence)
        sample_info = SampleInfo(gid, sequence, source_ns, arrived_ns)
        self._deliver_with(msg, sample_info, inline_deadline_ns)

    def put(self, item: Any, *, is_own: bool = False) -> bool:
        """Queue an item; see `MessageQueue.put`."""
        return super().put(Arrived(item, *self._arriving), is_own=is_own)

    def take_inline(self, item: Any, inline_deadline_ns: int) -> bool:
        """Call the callback with `item` now, if possible."""
        return MessageQueue.take_inline(self, Arrived(item, *self._arriving), inline_deadline_ns)

    def handle_items(
        self,
        handle: Callable[[int, Any], Coroutine[object, object, None] | None],
        now_ns: int,
        turn_ends_ns: int,
    ) -> Coroutine[object, object, None] | None:
        """Call the callback with the oldest message."""
        return MessageQueue.handle_items(self, handle, now_ns, turn_ends_ns)

    def noting(
        self, handle: Callable[[int, Any], Coroutine[Any, Any, None] | None]
    ) -> Callable[[int, Arrived], Coroutine[Any, Any, None] | None]:
        """Return a function that passes items of the queue to `handle`, and notes each run."""

        def handle_arrived(entered_ns: int, arrived: Arrived) -> Coroutine[Any, Any, None] | None:
            run = self._begin(entered_ns, arrived)
            rest = None
            try:
                rest = handle(entered_ns, arrived.item)
            finally:
                if rest is None:
                    run.end(perf_ns())
            return rest

        return handle_arrived

    def taken(self, entered_ns: int, arrived: Arrived) -> Any:
        """Return the item that the current task has read: a cause of what it sends from now on."""
        now_ns = perf_ns()
        take(Run(self._party, "message", arrived.gid, arrived.sequence, entered_ns, now_ns))
        return arrived.item

    def note_silence(self) -> None:
        """Make a silence of the topic the cause of what the current task sends from now on."""
        self._log.begin(
            Party("silence", self._party.node, self.endpoint.name, self.endpoint.gid),
            "timer",
            self.endpoint.gid,
            0,
            perf_ns(),
        )

    def _begin(self, entered_ns: int, arrived: Arrived) -> Run:
        return self._log.begin(self._party, "message", arrived.gid, arrived.sequence, entered_ns)


class DirectReader(SubscriptionReader):
    """Passes each message on within the event that brings it, bypassing the queue.

    For aionode's own subscriptions that only store messages elsewhere: no task is woken, no call is
    timed, and the queue stays empty. The event may be the `publish` of another node. There is no
    content filter.

    Args:
        endpoint: The subscription in the graph.
        stats: Where lost and invalid messages are counted.
        time_base: The source of the arrival time.
        take: Takes the messages; it must not block or raise.
    """

    __slots__ = ("_take",)

    def __init__(
        self, endpoint: EndpointInfo, stats: CallbackStats, time_base: TimeBase, take: Take
    ) -> None:
        super().__init__(endpoint, stats, time_base, raw="parts", wants_info=False)
        self._take = take

    def deliver(
        self,
        msg: Any,
        gid: bytes,
        sequence: int,
        source_ns: int,
        inline_deadline_ns: int = 0,  # noqa: ARG002  # it always hands on at once
        arrived_ns: int = 0,
    ) -> None:
        """Take one message from a transport; see `Reader` for the arguments."""
        if self._last_sequences.get(gid) == sequence - 1:
            self._last_sequences[gid] = sequence
        else:
            self._note_sequence(gid, sequence)
        if self.on_arrival is not None and not self.on_arrival(
            SampleInfo(gid, sequence, source_ns, arrived_ns)
        ):
            return
        self.stats.received += 1
        self._take(msg, sequence, source_ns, arrived_ns or self._now_ns())


def admit(sample_info: SampleInfo) -> bool:  # noqa: ARG001  # as `on_arrival`
    """Deliver every message."""
    return True


def refuse(sample_info: SampleInfo) -> bool:  # noqa: ARG001  # as `on_arrival`
    """Deliver no message, as the subscription is closed."""
    return False
