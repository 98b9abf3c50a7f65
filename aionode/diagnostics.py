"""Publish the health of a node and its devices on ``/diagnostics``.

The names and rules are those of ROS 2's package `diagnostic_updater`: an `Updater` calls its tasks
periodically, and publishes the status that each of them fills. ::

    updater = Updater(self)
    updater.setHardwareID("lidar 0042")
    updater.add("temperature", self.check_temperature)  # may be a coroutine function
    rate = FrequencyStatusParam({"min": 9.0, "max": 11.0})
    self.scans = DiagnosedPublisher(publisher, updater, rate, TimeStampStatusParam())

``ros2 run rqt_robot_monitor``, the `diagnostic_aggregator` and ``aionode doctor`` read them.
"""

from __future__ import annotations

import asyncio
import inspect
import math
import threading
from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Final, TypeAlias

from aionode.clock import MachineTime
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

__all__ = [
    "CompositeDiagnosticTask",
    "DiagnosedPublisher",
    "DiagnosticStatusWrapper",
    "DiagnosticTask",
    "FrequencyStatus",
    "FrequencyStatusParam",
    "FunctionDiagnosticTask",
    "HeaderlessTopicDiagnostic",
    "Heartbeat",
    "TimeStampStatus",
    "TimeStampStatusParam",
    "TopicDiagnostic",
    "Updater",
]

OK: Final = DiagnosticStatus.OK
WARN: Final = DiagnosticStatus.WARN
ERROR: Final = DiagnosticStatus.ERROR

Run: TypeAlias = "Callable[[Any], Any]"
"""Fills a status and returns it; may be a coroutine function in a task of its own."""


# Statuses


class StatusMethods:
    """Fills a status: the methods of `DiagnosticStatusWrapper`, for the messages of either API."""

    level: Any
    message: str
    values: Any
    _value_class: ClassVar[Any] = KeyValue

    def summary(self, *args: Any) -> None:
        """Set level and message.

        Args:
            args: A level and a message, or a status from which both are copied.
        """
        self.level, self.message = level_and_message(args)

    def clearSummary(self) -> None:
        """Set the level to OK, and the message to an empty text."""
        self.summary(OK, "")

    def mergeSummary(self, *args: Any) -> None:
        """Combine another level and message with these: the worse one counts.

        If both are OK, or neither is, both messages are kept.

        Args:
            args: A level and a message, or a status.
        """
        level, message = level_and_message(args)
        if (level > OK) == (self.level > OK):
            self.message += f"; {message}" if self.message else message
        elif level > self.level:
            self.message = message
        self.level = max(level, self.level)

    def add(self, key: str, val: Any) -> None:
        """Add a named value, converted to text."""
        self.values.append(self._value_class(key=key, value=str(val)))


def level_and_message(args: tuple[Any, ...]) -> tuple[Any, str]:
    """Return the arguments of `summary`: two, or the two of a status."""
    if len(args) == 1:
        return args[0].level, args[0].message
    level, message = args
    return level, str(message)


class DiagnosticStatusWrapper(StatusMethods, DiagnosticStatus):
    """A status that tasks fill."""


# Tasks


class DiagnosticTask:
    """Something that fills a status, with its name.

    Args:
        name: The name of the status, behind that of the node.

    Attributes:
        name: The name.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._clock: Any = None

    def getName(self) -> str:
        """Return the name."""
        return self.name

    def run(self, stat: Any) -> Any:
        """Fill a status and return it."""
        return stat

    def use_clock(self, clock: Any) -> None:
        """Set the clock unless there is one; an updater passes its node's clock."""
        if self._clock is None:
            self._clock = clock

    def _now_ns(self) -> int:
        if self._clock is None:
            return MachineTime().system_ns()
        return int(self._clock.now().nanoseconds)


class FunctionDiagnosticTask(DiagnosticTask):
    """A task that is a function.

    Args:
        name: The name of the status.
        fn: Fills the status and returns it; a coroutine function is awaited.
    """

    def __init__(self, name: str, fn: Run) -> None:
        super().__init__(name)
        self.fn = fn

    def run(self, stat: Any) -> Any:
        """Call the function."""
        return self.fn(stat)


