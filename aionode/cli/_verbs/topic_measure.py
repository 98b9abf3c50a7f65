"""``aionode topic hz``, ``bw`` and ``delay``.

Messages are timed on arrival, not when they are processed, and decoded only if their content is
needed, so the results hold at rates too high for printing. Messages of the first moments are not
counted: connecting delays them.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from aionode.cli._support.follow import Follower, filter_from, wait_for_type
from aionode.cli._support.statistics import (
    Bandwidth,
    Intervals,
    Spread,
    Window,
    size_texts,
    table_text,
)
from aionode.errors import CommandError
from aionode.message import fields, type_name
from aionode.qos import qos_profile_sensor_data

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.cli._support.output import Output
    from aionode.endpoints.subscription import MessageInfo, Subscription
    from aionode.message import Message
    from aionode.node import Node

__all__ = ["bw", "delay", "hz"]

DEPTH = 10_000
"""Queue depth: one second of the fastest topics."""

PRINT_PERIOD_S = 1.0

CONNECTING_S = 0.3
"""How long messages may reach a new subscription late and in bursts, in seconds.

During this time publishers of other processes are discovered and switch to a link, which normally
takes 0.1 s.
"""

QOS = qos_profile_sensor_data.replace(depth=DEPTH)

HZ_HEADER = ("topic", "rate", "min_delta", "max_delta", "std_dev", "window")


# Rate


async def hz(
    node: Node,
    topic_names: Sequence[str],
    *,
    output: Output,
    window: int = 10_000,
    filter_text: str | None = None,
    wall_time: bool = False,
) -> None:
    """Print the rate of messages, once a second, until cancelled.

    Raises:
        CommandError: the type of a topic cannot be determined, or the filter is invalid.
    """
    fits = filter_from(filter_text)
    names = [node.resolve_topic_name(name) for name in topic_names]
    intervals = {name: Intervals(window) for name in names}
    follower = Follower(node)

    def on_message(name: str, msg: Any, info: MessageInfo) -> None:
        if filter_text is not None and not fits(msg):
            return
        if intervals[name].arrive(arrival_ns(node, info, wall_time=wall_time)):
            output.text("time has reset, resetting counters")

    subscriptions = []
    for name in names:
        msg_type = await wait_for_type(node, name, output)
        if len(names) > 1:
            output.text(f"Subscribed to [{name}]")
        subscriptions.append(
            follow_connected(
                node, follower, msg_type, name, partial(on_message, name), raw=filter_text is None
            )
        )
    dropped = Dropped(subscriptions, output)
    shown: dict[str, Spread] = {}

    def report(show: Callable[[dict[str, Spread]], None]) -> None:
        dropped.warn()
        new = {name: spread for name in names if (spread := intervals[name].spread())}
        shown.update(new)
        if new:
            show(shown)

    if len(names) > 1 and output.is_terminal:
        with output.live() as update:
            await every_second(node, follower, partial(report, lambda s: update(hz_table(s))))
    else:
        show = partial(print_rate if len(names) == 1 else print_rates, output)
        await every_second(node, follower, partial(report, show))


def follow_connected(
    node: Node,
    follower: Follower,
    msg_type: type[Message],
    name: str,
    on_message: Callable[[Any, MessageInfo], None],
    *,
    raw: bool,
) -> Subscription[Any]:
    """Call `on_message` with each message that arrives after publishers have been connected."""
    others = len(node.context.transports) > 1  # beyond this process
    begins_ns = node.context.time_base.system_ns() + int(CONNECTING_S * 1e9) * others

    def when_connected(msg: Any, info: MessageInfo) -> None:
        if info["received_timestamp"] >= begins_ns:
            on_message(msg, info)

    return follower.follow(msg_type, name, when_connected, QOS, raw=raw)


def arrival_ns(node: Node, info: MessageInfo, *, wall_time: bool = True) -> int:
    """Return when a message arrived, in ROS time if that is simulated."""
    clock = node.get_clock()
    if not wall_time and getattr(clock, "ros_time_is_active", False):
        return clock.now().nanoseconds
    return info["received_timestamp"]


class Dropped:
    """Warns when messages arrived faster than they could be counted."""

    def __init__(self, subscriptions: list[Subscription[Any]], output: Output) -> None:
        self._subscriptions = subscriptions
        self._output = output
        self._reported = 0

    def warn(self) -> None:
        """Warn if more messages have been dropped since the last warning."""
        dropped = sum(subscription.stats.dropped for subscription in self._subscriptions)
        if dropped > self._reported:
            self._output.warn(
                f"{dropped} messages arrived too fast to be counted: the real rates are higher"
            )
            self._reported = dropped


async def every_second(node: Node, follower: Follower, show: Callable[[], None]) -> None:
    """Call `show` once a second until the follower fails."""
    node.create_timer(PRINT_PERIOD_S, show, on_error=follower.fail)
    await follower.finished()


def hz_values(spread: Spread) -> tuple[str, str, str, str, str]:
    """Return the rate in Hz, extremes and deviation in seconds, and the number of intervals."""
    return (
        f"{spread.rate_hz:.3f}",
        f"{spread.low / 1e9:.3f}",
        f"{spread.high / 1e9:.3f}",
        f"{spread.deviation / 1e9:.5f}",
        str(spread.count),
    )


def hz_record(name: str, spread: Spread) -> dict[str, Any]:
    """Return the record of one topic."""
    return {
        "topic": name,
        "rate_hz": spread.rate_hz,
        "min_s": spread.low / 1e9,
        "max_s": spread.high / 1e9,
        "std_dev_s": spread.deviation / 1e9,
        "window": spread.count,
    }


def print_rate(output: Output, shown: dict[str, Spread]) -> None:
    """Print the statistics of the only topic."""
    ((name, spread),) = shown.items()
    rate, low, high, deviation, count = hz_values(spread)
    output.item(
        f"average rate: {rate}\n\tmin: {low}s max: {high}s std dev: {deviation}s window: {count}",
        hz_record(name, spread),
    )


def print_rates(output: Output, shown: dict[str, Spread]) -> None:
    """Print the statistics of several topics."""
    output.text(table_text(HZ_HEADER, [(n, *hz_values(s)) for n, s in shown.items()]))
    if output.json:
        for name, spread in shown.items():
            output.item("", hz_record(name, spread))


def hz_table(shown: dict[str, Spread]) -> Any:
    """Return the statistics as a rich table."""
    from rich.table import Table

    table = Table(*HZ_HEADER)
    for name, spread in shown.items():
        table.add_row(name, *hz_values(spread))
    return table


# Bandwidth


async def bw(node: Node, topic_name: str, *, output: Output, window: int = 100) -> None:
    """Print the bandwidth of a topic, once a second, until cancelled.

    Raises:
        CommandError: the type of the topic cannot be determined.
    """
    name = node.resolve_topic_name(topic_name)
    msg_type = await wait_for_type(node, name, output)
    bandwidth = Bandwidth(window)
    follower = Follower(node)

    def on_message(data: bytes, info: MessageInfo) -> None:
        bandwidth.arrive(info["received_timestamp"], len(data))

    subscription = follow_connected(node, follower, msg_type, name, on_message, raw=True)
    dropped = Dropped([subscription], output)
    output.text(f"Subscribed to [{name}]")

    def show() -> None:
        dropped.warn()
        rate = bandwidth.rate(node.context.time_base.system_ns())
        if rate is None:
            return
        speed, mean, low, high = size_texts(rate.bytes_per_s, rate.mean, rate.low, rate.high)
        output.item(
            f"{speed}/s from {rate.count} messages\n"
            f"\tMessage size mean: {mean} min: {low} max: {high}",
            {
                "topic": name,
                "bytes_per_s": rate.bytes_per_s,
                "mean_bytes": rate.mean,
                "min_bytes": rate.low,
                "max_bytes": rate.high,
                "window": rate.count,
            },
        )

    await every_second(node, follower, show)


# Age


async def delay(node: Node, topic_name: str, *, output: Output, window: int = 10_000) -> None:
    """Print the age of messages by the stamp in their header, once a second, until cancelled.

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
    follower = Follower(node)

    def on_message(msg: Any, info: MessageInfo) -> None:
        # Not converted to `Time`, which rejects times before 1970; a received stamp may be one.
        stamp_ns = msg.header.stamp.sec * 1_000_000_000 + msg.header.stamp.nanosec
        delays.add(arrival_ns(node, info, wall_time=False) - stamp_ns)

    follow_connected(node, follower, msg_type, name, on_message, raw=False)

    def show() -> None:
        spread = delays.spread()
        if spread is None:
            return
        output.item(
            f"average delay: {spread.mean / 1e9:.3f}\n"
            f"\tmin: {spread.low / 1e9:.3f}s max: {spread.high / 1e9:.3f}s "
            f"std dev: {spread.deviation / 1e9:.5f}s window: {spread.count}",
            {
                "topic": name,
                "delay_s": spread.mean / 1e9,
                "min_s": spread.low / 1e9,
                "max_s": spread.high / 1e9,
                "std_dev_s": spread.deviation / 1e9,
                "window": spread.count,
            },
        )

    await every_second(node, follower, show)


def has_header(msg_type: Any) -> bool:
    """Return whether messages of a type have a stamped header."""
    return any(
        field.name == "header"
        and field.type.nested is not None
        and type_name(field.type.nested) == "std_msgs/msg/Header"
        for field in fields(msg_type)
    )
