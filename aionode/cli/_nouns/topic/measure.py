"""``aionode topic hz``, ``bw`` and ``delay``, and the statistics that they print.

Messages are timed on arrival, not when they are processed, and decoded only if their content is
needed, so the results also hold at rates too high for printing. Messages of the first moments are
not counted, because connecting delays them.
"""

from __future__ import annotations

import asyncio
import math
from collections import deque
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Protocol

import click

from aionode.cli._support.command import command
from aionode.cli._support.completion import complete_names, name_argument
from aionode.cli._support.follow import Follower, filter_from, wait_for_type
from aionode.cli._support.nouns import TOPIC
from aionode.cli._support.options import CommandT, filter_option, natural
from aionode.errors import CommandError
from aionode.message import fields, type_name
from aionode.qos import qos_profile_sensor_data

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.cli._support.output import Output
    from aionode.endpoints.subscription import MessageInfo, Subscription
    from aionode.message import Message
    from aionode.node import Node

__all__ = [
    "Bandwidth",
    "Intervals",
    "bw",
    "delay",
    "hz",
    "measuring",
    "size_texts",
    "spread_of",
]

DEPTH = 10_000
"""Queue depth: one second of the fastest topics."""

PRINT_PERIOD_S = 1.0

CONNECTING_S = 0.3
"""Time during which messages reach a new subscription late and in bursts, in seconds.

During this time, publishers in other processes are discovered and switch to a link, which normally
takes 0.1 s.
"""

QOS = qos_profile_sensor_data.replace(depth=DEPTH)

HZ_HEADER: Final[tuple[str, ...]] = ("topic", "rate", "min_delta", "max_delta", "std_dev", "window")

BW_HEADER: Final[tuple[str, ...]] = ("topic", "bandwidth", "window", "mean", "min", "max")

MIN_FIRST = (5, 4, 3, 2)
"""The columns that a narrow terminal omits, least important first."""

SILENT = ("-",) * (len(HZ_HEADER) - 1)
"""The cells of a silent topic."""

measuring = click.Group("topic")
"""The commands of this module, which the group ``topic`` includes."""


def window_option(default: int) -> Callable[[CommandT], CommandT]:
    """Return the option for the number of messages in the statistics."""
    return click.option(
        "-w",
        "--window",
        metavar="N",
        type=natural,
        default=default,
        show_default=True,
        help="Number of messages in the statistics.",
    )


names_argument = click.argument("topic_names", nargs=-1, shell_complete=complete_names("topic"))
all_option = click.option(
    "-a", "--all", "every", is_flag=True, help="Measure all topics that exist now."
)


def expect_names(options: dict[str, Any]) -> None:
    """Check that there are names of topics, or that all are wanted."""
    if options["every"] and options["topic_names"]:
        raise click.UsageError("Give names of topics or --all, not both.")
    if not options["every"] and not options["topic_names"]:
        raise click.UsageError("Missing argument 'TOPIC_NAMES...'; --all measures all topics.")


def wanted_topics(node: Node, given: Sequence[str], *, every: bool, output: Output) -> list[str]:
    """Return the full names of the topics to measure; if those are all, print their number."""
    if not every:
        return list(dict.fromkeys(map(node.resolve_topic_name, given)))
    names = sorted(TOPIC.types_by_name(node))
    output.text(
        f"Subscribing to all {len(names)} available topics..." if names else "No topics available"
    )
    return names


# Rate


@command(
    measuring,
    "hz",
    names_argument,
    all_option,
    window_option(10_000),
    filter_option("Count"),
    click.option(
        "--wall-time", is_flag=True, help="Measure by this machine's clock, not in ROS time."
    ),
    interfaces=True,
    sim_time=True,
    prepare=expect_names,
    endless=True,
    busy=True,
)
async def hz(
    node: Node,
    topic_names: Sequence[str],
    *,
    output: Output,
    every: bool = False,
    window: int = 10_000,
    filter_text: str | None = None,
    wall_time: bool = False,
) -> None:
    """Print the rate of messages, once a second.

    Raises:
        CommandError: the type of a topic cannot be determined, or the filter is invalid.
    """
    fits = filter_from(filter_text)
    names = wanted_topics(node, topic_names, every=every, output=output)
    intervals = {name: Intervals(window) for name in names}
    meter = Meter(node, output)

    def on_message(name: str, msg: Any, info: MessageInfo) -> None:
        if filter_text is not None and not fits(msg):
            return
        if intervals[name].arrive(arrival_ns(node, info, wall_time=wall_time)):
            output.text("time has reset, resetting counters")

    if len(names) == 1:
        msg_type = await wait_for_type(node, names[0], output)
        meter.follow(msg_type, names[0], partial(on_message, names[0]), raw=filter_text is None)
        await meter.report(partial(print_rate, output, names[0], intervals[names[0]]))
    elif names:
        await meter.report_table(RateTable(intervals), on_message, raw=filter_text is None)


