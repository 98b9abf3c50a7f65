"""Compares a running robot with a contract: its topics, their rates, and their ages at an image."""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from aionode.bag import Record, TopicInfo
from aionode.bag.recording.recorder import adapted_qos
from aionode.clock import S_TO_NS
from aionode.graph import EndpointKind
from aionode.learn._alignment import aligned
from aionode.learn._report import lags, topic_of, topic_text, trouble_of
from aionode.learn._scan import Collected
from aionode.node import direct_subscription

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo
    from aionode.learn._series import Series
    from aionode.learn.contract import Action, Contract, Observation
    from aionode.node import Node

__all__ = ["Checked", "check"]

SILENT_NS: Final = 500_000_000
"""How long an observed topic may be silent, beyond its `max_age`."""

FLOOD_HZ: Final = 2000.0
"""The rate from which a topic counts as a flood, if it also has `FLOOD_ROWS` messages per row."""

FLOOD_ROWS: Final = 10
"""Messages per row from which a topic may count as a flood."""


@dataclass(frozen=True, slots=True)
class Checked:
    """The findings of a check of a robot.

    Attributes:
        topics: The numbers of each topic of the contract.
        text: The topics and lags that were found, as text.
        problems: What does not match, with what to do.
    """

    topics: list[dict[str, Any]]
    text: str
    problems: list[str]


async def check(node: Node, contract: Contract, duration_sec: float = 3.0) -> Checked:
    """Listen to a running robot, and report what does not match a contract.

    Args:
        node: A running node that already knows the graph.
        contract: The contract.
        duration_sec: How long to listen.
    """
    collected = [Collected(entry) for entry in contract.entries]
    by_topic: dict[str, list[Collected]] = {}
    for each in collected:
        by_topic.setdefault(node.resolve_topic_name(each.entry.topic), []).append(each)
    publishers = {name: endpoints_of(node, name, EndpointKind.PUBLISHER) for name in by_topic}
    subscriptions = [
        direct_subscription(
            node,
            each[0].entry.message_type,
            name,
            partial(take, node, each, TopicInfo(name=name, type=each[0].entry.type)),
            adapted_qos([endpoint.qos for endpoint in publishers[name]]),
        )
        for name, each in by_topic.items()
    ]
    try:
        await node.get_clock().sleep(duration_sec)
        end_ns = node.get_clock().now_ns()
    finally:
        for subscription in subscriptions:
            subscription.destroy()
    series = [each.series() for each in collected]
    rows = aligned(contract, heard_together(contract, series))
    topics = [
        topic_of(contract, entry, each, rows, position)
        for position, (entry, each) in enumerate(zip(contract.entries, series, strict=True))
    ]
    floods = [
        f"{node.resolve_topic_name(each['topic'])}: {each['messages']} messages in "
        f"{duration_sec:g} s, published faster than they are read, which makes others late or "
        "lost; lower its rate"
        for each in topics
        if each["rate_hz"] > FLOOD_HZ
        and each["messages"] > FLOOD_ROWS * contract.fps * duration_sec
    ]
    lines, problems = [], []
    for entry, topic in zip(contract.entries, topics, strict=True):
        name = node.resolve_topic_name(entry.topic)
        lines.append(f"{topic_text(topic, len(rows.times))}{qos_text(publishers[name])}")
        problems += problems_of(node, contract, entry, topic, publishers[name]) or trouble_of(
            contract, entry, topic, rows.references
        )
    problems += dict.fromkeys(
        line for each in collected for line in silence_of(node, contract, each, end_ns)
    )
    is_idle = any(
        entry in contract.actions and not topic["messages"]
        for entry, topic in zip(contract.entries, topics, strict=True)
    )
    if not problems and not len(rows.times) and not is_idle:
        problems.append("at no image was everything fresh enough; see the ages above")
    if problems:
        problems = floods + problems  # floods may have caused the others
    followed = lags(contract, rows) if rows.starts else {}
    lines += [
        f"{name}: observed {lag * 1e3:.0f} ms after its command" for name, lag in followed.items()
    ]
    return Checked(topics, "\n".join(lines), problems)


def heard_together(contract: Contract, series: list[Series]) -> list[Series]:
    """Return the messages, with only those references at which every topic had been heard.

    At both ends of the period, messages that arrive late would otherwise seem to be missing.
    """
    heard = [each.times for each in series if len(each.times)]
    if not heard:
        return series
    first, last = max(each[0] for each in heard), min(each[-1] for each in heard)
    position = contract.entries.index(contract.main)
    times = series[position].times
    found = list(series)
    found[position] = series[position].only((first <= times) & (times <= last))
    return found


def take(
    node: Node,
    collected: list[Collected],
    info: TopicInfo,
    raw: Any,
    sequence: int,
    source_ns: int,
    received_ns: int,
) -> None:
    """Take a message from a subscription."""
    clock = node.get_clock()
    if clock.ros_time_is_active:  # simulated, as are the stamps
        received_ns = clock.now_ns()
    joined = b"".join(raw) if isinstance(raw, list) else bytes(raw)
    record = Record(info, received_ns, source_ns, sequence, joined)
    for each in collected:
        each.take(record)


def silence_of(node: Node, contract: Contract, collected: Collected, end_ns: int) -> list[str]:
    """Return whether an observed topic fell silent before the end, with what to do."""
    entry = collected.entry
    if entry in contract.actions or not collected.times or len(collected.times) < collected.count:
        return []  # mismatches have been reported already
    silent_ns = end_ns - collected.arrivals[-1]
    if silent_ns <= contract.max_age(entry) * S_TO_NS + SILENT_NS:
        return []
    name = node.resolve_topic_name(entry.topic)
    return [f"{name}: silent for the last {silent_ns / S_TO_NS:.1f} s; is its driver running?"]


def endpoints_of(node: Node, name: str, kind: EndpointKind) -> list[EndpointInfo]:
    """Return the endpoints of a topic."""
    return [each for each in node.graph.endpoints(kind) if each.name == name]


def qos_text(publishers: list[EndpointInfo]) -> str:
    """Return the reliability and durability that publishers offer."""
    offered = sorted({
        f"{each.qos.reliability.name.lower()}, {each.qos.durability.name.lower()}"
        for each in publishers
    })  # fmt: skip
    return f"; {' or '.join(offered).replace('_', ' ')}" if offered else ""


def problems_of(
    node: Node,
    contract: Contract,
    entry: Observation | Action,
    topic: dict[str, Any],
    publishers: list[EndpointInfo],
) -> list[str]:
    """Return what does not match about a topic, with what to do."""
    name = node.resolve_topic_name(entry.topic)
    others = {each.type_name for each in publishers} - {entry.type}
    is_silent = not topic["messages"] and not topic["invalid"]
    if others:
        return [f"{name}: it is {', '.join(sorted(others))}, but {entry.type} in the contract"]
    if entry in contract.actions and is_silent:
        robot = endpoints_of(node, name, EndpointKind.SUBSCRIPTION)
        types = {each.type_name for each in robot}
        if types and entry.type not in types:
            return [f"{name}: the robot expects {', '.join(sorted(types))}, not {entry.type}"]
        if types or publishers:
            return []  # nobody is demonstrating at the moment
    if not publishers:
        known = {each.name for each in node.graph.endpoints(EndpointKind.PUBLISHER)}
        near = difflib.get_close_matches(name, sorted(known), 1)
        remedy = f"did you mean {near[0]}?" if near else "start its driver"
        return [f"{name}: nobody publishes it; {remedy}"]
    if is_silent:
        return [f"{name}: published, but nothing arrived; is its driver running?"]
    return []
