"""What a process of a fault case does, and what it reports: the words between both sides.

The harness hands a `Role` to a process as its argument; the process writes a `Report` as one line
of JSON ten times a second, and a last one at its end, to the descriptor that the variable
`REPORTS_VARIABLE` names.
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
"""What a process is told in a line on its stdin: to publish nothing until it is to go on, to
publish, call and send goals no more, to have its wheels join, or that the target of its wheels is
near."""


class Publish(msgspec.Struct, frozen=True):
    """Messages that count from 1, each with the time at which it was sent.

    Attributes:
        topic: Where.
        keep_all: Whether the publisher waits for slow readers, or keeps the last `depth`.
        depth: How many it keeps.
        transient: Whether it keeps what it has published for late readers.
        period_s: Time between two messages; 0 for as fast as can be.
        size: Bytes that are added to each message.
        readers: For how many it waits before the first one.
        count: How many are sent; 0 for until the end. After the last one the process ends at once.
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
        topic: Where.
        keep_all: Whether its publishers wait for it.
        depth: How many messages may wait for its callback.
        transient: Whether it asks for what its publishers have kept.
        slow_s: How long the callback awaits for each message.
        block_s: How long it keeps the loop busy for each message.
        pause_s: How long it awaits once, at message number 50, with its loop free.
    """

    topic: str
    keep_all: bool = False
    depth: int = 10
    transient: bool = False
    slow_s: float = 0.0
    block_s: float = 0.0
    pause_s: float = 0.0


class Role(msgspec.Struct, frozen=True):
    """One process: a node that does all of what is named here.

    Attributes:
        name: Of the node, and of the process within its case.
        publish: What it publishes.
        hear: What it hears.
        serve: The service that it serves.
        call: The service that it calls, again and again, with a time limit of 1 s.
        callers: How many such calls are under way at once.
        size: Bytes of each request and of each response.
        act: The action that it serves.
        send: The action to which it sends goals, one after the other.
        router: The endpoint on which it listens as a router; it has no node then.
        connect: The endpoint of another router, with which it is linked then.
        ros: Whether it is a stand-in for a ROS 2 node: a Zenoh session with the settings of
            rmw_zenoh, the lease of 60 s included. It can only publish and hear.
        noisy: Whether it writes to stdout and stderr without end.
        fork: Whether it makes a node in a forked child of its own.
        parameter_size: Characters of the parameter ``large`` that its services of parameters offer;
            0 for a node without such services.
        curious: Whether it looks up types that it does not know, and makes messages of them.
        gateway: Whether it has a gateway besides, where everything is allowed on this host, and to
            a viewer, an operator and an admin with tokens, but to see the parameter ``large``.
        control: Whether it has no node, and does nothing but watch its event loop.
        mover: What it asks to move, in a program of its own.
        wheels: The wheels that it has.
        joins: Whether these wheels obey nothing before it is told to have them join.
        moves: The wheels that it moves, as long as it runs.
        rclpy: Whether it is a program of plain rclpy: of aionode's, or of what `python` has.
        python: The interpreter that runs it; empty for that of the harness.
        command: What runs instead of a program of these tests, after the interpreter.
        env: Variables of its environment.
        wrapper: A command that runs it, such as ``ip netns exec NAME``.
        output: Where its stdout and stderr go: to a ``file``, to ``/dev/full``, into a pipe that is
            never read, or to a ``terminal``, which is also the one that controls it.
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
        time_s: When, by `time.monotonic`, which all processes of a host have in common.
        ready: Whether its node runs.
        gap_s: The longest time for which its event loop did not turn, since the last report.
        own_gap_s: The same without the time for which its threads waited for a core of the machine.
        marks: For each thing that works, the start of the last time that it did: see `hear_mark`;
            ``call`` and ``goal`` for an answer and a result.
        nodes: The nodes that it sees, its own included; a router and a stand-in tell none.
        sent: How many messages it has published, by `stream_key`.
        heard: The numbers that it has heard, by `stream_key`: first and last of each range.
        doubled: How many messages it has heard twice.
        told: How many messages its publishers and subscriptions count as lost or dropped.
        calls: How many calls and goals it has begun.
        failed: How many of them ended with an error.
        hung: How many of them took longer than their time limit allows.
        handed: What its wheels were handed since the last report.
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
    """Return the mark for hearing one process on a topic."""
    return f"hear {topic} {sender}"


def stream_key(topic: str, sender: str, pid: int | Literal[""] = "") -> str:
    """Return what tells the messages of one publisher from those of its successor.

    Without the process id it is what all of them begin with.
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
    """Return how many numbers are missing from the first that is there up to `last`."""
    known = list(ranges)
    if not known:
        return 0
    first = min(begin for begin, _ in known)
    have = sum(end - begin + 1 for begin, end in known)
    return max(last, *(end for _, end in known)) - first + 1 - have
