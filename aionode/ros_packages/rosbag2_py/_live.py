"""Programs import these as `rosbag2_py.Recorder` and `Player`: each runs in its own thread.

Their methods may be called from any thread. They handle no signals, and the program continues
meanwhile.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import inspect
import threading
from typing import TYPE_CHECKING, Any, ClassVar, Final

import msgspec

from aionode import Context, bag
from aionode.bag.yaml_files import PRESETS, static_topics_in
from aionode.clock import Duration, Time
from aionode.errors import AionodeError
from aionode.logging import LoggingSeverity, get_logger_level, set_logger_level

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

__all__ = [
    "MessageOrder",
    "PlayOptions",
    "Player",
    "RecordOptions",
    "Recorder",
    "ServiceRequestsSource",
]

CHECK_S: Final = 0.1
"""Interval at which a wait checks for Ctrl-C, which does not interrupt a lock on every system."""

NOT_CONFIGURED: Final = "pass storage options, and options, when it is created"


class ServiceRequestsSource:
    """The events from which service requests are taken."""

    SERVICE_INTROSPECTION = "service_introspection"
    CLIENT_INTROSPECTION = "client_introspection"


class MessageOrder:
    """The clock by which messages are played."""

    RECEIVED_TIMESTAMP = "received"
    SENT_TIMESTAMP = "sent"


class RecordOptions(msgspec.Struct):
    """The topics to record, and how to record them."""

    all_topics: bool = False
    all_services: bool = False
    all_actions: bool = False
    is_discovery_disabled: bool = False
    topics: list[str] = []
    services: list[str] = []
    actions: list[str] = []
    topic_types: list[str] = []
    exclude_topic_types: list[str] = []
    rmw_serialization_format: str = "cdr"
    input_serialization_format: str = "cdr"
    output_serialization_format: str = "cdr"
    topic_polling_interval: Any = None
    regex: str = ""
    exclude_regex: str = ""
    exclude_topics: list[str] = []
    exclude_service_events: list[str] = []
    exclude_actions: list[str] = []
    node_prefix: str = ""
    compression_mode: str = ""
    compression_format: str = ""
    compression_queue_size: int = 1
    compression_threads: int = 0
    compression_threads_priority: int = 0
    topic_qos_profile_overrides: dict[str, Any] = {}
    include_hidden_topics: bool = False
    include_unpublished_topics: bool = False
    ignore_leaf_topics: bool = False
    start_paused: bool = False
    use_sim_time: bool = False
    static_topics_uri: str = ""
    disable_keyboard_controls: bool = True
    statistics_max_publishing_rate: float = 1.0
    repeat_transient_local_messages: dict[str, int] = {}
    repeat_all_transient_local_depth: int = 0

    def repeated(self) -> dict[str, int]:
        """Return the latched topics repeated at the start of further files, with their counts."""
        depth = self.repeat_all_transient_local_depth
        return ({"*": depth} if depth > 0 else {}) | self.repeat_transient_local_messages

    def selection(self) -> bag.Selection:
        """Return the topics to record."""
        every = [kind for kind in ("topic", "service", "action") if getattr(self, f"all_{kind}s")]
        return bag.Selection(
            topics=self.topics,
            services=[name.removesuffix("/_service_event") for name in self.services],
            actions=self.actions,
            types=self.topic_types,
            regex=self.regex,
            every=every,
            exclude_regex=self.exclude_regex,
            exclude=[*self.exclude_topics, *self.exclude_service_events, *self.exclude_actions],
            exclude_types=self.exclude_topic_types,
            hidden=self.include_hidden_topics,
        )


class PlayOptions(msgspec.Struct):
    """The topics to play, and how: times are in seconds, except the last, in nanoseconds."""

    read_ahead_queue_size: int = 1000
    node_prefix: str = ""
    rate: float = 1.0
    topics_to_filter: list[str] = []
    services_to_filter: list[str] = []
    actions_to_filter: list[str] = []
    regex_to_filter: str = ""
    exclude_regex_to_filter: str = ""
    exclude_topics_to_filter: list[str] = []
    exclude_service_events_to_filter: list[str] = []
    exclude_actions_to_filter: list[str] = []
    topic_qos_profile_overrides: dict[str, Any] = {}
    loop: bool = False
    topic_remapping_options: list[str] = []
    clock_publish_frequency: float = 0.0
    clock_publish_on_topic_publish: bool = False
    clock_topics: list[str] = []
    delay: float = 0.0
    playback_duration: float = -1.0
    disable_keyboard_controls: bool = True
    start_paused: bool = False
    start_offset: float = 0.0
    progress_bar_update_rate: int = 0
    progress_bar_separation_lines: int = 0
    wait_acked_timeout: int = -1
    disable_loan_message: bool = False
    publish_service_requests: bool = False
    send_actions_as_client: bool = False
    service_requests_source: str = ServiceRequestsSource.SERVICE_INTROSPECTION
    message_order: str = MessageOrder.RECEIVED_TIMESTAMP
    playback_until_timestamp: int = -1

    def selection(self) -> bag.Selection:
        """Return the topics to play; without any named, all."""
        named = (
            self.topics_to_filter,
            self.services_to_filter,
            self.actions_to_filter,
            self.regex_to_filter,
        )
        return bag.Selection(
            topics=self.topics_to_filter,
            services=[name.removesuffix("/_service_event") for name in self.services_to_filter],
            actions=self.actions_to_filter,
            regex=self.regex_to_filter,
            every=() if any(named) else ("topic", "service", "action"),
            exclude_regex=self.exclude_regex_to_filter,
            exclude=[
                *self.exclude_topics_to_filter,
                *self.exclude_service_events_to_filter,
                *self.exclude_actions_to_filter,
            ],
            hidden=True,
        )

    def clock_with(self) -> list[str]:
        """Return the topics whose messages also trigger ``/clock``."""
        if not self.clock_publish_on_topic_publish:
            return []
        return self.clock_topics or ["*"]


class LiveThread:
    """Runs a recorder or a player in its own event loop and context, in a thread.

    Args:
        kind: Its class.
        make: Returns it, for a context.
        level: The level of its node's logger meanwhile.

    Raises:
        RuntimeError: it cannot start: the folder of a bag exists, or there is no bag.
    """

    running: ClassVar[set[LiveThread]] = set()

    def __init__(
        self, kind: type[Any], make: Callable[[Context], Any], level: LoggingSeverity
    ) -> None:
        self.kind = kind
        self._make, self._level = make, level
        self._entered: concurrent.futures.Future[None] = concurrent.futures.Future()
        self._ended: concurrent.futures.Future[None] = concurrent.futures.Future()
        self.entity: Any = None
        self._thread = threading.Thread(target=self._main, name="rosbag2-py", daemon=True)
        self.running.add(self)
        self._thread.start()
        awaited(self._entered)

    def _main(self) -> None:
        try:
            asyncio.run(self._run())
        except BaseException as error:  # noqa: BLE001  # raised in the thread that waits
            expected = isinstance(error, AionodeError | OSError | ValueError)
            failure = RuntimeError(str(error)) if expected else error
            for future in (self._entered, self._ended):
                if not future.done():
                    future.set_exception(failure)
        else:
            self._ended.set_result(None)
        finally:
            self.running.discard(self)

    async def _run(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._stopping = asyncio.Event()
        name, level_before = "", LoggingSeverity.UNSET
        try:
            async with Context() as context, self._make(context) as self.entity:
                name = self.entity.node.get_logger().name
                level_before = get_logger_level(name)
                set_logger_level(name, self._level)
                self._entered.set_result(None)
                await self._stopping.wait()
        finally:
            if name:  # the level is the process's: the next node of this name would have it, too
                set_logger_level(name, level_before)

    def call(self, work: Callable[[], Any]) -> Any:
        """Call a function in the loop's thread, and return its result, awaiting a coroutine.

        Raises:
            RuntimeError: it failed, or the thread has ended.
        """
        awaited(self._entered)

        async def run() -> Any:
            result = work()
            return await result if inspect.isawaitable(result) else result

        try:
            return awaited(asyncio.run_coroutine_threadsafe(run(), self._loop))
        except (AionodeError, OSError) as error:
            raise RuntimeError(str(error)) from error

    def begin(self, work: Coroutine[Any, Any, Any]) -> concurrent.futures.Future[Any]:
        """Run a coroutine in the loop, once the loop runs."""
        awaited(self._entered)
        return asyncio.run_coroutine_threadsafe(work, self._loop)

    def stop(self) -> None:
        """End it, once it has started, and wait until everything is written."""
        concurrent.futures.wait([self._entered])
        if not self._ended.done():
            self._loop.call_soon_threadsafe(self._stopping.set)
        awaited(self._ended)

    def wait(self) -> None:
        """Wait until somebody stops it; Ctrl-C stops it, too, and is raised.

        Raises:
            KeyboardInterrupt: after everything is written.
        """
        try:
            awaited(self._ended)
        except KeyboardInterrupt:
            self.stop()
            raise


def awaited(future: concurrent.futures.Future[Any], timeout_sec: float | None = None) -> Any:
    """Return the result of a future without blocking Ctrl-C.

    Raises:
        TimeoutError: it was not done in time.
    """
    if timeout_sec is not None:
        return future.result(timeout_sec)
    while not concurrent.futures.wait([future], CHECK_S).done:
        pass
    return future.result()


def level_of(name: str) -> LoggingSeverity:
    """Return a log level by its name."""
    return LoggingSeverity["WARN" if name.lower() == "warning" else name.upper()]


class Live:
    """The base class of recorders and players."""

    _kind: ClassVar[type[Any]]

    def __init__(
        self,
        storage_options: Any = None,
        options: Any = None,
        log_level: str = "info",
        node_name: str = "",
    ) -> None:
        if isinstance(storage_options, str):  # before Lyrical, only the level was given
            storage_options, log_level = None, storage_options
        self._storage, self._options = storage_options, options
        self._level, self._node_name = log_level, node_name
        self._thread: LiveThread | None = None

    def __del__(self) -> None:
        if getattr(self, "_thread", None) is not None:
            self.stop_spin()

    def _make(self, context: Context) -> Any:
        raise NotImplementedError

    def start_spin(self) -> None:
        """Start the thread of the node.

        Raises:
            RuntimeError: it cannot start.
        """
        if self._storage is None or self._options is None:
            raise RuntimeError(f"{type(self).__name__}: {NOT_CONFIGURED}")
        if self._thread is None:
            self._thread = LiveThread(self._kind, self._make, level_of(self._level))

    def stop_spin(self) -> None:
        """End the thread of the node, and wait until everything is written."""
        thread, self._thread = self._thread, None
        if thread is not None:
            thread.stop()

    def _live(self) -> LiveThread:
        self.start_spin()
        assert self._thread is not None  # noqa: S101  # it has started
        return self._thread

    def _call(self, work: Callable[[Any], Any]) -> Any:
        """Return the result of `work`, called with the recorder or player in its loop's thread."""
        thread = self._live()
        return thread.call(lambda: work(thread.entity))

    def pause(self) -> None:
        """Pause."""
        self._call(lambda entity: entity.pause())

    def resume(self) -> None:
        """Resume."""
        self._call(lambda entity: entity.resume())

    def is_paused(self) -> bool:
        """Whether it is paused."""
        return bool(self._call(lambda entity: entity.paused))


