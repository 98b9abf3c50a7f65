"""Reads what a contract needs from a bag: all numbers, and of pictures their times."""

from __future__ import annotations

import difflib
import struct
from array import array
from typing import TYPE_CHECKING, Final

import numpy as np

from aionode.bag.files.record import MOST_NS
from aionode.errors import BagError, DecodeError, InterfaceNotFoundError, MessageError
from aionode.learn._alignment import Series

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from aionode.bag import Bag, Record
    from aionode.learn.contract import Action, Contract, Observation

__all__ = ["UNREADABLE", "Collected", "full_name", "records_of", "scanned"]

UNREADABLE: Final = (DecodeError, InterfaceNotFoundError, MessageError)
"""What a message that does not fit the contract raises."""

STAMPS: Final = (struct.Struct(">iI"), struct.Struct("<iI"))
"""The time at the start of a message with a header, by the lowest bit of its second byte."""

FIRST_FIELD: Final = 4
"""Where the first field of a message begins, in its bytes."""


class Collected:
    """The messages of one entry, while they are read.

    In arrays, which take a tenth of the memory of lists: a recording of an hour has a million.

    Attributes:
        entry: The entry of the contract.
        is_image: Whether its messages are pictures.
        times: Their times in nanoseconds, by header or arrival.
        arrivals: When they arrived.
        ordinals: Their places among all messages of their topic.
        values: The numbers of one after the other; none of pictures.
        count: How many messages there were, with those that were left out.
        backwards: How many were left out because their time is not after the one before.
        invalid: How many could not be read.
        problem: What was wrong with the first of these.
    """

    def __init__(self, entry: Observation | Action) -> None:
        self.entry = entry
        self.is_image = bool(getattr(entry, "image", None))
        self.times = array("q")
        self.arrivals = array("q")
        self.ordinals = array("q")
        self.values = array("f")
        self.count = 0
        self.backwards = 0
        self.invalid = 0
        self.problem = ""

    def take(self, record: Record) -> None:
        """Take a message of the topic."""
        ordinal, self.count = self.count, self.count + 1
        try:
            arrival = min(record.time_ns, MOST_NS)
            time = self.time_of(record, arrival)
            if self.times and time <= self.times[-1]:
                self.backwards += 1
                return
            if not self.is_image:
                self.values.frombytes(self.entry.value(record.message).tobytes())
            elif not self.times:
                self.entry.value(record.message)  # is it such a picture at all?
        except UNREADABLE as error:
            self.invalid += 1
            self.problem = self.problem or str(error)
            return
        self.times.append(time)
        self.arrivals.append(arrival)
        self.ordinals.append(ordinal)

    def time_of(self, record: Record, arrival: int) -> int:
        """Return the time of a message; that of a picture is read without the picture."""
        if not self.entry.is_captured:
            return arrival
        if not self.is_image:
            return self.entry.time_of(record.message, arrival)
        if len(record.raw) < FIRST_FIELD + 8:
            raise MessageError(self.entry.type, f"{len(record.raw)} bytes only")
        sec, nanosec = STAMPS[record.raw[1] & 1].unpack_from(record.raw, FIRST_FIELD)
        return int(sec) * 1_000_000_000 + int(nanosec) or arrival

    def series(self) -> Series:
        """Return what was taken."""
        columns = 0 if self.is_image else self.entry.shape[0]
        return Series(
            np.array(self.times, np.int64),
            np.array(self.arrivals, np.int64),
            np.array(self.values, np.float64).reshape(len(self.times), columns),
            np.array(self.ordinals, np.int64),
            self.backwards,
            self.invalid,
            self.problem,
        )


def scanned(
    opened: Bag, contract: Contract, tell: Callable[[int], None]
) -> tuple[list[Series], list[str]]:
    """Return the messages of each entry of a contract, and what could not be read of the bag.

    Args:
        opened: The bag.
        contract: The contract.
        tell: Called with the number of messages that were read, to show progress.
    """
    collected = [Collected(entry) for entry in contract.entries]
    by_topic: dict[str, list[Collected]] = {}
    for each in collected:
        by_topic.setdefault(full_name(each.entry.topic), []).append(each)
    problems = [absence_of(opened, name) for name in by_topic if not opened.counts.get(name)]
    problems += [
        f"{name} is {opened.topics[name].type} in the bag, and {each[0].entry.type} in the contract"
        for name, each in by_topic.items()
        if name in opened.topics and opened.topics[name].type != each[0].entry.type
    ]
    for record in records_of(opened, by_topic.keys() & opened.topics.keys(), problems):
        tell(1)
        for each in by_topic[record.topic]:
            each.take(record)
    return [each.series() for each in collected], problems


def absence_of(opened: Bag, name: str) -> str:
    """Return that a bag has no message of a topic, with a topic of a similar name if it has one."""
    there = sorted(each for each, count in opened.counts.items() if count)
    near = difflib.get_close_matches(name, there, 1)
    remedy = f"did you mean {near[0]}?" if near else "was its driver at work?"
    return f"{name}: no messages in the bag; {remedy}"


def full_name(topic: str) -> str:
    """Return a topic of a contract as bags name it: those of a robot without a namespace."""
    return f"/{topic.removeprefix('/')}"


def records_of(opened: Bag, topics: set[str], problems: list[str]) -> Iterator[Record]:
    """Yield the records of topics; what is damaged is left out, and noted."""
    if not topics:
        return
    try:
        yield from opened.read(topics)
    except BagError as error:
        problems.append(str(error))
