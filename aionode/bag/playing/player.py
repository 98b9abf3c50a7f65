"""Plays bags: publishes their messages at the recorded times."""

from __future__ import annotations

import asyncio
import contextlib
from contextlib import AsyncExitStack, ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

from aionode._process.concurrency import SLICE_NS, checkpoint, run_in_thread
from aionode.bag._bag import Batches, open  # noqa: A004  # as in `bag.open(path)`
from aionode.bag._copy import merged_records
from aionode.bag._selection import CAUSES, Selection
from aionode.bag.files.record import MAX_NS, time_of
from aionode.bag.playing.files import FilesInPlay, in_order_sent
from aionode.bag.playing.requests import SOURCES, RequestSender
from aionode.bag.playing.services import serve_player
from aionode.clock import Duration
from aionode.errors import (
    BagError,
    DecodeError,
    InterfaceNotFoundError,
    NameValidationException,
    escaped,
)
from aionode.interfaces.rosgraph_msgs.msg import Clock as ClockMessage
from aionode.node import Node
from aionode.qos import QoSProfile

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping, Sequence
    from os import PathLike
    from types import TracebackType

    from aionode.bag._bag import Bag
    from aionode.bag.files.record import Record, TopicInfo
    from aionode.clock import Time
    from aionode.endpoints.publisher import Publisher
    from aionode.engine.context import Context

__all__ = ["Player"]

DEFAULT_DEPTH: Final = 10
READ_AHEAD: Final = 1024
"""Messages to read at once, while those before them are being published."""

EARLY_NS: Final = 100_000
"""A message may be published this much early, in nanoseconds, to avoid waking up for it alone:
waking up takes as long as publishing several messages."""

CLOCK_TOPIC: Final = "/clock"


class Player:
    """Plays one or more bags: ``async with Player("run") as player: await player.play()``.

    A thread reads ahead, so that the event loop never waits for the disk. Times are those of the
    recording, divided by the rate; waiting uses the steady clock of the context.

    Args:
        path: The bag, or several, which are played as one in time order.
        context: The context of its node; defaults to `Context.default()`.
        node_name: The name of its node.
        rate: The speed, positive and finite: 2 plays twice as fast.
        loop: Whether to start over at the end, until stopped.
        start_offset: Where to start, from the start of the bag.
        duration: How long to play, in recorded time; defaults to the end.
        until: The recorded time at which to stop.
        delay_sec: Time to wait before the first message, in seconds.
        selection: The topics to play; all by default.
        remap: New topic names by recorded name.
        clock_hz: The rate at which to publish ``/clock``, in Hz; 0 for never. If set, the recorded
        ``/clock`` is not played.
        clock_topics: Topics for which to publish ``/clock`` with each message; ``*`` for all.
        qos: QoS profiles of publishers by topic, overriding the recorded ones.
        start_paused: Whether to start paused.
        in_order_sent: Whether to play messages by the time they were published, not received;
            within windows of 1000 messages, as in rosbag2.
        send_requests: The kinds of recorded requests to send as a client instead of publishing
            their events: ``service``, ``action``.
        requests_source: The events to take requests from: ``service_introspection`` for the
            servers', or ``client_introspection``.
        wait_acked_sec: How long `play` waits at the end until reliable subscriptions have received
            all messages, in seconds; 0 for no limit, None for no wait.

    Attributes:
        node: Its node.
        bags: The bags.
        played: Number of messages published.

    Raises:
        ValueError: the rate is not positive and finite, or the source of requests is unknown.
    """

    def __init__(
        self,
        path: str | PathLike[str] | Sequence[str | PathLike[str]],
        *,
        context: Context | None = None,
        node_name: str = "rosbag2_player",
        rate: float = 1.0,
        loop: bool = False,
        start_offset: Duration | None = None,
        duration: Duration | None = None,
        until: Time | None = None,
        delay_sec: float = 0.0,
        selection: Selection | None = None,
        remap: Mapping[str, str] | None = None,
        clock_hz: float = 0.0,
        clock_topics: Collection[str] = (),
        qos: Mapping[str, QoSProfile] | None = None,
        start_paused: bool = False,
        in_order_sent: bool = False,
        send_requests: Collection[str] = (),
        requests_source: str = "service_introspection",
        wait_acked_sec: float | None = None,
    ) -> None:
        is_one = isinstance(path, str | Path) or hasattr(path, "__fspath__")
        self._paths: Any = [path] if is_one else list(path)  # type: ignore[arg-type]
        self.bags: list[Bag] = []
        self.played = 0
        if requests_source not in SOURCES:
            raise ValueError(f"requests_source: {requests_source!r}; use {' or '.join(SOURCES)}")
        self._context = context
        self._node_name = node_name
        self._anchor: tuple[int, int] | None = None  # recorded and steady time, in nanoseconds
        self._rate = 1.0
        self.set_rate(rate)
        self._loop = loop
        self._start_offset = start_offset or Duration()
        self._duration = duration
        self._until_ns = MAX_NS if until is None else until.nanoseconds
        self._delay_sec = delay_sec
        self._selection = selection
        self._remap = dict(remap or {})
        self._clock_hz = clock_hz
        self._clock_topics = frozenset(clock_topics)
        self._in_order_sent = in_order_sent
        self._sent_kinds, self._requests_source = frozenset(send_requests), requests_source
        self._wait_acked_sec = wait_acked_sec
        self._qos = dict(qos or {})
        self._is_paused = start_paused
        self._is_playing = False
        self._is_stopped = False
        self._seek_ns: int | None = None
        self._steps = 0
        self._stepped: asyncio.Future[None] | None = None
        self._position_ns = 0
        self._wake = asyncio.Event()
        self._publishers: dict[tuple[str, str, str], Publisher[Any] | None] = {}
        self.node: Node = None  # type: ignore[assignment]  # until it is entered

    async def __aenter__(self) -> Self:
        """Open the bags, and create a publisher for each topic.

        Raises:
            BagError: a bag cannot be read.
            FileNotFoundError: there is no such file or folder.
        """
        async with AsyncExitStack() as stack:
            files = stack.enter_context(ExitStack())
            for path in self._paths:
                self.bags.append(files.enter_context(await run_in_thread(open, path)))
            self.node = Node(self._node_name, context=self._context)
            await stack.enter_async_context(self.node)
            self._time_base = self.node.context.time_base
            self._requests = RequestSender(
                self.node, self._sent_kinds, self._requests_source, self._remap, self._warn
            )
            for bag in self.bags:
                for topic in bag.connections:
                    self._publisher_of(topic)
            self._files = FilesInPlay(self.node, self.bags)
            self._position_ns = self._start_ns
            if self._tells_time:
                self._clock = self.node.create_publisher(ClockMessage, CLOCK_TOPIC, 1)
            if self._clock_hz:
                self.node.create_timer(1 / self._clock_hz, self._tell_time)
            serve_player(self.node, self)
            self._stack = stack.pop_all()
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Stop, and close the bags."""
        self.stop()
        await self._stack.__aexit__(kind, error, traceback)

    # Public API

    @property
    def start(self) -> Time:
        """The time of the first message."""
        return time_of(min((bag.start_ns for bag in self.bags), default=0))

    @property
    def end(self) -> Time:
        """The time of the last message."""
        return time_of(max((bag.end_ns for bag in self.bags), default=0))

    @property
    def time(self) -> Time:
        """The current position, as a recorded time."""
        return time_of(self._now_ns())

    @property
    def playing(self) -> bool:
        """Whether it is playing, possibly paused."""
        return self._is_playing

    @property
    def paused(self) -> bool:
        """Whether it is paused."""
        return self._is_paused

    @property
    def rate(self) -> float:
        """The current rate."""
        return self._rate

    async def play(
        self,
        start_offset: Duration | None = None,
        duration: Duration | None = None,
        until: Time | None = None,
    ) -> bool:
        """Play, and return when the end is reached or `stop` is called.

        Cancelling stops it immediately.

        Args:
            start_offset: Where to start, overriding that of the player.
            duration: How long to play, in recorded time.
            until: The recorded time at which to stop.

        Returns:
            False if another call is already playing, so that this one did nothing.

        Raises:
            BagError: a file is damaged.
        """
        if self._is_playing:
            return False
        self._is_playing, self._is_stopped = True, False
        offset = self._start_offset if start_offset is None else start_offset
        start_ns = self._start_ns_with(offset)
        end_ns = self._until_ns if until is None else until.nanoseconds
        length = duration or self._duration
        if length is not None:
            end_ns = min(end_ns, start_ns + length.nanoseconds)
        try:
            if self._delay_sec:
                await self._sleep_until(self._steady_ns() + int(self._delay_sec * 1e9))
            while True:
                await self._play_from(start_ns, end_ns)
                if self._is_stopped or not self._loop:
                    break
                await checkpoint()
            if not self._is_stopped:
                await self._hand_over()
        finally:
            self._is_playing = False
            self._finish_steps()
        return True

    def pause(self) -> None:
        """Stop the recorded time until `resume`."""
        self._position_ns = self._now_ns()
        self._is_paused = True
        self._wake.set()

    def resume(self) -> None:
        """Resume."""
        if self._is_paused:
            self._is_paused = False
            self._set_anchor(self._position_ns)

    def toggle_paused(self) -> None:
        """Pause or resume."""
        if self._is_paused:
            self.resume()
        else:
            self.pause()

    def set_rate(self, rate: float) -> None:
        """Change the rate from now on.

        Raises:
            ValueError: the rate is not positive and finite.
        """
        if not 0 < rate < float("inf"):
            raise ValueError(f"rate: {rate} is not positive and finite; 1 is the recorded speed")
        if self._anchor is None:
            self._rate = rate
            return
        now_ns = self._now_ns()
        self._rate = rate
        self._set_anchor(now_ns)

    def seek(self, time: Time) -> bool:
        """Continue at another recorded time; return whether the bag contains that time."""
        if not self.start.nanoseconds <= time.nanoseconds <= self.end.nanoseconds:
            return False
        self._seek_ns = self._position_ns = time.nanoseconds
        self._wake.set()
        return True

    async def play_next(self) -> bool:
        """Publish the next message while paused; return whether there was one."""
        return await self.burst(1) == 1

    async def burst(self, count: int = 0) -> int:
        """Publish the next messages immediately while paused, and return how many there were.

        Args:
            count: Number of messages; 0 for all that are left.
        """
        if not (self._is_paused and self._is_playing) or self._steps:
            return 0
        wanted = self._steps = count or MAX_NS
        self._stepped = asyncio.get_running_loop().create_future()
        self._wake.set()
        await self._stepped
        done, self._steps = wanted - self._steps, 0
        return done

    def stop(self) -> None:
        """End `play`."""
        self._is_stopped = True
        self._wake.set()

    # Time

    @property
    def _start_ns(self) -> int:
        return self._start_ns_with(self._start_offset)

    def _start_ns_with(self, offset: Duration) -> int:
        return self.start.nanoseconds + offset.nanoseconds

    def _steady_ns(self) -> int:
        return self._time_base.steady_ns()

    def _now_ns(self) -> int:
        """Return the current recorded time."""
        if self._is_paused or not self._is_playing or self._anchor is None:
            return self._position_ns
        steady_ns, bag_ns = self._anchor
        return bag_ns + int((self._steady_ns() - steady_ns) * self._rate)

    def _set_anchor(self, bag_ns: int) -> None:
        """Seek to a recorded time, and continue from there."""
        self._anchor = (self._steady_ns(), bag_ns)
        self._wake.set()

    async def _sleep_until(self, steady_ns: int | None) -> None:
        """Wait until a steady time, or until something has changed."""
        self._wake.clear()
        alarm = None
        if steady_ns is not None:
            alarm = self._time_base.call_at(steady_ns, self._wake.set)
        try:
            await self._wake.wait()
        finally:
            if alarm is not None:
                alarm.cancel()

    @property
    def _tells_time(self) -> bool:
        return bool(self._clock_hz or self._clock_topics)

    def _tell_time(self) -> None:
        self._clock.publish(ClockMessage(clock=self.time.to_msg()))

    # Messages

    async def _play_from(self, start_ns: int, end_ns: int) -> None:
        """Play once."""
        self._position_ns = start_ns
        self._set_anchor(start_ns)
        at_ns: int | None = start_ns
        while at_ns is not None and not self._is_stopped:
            self._files.go_to(at_ns)
            at_ns = await self._play_records(self._records(at_ns, end_ns))
            if at_ns is not None:
                self._set_anchor(at_ns)

    def _records(self, start_ns: int, end_ns: int) -> Iterator[tuple[int, Record]]:
        """Return the records that are played, in order, each after its time."""
        start = None if start_ns <= self.start.nanoseconds else time_of(start_ns)
        end = None if end_ns == MAX_NS else time_of(end_ns)
        records = merged_records(self.bags, self._selection, start, end)
        if self._in_order_sent:
            return in_order_sent(records)
        return ((record.time_ns, record) for record in records)

    async def _play_records(self, records: Iterator[tuple[int, Record]]) -> int | None:
        """Publish records at their times; return where to continue, or None at the end.

        Raises:
            BagError: a file is damaged.
        """
        async with asyncio.TaskGroup() as tasks:
            batches = Batches(records, lambda item: len(item[1].raw), READ_AHEAD)
            reading = tasks.create_task(run_in_thread(batch_or_error, batches))
            try:
                while isinstance(batch := await reading, list) and batch:
                    reading = tasks.create_task(run_in_thread(batch_or_error, batches))
                    if not await self._publish_batch(batch):
                        seek_ns, self._seek_ns = self._seek_ns, None
                        return seek_ns
            finally:
                reading.cancel()
        if isinstance(batch, BagError):
            raise batch  # raised here, so that it is not wrapped in an exception group
        return None

    async def _publish_batch(self, batch: list[tuple[int, Record]]) -> bool:
        """Publish records at their times; return False if stopped or a seek is pending."""
        turn_ends_ns = self._steady_ns() + SLICE_NS
        for time_ns, record in batch:
            if not await self._is_due(time_ns):
                return False
            self._publish(record)
            if self._steady_ns() >= turn_ends_ns:
                await checkpoint()
                turn_ends_ns = self._steady_ns() + SLICE_NS
        return True

    async def _hand_over(self) -> None:
        """Wait until published messages and requests have arrived, if requested."""
        await self._requests.drain()
        if self._wait_acked_sec is not None:
            publishers = [
                publisher for publisher in self._publishers.values() if publisher is not None
            ]
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(self._wait_acked_sec or None):
                    for publisher in publishers:
                        await publisher.drain()

    async def _is_due(self, time_ns: int) -> bool:
        """Wait until a recorded time; return False if stopped or a seek is pending."""
        while True:
            if self._is_stopped or self._seek_ns is not None:
                return False
            if self._is_paused:
                if self._steps:
                    self._steps -= 1
                    self._position_ns = max(time_ns, self._position_ns)
                    if not self._steps:
                        self._finish_steps()
                    return True
                await self._sleep_until(None)
                continue
            steady_ns, bag_ns = self._anchor or (0, 0)
            due_ns = steady_ns + int((time_ns - bag_ns) / self._rate)
            if self._steady_ns() >= due_ns - EARLY_NS:
                return True
            await self._sleep_until(due_ns)

    def _finish_steps(self) -> None:
        if self._stepped is not None and not self._stepped.done():
            self._stepped.set_result(None)

    def _publish(self, record: Record) -> None:
        if record.time_ns >= self._files.next_ns:
            self._files.pass_to(record.time_ns)
        if record.topic in self._clock_topics or "*" in self._clock_topics:
            self._clock.publish(ClockMessage(clock=record.time.to_msg()))
        try:
            publisher = self._publishers.get(record.info.key)
            if publisher is not None:
                publisher.publish(record.raw)
                self.played += 1
            elif self._sent_kinds:
                self._requests.send(record)
        except DecodeError as error:
            self._publishers[record.info.key] = None
            self._warn(f"{record.topic} is no longer played: {error}")

    def _publisher_of(self, topic: TopicInfo) -> None:
        """Create the publisher of a topic, if it is selected and its type is known."""
        if self._selection is not None and not self._selection.wants(topic.name, topic.type):
            return
        if topic.name == CAUSES or topic.key in self._publishers:
            return
        if self._tells_time and topic.name == CLOCK_TOPIC:
            return
        if self._requests.takes(topic):
            self._publishers[topic.key] = None
            return
        try:
            profile = self._qos.get(topic.name) or self._offered(topic)
            publisher = self.node.create_publisher(
                topic.msg_type, self._remap.get(topic.name, topic.name), profile
            )
        except (InterfaceNotFoundError, NameValidationException) as error:
            self._warn(f"{topic.name} is not played: {error}")
            return
        self._publishers[topic.key] = publisher

    def _offered(self, topic: TopicInfo) -> QoSProfile:
        """Return the recorded profile, if all publishers had the same."""
        if topic.problem:
            self._warn(f"{topic.name}: {topic.problem}, so the default QoS is used")
        profiles = list(dict.fromkeys(topic.qos))
        if len(profiles) == 1:
            return profiles[0]
        if profiles:
            self._warn(f"{topic.name}: its publishers had different QoS, so the default is used")
        return QoSProfile(depth=DEFAULT_DEPTH)

    def _warn(self, text: str) -> None:
        self.node.get_logger().warning(escaped(text, one_line=True))


def batch_or_error(batches: Batches[tuple[int, Record]]) -> list[tuple[int, Record]] | BagError:
    """Return the next records, or the error that some could not be read."""
    try:
        return batches.next()
    except BagError as error:
        return error
