"""Copies records of bags into a new one: a piece, a merge, or with another compression."""

from __future__ import annotations

from collections import Counter
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

from aionode.bag._bag import Bag, open  # noqa: A004  # as in `bag.open(path)`
from aionode.bag._selection import Selection
from aionode.bag._writer import BagWriter
from aionode.bag.files.losses import LOSSES, MISSING, added_losses, losses_text, missing_text
from aionode.bag.files.order import in_order

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from os import PathLike

    from aionode.bag.files.record import Record
    from aionode.clock import Duration, Time

__all__ = ["convert", "cut", "merge", "merged_records"]


def cut(
    path: str | PathLike[str],
    out: str | PathLike[str],
    *,
    start: Time | Duration | None = None,
    end: Time | Duration | None = None,
    topics: Iterable[str] | None = None,
    **options: Any,
) -> int:
    """Copy a piece of a bag, and return its number of messages.

    Args:
        path: The bag.
        out: The folder of the new bag, which must not exist.
        start: The time of its first message, or how long after the start of the bag to begin.
        end: The time before which it ends, or how long after the start of the bag.
        topics: Names of its topics; all by default.
        options: Options for writing it; see `BagWriter`.

    Raises:
        BagError: the bag cannot be read, has no such topic, or the folder exists.
        BagWriteError: the disk is full or fails.
    """
    with open(path) as bag:
        if topics is not None:
            topics = list(topics)
        return written(bag.read(topics, start, end), out, custom_data_of([bag]), options)


def merge(paths: Iterable[str | PathLike[str]], out: str | PathLike[str], **options: Any) -> int:
    """Merge several bags into one in time order, and return its number of messages.

    Args:
        paths: The bags.
        out: The folder of the new bag, which must not exist.
        options: Options for writing it; see `BagWriter`.

    Raises:
        BagError: a bag cannot be read, or the folder exists.
        BagWriteError: the disk is full or fails.
    """
    return convert(paths, out, **options)


def convert(
    paths: Iterable[str | PathLike[str]],
    out: str | PathLike[str],
    *,
    selection: Selection | None = None,
    start: Time | Duration | None = None,
    end: Time | Duration | None = None,
    **options: Any,
) -> int:
    """Convert bags of any format to one MCAP bag, and return its number of messages.

    Args:
        paths: The bags.
        out: The folder of the new bag, which must not exist.
        selection: Its topics; all by default.
        start: The time of its first message, or how long after the start of each bag to begin.
        end: The time before which it ends, or how long after the start of each bag.
        options: Options for writing it; see `BagWriter`.

    Raises:
        BagError: a bag cannot be read, or the folder exists.
        BagWriteError: the disk is full or fails.
    """
    with ExitStack() as stack:
        bags = [stack.enter_context(open(path)) for path in paths]
        records = merged_records(bags, selection, start, end)
        return written(records, out, custom_data_of(bags), options)


def custom_data_of(bags: list[Bag]) -> dict[str, str]:
    """Return the custom data of a bag made from others, including the sums of what they lack."""
    custom: dict[str, str] = {}
    for bag in bags:
        custom |= bag.custom_data
    missing: Counter[str] = Counter()
    for bag in bags:
        missing.update(bag.missing)
    if missing:
        custom[MISSING] = missing_text(missing)
    losses = added_losses(bag.losses for bag in bags)
    return custom if losses is None else custom | {LOSSES: losses_text(losses)}


def merged_records(
    bags: Iterable[Bag],
    selection: Selection | None = None,
    start: Time | Duration | None = None,
    end: Time | Duration | None = None,
) -> Iterator[Record]:
    """Yield the selected records of several bags in time order."""
    streams = []
    for bag in bags:
        topics = None
        if selection is not None:
            topics = [
                topic.name for topic in bag.connections if selection.wants(topic.name, topic.type)
            ]
        streams.append((bag.start_ns, iter(bag.read(topics, start, end))))
    return in_order(streams)


def written(
    records: Iterable[Record],
    out: str | PathLike[str],
    custom_data: dict[str, str],
    options: dict[str, Any],
) -> int:
    """Write records to a new bag."""
    added = options.pop("custom_data", None) or {}
    with BagWriter(out, custom_data=custom_data | added, **options) as writer:
        for record in records:
            writer.write_record(record)
        return writer.message_count