class Meter:
    """Receives the messages of topics and reports once a second.

    Args:
        node: The command's node.
        output: Where to warn if messages arrive faster than they can be counted.
    """

    def __init__(self, node: Node, output: Output) -> None:
        self._node = node
        self._output = output
        self._follower = Follower(node)
        self._subscriptions: list[Subscription[Any]] = []
        self._dropped = 0

    def follow(
        self,
        msg_type: type[Message],
        name: str,
        on_message: Callable[[Any, MessageInfo], None],
        *,
        raw: bool,
    ) -> None:
        """Call `on_message` with each message that arrives once publishers are connected."""
        others = len(self._node.context.transports) > 1  # not only within this process
        begins_ns = self._node.context.time_base.system_ns() + int(CONNECTING_S * 1e9) * others

        def when_connected(msg: Any, info: MessageInfo) -> None:
            if info["received_timestamp"] >= begins_ns:
                on_message(msg, info)

        self._subscriptions.append(
            self._follower.follow(msg_type, name, when_connected, QOS, raw=raw)
        )

    async def report(self, show: Callable[[], None]) -> None:
        """Call `show` once a second until a callback fails."""

        def tick() -> None:
            self._warn_of_dropped()
            show()

        self._node.create_timer(PRINT_PERIOD_S, tick, on_error=self._follower.fail)
        await self._follower.finished()

    async def report_table(
        self, table: Table, on_message: Callable[[str, Any, MessageInfo], None], *, raw: bool
    ) -> None:
        """Call `on_message` with the messages of several topics, and print a table of them.

        Args:
            table: It has a row for each topic.
            on_message: Called with the name of the topic first.
            raw: Whether messages are passed as bytes.
        """

        async def subscribe(name: str) -> None:
            msg_type = await wait_for_type(self._node, name, self._output, spinner=False)
            if not self._output.is_terminal:  # a terminal has it in the table
                self._output.text(f"Subscribed to [{name}]")
            self.follow(msg_type, name, partial(on_message, name), raw=raw)

        with self._output.live() if self._output.is_terminal else nullcontext() as update:
            show = partial(print_table, table, self._output, update)
            # Concurrently: a topic without a publisher must not hold up the others.
            await asyncio.gather(self.report(show), *map(subscribe, table.names))

    def _warn_of_dropped(self) -> None:
        dropped = sum(subscription.stats.dropped for subscription in self._subscriptions)
        if dropped > self._dropped:
            self._output.warn(
                f"{dropped} messages arrived too fast to be counted: the real rates are higher"
            )
            self._dropped = dropped


def arrival_ns(node: Node, info: MessageInfo, *, wall_time: bool = False) -> int:
    """Return when a message arrived, in ROS time if that is simulated and wanted."""
    clock = node.get_clock()
    if not wall_time and getattr(clock, "ros_time_is_active", False):
        return clock.now().nanoseconds
    return info["received_timestamp"]


def spread_text(spread: Spread) -> str:
    """Return the extremes and deviation in seconds, and the number of samples, in ros2's layout."""
    _, low, high, deviation, count = hz_values(spread)
    return f"\tmin: {low}s max: {high}s std dev: {deviation}s window: {count}"


def spread_record(spread: Spread) -> dict[str, Any]:
    """Return the fields that `spread_text` shows, as a record."""
    return {
        "min_s": spread.low / 1e9,
        "max_s": spread.high / 1e9,
        "std_dev_s": spread.deviation / 1e9,
        "window": spread.count,
    }


def hz_values(spread: Spread) -> tuple[str, str, str, str, str]:
    """Return the rate in Hz, extremes and deviation in seconds, and the number of intervals."""
    return (
        f"{spread.rate_hz:.3f}",
        f"{spread.low / 1e9:.3f}",
        f"{spread.high / 1e9:.3f}",
        f"{spread.deviation / 1e9:.5f}",
        str(spread.count),
    )