class CompositeDiagnosticTask(DiagnosticTask):
    """Several tasks with one status: its level is the worst of theirs.

    Their functions may not be coroutine functions.
    """

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.tasks: list[DiagnosticTask] = []

    def run(self, stat: Any) -> Any:
        """Run all tasks, and combine their summaries."""
        combined, original = type(stat)(), type(stat)()
        original.summary(stat)
        for task in self.tasks:
            stat.summary(original)
            stat = task.run(stat)
            combined.mergeSummary(stat)
        stat.summary(combined)
        return stat

    def addTask(self, t: DiagnosticTask) -> None:
        """Add a task."""
        self.tasks.append(t)
        if self._clock is not None:
            t.use_clock(self._clock)

    def use_clock(self, clock: Any) -> None:
        """Measure by a clock unless there is one."""
        super().use_clock(clock)
        for task in self.tasks:
            task.use_clock(clock)


class Heartbeat(DiagnosticTask):
    """A task that reports that the node is alive."""

    def __init__(self) -> None:
        super().__init__("Heartbeat")

    def run(self, stat: Any) -> Any:
        """Report that the node is alive."""
        stat.summary(OK, "Alive")
        return stat


@dataclass(slots=True)
class FrequencyStatusParam:
    """The limits of a `FrequencyStatus`.

    Attributes:
        freq_bound: The lowest and, unless there is none, the highest frequency in hertz, as ``min``
            and ``max``. A change has effect from the next run on.
        tolerance: The fraction by which they may be exceeded.
        window_size: The number of runs over which the frequency is averaged.
    """

    freq_bound: dict[str, float]
    tolerance: float = 0.1
    window_size: int = 5


class FrequencyStatus(DiagnosticTask):
    """Warns if events are too rare or too frequent; no event at all is an error.

    Args:
        params: The limits.
        name: The name of the status.
        clock: The clock by which it measures; that of the updater's node by default.
    """

    def __init__(
        self, params: FrequencyStatusParam, name: str = "FrequencyStatus", clock: Any = None
    ) -> None:
        super().__init__(name)
        self.params = params
        self._clock = clock
        self._lock = threading.Lock()  # programs of rclpy tick in other threads
        self.clear()

    def use_clock(self, clock: Any) -> None:
        """Measure by a clock unless there is one, and from now on."""
        if self._clock is None:
            super().use_clock(clock)
            self.clear()

    def clear(self) -> None:
        """Forget all events."""
        with self._lock:
            self.count = 0
            self._marks = deque([(self._now_ns(), 0)], max(self.params.window_size, 1))

    def tick(self) -> None:
        """Note an event."""
        with self._lock:
            self.count += 1

    def run(self, stat: Any) -> Any:
        """Check the frequency over the last `window_size` runs."""
        now_ns = self._now_ns()
        with self._lock:
            (start_ns, before), count = self._marks[0], self.count
            self._marks.append((now_ns, count))
        events, window = count - before, (now_ns - start_ns) / 1e9
        if window < 0:  # simulated time was set back
            self.clear()
        frequency = events / window if window > 0 else 0.0
        bound, tolerance = self.params.freq_bound, self.params.tolerance
        low, high = bound["min"] * (1 - tolerance), bound.get("max", math.inf) * (1 + tolerance)
        if events == 0:
            stat.summary(ERROR, "No events recorded.")
        elif frequency < low:
            stat.summary(WARN, "Frequency too low.")
        elif frequency > high:
            stat.summary(WARN, "Frequency too high.")
        else:
            stat.summary(OK, "Desired frequency met")
        stat.add("Events in window", f"{events:d}")
        stat.add("Events since startup", f"{count:d}")
        stat.add("Duration of window (s)", f"{window:f}")
        stat.add("Actual frequency (Hz)", f"{frequency:f}")
        if bound.get("max") == bound["min"]:
            stat.add("Target frequency (Hz)", f"{bound['min']:f}")
        if bound["min"] > 0:
            stat.add("Minimum acceptable frequency (Hz)", f"{low:f}")
        if "max" in bound:
            stat.add("Maximum acceptable frequency (Hz)", f"{high:f}")
        return stat