class Recorder(Live):
    """Records topics: `record` starts, `stop` ends."""

    _kind = bag.Recorder

    def __init__(
        self,
        storage_options: Any = None,
        record_options: RecordOptions | None = None,
        log_level: str = "info",
        node_name: str = "rosbag2_recorder",
    ) -> None:
        super().__init__(storage_options, record_options, log_level, node_name)

    def _make(self, context: Context) -> bag.Recorder:
        storage, options = self._storage, self._options
        if storage.storage_id not in {"", "mcap"}:
            raise RuntimeError(f"aionode writes mcap, not {storage.storage_id}")
        return bag.Recorder(
            storage.uri,
            selection=options.selection(),
            context=context,
            node_name=self._node_name,
            compression=PRESETS.get(storage.storage_preset_profile, "zstd"),
            max_bytes=storage.max_bagfile_size,
            max_duration_sec=storage.max_bagfile_duration,
            snapshot=storage.snapshot_mode,
            repeat_latched=options.repeated() or True,
            discovery=not options.is_discovery_disabled,
            include_unpublished=options.include_unpublished_topics,
            ignore_leaf=options.ignore_leaf_topics,
            static_topics=static_topics_in(options.static_topics_uri),
            qos=options.topic_qos_profile_overrides,
            use_sim_time=options.use_sim_time,
            start_paused=options.start_paused,
            loss_report_hz=options.statistics_max_publishing_rate,
            custom_data=storage.custom_data,
        )

    def record(
        self,
        storage_options: Any = None,
        record_options: RecordOptions | None = None,
        node_name: str = "rosbag2_recorder",
    ) -> None:
        """Start recording; with options, as before Lyrical, record until `cancel` or Ctrl-C.

        Raises:
            RuntimeError: the folder exists or cannot be created, or no options were given.
            KeyboardInterrupt: with options, after Ctrl-C, when the bag is closed.
        """
        if storage_options is None:
            self._live()
            return
        self._storage, self._options, self._node_name = storage_options, record_options, node_name
        thread = self._live()
        try:
            thread.wait()
        finally:
            self._thread = None

    def stop(self) -> None:
        """Close the bag."""
        self.stop_spin()

    @staticmethod
    def cancel() -> None:
        """End all recorders of this process, as before Lyrical."""
        cancel_all(bag.Recorder)