def hz_record(name: str, spread: Spread | None) -> dict[str, Any]:
    """Return the record of one topic; the rate of a silent one is 0."""
    if spread is None:
        silent = dict.fromkeys(("min_s", "max_s", "std_dev_s"))
        return {"topic": name, "rate_hz": 0.0, **silent, "window": 0}
    return {"topic": name, "rate_hz": spread.rate_hz, **spread_record(spread)}


class Table(Protocol):
    """Statistics of several topics."""

    header: tuple[str, ...]

    @property
    def names(self) -> Sequence[str]:
        """The topics."""
        ...

    def update(self) -> bool:
        """Take over the last second's messages; return whether there is something to print."""
        ...

    def rows(self) -> list[tuple[str, ...]]:
        """Return the cells of each topic, in the columns of `header`."""
        ...

    def records(self) -> list[dict[str, Any]]:
        """Return the record of each topic."""
        ...


class RateTable:
    """The latest rates of several topics, updated once a second.

    A topic is silent until its second message, and again once its next one is long overdue.

    Args:
        intervals: For each topic, the time between its messages.
    """

    header = HZ_HEADER

    def __init__(self, intervals: dict[str, Intervals]) -> None:
        self.names = list(intervals)
        self._intervals = intervals
        self._shown: dict[str, Spread | None] = dict.fromkeys(intervals)
        self._silent_s = dict.fromkeys(intervals, 0.0)

    def update(self) -> bool:
        """Process the last second's messages; return whether any came, or a topic fell silent."""
        changed = False
        for name, before in self._shown.items():
            new = self._intervals[name].spread()
            self._silent_s[name] = 0.0 if new else self._silent_s[name] + PRINT_PERIOD_S
            if new is None and before is not None and self._silent_s[name] > overdue_s(before):
                self._shown[name] = None
                changed = True
            if new is not None:
                self._shown[name] = new
                changed = True
        return changed

    def rows(self) -> list[tuple[str, ...]]:
        """Return a row for each topic, in the columns of `HZ_HEADER`."""
        return [
            (name, *(SILENT if spread is None else hz_values(spread)))
            for name, spread in self._shown.items()
        ]

    def records(self) -> list[dict[str, Any]]:
        """Return the record of each topic."""
        return [hz_record(name, spread) for name, spread in self._shown.items()]


def overdue_s(spread: Spread) -> float:
    """Return after how many seconds without messages a topic is silent: a few intervals."""
    return 1.0 + 3 * spread.high / 1e9


def print_rate(output: Output, name: str, intervals: Intervals) -> None:
    """Print the statistics of the only topic, unless it is silent."""
    spread = intervals.spread()
    if spread is not None:
        output.item(
            f"average rate: {spread.rate_hz:.3f}\n{spread_text(spread)}", hz_record(name, spread)
        )


def print_table(
    table: Table, output: Output, update: Callable[[Callable[[int], str]], None] | None
) -> None:
    """Print new statistics of several topics, if there are any; `update` redraws a terminal."""
    changed = table.update()
    if update is not None:
        update(partial(fitted_table, table.header, table.rows()))
    elif changed:
        output.text(fitted_table(table.header, table.rows()))
        if output.json:
            output.items([("", record) for record in table.records()])


def fitted_table(
    header: tuple[str, ...], rows: list[tuple[str, ...]], width: int | None = None
) -> str:
    """Return the statistics as a table, without columns that do not fit into `width`."""
    kept = range(len(header)) if width is None else columns_for(header, rows, width)
    return table_text([[row[i] for i in kept] for row in (header, *rows)])


def columns_for(header: tuple[str, ...], rows: list[tuple[str, ...]], width: int) -> list[int]:
    """Return which columns fit into `width`; topic and rate are always kept."""
    widths = [max(map(len, column)) for column in zip(header, *rows, strict=True)]
    kept = list(range(len(header)))
    for column in MIN_FIRST:
        if sum(widths[i] + 3 for i in kept) - 3 < width:  # not the full width
            break
        kept.remove(column)
    return kept


# Bandwidth


@command(
    measuring,
    "bw",
    names_argument,
    all_option,
    window_option(100),
    interfaces=True,
    prepare=expect_names,
    endless=True,
    busy=True,
)
async def bw(
    node: Node,
    topic_names: Sequence[str],
    *,
    output: Output,
    every: bool = False,
    window: int = 100,
) -> None:
    """Print the bandwidth of topics, once a second.

    Raises:
        CommandError: the type of a topic cannot be determined.
    """
    names = wanted_topics(node, topic_names, every=every, output=output)
    table = BandwidthTable(names, window, node.context.time_base.system_ns)
    meter = Meter(node, output)
    if len(names) == 1:
        msg_type = await wait_for_type(node, names[0], output)
        meter.follow(msg_type, names[0], partial(table.arrive, names[0]), raw=True)
        output.text(f"Subscribed to [{names[0]}]")
        await meter.report(partial(print_bandwidth, output, table))
    elif names:
        await meter.report_table(table, table.arrive, raw=True)