@dataclass(slots=True)
class TimeStampStatusParam:
    """The limits of a `TimeStampStatus`.

    Attributes:
        min_acceptable: Minimum age of a stamp in seconds; negative ages are in the future.
        max_acceptable: Maximum age of a stamp, in seconds.
    """

    min_acceptable: float = -1
    max_acceptable: float = 5


class TimeStampStatus(DiagnosticTask):
    """Checks the ages of stamps since the last run.

    Args:
        params: The limits.
        name: The name of the status.
        clock: The clock of the stamps; that of the updater's node by default.
    """

    def __init__(
        self,
        params: TimeStampStatusParam | None = None,
        name: str = "Timestamp Status",
        clock: Any = None,
    ) -> None:
        super().__init__(name)
        self.params = TimeStampStatusParam() if params is None else params
        self._clock = clock
        self._lock = threading.Lock()
        self.early_count = self.late_count = self.zero_count = 0
        self._seen = Ages()

    def tick(self, stamp: Any) -> None:
        """Note the stamp of an event.

        Args:
            stamp: Seconds, a `Time`, or the stamp of a header.
        """
        if isinstance(stamp, int | float):
            seconds = float(stamp)
        elif hasattr(stamp, "nanoseconds"):
            seconds = stamp.nanoseconds / 1e9
        else:
            seconds = stamp.sec + stamp.nanosec / 1e9
        with self._lock:
            if seconds == 0:
                self._seen.has_zero = True
            else:
                age = self._now_ns() / 1e9 - seconds
                self._seen.oldest = max(self._seen.oldest, age)
                self._seen.newest = min(self._seen.newest, age)

    def run(self, stat: Any) -> Any:
        """Check the ages of the stamps since the last run."""
        with self._lock:
            seen, self._seen = self._seen, Ages()
        stat.summary(OK, "Timestamps are reasonable.")
        has_ages = seen.newest <= seen.oldest
        if not has_ages and not seen.has_zero:
            stat.summary(WARN, "No data since last update.")
        if has_ages and seen.newest < self.params.min_acceptable:
            stat.summary(ERROR, "Timestamps too far in future seen.")
            self.early_count += 1
        if has_ages and seen.oldest > self.params.max_acceptable:
            stat.summary(ERROR, "Timestamps too far in past seen.")
            self.late_count += 1
        if seen.has_zero:
            stat.summary(ERROR, "Zero timestamp seen.")
            self.zero_count += 1
        stat.add("Earliest timestamp delay:", f"{seen.newest if has_ages else 0:f}")
        stat.add("Latest timestamp delay:", f"{seen.oldest if has_ages else 0:f}")
        stat.add("Earliest acceptable timestamp delay:", f"{self.params.min_acceptable:f}")
        stat.add("Latest acceptable timestamp delay:", f"{self.params.max_acceptable:f}")
        stat.add("Late diagnostic update count:", f"{self.late_count}")
        stat.add("Early diagnostic update count:", f"{self.early_count}")
        stat.add("Zero seen diagnostic update count:", f"{self.zero_count}")
        return stat


@dataclass(slots=True)
class Ages:
    """The ages of stamps since a run, in seconds."""

    newest: float = math.inf
    oldest: float = -math.inf
    has_zero: bool = False


# Topics


class HeaderlessTopicDiagnostic(CompositeDiagnosticTask):
    """Checks the rate of a topic.

    Args:
        name: The name of the topic.
        diag: The updater, to which it adds itself.
        freq: The limits of the frequency.
    """

    def __init__(self, name: str, diag: Any, freq: FrequencyStatusParam) -> None:
        super().__init__(f"{name} topic status")
        self.diag = diag
        self.freq = FrequencyStatus(freq)
        self.addTask(self.freq)
        self.diag.add(self)

    def tick(self, *_: Any) -> None:
        """Note that a message was published."""
        self.freq.tick()

    def clear_window(self) -> None:
        """Forget all messages."""
        self.freq.clear()