class Player(Live):
    """Plays bags: `play` starts, `wait_for_playback_to_finish` waits."""

    _kind = bag.Player

    def __init__(
        self,
        storage_options: Any = None,
        play_options: PlayOptions | None = None,
        log_level: str = "info",
        node_name: str = "rosbag2_player",
    ) -> None:
        super().__init__(storage_options, play_options, log_level, node_name)
        self._playing: concurrent.futures.Future[Any] | None = None

    def _make(self, context: Context) -> bag.Player:
        options = self._options
        storages = self._storage if isinstance(self._storage, list) else [self._storage]
        remap = [option for option in options.topic_remapping_options if ":=" in option]
        until_ns, length = options.playback_until_timestamp, options.playback_duration
        kinds = {
            "service": options.publish_service_requests,
            "action": options.send_actions_as_client,
        }
        acked_ms = options.wait_acked_timeout
        return bag.Player(
            [storage.uri for storage in storages],
            context=context,
            node_name=self._node_name,
            rate=options.rate,
            loop=options.loop,
            start_offset=Duration(seconds=options.start_offset),
            duration=Duration(seconds=length) if length > 0 else None,
            until=Time(nanoseconds=until_ns) if until_ns >= 0 else None,
            delay_sec=options.delay,
            selection=options.selection(),
            remap=dict(option.split(":=", 1) for option in remap),
            clock_hz=options.clock_publish_frequency,
            clock_topics=options.clock_with(),
            qos=options.topic_qos_profile_overrides,
            start_paused=options.start_paused,
            in_order_sent=options.message_order == MessageOrder.SENT_TIMESTAMP,
            send_requests=[kind for kind, wanted in kinds.items() if wanted],
            requests_source=options.service_requests_source,
            wait_acked_sec=acked_ms / 1000 if acked_ms >= 0 else None,
        )

    def play(self, storage_options: Any = None, play_options: PlayOptions | None = None) -> None:
        """Start playing; with options, as before Lyrical, play to the end.

        Raises:
            RuntimeError: there is no such bag, or no options were given.
            KeyboardInterrupt: with options, after Ctrl-C.
        """
        if storage_options is not None:
            self._storage, self._options = storage_options, play_options
        thread = self._live()
        if self._playing is None or self._playing.done():
            self._playing = thread.begin(thread.entity.play())
        if storage_options is not None:
            self.wait_for_playback_to_finish()
            self.stop_spin()

    def wait_for_playback_to_start(self, timeout: float = -1.0) -> bool:
        """Return whether it plays; there is nothing to wait for."""
        del timeout
        return self._playing is not None

    def wait_for_playback_to_finish(self, timeout: float = -1.0) -> bool:
        """Wait for the end, for some seconds at most, and return whether it was reached.

        Raises:
            RuntimeError: a file is damaged.
        """
        if self._playing is None:
            return True
        try:
            awaited(self._playing, timeout if timeout >= 0 else None)
        except TimeoutError:
            return False
        except (AionodeError, OSError) as error:
            raise RuntimeError(str(error)) from error
        except KeyboardInterrupt:
            self.stop()
            raise
        return True

    wait_for_playback_to_start_exclusively = wait_for_playback_to_start
    wait_for_playback_to_finish_exclusively = wait_for_playback_to_finish

    def stop(self) -> None:
        """Stop playing."""
        self._call(lambda player: player.stop())
        self.wait_for_playback_to_finish()

    def play_next(self) -> bool:
        """Publish the next message, while paused; return whether there was one."""
        return bool(self._call(lambda player: player.play_next()))

    def burst(self, *given: Any) -> int:
        """Publish several of the next messages at once, while paused, and return their number.

        Args:
            given: The number, 0 for all; before Lyrical, after the storage and play options.
        """
        if len(given) > 1:
            self._storage, self._options = given[0], msgspec.structs.replace(given[1])
            self._options.start_paused = True
            self.play()
        count = int(self._call(lambda player: player.burst(int(given[-1]))))
        if len(given) > 1:
            self.stop()
            self.stop_spin()
        return count

    def seek(self, time_point: int) -> None:
        """Seek to another time, in nanoseconds."""
        self._call(lambda player: player.seek(Time(nanoseconds=int(time_point))))

    def get_starting_time(self) -> int:
        """Return the time of the first message in nanoseconds."""
        return int(self._call(lambda player: player.start.nanoseconds))

    def get_playback_duration(self) -> int:
        """Return the duration of the bags, in nanoseconds."""
        return int(self._call(lambda player: player.end.nanoseconds - player.start.nanoseconds))

    @staticmethod
    def cancel() -> None:
        """Stop all players of this process, as before Lyrical."""
        cancel_all(bag.Player)


def cancel_all(kind: type[Any]) -> None:
    """End everything of a kind that runs in this process."""
    for thread in [thread for thread in LiveThread.running if thread.kind is kind]:
        if kind is bag.Player:
            awaited(thread.begin(stopped(thread)))
        else:
            thread.stop()


async def stopped(thread: LiveThread) -> None:
    """Stop the player of a thread."""
    thread.entity.stop()