class BandwidthTable:
    """The bandwidths of several topics.

    Args:
        names: The topics.
        window: The number of messages in the statistics.
        now_ns: Returns the time.
    """

    header = BW_HEADER

    def __init__(self, names: Sequence[str], window: int, now_ns: Callable[[], int]) -> None:
        self.names = list(names)
        self._now_ns = now_ns
        self._bandwidths = {name: Bandwidth(window) for name in names}
        self.shown: dict[str, Throughput | None] = dict.fromkeys(names)

    def arrive(self, name: str, data: bytes, info: MessageInfo) -> None:
        """Count a message."""
        self._bandwidths[name].arrive(info["received_timestamp"], len(data))

    def update(self) -> bool:
        """Compute the current bandwidths; return whether there are any."""
        now_ns = self._now_ns()
        self.shown = {name: each.rate(now_ns) for name, each in self._bandwidths.items()}
        return any(self.shown.values())

    def rows(self) -> list[tuple[str, ...]]:
        """Return a row for each topic, in the columns of `BW_HEADER`."""
        return [
            (name, *(SILENT if rate is None else bw_values(rate)))
            for name, rate in self.shown.items()
        ]

    def records(self) -> list[dict[str, Any]]:
        """Return the record of each topic; the bandwidth of a silent one is 0."""
        return [bw_record(name, rate) for name, rate in self.shown.items()]


def bw_values(rate: Throughput) -> tuple[str, ...]:
    """Return the bandwidth, the number of messages, and their sizes."""
    speed, *sizes = size_texts(rate.bytes_per_s, rate.mean, rate.low, rate.high)
    return f"{speed}/s", str(rate.count), *sizes


def bw_record(name: str, rate: Throughput | None) -> dict[str, Any]:
    """Return the record of one topic."""
    if rate is None:
        silent = dict.fromkeys(("mean_bytes", "min_bytes", "max_bytes"))
        return {"topic": name, "bytes_per_s": 0.0, **silent, "window": 0}
    return {
        "topic": name,
        "bytes_per_s": rate.bytes_per_s,
        "mean_bytes": rate.mean,
        "min_bytes": rate.low,
        "max_bytes": rate.high,
        "window": rate.count,
    }


def print_bandwidth(output: Output, table: BandwidthTable) -> None:
    """Print the bandwidth of the only topic, unless it is silent."""
    table.update()
    for name, rate in table.shown.items():
        if rate is not None:
            speed, count, mean, low, high = bw_values(rate)
            output.item(
                f"{speed} from {count} messages\n"
                f"\tMessage size mean: {mean} min: {low} max: {high}",
                bw_record(name, rate),
            )


# Age


@command(
    measuring,
    "delay",
    name_argument("topic"),
    window_option(10_000),
    interfaces=True,
    sim_time=True,
    endless=True,
    busy=True,
)
async def delay(node: Node, topic_name: str, *, output: Output, window: int = 10_000) -> None:
    """Print the age of messages on arrival, by the stamp in their header.

    Raises:
        CommandError: the type cannot be determined, or it has no header.
    """
    name = node.resolve_topic_name(topic_name)
    msg_type = await wait_for_type(node, name, output)
    if not has_header(msg_type):
        raise CommandError(
            f"Topic '{name}': {type_name(msg_type)} has no field header of std_msgs/msg/Header, "
            "so the age of its messages is unknown"
        )
    delays = Window(window)
    meter = Meter(node, output)

    def on_message(msg: Any, info: MessageInfo) -> None:
        # Not converted to `Time`, which rejects times before 1970 that a received stamp may have.
        stamp_ns = msg.header.stamp.sec * 1_000_000_000 + msg.header.stamp.nanosec
        delays.add(arrival_ns(node, info) - stamp_ns)

    meter.follow(msg_type, name, on_message, raw=False)

    def show() -> None:
        spread = delays.spread()
        if spread is None:
            return
        output.item(
            f"average delay: {spread.mean / 1e9:.3f}\n{spread_text(spread)}",
            {"topic": name, "delay_s": spread.mean / 1e9, **spread_record(spread)},
        )

    await meter.report(show)


