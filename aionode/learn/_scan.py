"""Reads what a contract needs from a bag: all numbers, but only the times of images."""

from __future__ import annotations

import difflib
import struct
from array import array
from typing import TYPE_CHECKING, Final

import numpy as np

from aionode.bag.files.record import MAX_NS
from aionode.errors import BagError, DecodeError, InterfaceNotFoundError, MessageError
from aionode.learn._field_paths import check_path
from aionode.learn._series import Series, in_order

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from aionode.bag import Bag, Record, TopicInfo
    from aionode.learn.contract import Action, Contract, Observation

__all__ = ["UNREADABLE", "Collected", "full_name", "records_of", "scanned"]

UNREADABLE: Final = (DecodeError, InterfaceNotFoundError, MessageError)
"""The exceptions that are raised by reading a message that does not match the contract."""

STAMPS: Final = (struct.Struct(">iI"), struct.Struct("<iI"))
"""The format of the time at the start of a message, by the lowest bit of its second byte."""

STAMP_PATHS: Final = ("header.stamp.sec", "header.stamp.nanosec")
"""The paths of the numbers that make up the time in a header."""

FIRST_FIELD: Final = 4
"""The offset of the first field in the bytes of a message."""


class Collected:
    """The messages of one entry, while they are read.

    They are kept in arrays, which take a tenth of the memory of lists: an hour has a million.

    Attributes:
        entry: The entry of the contract.
        is_image: Whether its messages are images.
        is_captured: Whether their times are those in their headers.
        info: The topic of the last message that the entry could read, as in the bag.
        times: Their times in nanoseconds, by header or arrival.
        arrivals: When they arrived.
        ordinals: Their positions among all messages of their topic.
        values: The numbers of one message after the other; empty for images.
        unstamped: Which of them have no time in their header.
        count: How many messages there were, including those that were left out.
        invalid: How many could not be read.
        problem: What was wrong with the first of these.
    """

    def __init__(self, entry: Observation | Action) -> None:
        self.entry = entry
        self.is_image = bool(getattr(entry, "image", None))
        self.is_captured = entry.is_captured
        self.info: TopicInfo | None = None
        self.times = array("q")
        self.arrivals = array("q")
        self.ordinals = array("q")
        self.values = array("f")
        self.unstamped = array("q")
        self.count = 0
        self.invalid = 0
        self.problem = ""

    def take(self, record: Record) -> None:
        """Take a message of the topic."""
        ordinal, self.count = self.count, self.count + 1
        try:
            if record.info is not self.info:
                check_type(record.info, self.entry)
                self.info = record.info
            stamp = self.stamp_of(record) if self.is_captured else 0
            if not self.is_image:
                self.values.frombytes(self.entry.value(record.message).tobytes())
            elif not self.times:
                self.entry.value(record.message)  # raises if it does not match the contract
        except UNREADABLE as error:
            self.invalid += 1
            self.problem = self.problem or str(error)
            return
        arrival = min(record.time_ns, MAX_NS)
        if self.is_captured and not stamp:
            self.unstamped.append(len(self.times))
        self.times.append(stamp or arrival)
        self.arrivals.append(arrival)
        self.ordinals.append(ordinal)

    def stamp_of(self, record: Record) -> int:
        """Return the time in a header, or 0; for an image, without decoding the rest."""
        if not self.is_image:
            return self.entry.time_of(record.message, 0)
        if len(record.raw) < FIRST_FIELD + 8:
            raise MessageError(self.entry.type, f"only {len(record.raw)} bytes")
        sec, nanosec = STAMPS[record.raw[1] & 1].unpack_from(record.raw, FIRST_FIELD)
        return int(sec) * 1_000_000_000 + int(nanosec)

    def series(self) -> Series:
        """Return the messages taken, in the order of their times.

        A message without a time in its header is left out, unless no message of the topic has one:
        then the times of arrival are used.
        """
        columns = 0 if self.is_image else self.entry.shape[0]
        found = Series(
            np.array(self.times, np.int64),
            np.array(self.arrivals, np.int64),
            np.array(self.values, np.float64).reshape(len(self.times), columns),
            np.array(self.ordinals, np.int64),
            is_captured=self.is_captured and len(self.unstamped) < len(self.times),
            unstamped=len(self.unstamped),
            invalid=self.invalid,
            problem=self.problem,
        )
        if found.is_captured and found.unstamped:
            is_stamped = np.ones(len(self.times), np.bool_)
            is_stamped[self.unstamped] = False
            found = found.only(is_stamped)
        return in_order(found)


def check_type(info: TopicInfo, entry: Observation | Action) -> None:
    """Raise an error if an entry cannot read a topic; a bag may have several of the same name.

    Raises:
        InterfaceNotFoundError: neither aionode nor the bag has a definition of its type.
        MessageError: it is of another type, or its definition lacks a field (a ValueError).
    """
    if info.type != entry.type:
        raise MessageError(entry.type, f"it is {info.type} in the bag")
    cls = info.msg_type
    if cls is entry.message_type:
        return
    problem = "images with a different definition cannot be read"
    try:
        if not getattr(entry, "image", None):
            for path in (*entry.paths, *STAMP_PATHS * entry.is_captured):
                problem = path
                check_path(cls, path)
            return
    except ValueError as error:
        problem = f"{problem}: {error}"
    raise MessageError(entry.type, f"its definition in the bag is different: {problem}")


def scanned(
    opened: Bag, contract: Contract, tell: Callable[[int], None]
) -> tuple[list[Series], list[str]]:
    """Return the messages of each entry of a contract, and which parts of the bag were unreadable.

    Args:
        opened: The bag.
        contract: The contract.
        tell: Called with the number of messages read so far, to show progress.
    """
    collected = [Collected(entry) for entry in contract.entries]
    by_topic: dict[str, list[Collected]] = {}
    for each in collected:
        by_topic.setdefault(full_name(each.entry.topic), []).append(each)
    problems = [absence_of(opened, name) for name in by_topic if not opened.counts.get(name)]
    for record in records_of(opened, by_topic.keys() & opened.topics.keys(), problems):
        tell(1)
        for each in by_topic[record.topic]:
            each.take(record)
    return [each.series() for each in collected], problems


def absence_of(opened: Bag, name: str) -> str:
    """Return the text for a topic missing from a bag, with a topic of a similar name if any."""
    there = sorted(each for each, count in opened.counts.items() if count)
    near = difflib.get_close_matches(name, there, 1)
    remedy = f"did you mean {near[0]}?" if near else "was its driver running?"
    return f"{name}: no messages in the bag; {remedy}"


def full_name(topic: str) -> str:
    """Return the name of a contract's topic in a bag, assuming a robot without a namespace."""
    return f"/{topic.removeprefix('/')}"


def records_of(opened: Bag, topics: set[str], problems: list[str]) -> Iterator[Record]:
    """Yield the records of topics; damaged parts are skipped and noted."""
    if not topics:
        return
    try:
        yield from opened.read(topics)
    except BagError as error:
        problems.append(str(error))
