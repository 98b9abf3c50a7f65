"""Merges the records of several files or chunks in time order."""

from __future__ import annotations

import heapq
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.bag.files.record import Record

__all__ = ["in_order"]


def in_order(streams: list[tuple[int, Iterator[Record]]]) -> Iterator[Record]:
    """Yield the records of several streams in time order.

    Records of one time come in the order of their streams. A stream is read only once its
    start time is reached, so that few files are in use at a time.

    Args:
        streams: Streams that are each in order, with a time before which they have no record.
    """
    if len(streams) == 1:
        yield from streams[0][1]
        return
    starts = sorted((start, number) for number, (start, _) in enumerate(streams))
    waiting = starts[::-1]  # the next one to be read is last
    heads: list[tuple[int, int, Record, Iterator[Record]]] = []
    while waiting or heads:
        while waiting and (not heads or waiting[-1][0] <= heads[0][0]):
            _, number = waiting.pop()
            stream = streams[number][1]
            first = next(stream, None)
            if first is not None:
                heapq.heappush(heads, (first.time_ns, number, first, stream))
        if not heads:
            continue
        _, number, record, stream = heads[0]
        yield record
        following = next(stream, None)
        if following is None:
            heapq.heappop(heads)
        else:
            heapq.heapreplace(heads, (following.time_ns, number, following, stream))
