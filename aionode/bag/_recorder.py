"""Records topics into a bag, and says what it lost."""

from __future__ import annotations

import asyncio
from contextlib import AsyncExitStack
from functools import partial
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Self

from aionode._concurrency import run_in_thread, to_the_end
from aionode.bag._recorder_services import RecorderServices
from aionode.bag._selection import Selection
from aionode.bag._types import known_class
from aionode.bag._writer import BagWriter, topic_info
from aionode.bag._writer_thread import Row, WriterThread
from aionode.errors import BagError, InterfaceNotFoundError
from aionode.graph import TOPIC_KINDS, EndpointKind
from aionode.node import Node
from aionode.parameter import Parameter
from aionode.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from aionode.wire import cdr

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from os import PathLike
    from types import TracebackType

    from aionode.bag._record import TopicInfo
    from aionode.clock import Time
    from aionode.context import Context
    from aionode.endpoints.subscription import MessageInfo, Subscription
    from aionode.graph import EndpointInfo

__all__ = ["Recorder", "TopicStats", "adapted_qos"]

CACHE_BYTES: Final = 100 << 20
LEAST_DEPTH: Final = 1000
"""The depth of subscriptions, at least: the loop may be busy for some milliseconds."""

BACK_NS: Final = 1_000_000_000
"""A time that is so much before the last one is a clock that was set back, in nanoseconds."""

Key = tuple[str, str, str]


class TopicStats(NamedTuple):
    """What became of the messages of one topic.

    Attributes:
        recorded: How many are in the bag, or on their way to it.
        lost_in_transport: How many were published and did not arrive, by their numbers.
        lost_in_recorder: How many arrived and were not written.
    """

    recorded: int
    lost_in_transport: int
    lost_in_recorder: int


