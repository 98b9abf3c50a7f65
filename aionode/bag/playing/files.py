"""Reads a player's files one after another, in the requested order."""

from __future__ import annotations

import heapq
from functools import partial
from itertools import count
from typing import TYPE_CHECKING, Final

from aionode.bag.files.record import MAX_NS
from aionode.bag.recording.services import offered
from aionode.interfaces.rosbag2_interfaces.msg import ReadSplitEvent

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.bag._bag import Bag
    from aionode.bag.files.record import Record
    from aionode.node import Node

__all__ = ["FilesInPlay", "in_order_sent"]

READ_AHEAD: Final = 1000
"""Messages that are sorted by send time at once, as in rosbag2."""


class FilesInPlay:
    """Publishes on ``events/read_split`` when a player moves on to the next file of a bag.

    Args:
        node: The node of the player.
        bags: The bags.

    Attributes:
        next_ns: The time at which the next file starts; `MAX_NS` if there is none.
    """

    def __init__(self, node: Node, bags: list[Bag]) -> None:
        self._node = node
        make = partial(node.create_publisher, ReadSplitEvent, "events/read_split", 10)
        (self._splits,) = offered(node, [make])
        self._files = sorted(
            (start_ns, closed, opened)
            for bag in bags
            for (_, closed), (start_ns, opened) in zip(bag.files, bag.files[1:], strict=False)
        )
        self._next = 0
        self.next_ns = MAX_NS

    def go_to(self, time_ns: int) -> None:
        """Record the time from which the player reads."""
        self._next = sum(start_ns <= time_ns for start_ns, _, _ in self._files)
        self._note()

    def pass_to(self, time_ns: int) -> None:
        """Report each file that is opened at or before a time."""
        while self.next_ns <= time_ns < MAX_NS:
            _, closed, opened = self._files[self._next]
            name = self._node.get_fully_qualified_name()
            if self._splits is not None:
                self._splits.publish(
                    ReadSplitEvent(closed_file=closed, opened_file=opened, node_name=name)
                )
            self._next += 1
            self._note()

    def _note(self) -> None:
        has_next = self._next < len(self._files)
        self.next_ns = self._files[self._next][0] if has_next else MAX_NS


def in_order_sent(records: Iterator[Record]) -> Iterator[tuple[int, Record]]:
    """Yield records in the order of publishing, each after the time to play it.

    The first one keeps its receive time; the intervals are those between publish times. Records are
    sorted within a window of `READ_AHEAD`.
    """
    numbers = count()
    waiting: list[tuple[int, int, Record]] = []
    shift: int | None = None
    for record in records:
        if shift is None:
            shift = record.time_ns - record.publish_time_ns
        heapq.heappush(waiting, (record.publish_time_ns + shift, next(numbers), record))
        if len(waiting) > READ_AHEAD:
            time_ns, _, first = heapq.heappop(waiting)
            yield time_ns, first
    while waiting:
        time_ns, _, first = heapq.heappop(waiting)
        yield time_ns, first