def has_header(msg_type: Any) -> bool:
    """Return whether messages of a type have a header with a stamp."""
    return any(
        field.name == "header"
        and field.type.nested is not None
        and type_name(field.type.nested) == "std_msgs/msg/Header"
        for field in fields(msg_type)
    )


# Statistics: pure computation without I/O


@dataclass(frozen=True, slots=True)
class Spread:
    """Mean, extremes, population standard deviation and count of durations in nanoseconds."""

    mean: float
    low: int
    high: int
    deviation: float
    count: int

    @property
    def rate_hz(self) -> float:
        """The number of such durations per second; 0 if all of them are zero."""
        return 1e9 / self.mean if self.mean else 0.0


def spread_of(values: Sequence[int]) -> Spread:
    """Return the spread of at least one duration."""
    count = len(values)
    mean = sum(values) / count
    deviation = math.sqrt(sum((value - mean) ** 2 for value in values) / count)
    return Spread(mean, min(values), max(values), deviation, count)


class Window:
    """The newest durations, and whether any was added since the last `spread`."""

    def __init__(self, size: int) -> None:
        self._values: deque[int] = deque(maxlen=size)
        self._fresh = False

    def add(self, value_ns: int) -> None:
        """Add a duration; the oldest is dropped when the window is full."""
        self._values.append(value_ns)
        self._fresh = True

    def clear(self) -> bool:
        """Drop all durations; return whether there were any."""
        had = bool(self._values)
        self._values.clear()
        self._fresh = False
        return had

    def spread(self) -> Spread | None:
        """Return the spread, or None if nothing was added since the last call."""
        if not self._fresh:
            return None
        self._fresh = False
        return spread_of(list(self._values))


class Intervals(Window):
    """The time between one message and the next."""

    def __init__(self, size: int) -> None:
        super().__init__(size)
        self._last_ns: int | None = None

    def arrive(self, now_ns: int) -> bool:
        """Record a message; return whether time went backwards, which resets the window."""
        last_ns, self._last_ns = self._last_ns, now_ns
        if last_ns is None:
            return False
        if now_ns < last_ns:
            return self.clear()
        self.add(now_ns - last_ns)
        return False


@dataclass(frozen=True, slots=True)
class Throughput:
    """Bytes per second of the messages in a window, and their sizes in bytes."""

    bytes_per_s: float
    count: int
    mean: float
    low: int
    high: int


class Bandwidth:
    """Sizes and arrival times of the newest messages."""

    def __init__(self, size: int) -> None:
        self._messages: deque[tuple[int, int]] = deque(maxlen=size)

    def arrive(self, now_ns: int, size_bytes: int) -> None:
        """Record a message."""
        self._messages.append((now_ns, size_bytes))

    def rate(self, now_ns: int) -> Throughput | None:
        """Return the rate since the oldest message; None if there are fewer than two.

        The oldest message starts the measured period, so its own bytes do not count. The period
        ends with the newest message, or at `now_ns` once the next one is overdue.
        """
        if len(self._messages) < 2:
            return None
        sizes = [size for _, size in self._messages]
        first_ns, last_ns = self._messages[0][0], self._messages[-1][0]
        overdue_ns = now_ns - last_ns - (last_ns - first_ns) / (len(sizes) - 1)
        duration_s = (last_ns - first_ns + max(overdue_ns, 0)) / 1e9
        if duration_s <= 0:
            return None
        total = sum(sizes)
        speed = (total - sizes[0]) / duration_s
        return Throughput(speed, len(sizes), total / len(sizes), min(sizes), max(sizes))


def size_texts(bytes_per_s: float, *sizes: float) -> list[str]:
    """Return the rate and sizes as text, all in the unit that suits the rate."""
    if bytes_per_s < 1e3:
        return [f"{size:.0f} B" for size in (bytes_per_s, *sizes)]
    unit, divisor = ("KB", 1e3) if bytes_per_s < 1e6 else ("MB", 1e6)
    return [f"{size / divisor:.2f} {unit}" for size in (bytes_per_s, *sizes)]


def table_text(rows: Sequence[Sequence[str]]) -> str:
    """Return a table as text; the first row is the heading."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    head = "   ".join(word.center(width) for word, width in zip(rows[0], widths, strict=True))
    line = "=" * (sum(widths) + 3 * (len(widths) - 1))
    body = "\n".join(
        "   ".join(word.ljust(width) for word, width in zip(row, widths, strict=True))
        for row in rows[1:]
    )
    return f"{head}\n{line}\n{body}\n"