class Recorder:
    """Records topics into a bag: ``async with Recorder("run", topics=["/scan"]) as recorder:``.

    Messages are recorded from the moment at which the block is entered; its end closes the bag.
    Bytes are written as they arrive, in a thread, so that the event loop never waits for the disk.
    New topics are found while it runs.

    Args:
        path: The folder of the bag, which must not exist.
        topics: Names of topics; without these and without `selection`, all that are not hidden.
        selection: Which topics, services and actions are wanted, in place of `topics`.
        context: The context of its node; `Context.default()` by default.
        node_name: The name of its node.
        compression: ``zstd``, ``lz4`` or ``none``.
        max_bytes: The size from which on a new file begins; 0 for one file.
        max_duration_sec: The time after which a new file begins, in seconds; 0 for one file.
        max_messages: How many messages a file takes; 0 for no limit.
        max_files: How many files are kept: older ones are removed; 0 for all.
        cache_bytes: How many bytes may wait for the disk; in snapshot mode, how many are kept.
        snapshot: Whether messages are only kept, until `snapshot` writes them.
        repeat_latched: Whether each further file begins with the last messages of the topics whose
            publishers are all transient local.
        discovery: Whether topics that appear later are recorded.
        include_unpublished: Whether topics that only have subscriptions are recorded as well.
        qos: Profiles of subscriptions by topic, in place of those that fit the publishers.
        use_sim_time: Whether the times are those of ``/clock``.
        start_paused: Whether it begins paused.
        custom_data: What else the metadata say.

    Attributes:
        node: Its node.
        topics: The topics that it has found, with their types.
    """

    def __init__(
        self,
        path: str | PathLike[str],
        *,
        topics: Iterable[str] | None = None,
        selection: Selection | None = None,
        context: Context | None = None,
        node_name: str = "rosbag2_recorder",
        compression: str = "zstd",
        max_bytes: int = 0,
        max_duration_sec: float = 0.0,
        max_messages: int = 0,
        max_files: int = 0,
        cache_bytes: int = CACHE_BYTES,
        snapshot: bool = False,
        repeat_latched: bool = True,
        discovery: bool = True,
        include_unpublished: bool = False,
        qos: Mapping[str, QoSProfile] | None = None,
        use_sim_time: bool = False,
        start_paused: bool = False,
        custom_data: Mapping[str, str] | None = None,
    ) -> None:
        if max_files and not (max_bytes or max_duration_sec or max_messages):
            raise BagError(str(path), "max_files is given without a size, time or count of a file")
        self.path = path
        names = None if topics is None else list(topics)
        self._selection = selection or (
            Selection(every=("topic",)) if names is None else Selection(topics=names)
        )
        self._context = context
        self._node_name = node_name
        self._make_writer = partial(
            BagWriter,
            path,
            compression=compression,
            max_bytes=max_bytes,
            max_duration_ns=int(max_duration_sec * 1e9),
            max_messages=max_messages,
            max_files=max_files,
            custom_data=custom_data,
        )
        self._cache_bytes = cache_bytes
        self._is_snapshot = snapshot
        self._repeat_latched = repeat_latched
        self._discovers = discovery
        self._unpublished = include_unpublished
        self._qos = dict(qos or {})
        self._use_sim_time = use_sim_time
        self._paused = start_paused
        self._numbers: dict[Key, int] = {}
        self._topics: list[tuple[TopicInfo, int]] = []
        self._taken: list[int] = []
        self._refused: list[int] = []
        self._subscriptions: dict[int, Subscription[bytes]] = {}
        self._unknown: dict[str, frozenset[bytes]] = {}
        self._last_ns = 0
        self._thread: WriterThread | None = None
        self._failed = asyncio.Event()
        self.node: Node = None  # type: ignore[assignment]  # until it is entered

    async def __aenter__(self) -> Self:
        """Open the bag and subscribe to what there is.

        Raises:
            BagError: the folder exists.
            BagWriteError: it cannot be made.
        """
        loop = asyncio.get_running_loop()
        async with AsyncExitStack() as stack:
            writer = await run_in_thread(
                partial(
                    self._make_writer,
                    on_split=lambda closed, opened: loop.call_soon_threadsafe(
                        self._tell_split, closed, opened
                    ),
                )
            )
            self._writer = writer
            self._thread = WriterThread(
                writer,
                self._topics,
                self._cache_bytes,
                snapshot=self._is_snapshot,
                on_failure=lambda: void(loop.call_soon_threadsafe(self._note_failure)),
            )
            stack.push_async_callback(self._close_bag)
            self.node = Node(
                self._node_name,
                context=self._context,
                parameter_overrides=[Parameter("use_sim_time", value=self._use_sim_time)],
            )
            await stack.enter_async_context(self.node)
            self._services = RecorderServices(self)
            self._tasks = await stack.enter_async_context(asyncio.TaskGroup())
            await self._subscribe_to_new()
            following = self._tasks.create_task(self._follow_graph())
            stack.callback(following.cancel)
            self._stack = stack.pop_all()
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Take what has arrived, and close the bag.

        Raises:
            BagWriteError: the disk was full, or failed; what was written before can be read.
        """
        await self._stack.__aexit__(kind, error, traceback)

    # What a program does with it

    def write(self, topic: str, msg: Any, time: Time | None = None) -> None:
        """Record a message that is not published.

        Args:
            topic: The name of the topic.
            msg: The message.
            time: When it was received; now by default.

        Raises:
            MessageError: a value does not fit its field.
            QueueFullError: it has to wait for the disk, and there is no more room.
        """
        info = topic_info(topic, type(msg))
        number = self._number(info, 0)
        time_ns = self._now_ns() if time is None else time.nanoseconds
        self._put(Row(number, time_ns, time_ns, 0, cdr.encode(msg)))

    @property
    def stats(self) -> dict[str, TopicStats]:
        """What was recorded and what was lost, by topic."""
        found: dict[str, TopicStats] = {}
        lost = {} if self._thread is None else self._thread.lost
        for number, (info, _) in enumerate(self._topics):
            subscription = self._subscriptions.get(number)
            transport = dropped = 0
            if subscription is not None:
                transport, dropped = subscription.stats.lost, subscription.stats.dropped
            not_written = lost.get(number, 0)
            before = found.get(info.name, TopicStats(0, 0, 0))
            found[info.name] = TopicStats(
                before.recorded + self._taken[number] - not_written,
                before.lost_in_transport + transport,
                before.lost_in_recorder + self._refused[number] + dropped + not_written,
            )
        return found

    @property
    def paused(self) -> bool:
        """Whether it is paused: what is published meanwhile is not recorded."""
        return self._paused

    @property
    def discovering(self) -> bool:
        """Whether topics that appear are recorded."""
        return self._discovers

    def pause(self) -> None:
        """Record nothing until `resume`."""
        self._paused = True

    def resume(self) -> None:
        """Record again."""
        self._paused = False

    def start_discovery(self) -> None:
        """Record topics that appear."""
        self._discovers = True
        self._tasks.create_task(self._subscribe_to_new())

    def stop_discovery(self) -> None:
        """Record no further topics."""
        self._discovers = False

    async def split(self) -> None:
        """Begin a new file.

        Raises:
            BagWriteError: the disk is full, or fails.
        """
        await self._in_thread(partial(self._writing.split, self._now_ns()))

    async def snapshot(self) -> None:
        """Write what is kept, in snapshot mode, and wait until it is on the disk.

        Raises:
            BagError: it is not in snapshot mode.
            BagWriteError: the disk is full, or fails.
        """
        if not self._is_snapshot:
            raise BagError(str(self.path), "the recorder is not in snapshot mode")
        await self._in_thread(self._writing.write_snapshot)

    async def failed(self) -> None:
        """Wait until nothing can be written any more: the disk is full, or fails.

        Raises:
            BagWriteError: always, then.
        """
        await self._failed.wait()
        self._raise_failure()

    # Inside

    @property
    def _writing(self) -> WriterThread:
        assert self._thread is not None  # noqa: S101  # it is entered
        return self._thread

    async def _in_thread(self, work: Any) -> None:
        """Have the thread of the writer do something, and wait for it."""
        loop = asyncio.get_running_loop()
        done: asyncio.Future[None] = loop.create_future()

        def finish() -> None:
            if not done.done():
                done.set_result(None)

        def run() -> None:
            try:
                work()
            finally:
                loop.call_soon_threadsafe(finish)

        self._writing.call(run)
        await done
        self._raise_failure()

    def _raise_failure(self) -> None:
        failure = self._writing.failure
        if failure is not None:
            raise failure

    def _note_failure(self) -> None:
        self.node.get_logger().error(f"{self._writing.failure}")
        self._failed.set()

    def _now_ns(self) -> int:
        return self.node.get_clock().now().nanoseconds

    def _number(self, info: TopicInfo, latched_depth: int) -> int:
        number = self._numbers.get(info.key)
        if number is None:
            number = self._numbers[info.key] = len(self._topics)
            self._topics.append((info, latched_depth))
            self._taken.append(0)
            self._refused.append(0)
        return number

    def _put(self, row: Row) -> None:
        if self._writing.put(row):
            self._taken[row.topic] += 1
        else:
            self._refused[row.topic] += 1

    def _take(self, number: int, raw: bytes, info: MessageInfo) -> None:
        """Take one message of a subscription."""
        if self._paused:
            return
        time_ns = self._now_ns() if self._use_sim_time else info["received_timestamp"]
        if time_ns < self._last_ns - BACK_NS:
            self._warn(
                f"the clock was set back by {(self._last_ns - time_ns) / 1e9:.1f} s; the bag has "
                "the times as they were shown"
            )
        self._last_ns = time_ns
        sent_ns = info["source_timestamp"] or time_ns
        self._put(Row(number, time_ns, sent_ns, info["publication_sequence_number"], raw))

    def _warn(self, text: str) -> None:
        self.node.get_logger().warning(text)

    async def _follow_graph(self) -> None:
        graph = self.node.graph
        while True:
            changes = graph.changes
            if self._discovers:
                await self._subscribe_to_new()
            if graph.changes == changes:
                await graph.changed()

    async def _subscribe_to_new(self) -> None:
        """Subscribe to each wanted topic that has no subscription yet."""
        kinds = TOPIC_KINDS if self._unpublished else (EndpointKind.PUBLISHER,)
        found: dict[Key, list[EndpointInfo]] = {}
        for endpoint in self.node.graph.endpoints(*kinds):
            if endpoint.node.fully_qualified_name == self.node.get_fully_qualified_name():
                continue
            if self._selection.wants(endpoint.name, endpoint.type_name):
                key = endpoint.name, endpoint.type_name, endpoint.type_hash
                found.setdefault(key, []).append(endpoint)
        for key, endpoints in found.items():
            if key not in self._numbers:
                await self._subscribe(key, endpoints)

    async def _subscribe(self, key: Key, endpoints: list[EndpointInfo]) -> None:
        name, typename, _ = key
        msg_type = await self._class_of(typename, endpoints)
        if msg_type is None:
            return
        others = [info.type for info, _ in self._topics if info.name == name]
        if others:
            self._warn(f"{name} has the type {typename} besides {others[-1]}: both are recorded")
        offered = [e.qos for e in endpoints if e.kind is EndpointKind.PUBLISHER]
        profile = self._qos.get(name) or adapted_qos(offered)
        is_latched = profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
        depth = max((each.depth for each in offered), default=1)
        info = topic_info(name, msg_type, offered)
        info.type_hash = key[2] if key[2].startswith("RIHS") else info.type_hash
        number = self._number(info, depth * (is_latched and self._repeat_latched))
        self._numbers[key] = number  # the graph may show no hash
        self._subscriptions[number] = self.node.create_subscription(
            msg_type, name, partial(self._take, number), profile, raw=True
        )

    async def _class_of(self, typename: str, endpoints: list[EndpointInfo]) -> Any | None:
        """Return the class of a type; None, with one warning, if nobody describes it."""
        gids = frozenset(endpoint.gid for endpoint in endpoints)
        if self._unknown.get(typename) == gids:
            return None
        try:
            if "/msg/" in typename:
                return await self.node.find_type(typename, endpoints=endpoints)
            return known_class(typename)
        except InterfaceNotFoundError as error:
            if typename not in self._unknown:
                self._warn(f"{endpoints[0].name} is not recorded: {error}")
            self._unknown[typename] = gids
            return None

    def _tell_split(self, closed: str, opened: str) -> None:
        self._services.tell_split(closed, opened)

    async def _close_bag(self) -> None:
        """Write the rest, and say in one line what the bag has."""
        await to_the_end(run_in_thread(self._writing.stop))
        if self._failed.is_set() or self.stats:
            self.node.get_logger().info(self.summary())
        failure = self._writing.failure
        if failure is not None:
            raise failure

    def summary(self) -> str:
        """Return in one line what was recorded and what was lost."""
        stats = self.stats
        recorded = sum(each.recorded for each in stats.values())
        lost = [
            f"{name}: {each.lost_in_transport} in transport, {each.lost_in_recorder} in recorder"
            for name, each in sorted(stats.items())
            if each.lost_in_transport or each.lost_in_recorder
        ]
        end = f"lost: {'; '.join(lost)}" if lost else "lost: nothing"
        return f"recorded {recorded} messages of {len(stats)} topics to {self.path}; {end}"


def void(_: object) -> None:
    """Return nothing, where that is wanted."""


def adapted_qos(offered: list[QoSProfile]) -> QoSProfile:
    """Return the profile of a subscription that gets the messages of all these publishers.

    It is reliable only if all are, and transient local only if all are, as in rosbag2.
    """
    reliable = all(each.reliability is not ReliabilityPolicy.BEST_EFFORT for each in offered)
    latched = bool(offered) and all(
        each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in offered
    )
    return QoSProfile(
        depth=max([LEAST_DEPTH, *(each.depth for each in offered)]),
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )
