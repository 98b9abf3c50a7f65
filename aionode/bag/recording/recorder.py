"""Records topics into a bag, and reports what it lost."""

from __future__ import annotations

import asyncio
import contextlib
from contextlib import AsyncExitStack
from functools import partial
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Self

from aionode._process.concurrency import run_in_thread
from aionode.bag._selection import CAUSES, Selection
from aionode.bag._writer import BagWriter, topic_info
from aionode.bag.recording.recording import Key, Recording, TopicStats, summary_of
from aionode.bag.recording.services import RecorderServices
from aionode.bag.recording.writer_thread import Row
from aionode.clock import Clock, ClockType, Time
from aionode.endpoints.core.subscription_reader import size_of_raw
from aionode.engine.wire import cdr
from aionode.errors import BagError, InterfaceNotFoundError, TimeSourceChangedError
from aionode.graph import TOPIC_KINDS, EndpointKind
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node, direct_subscription
from aionode.parameter import Parameter
from aionode.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Iterable, Mapping
    from os import PathLike
    from types import TracebackType

    from aionode.bag.files.mcap_writer import Parts
    from aionode.engine.context import Context
    from aionode.graph import EndpointInfo
    from aionode.observe import CauseRecorder

__all__ = ["Recorder", "TopicStats", "adapted_qos"]

CACHE_BYTES: Final = 100 << 20
MIN_DEPTH: Final = 1000
"""Minimum depth of subscriptions: the loop may be busy for some milliseconds."""

CAUSES_S: Final = 1.0
"""How often the processes are asked for causes, in seconds; each keeps the last 4096."""

BACK_NS: Final = 1_000_000_000
"""How far time must jump back to count as a clock that was set back, in nanoseconds."""

NODE_TIME: Final = 0
PUBLISH_TIME: Final = 1
RECEIVE_TIME: Final = 2
"""The clocks by which actions may be scheduled, with the numbers of rosbag2's services."""


class Due(NamedTuple):
    """An action that is due when a message with its time arrives.

    Attributes:
        time_ns: The time, in nanoseconds since 1970.
        mode: Whether that is the publish time or the receive time.
        topic: The id of the topic whose messages count; -1 for any.
        act: Called at that point, before the message is recorded.
    """

    time_ns: int
    mode: int
    topic: int
    act: Callable[[], None]

    def has_come(self, topic: int, time_ns: int, sent_ns: int) -> bool:
        """Return whether a message reaches the time."""
        if self.topic not in {-1, topic}:
            return False
        return (sent_ns if self.mode == PUBLISH_TIME else time_ns) >= self.time_ns


