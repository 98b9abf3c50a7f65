"""Compares two recordings: the first differences by topic, time and field."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping
from itertools import zip_longest
from os import PathLike
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode.bag._bag import Bag
from aionode.bag._bag import open as open_bag
from aionode.bag.replaying.outputs import Outputs
from aionode.errors import escaped
from aionode.message import to_builtins

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.bag.files.record import Record

__all__ = ["Difference", "Source", "compare"]

Source = Outputs | Bag | str | PathLike[str] | Iterable["Record"]
"""One side of a comparison: the outputs of a run, a bag or its path, or records."""

LIMIT: Final = 10
"""Default number of differences to list per topic."""

SHOWN: Final = 60
"""Maximum number of characters of a value to show."""


class Difference(msgspec.Struct, frozen=True):
    """One difference between two recordings.

    Attributes:
        topic: The topic.
        time_ns: When the message was published, in nanoseconds since 1970: in the first recording,
            or in the second if it is only there.
        field: The path of the field, such as ``linear.x`` or ``poses[3].position.y``; ``time`` or
        ``type`` for the whole message, and ``message`` if one recording does not have it.
        left: The value in the first recording.
        right: The value in the second recording.
        offset_ns: Time since the start of the recordings, in nanoseconds.
    """

    topic: str
    time_ns: int
    field: str
    left: Any
    right: Any
    offset_ns: int = 0

    def __str__(self) -> str:
        left, right = shown(self.left), shown(self.right)
        text = f"{self.topic} at {self.offset_ns / 1e9:.6f} s: {self.field}: {left} != {right}"
        return escaped(text, one_line=True)

    __repr__ = __str__


def compare(
    a: Source,
    b: Source,
    tolerance: float | Mapping[str, float] = 0.0,
    *,
    time_tolerance_sec: float = 0.0,
    limit: int = LIMIT,
) -> list[Difference]:
    """Return the first differences of two recordings in time order; empty if they are equal.

    The messages of each topic are compared one by one, in order.

    Args:
        a: The outputs of a run, a bag or its path, or records.
        b: What to compare it with.
        tolerance: Allowed difference of numbers: for all, by topic, or by topic and field, such as
            ``{"/cmd_vel": 1e-6, "/odom pose.pose.position.x": 0.01}``. NaN equals NaN.
        time_tolerance_sec: Allowed difference between the times of two messages, in seconds.
        limit: Maximum number of differences to list per topic.

    Raises:
        BagError: a bag cannot be read (a ValueError).
    """
    left, right = by_topic(a), by_topic(b)
    starts = [records[0].time_ns for records in (*left.values(), *right.values())]
    start_ns = min(starts, default=0)
    result: list[Difference] = []
    for topic in dict.fromkeys((*left, *right)):
        tolerances = Tolerances(topic, tolerance, round(time_tolerance_sec * 1e9))
        listed = differences(topic, left.get(topic, []), right.get(topic, []), tolerances, start_ns)
        result += [difference for difference, _ in zip(listed, range(limit), strict=False)]
    return sorted(result, key=lambda difference: difference.time_ns)


class Tolerances:
    """The allowed differences for the messages of one topic.

    Args:
        topic: The topic.
        tolerance: See `compare`.
        time_ns: Allowed difference of times, in nanoseconds.
    """

    def __init__(self, topic: str, tolerance: float | Mapping[str, float], time_ns: int) -> None:
        self.time_ns = time_ns
        self._topic = topic
        self._fields = tolerance if isinstance(tolerance, Mapping) else {}
        self._number = self._fields.get(topic, 0.0) if self._fields else tolerance

    def equal(self, field: str, left: Any, right: Any) -> bool:
        """Return whether two plain values are equal within the tolerance."""
        if left == right:
            return True
        numbers = (int, float)
        if not (isinstance(left, numbers) and isinstance(right, numbers)):
            return False
        if math.isnan(left) or math.isnan(right):
            return math.isnan(left) and math.isnan(right)
        allowed = self._fields.get(f"{self._topic} {field}", self._number)
        return abs(left - right) <= allowed  # type: ignore[operator]  # a number


def by_topic(source: Source) -> dict[str, list[Record]]:
    """Return the records of a recording, by topic."""
    if isinstance(source, str | PathLike):
        with open_bag(source) as bag:
            return by_topic(bag)
    records: Iterable[Record]
    if isinstance(source, Outputs):
        records = source.records
    elif isinstance(source, Bag):
        records = source.read()
    else:
        records = source
    topics: dict[str, list[Record]] = defaultdict(list)
    for record in records:
        topics[record.topic].append(record)
    return topics


def differences(
    topic: str,
    left: list[Record],
    right: list[Record],
    tolerances: Tolerances,
    start_ns: int,
) -> Iterator[Difference]:
    """Yield the differences between the messages of one topic."""
    for a, b in zip_longest(left, right):
        record = a or b
        pairs: Iterable[tuple[str, Any, Any]]
        if a is None or b is None:
            there = "a message"
            missing = f"none after {min(len(left), len(right))} messages"
            pairs = [("message", there if a else missing, there if b else missing)]
        else:
            pairs = unequal(a, b, tolerances)
        for field, x, y in pairs:
            yield Difference(topic, record.time_ns, field, x, y, record.time_ns - start_ns)


def unequal(a: Record, b: Record, tolerances: Tolerances) -> Iterator[tuple[str, Any, Any]]:
    """Yield the fields in which two messages differ, with their values."""
    if abs(a.time_ns - b.time_ns) > tolerances.time_ns:
        yield "time", a.time_ns, b.time_ns
    if a.type != b.type:
        yield "type", a.type, b.type
    elif a.raw != b.raw:
        for field, x, y in leaves(to_builtins(a.message), to_builtins(b.message), ""):
            if not tolerances.equal(field, x, y):
                yield field, x, y


def leaves(a: Any, b: Any, path: str) -> Iterator[tuple[str, Any, Any]]:
    """Yield the path and both values of each field of two messages in plain form."""
    if isinstance(a, dict) and isinstance(b, dict):
        for name in a:
            yield from leaves(a[name], b.get(name), f"{path}.{name}" if path else name)
    elif isinstance(a, list) and isinstance(b, list):
        if len(a) != len(b):
            yield f"len({path})", str(len(a)), str(len(b))  # strings, so that no tolerance applies
        for index, (x, y) in enumerate(zip(a, b, strict=False)):
            yield from leaves(x, y, f"{path}[{index}]")
    else:
        yield path, a, b


def shown(value: Any) -> str:
    """Return a value for a report, shortened to fit a line."""
    text = value if isinstance(value, str) else repr(value)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}…"