class TopicDiagnostic(HeaderlessTopicDiagnostic):
    """Checks the rate of a topic, and the ages of its stamps.

    Args:
        name: The name of the topic.
        diag: The updater, to which it adds itself.
        freq: The limits of the frequency.
        stamp: The limits of the ages.
    """

    def __init__(
        self, name: str, diag: Any, freq: FrequencyStatusParam, stamp: TimeStampStatusParam
    ) -> None:
        super().__init__(name, diag, freq)
        self.stamp = TimeStampStatus(stamp)
        self.addTask(self.stamp)

    def tick(self, stamp: Any) -> None:
        """Note that a message with a stamp was published."""
        self.stamp.tick(stamp)
        super().tick()


class DiagnosedPublisher(TopicDiagnostic):
    """A publisher of messages with a header, checked like a `TopicDiagnostic`.

    Args:
        pub: The publisher.
        diag: The updater, to which it adds itself.
        freq: The limits of the frequency.
        stamp: The limits of the ages.

    Attributes:
        publisher: The publisher.
    """

    def __init__(
        self, pub: Any, diag: Any, freq: FrequencyStatusParam, stamp: TimeStampStatusParam
    ) -> None:
        super().__init__(pub.topic_name, diag, freq, stamp)
        self.publisher = pub

    def publish(self, message: Any) -> None:
        """Note the message, and publish it."""
        self.tick(message.header.stamp)
        self.publisher.publish(message)


# The updater


@dataclass(slots=True)
class Named:
    """A task of an updater, with the name of its status."""

    name: str
    run: Run = field(repr=False)


class UpdaterBase:
    """The base class of the updaters of both APIs; see `Updater`."""

    _wrapper_class: ClassVar[Any] = DiagnosticStatusWrapper
    _status_class: ClassVar[Any] = DiagnosticStatus
    _array_class: ClassVar[Any] = DiagnosticArray

    def __init__(self, node: Any, period: float = 1.0) -> None:
        self.node = node
        self.tasks: list[Named] = []
        self.verbose = False
        self.hwid = ""
        self.warn_nohwid_done = False
        self.period_parameter = "diagnostic_updater.period"
        self.use_fqn_parameter = "diagnostic_updater.use_fqn"
        self.publisher = node.create_publisher(self._array_class, "/diagnostics", 1)
        self._period = float(self._declared(self.period_parameter, float(period)))
        has_full_name = self._declared(self.use_fqn_parameter, False)
        self.node_name = node.get_fully_qualified_name() if has_full_name else node.get_name()
        self.timer = node.create_timer(self._period, self.update)

    def _declared(self, name: str, default: Any) -> Any:
        """Return a parameter, which another updater of the node may have declared."""
        if self.node.has_parameter(name):
            return self.node.get_parameter(name).value
        return self.node.declare_parameter(name, default).value

    def update(self) -> Any:
        """Run all tasks and publish their statuses; the timer does so."""
        raise NotImplementedError

    @property
    def period(self) -> float:
        """The time between two updates, in seconds; setting it changes the timer."""
        return self._period

    @period.setter
    def period(self, period: float) -> None:
        timer = self.node.create_timer(period, self.update)
        self.node.destroy_timer(self.timer)
        self._period, self.timer = float(period), timer

    def add(self, *args: Any) -> None:
        """Add a task, and publish that the node is starting.

        Args:
            args: A `DiagnosticTask`; or a name and a function that fills a status and returns it.
        """
        if len(args) == 1:
            task = Named(args[0].getName(), args[0].run)
            if hasattr(args[0], "use_clock"):  # tasks of other classes may lack it
                args[0].use_clock(self.node.get_clock())
        else:
            task = Named(*args)
        self.tasks.append(task)
        self._tell([task], OK, "Node starting up")

    def removeByName(self, name: str) -> bool:
        """Remove the first task with a name; return whether there was one."""
        found = next((task for task in self.tasks if task.name == name), None)
        if found is not None:
            self.tasks.remove(found)
        return found is not None

    def setHardwareID(self, hwid: str) -> None:
        """Set the serial number or name of the device to which all statuses refer."""
        self.hwid = hwid

    def broadcast(self, lvl: Any, msg: str) -> None:
        """Publish the same level and message for all tasks, for example before a shutdown."""
        self._tell(self.tasks, lvl, msg)

    def _tell(self, tasks: list[Named], level: Any, message: str) -> None:
        statuses = []
        for task in tasks:
            status = self._wrapper_class()
            status.name = task.name
            status.summary(level, message)
            statuses.append(status)
        self.publish(statuses)

    def publish(self, msg: Any) -> None:
        """Publish a status, or a list of them."""
        array = self._array_class()
        array.header.stamp = self.node.get_clock().now().to_msg()
        array.status = [
            self._status_class(
                level=stat.level,
                name=f"{self.node_name}: {stat.name}",
                message=stat.message,
                hardware_id=stat.hardware_id,
                values=stat.values,
            )
            for stat in (msg if isinstance(msg, list) else [msg])
        ]
        self.publisher.publish(array)

    # The parts of an update

    def _begun(self, task: Named) -> Any:
        """Return the status that a task is given."""
        return self._wrapper_class(
            level=ERROR, name=task.name, message="No message was set", hardware_id=self.hwid
        )

    def _failed(self, task: Named, error: Exception) -> Any:
        """Return the status of a task that has raised; the others are published as usual."""
        status = self._begun(task)
        text = str(error) or "no answer in time"
        status.message = f"the task has failed: {type(error).__name__}: {text}"
        self.node.get_logger().error(f"diagnostic_updater: {task.name}: {status.message}")
        return status

    def _finish(self, statuses: list[Any]) -> None:
        """Publish statuses, warn of what is wrong, and follow the parameter."""
        for status in statuses:
            if self.verbose and status.level != OK:
                self.node.get_logger().warning(
                    f"Non-zero diagnostic status. Name: {status.name}, status "
                    f"{status.level[0]}: {status.message}"
                )
        if not (self.hwid or self.warn_nohwid_done) and all(each.level == OK for each in statuses):
            self.warn_nohwid_done = True
            self.node.get_logger().warning(
                "diagnostic_updater: no hardware id was set; call setHardwareID, with 'none' if "
                "there is no device"
            )
        self.publish(statuses)
        wanted = self.node.get_parameter(self.period_parameter).value
        if wanted != self._period and isinstance(wanted, float) and 0 < wanted < math.inf:
            self.period = wanted


class Updater(UpdaterBase):
    """Calls its tasks periodically, and publishes the status that each of them fills.

    The parameter ``diagnostic_updater.period`` takes precedence over `period`, and may be changed
    while the node runs. With ``diagnostic_updater.use_fqn``, statuses begin with the full name of
    the node. A task that raises, or a coroutine that takes longer than a period, gets the level
    ERROR; the others are still published.

    Args:
        node: The node.
        period: The time between two updates, in seconds.

    Attributes:
        node: The node.
        verbose: Whether statuses that are not OK are logged.
        hwid: The hardware id of all statuses.
    """

    async def update(self) -> None:
        """Run all tasks one after another, and publish their statuses."""
        statuses = []
        for task in list(self.tasks):
            status = self._begun(task)
            try:
                filled = task.run(status)
                if inspect.isawaitable(filled):
                    filled = await self._in_time(filled)
            except Exception as error:  # noqa: BLE001  # the user's task: reported and logged
                filled = self._failed(task, error)
            statuses.append(status if filled is None else filled)
        self._finish(statuses)

    async def _in_time(self, filling: Awaitable[Any]) -> Any:
        async with asyncio.timeout(self._period):
            return await filling

    async def force_update(self) -> None:
        """Update now, whatever the period is."""
        await self.update()
