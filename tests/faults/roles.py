"""The protocol between the harness and the processes of a fault case: roles, words and reports.

The harness passes a `Role` to a process as its argument. Ten times a second, and at its end, the
process writes a `Report` as one line of JSON to the descriptor in the variable `REPORTS_VARIABLE`.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

import msgspec

from tests.faults.motion.words import Handed, Mover, Wheel

__all__ = [
    "REPORTS_VARIABLE",
    "Hear",
    "Output",
    "Publish",
    "Report",
    "Role",
    "Word",
    "hear_mark",
    "missing",
    "note",
    "stream_key",
]

REPORTS_VARIABLE = "AIONODE_FAULTS_REPORTS"

Output = Literal["file", "full", "unread", "terminal"]

Word = Literal["pause", "go on", "quiet", "join", "near"]
"""A command to a process, as a line on its stdin: pause publishing; resume it; stop publishing,
calling and sending goals; let its wheels join; or move the target close to its wheels."""


class Publish(msgspec.Struct, frozen=True):
    """A publisher of messages numbered from 1, each with the time at which it was sent.

    Attributes:
        topic: Its topic.
        keep_all: Whether it waits for slow readers; otherwise it keeps the last `depth` messages.
        depth: How many messages it keeps.
        transient: Whether it keeps its messages for late readers.
        period_s: Time between two messages; 0 for as fast as possible.
        size: Bytes that are added to each message.
        readers: How many readers it waits for before the first message.
        count: How many messages it sends; 0 for no limit. After the last one the process ends.
    """

    topic: str
    keep_all: bool = False
    depth: int = 10
    transient: bool = False
    period_s: float = 0.02
    size: int = 0
    readers: int = 1
    count: int = 0


class Hear(msgspec.Struct, frozen=True):
    """A subscription.

    Attributes:
        topic: Its topic.
        keep_all: Whether its publishers wait for it.
        depth: How many messages may wait for its callback.
        transient: Whether it requests the messages that its publishers have kept.
        slow_s: How long the callback awaits for each message.
        block_s: How long the callback blocks the loop for each message.
        pause_s: How long the callback awaits once, at message number 50, without blocking the loop.
    """

    topic: str
    keep_all: bool = False
    depth: int = 10
    transient: bool = False
    slow_s: float = 0.0
    block_s: float = 0.0
    pause_s: float = 0.0


class Role(msgspec.Struct, frozen=True):
    """One process: a node that does everything listed here.

    Attributes:
        name: The name of the node, and of the process within its case.
        publish: Its publishers.
        hear: Its subscriptions.
        serve: The service that it serves.
        call: The service that it calls repeatedly, with a time limit of 1 s.
        callers: The number of concurrent calls.
        size: Bytes of each request and of each response.
        act: The action that it serves.
        send: The action to which it sends goals, one after the other.
        router: The endpoint on which it listens as a router, without a node.
        connect: The endpoint of another router with which that router is linked.
        ros: Whether it is a stand-in for a ROS 2 node: a Zenoh session with the settings of
            rmw_zenoh, including the lease of 60 s. It can only publish and subscribe.
        noisy: Whether it writes to stdout and stderr endlessly.
        fork: Whether it creates a node in a forked child.
        parameter_size: Length of the parameter ``large`` that its parameter services offer; 0 for a
            node without these services.
        curious: Whether it looks up unknown types, and creates messages of them.
        gateway: Whether it also has a gateway, which allows programs of this host, and clients with
            the tokens viewer, operator and admin, everything except seeing the parameter ``large``.
        control: Whether it has no node, and only watches its event loop.
        mover: What it moves, in a program of its own.
        wheels: Its wheels.
        joins: Whether these wheels obey nothing until the harness has them join.
        moves: The wheels that it moves as long as it runs.
        rclpy: Whether it is a plain rclpy program, on aionode's rclpy or on that of `python`.
        python: The interpreter that runs it; empty for that of the harness.
        command: The arguments of the interpreter, instead of a program of these tests.
        env: Its environment variables.
        wrapper: A command that runs it, such as ``ip netns exec NAME``.
        output: Where its stdout and stderr go: to a ``file``, to ``/dev/full``, into a pipe that is
            never read, or to a ``terminal``, which is also its controlling terminal.
    """

    name: str
    publish: tuple[Publish, ...] = ()
    hear: tuple[Hear, ...] = ()
    serve: str = ""
    call: str = ""
    callers: int = 1
    size: int = 10
    act: str = ""
    send: str = ""
    router: str = ""
    connect: str = ""
    ros: bool = False
    noisy: bool = False
    fork: bool = False
    parameter_size: int = 0
    curious: bool = False
    gateway: bool = False
    control: bool = False
    mover: Mover | None = None
    wheels: tuple[Wheel, ...] = ()
    joins: bool = False
    moves: tuple[Wheel, ...] = ()
    rclpy: bool = False
    python: str = ""
    command: tuple[str, ...] = ()
    env: dict[str, str] = {}
    wrapper: tuple[str, ...] = ()
    output: Output = "file"


class Report(msgspec.Struct):
    """What a process has seen so far.

    Attributes:
        time_s: The time, by `time.monotonic`, which all processes of a host share.
        ready: Whether its node runs.
        gap_s: The longest stall of its event loop since the last report.
        own_gap_s: The same, without the time for which its threads waited for a core.
        marks: For each thing that works, the start of its last success: see `hear_mark`; ``call``
            and ``goal`` for an answer and a result.
        nodes: The nodes that it sees, including its own; routers and stand-ins report none.
        sent: The number of published messages, by `stream_key`.
        heard: The numbers of received messages, by `stream_key`: first and last of each range.
        doubled: How many messages it has received twice.
        told: How many messages its publishers and subscriptions count as lost or dropped.
        calls: How many calls and goals it has started.
        failed: How many of them ended with an error.
        hung: How many of them exceeded their time limit.
        handed: What its wheels received since the last report.
        last: Whether this is the last report.
    """

    time_s: float = 0.0
    ready: bool = False
    gap_s: float = 0.0
    own_gap_s: float = 0.0
    marks: dict[str, float] = {}
    nodes: list[str] = []
    sent: dict[str, int] = {}
    heard: dict[str, list[tuple[int, int]]] = {}
    doubled: int = 0
    told: int = 0
    calls: int = 0
    failed: int = 0
    hung: int = 0
    handed: list[Handed] = []
    last: bool = False


def hear_mark(topic: str, sender: str) -> str:
    """Return the mark for receiving the messages of one process on a topic."""
    return f"hear {topic} {sender}"


def stream_key(topic: str, sender: str, pid: int | Literal[""] = "") -> str:
    """Return the key that distinguishes a publisher's messages from those of its successor.

    Without the process id, it is the prefix of all these keys.
    """
    return f"{topic} {sender} {pid}"


def note(ranges: list[tuple[int, int]], number: int) -> bool:
    """Add a number to ranges; return whether it is new."""
    if ranges and ranges[-1][0] <= number <= ranges[-1][1]:
        return False
    if ranges and number == ranges[-1][1] + 1:
        ranges[-1] = (ranges[-1][0], number)
        return True
    if any(first <= number <= last for first, last in ranges):
        return False
    ranges.append((number, number))
    ranges.sort()
    return True


def missing(ranges: Iterable[tuple[int, int]], last: int) -> int:
    """Return how many numbers are missing from the first one in the ranges up to `last`."""
    known = list(ranges)
    if not known:
        return 0
    first = min(begin for begin, _ in known)
    have = sum(end - begin + 1 for begin, end in known)
    return max(last, *(end for _, end in known)) - first + 1 - have