class Recorder:
    """Records topics into a bag: ``async with Recorder("run", topics=["/scan"]) as recorder:``.

    Messages are recorded from the moment the block is entered; leaving it closes the bag. A thread
    writes the bytes as they arrive, so that the event loop never waits for the disk. New topics are
    found while it runs.

    Args:
        path: The folder of the bag, which must not exist.
        topics: Names of topics; by default, without `selection`, all that are not hidden.
        selection: Selects topics, services and actions, instead of `topics`.
        context: The context of its node; defaults to `Context.default()`.
        node_name: The name of its node.
        compression: ``zstd``, ``zstd_small`` (slow), ``lz4`` or ``none``.
        max_bytes: The size at which to start a new file; 0 for a single file.
        max_duration_sec: The time after which to start a new file, in seconds; 0 for a single file.
        max_messages: Maximum number of messages per file; 0 for no limit.
        max_files: Number of files to keep, removing older ones; 0 for all.
        cache_bytes: How many bytes may wait for the disk; in snapshot mode, how many are kept.
        cache_duration_sec: How long messages are kept in snapshot mode, in seconds; 0 for no limit.
        snapshot: Whether to only keep messages in memory, until `snapshot` writes them.
        repeat_latched: Whether each further file starts with the last messages of the topics whose
            publishers are all transient local; or a mapping of topics to their number of messages:
            0 for as many as are offered, ``*`` for all other topics.
        discovery: Whether to record topics that appear later.
        include_unpublished: Whether to also record topics that only have subscriptions.
        ignore_leaf: Whether to skip topics without any other subscription.
        static_topics: Types by topic: these are recorded even before they are published.
        qos: QoS profiles of subscriptions by topic, instead of ones adapted to the publishers.
        use_sim_time: Whether to use the time of ``/clock``.
        start_paused: Whether to start paused.
        loss_report_hz: Maximum rate at which losses are published, in Hz; 0 for never.
        custom_data: Additional metadata.
        causes: Whether to also record the causes that processes keep (``AIONODE_CAUSES=1``), for
            `bag.why`.

    Attributes:
        path: The folder of the bag.
        node: Its node.

    Raises:
        BagError: `max_files` is given without a size, duration or message limit per file.
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
        cache_duration_sec: float = 0.0,
        snapshot: bool = False,
        repeat_latched: bool | Mapping[str, int] = True,
        discovery: bool = True,
        include_unpublished: bool = False,
        ignore_leaf: bool = False,
        static_topics: Mapping[str, str] | None = None,
        qos: Mapping[str, QoSProfile] | None = None,
        use_sim_time: bool = False,
        start_paused: bool = False,
        loss_report_hz: float = 1.0,
        custom_data: Mapping[str, str] | None = None,
        causes: bool = False,
    ) -> None:
        if max_files and not (max_bytes or max_duration_sec or max_messages):
            raise BagError(
                str(path),
                "max_files is given without a limit of size, duration or messages per file",
            )
        self.path = path
        names = None if topics is None else list(topics)
        self._selection = selection or (
            Selection(every=("topic",)) if names is None else Selection(topics=names)
        )
        self._context = context
        self._node_name = node_name
        self._make_writer = partial(
            BagWriter,
            compression=compression,
            max_bytes=max_bytes,
            max_duration_ns=int(max_duration_sec * 1e9),
            max_messages=max_messages,
            max_files=max_files,
            custom_data=custom_data,
        )
        self._make_recording = partial(
            Recording,
            cache_bytes=cache_bytes,
            cache_ns=int(cache_duration_sec * 1e9),
            snapshot=snapshot,
            on_failure=self._note_failure,
        )
        self._is_snapshot = snapshot
        everything = {"*": 0} if repeat_latched is True else {}
        self._repeated = everything if isinstance(repeat_latched, bool) else dict(repeat_latched)
        self._discovers = discovery
        self._unpublished = include_unpublished
        self._ignores_leaf = ignore_leaf
        self._static_topics = dict(static_topics or {})
        self._qos = dict(qos or {})
        self._use_sim_time = use_sim_time
        self._paused = start_paused
        self._loss_report_hz = loss_report_hz
        self._records_causes = causes
        self._causes: CauseRecorder | None = None
        self._causes_lock = asyncio.Lock()
        self._unknown: dict[str, frozenset[bytes]] = {}
        self._unrecorded: set[str] = set()
        """Topics whose types are unknown."""
        self._last_ns = 0
        self._recording: Recording | None = None
        self._stats: dict[str, TopicStats] = {}
        self._due: list[Due] = []
        self._later: set[asyncio.Task[None]] = set()
        self._failed = asyncio.Event()
        self._has_node = False
        self.node: Node = None  # type: ignore[assignment]  # until it is entered

    async def __aenter__(self) -> Self:
        """Open the bag, and subscribe to the existing topics.

        Raises:
            BagError: the folder exists.
            BagWriteError: it cannot be created.
        """
        async with AsyncExitStack() as stack:
            stack.push_async_callback(self.stop)
            await self._open_bag()
            self.node = Node(
                self._node_name,
                context=self._context,
                parameter_overrides=[Parameter("use_sim_time", value=self._use_sim_time)],
            )
            await stack.enter_async_context(self.node)
            self._has_node = True
            self._services = RecorderServices(self, self._loss_report_hz)
            self._tasks = await stack.enter_async_context(asyncio.TaskGroup())
            stack.callback(self._cancel_tasks)
            await self._subscribe_to_new()
            self._start_task(self._follow_graph())
            if self._records_causes:
                self._start_causes(stack)
            self._stack = stack.pop_all()
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Write what has arrived, and close the bag.

        Raises:
            BagWriteError: the disk was full or failed; what was written before is readable.
        """
        await self._stack.__aexit__(None, None, None)  # an error of the block is kept as it is

    # Public API

    def write(self, topic: str, msg: Any, time: Time | None = None) -> None:
        """Record a message that is not published.

        Args:
            topic: The name of the topic.
            msg: The message.
            time: The receive time; defaults to now.

        It is counted as lost if the write queue is full.

        Raises:
            MessageError: a value does not fit its field.
            BagError: the recorder is stopped.
        """
        info = topic_info(topic, type(msg))
        time_ns = self._now_ns() if time is None else time.nanoseconds
        recording = self._open_recording
        number = recording.number_of(info, 0)
        raw = cdr.encode(msg)
        recording.put(Row(number, time_ns, time_ns, 0, len(raw), raw))

    def annotate(self, key: str, value: str) -> None:
        """Add an entry to the metadata of the bag, which are written when it is closed.

        Raises:
            BagError: the recorder is stopped.
        """
        self._open_recording.annotate(key, value)

    @property
    def stats(self) -> dict[str, TopicStats]:
        """The messages recorded and lost, by topic; after `stop`, those of the last bag."""
        return self._stats if self._recording is None else self._recording.stats

    @property
    def recording(self) -> bool:
        """Whether a bag is open; False after `stop`."""
        return self._recording is not None

    @property
    def paused(self) -> bool:
        """Whether it is paused, so that messages are not recorded."""
        return self._paused

    @property
    def discovering(self) -> bool:
        """Whether topics that appear are recorded."""
        return self._discovers

    def pause(self) -> None:
        """Record nothing until `resume`."""
        self._paused = True

    def resume(self, at: Time | None = None, *, mode: int = NODE_TIME, topic: str = "") -> None:
        """Resume recording, now or later.

        Args:
            at: When to resume; now by default.
            mode: The clock for `at`: 0 for the node's time, 1 for the publish time, 2 for the
                receive time of a message.
            topic: The topic whose messages must reach that time; any by default.

        Raises:
            BagError: the topic is not recorded, or there is no such mode.
        """
        self._at(at, mode, topic, self._go_on)

    def start_discovery(self) -> None:
        """Record topics that appear."""
        self._discovers = True
        self._start_task(self._subscribe_to_new())

    def stop_discovery(self) -> None:
        """Stop recording further topics."""
        self._discovers = False

    async def split(
        self, at: Time | None = None, *, mode: int = NODE_TIME, topic: str = ""
    ) -> None:
        """Start a new file, now or later; see `resume`.

        Raises:
            BagError: the recorder is stopped, the topic is not recorded, or there is no such mode.
            BagWriteError: the disk is full or fails.
        """
        thread = self._open_recording.thread
        if at is None:
            await self._open_recording.do(partial(thread.split, self._now_ns()))
        else:
            split = partial(thread.call, partial(thread.split, at.nanoseconds))
            self._at(at, mode, topic, split)

    async def stop(self) -> None:
        """Write what has arrived, and close the bag; the node stays. Stopping again has no effect.

        Raises:
            BagWriteError: the disk was full or failed; what was written before is readable.
        """
        await self._record_causes()
        recording = self._recording
        if recording is None:
            return
        for subscription in recording.subscriptions.values():
            subscription.destroy()
        self._due.clear()
        await recording.close()
        self._recording = None
        self._stats = recording.stats
        if self._has_node and (recording.thread.failure is not None or self._stats):
            self.node.get_logger().info(self.summary())
        recording.raise_failure()

    async def record(self, path: str | PathLike[str] = "") -> None:
        """Start another bag after `stop`.

        Args:
            path: Its folder, which must not exist; by default the previous one.

        Raises:
            BagError: a bag is open, or the folder exists.
            BagWriteError: it cannot be created.
        """
        if self._recording is not None:
            raise BagError(str(self.path), "the recorder is already recording", "stop it first")
        self.path = path or self.path
        await self._open_bag()
        await self._subscribe_to_new()

    async def snapshot(self) -> None:
        """Write the messages kept in snapshot mode, and wait until they are on disk.

        Raises:
            BagError: it is not in snapshot mode, or is stopped.
            BagWriteError: the disk is full or fails.
        """
        if not self._is_snapshot:
            raise BagError(str(self.path), "the recorder is not in snapshot mode")
        await self._record_causes()
        await self._open_recording.do(self._open_recording.thread.write_snapshot)

    async def failed(self) -> None:
        """Wait until nothing can be written any more because the disk is full or fails.

        Raises:
            BagWriteError: always, at that point.
        """
        while True:
            await self._failed.wait()
            self._failed.clear()
            if self._recording is not None:
                self._recording.raise_failure()

    def summary(self) -> str:
        """Summarize in one line what was recorded and what was lost."""
        return summary_of(self.stats, str(self.path), self._unrecorded - self.stats.keys())

    # Internals

    @property
    def _open_recording(self) -> Recording:
        if self._recording is None:
            raise BagError(str(self.path), "the recorder is stopped", "start another bag: record()")
        return self._recording

    async def _open_bag(self) -> None:
        loop = asyncio.get_running_loop()

        def tell_split(closed: str, opened: str) -> None:
            loop.call_soon_threadsafe(self._tell_split, closed, opened)

        writer = await run_in_thread(partial(self._make_writer, self.path, on_split=tell_split))
        self._failed.clear()
        self._recording = self._make_recording(writer)

    def _note_failure(self) -> None:
        if self._recording is not None and self._has_node:
            self.node.get_logger().error(f"{self._recording.thread.failure}")
        self._failed.set()

    def _now_ns(self) -> int:
        return self.node.get_clock().now().nanoseconds

    def _start_task(self, work: Coroutine[None, None, None]) -> None:
        """Run a coroutine that ends with the recorder at the latest."""
        task = self._tasks.create_task(work)
        self._later.add(task)
        task.add_done_callback(self._later.discard)

    def _cancel_tasks(self) -> None:
        for task in self._later:
            task.cancel()

    def _at(self, at: Time | None, mode: int, topic: str, act: Callable[[], None]) -> None:
        """Call `act` now, at a time of the node, or at the first message that reaches a time."""
        if mode not in {NODE_TIME, PUBLISH_TIME, RECEIVE_TIME}:
            raise BagError(str(self.path), f"there is no mode {mode}", "use 0, 1 or 2")
        number = -1
        if topic:
            numbers = [n for key, n in self._open_recording.numbers.items() if key[0] == topic]
            if not numbers:
                raise BagError(str(self.path), f"topic {topic} is not recorded")
            number = numbers[-1]
        if at is None or at.nanoseconds <= self._now_ns():
            act()
        elif mode == NODE_TIME:
            self._start_task(self._act_at(at, act))
        else:
            self._due.append(Due(at.nanoseconds, mode, number, act))

    async def _act_at(self, at: Time, act: Callable[[], None]) -> None:
        clock = self.node.get_clock()
        due = Time(nanoseconds=at.nanoseconds, clock_type=clock.clock_type)
        while clock.now() < due:
            with contextlib.suppress(TimeSourceChangedError):  # the new time source counts then
                await clock.sleep_until(due)
        act()

    def _act_on(self, number: int, time_ns: int, sent_ns: int) -> None:
        """Do what is due before a message."""
        for due in list(self._due):
            if due.has_come(number, time_ns, sent_ns):
                self._due.remove(due)
                due.act()

    def _go_on(self) -> None:
        self._paused = False

    def _take(
        self,
        number: int,
        raw: Parts | memoryview,
        sequence: int,
        source_ns: int,
        received_ns: int,
    ) -> None:
        """Accept a message of a subscription, within the event that delivers it."""
        time_ns = self._now_ns() if self._use_sim_time else received_ns
        sent_ns = source_ns if source_ns > 0 else time_ns  # peers may send anything
        if self._due:
            self._act_on(number, time_ns, sent_ns)
        if self._paused or self._recording is None:
            return
        if time_ns < self._last_ns - BACK_NS:
            back_sec, self._last_ns = (self._last_ns - time_ns) / 1e9, time_ns
            self._warn(
                f"the clock was set back by {back_sec:.1f} s; the bag contains the times as the "
                "clock showed them"
            )
        self._last_ns = time_ns
        if isinstance(raw, memoryview):
            raw = self._recording.owned(number, raw)
        size = size_of_raw(raw)
        self._recording.put(Row(number, time_ns, sent_ns, sequence, size, raw))

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

    def _start_causes(self, stack: AsyncExitStack) -> None:
        """Record causes from now on, for the last time when `stack` ends."""
        from aionode.observe import CauseRecorder  # few recorders need it

        self._causes = CauseRecorder(self.node)
        stack.push_async_callback(self._end_causes)
        self._start_task(self._follow_causes())

    async def _follow_causes(self) -> None:
        clock = Clock(ClockType.STEADY_TIME, time_base=self.node.context.time_base)
        while True:
            await self._record_causes()
            await clock.sleep(CAUSES_S)

    async def _end_causes(self) -> None:
        try:
            await self._record_causes()
        finally:
            self._causes = None

    async def _record_causes(self) -> None:
        """Write the causes that the processes have kept since the last time."""
        async with self._causes_lock:
            if self._causes is None or self._recording is None or self._paused:
                return
            texts = await self._causes.texts()
            now = self.node.get_clock().now()
            if self._recording is not None:
                for text in texts:
                    self.write(CAUSES, String(data=text), now)

    async def _subscribe_to_new(self) -> None:
        """Subscribe to each selected topic that has no subscription yet."""
        if self._recording is None:
            return
        numbers = self._recording.numbers
        for name, typename in self._static_topics.items():
            if not any(key[:2] == (name, typename) for key in numbers):
                await self._subscribe((name, typename, ""), [])
        for key, endpoints in self._wanted().items():
            if key not in numbers:
                await self._subscribe(key, endpoints)

    def _wanted(self) -> dict[Key, list[EndpointInfo]]:
        """Return the selected topics that exist, with their endpoints."""
        kinds = TOPIC_KINDS if self._unpublished else (EndpointKind.PUBLISHER,)
        heard = None
        if self._ignores_leaf:
            heard = {each.name for each in self._others(EndpointKind.SUBSCRIPTION)}
        found: dict[Key, list[EndpointInfo]] = {}
        for endpoint in self._others(*kinds):
            if heard is not None and endpoint.name not in heard:
                continue
            if endpoint.name == CAUSES:  # only the recorder writes there
                continue
            if self._selection.wants(endpoint.name, endpoint.type_name):
                key = endpoint.name, endpoint.type_name, endpoint.type_hash
                found.setdefault(key, []).append(endpoint)
        return found

    def _others(self, *kinds: EndpointKind) -> list[EndpointInfo]:
        """Return the endpoints of all other nodes."""
        own = self.node.get_fully_qualified_name()
        endpoints = self.node.graph.endpoints(*kinds)
        return [each for each in endpoints if each.node.fully_qualified_name != own]

    async def _subscribe(self, key: Key, endpoints: list[EndpointInfo]) -> None:
        name, typename, _ = key
        msg_type = await self._class_of(typename, name, endpoints)
        recording = self._recording
        if msg_type is None or recording is None or key in recording.numbers:
            return
        others = recording.types_of(name)
        if others:
            self._warn(f"{name} has the types {typename} and {others[-1]}: both are recorded")
        offered = [e.qos for e in endpoints if e.kind is EndpointKind.PUBLISHER]
        profile = self._qos.get(name) or adapted_qos(offered)
        info = topic_info(name, msg_type, offered)
        info.type_hash = key[2] if key[2].startswith("RIHS") else info.type_hash
        number = recording.number_of(info, self._repeated_depth(name, profile, offered))
        recording.numbers[key] = number  # the graph may not show the hash
        recording.subscriptions[number] = direct_subscription(
            self.node, msg_type, name, partial(self._take, number), profile
        )

    def _repeated_depth(self, name: str, profile: QoSProfile, offered: list[QoSProfile]) -> int:
        """Return how many messages of a topic each further file starts with."""
        depth = self._repeated.get(name, self._repeated.get("*"))
        if depth is None or profile.durability is not DurabilityPolicy.TRANSIENT_LOCAL:
            return 0
        return depth or max((each.depth for each in offered), default=1)

    async def _class_of(
        self, typename: str, topic: str, endpoints: list[EndpointInfo]
    ) -> Any | None:
        """Return the class of a type; None, with one warning, if no node can describe it."""
        gids = frozenset(endpoint.gid for endpoint in endpoints)
        if self._unknown.get(typename) == gids:
            return None
        try:
            return await self.node.find_type(typename, endpoints=endpoints)
        except InterfaceNotFoundError as error:
            self._unrecorded.add(topic)
            if typename not in self._unknown:
                self._warn(f"{topic} is not recorded: {error}")
            self._unknown[typename] = gids
            return None

    def _tell_split(self, closed: str, opened: str) -> None:
        self._services.tell_split(closed, opened)


def adapted_qos(offered: list[QoSProfile]) -> QoSProfile:
    """Return a QoS profile that receives the messages of all given publishers.

    It is reliable only if all are, and transient local only if all are, as in rosbag2.
    """
    reliable = all(each.reliability is not ReliabilityPolicy.BEST_EFFORT for each in offered)
    latched = bool(offered) and all(
        each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in offered
    )
    return QoSProfile(
        depth=max([MIN_DEPTH, *(each.depth for each in offered)]),
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )
