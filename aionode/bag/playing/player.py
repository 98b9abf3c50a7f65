"""Plays bags: publishes their messages at the times at which they were recorded."""

from __future__ import annotations

import asyncio
import contextlib
from contextlib import AsyncExitStack, ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

from aionode._process.concurrency import SLICE_NS, checkpoint, run_in_thread
from aionode.bag._bag import Batches, open  # noqa: A004  # as in `bag.open(path)`
from aionode.bag._copy import merged_records
from aionode.bag._selection import Selection
from aionode.bag.files.record import MOST_NS, time_of
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
"""Messages that are read at once, while those before them are published."""

EARLY_NS: Final = 100_000
"""A message is published so early, in nanoseconds, rather than that the loop sleeps for it alone:
waking up takes as long as publishing several messages."""

CLOCK_TOPIC: Final = "/clock"


class Player:
    """Plays one or more bags: ``async with Player("run") as player: await player.play()``.

    It reads ahead in a thread, so that the event loop never waits for the disk. Times are those of
    the recording, divided by the rate; waiting goes by the steady clock of the context.

    Args:
        path: The bag, or several, which are played as one, in order of time.
        context: The context of its node; `Context.default()` by default.
        node_name: The name of its node.
        rate: How fast, positive and finite: 2 plays in half of the time.
        loop: Whether it begins again at the end, until it is stopped.
        start_offset: Where to begin, after the start of the bag.
        duration: How long to play, in the time of the recording; to the end by default.
        until: The time in the recording at which to end.
        delay_sec: How many seconds to wait before the first message.
        selection: Which topics are played; all by default.
        remap: New names of topics, by the recorded ones.
        clock_hz: How often ``/clock`` is published, in Hz; 0 for never. That of the bag is left out
            then.
        clock_topics: The topics with whose messages ``/clock`` is published; ``*`` for all.
        qos: Profiles of publishers by topic, in place of the recorded ones.
        start_paused: Whether it begins paused.
        in_order_sent: Whether messages are played in the order and at the times at which they were
            published, not received; within 1000 messages, as in rosbag2.
        send_requests: Of which kinds recorded requests are sent as by a client, in place of
            publishing their events: ``service``, ``action``.
        requests_source: Whose events tell of them: ``service_introspection`` for those of the
            servers, or ``client_introspection``.
        wait_acked_sec: How many seconds the end of `play` waits at most until messages are handed
            over, as reliable subscriptions demand; 0 for no limit, None for no wait.

    Attributes:
        node: Its node.
        bags: The bags.
        played: How many messages it has published.

    Raises:
        ValueError: the rate is not positive and finite, or there is no such source of requests.
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
        self._anchor: tuple[int, int] | None = None  # of both clocks, in nanoseconds
        self._rate = 1.0
        self.set_rate(rate)
        self._loop = loop
        self._start_offset = start_offset or Duration()
        self._duration = duration
        self._until_ns = MOST_NS if until is None else until.nanoseconds
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
            FileNotFoundError: there is nothing of this name.
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

    # For programs to call

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
        """The present position, as a time of the recording."""
        return time_of(self._now_ns())

    @property
    def playing(self) -> bool:
        """Whether it plays, or is paused in between."""
        return self._is_playing

    @property
    def paused(self) -> bool:
        """Whether it is paused."""
        return self._is_paused

    @property
    def rate(self) -> float:
        """How fast it plays."""
        return self._rate

    async def play(
        self,
        start_offset: Duration | None = None,
        duration: Duration | None = None,
        until: Time | None = None,
    ) -> bool:
        """Play, and return when the end is reached, or after `stop`.

        Cancelling ends it at once.

        Args:
            start_offset: Where to begin, in place of what was given to the player.
            duration: How long to play, in the time of the recording.
            until: The time in the recording at which to end.

        Returns:
            False if another call plays already, and so nothing was done.

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
        """Stop the time of the recording until `resume`."""
        self._position_ns = self._now_ns()
        self._is_paused = True
        self._wake.set()

    def resume(self) -> None:
        """Go on."""
        if self._is_paused:
            self._is_paused = False
            self._set_anchor(self._position_ns)

    def toggle_paused(self) -> None:
        """Pause, or go on."""
        if self._is_paused:
            self.resume()
        else:
            self.pause()

    def set_rate(self, rate: float) -> None:
        """Play faster or slower from now on.

        Raises:
            ValueError: the rate is not positive and finite.
        """
        if not 0 < rate < float("inf"):
            raise ValueError(f"rate: {rate} is not positive and finite; 1 is as it was recorded")
        if self._anchor is None:
            self._rate = rate
            return
        now_ns = self._now_ns()
        self._rate = rate
        self._set_anchor(now_ns)

    def seek(self, time: Time) -> bool:
        """Go on at another time of the recording; return whether it has that time."""
        if not self.start.nanoseconds <= time.nanoseconds <= self.end.nanoseconds:
            return False
        self._seek_ns = self._position_ns = time.nanoseconds
        self._wake.set()
        return True

    async def play_next(self) -> bool:
        """Publish the next message, while paused; return whether there was one."""
        return await self.burst(1) == 1

    async def burst(self, count: int = 0) -> int:
        """Publish the next messages at once, while paused, and return how many there were.

        Args:
            count: How many; 0 for all that are left.
        """
        if not (self._is_paused and self._is_playing) or self._steps:
            return 0
        wanted = self._steps = count or MOST_NS
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
        """Return the time of the recording now."""
        if self._is_paused or not self._is_playing or self._anchor is None:
            return self._position_ns
        steady_ns, bag_ns = self._anchor
        return bag_ns + int((self._steady_ns() - steady_ns) * self._rate)

    def _set_anchor(self, bag_ns: int) -> None:
        """Seek to a time of the recording, and play on from there."""
        self._anchor = (self._steady_ns(), bag_ns)
        self._wake.set()

    async def _sleep_until(self, steady_ns: int | None) -> None:
        """Wait until a time of the steady clock, or until something has changed."""
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
        end = None if end_ns == MOST_NS else time_of(end_ns)
        records = merged_records(self.bags, self._selection, start, end)
        if self._in_order_sent:
            return in_order_sent(records)
        return ((record.time_ns, record) for record in records)

    async def _play_records(self, records: Iterator[tuple[int, Record]]) -> int | None:
        """Publish records at their times; return where to go on, or None at their end.

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
            raise batch  # here, where no group is made of it
        return None

    async def _publish_batch(self, batch: list[tuple[int, Record]]) -> bool:
        """Publish records at their times; return False if it was stopped or has to seek."""
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
        """Wait until what was published and asked has arrived, as far as that is wanted."""
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
        """Wait until a time of the recording; return False if it was stopped or has to seek."""
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
        """Create the publisher of a topic, if that is wanted and its type is known."""
        if self._selection is not None and not self._selection.wants(topic.name, topic.type):
            return
        if (self._tells_time and topic.name == CLOCK_TOPIC) or topic.key in self._publishers:
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
        """Return the recorded profile, if there is one for all publishers."""
        if topic.problem:
            self._warn(f"{topic.name}: {topic.problem}, so the default is taken")
        profiles = list(dict.fromkeys(topic.qos))
        if len(profiles) == 1:
            return profiles[0]
        if profiles:
            self._warn(f"{topic.name}: its publishers had different QoS, so the default is taken")
        return QoSProfile(depth=DEFAULT_DEPTH)

    def _warn(self, text: str) -> None:
        self.node.get_logger().warning(escaped(text, one_line=True))


def batch_or_error(batches: Batches[tuple[int, Record]]) -> list[tuple[int, Record]] | BagError:
    """Return the next records, or why some could not be read."""
    try:
        return batches.next()
    except BagError as error:
        return error
