"""Reads bags, whatever program has written them."""

from __future__ import annotations

from copy import copy
from itertools import islice
from pathlib import Path
from time import sleep  # noqa: TID251  # of no time: it only lets go of the interpreter
from typing import TYPE_CHECKING, Any, Final, Self, TypeVar

from aionode._process.concurrency import run_in_thread
from aionode.bag._losses import LOSSES, losses_from
from aionode.bag._metadata import FILE_NAME, read_metadata, topics_in
from aionode.bag._order import in_order
from aionode.bag._record import MOST_NS, Record, TopicInfo, time_of
from aionode.bag._source import McapSource, RosbagsSource
from aionode.clock import Duration, Time
from aionode.errors import BagError

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Iterable, Iterator
    from collections.abc import Set as AbstractSet
    from os import PathLike
    from types import TracebackType

    from aionode.bag._source import Source

__all__ = ["Bag", "Records", "open"]

T = TypeVar("T")

BATCH: Final = 256
"""Records that an async iteration reads at once, in a thread."""

TURN: Final = 64
"""Records that are read before other threads get their turn."""

BATCH_BYTES: Final = 8 << 20
"""A batch ends with the record that makes it this large."""


class Bag:
    """A recording that is open for reading; ``with`` closes it.

    Attributes:
        path: The folder or file.
        topics: Its topics by name. Of a topic whose type has changed, the first type is there, with
            the messages of all; `connections` has them one by one.
        connections: Each topic with each of its types.
        custom_data: What its recorder has noted besides.
        losses: What its recorder has lost, for each topic with losses; None if it does not tell.
    """

    def __init__(
        self, path: Path, sources: list[Source], metadata: dict[str, Any] | None = None
    ) -> None:
        self.path = path
        self.metadata = metadata or {}
        self.custom_data: dict[str, str] = dict(self.metadata.get("custom_data") or {})
        self.losses = losses_from(self.custom_data)
        if self.losses is not None:
            del self.custom_data[LOSSES]
        self._sources = sources
        self.connections = merged_topics(sources, listed_topics(self.metadata))
        self.topics: dict[str, TopicInfo] = {}
        for topic in self.connections:
            known = self.topics.get(topic.name)
            if known is None:
                self.topics[topic.name] = copy(topic)
            else:
                known.message_count += topic.message_count

    def __repr__(self) -> str:
        return f"<Bag {self.path}: {self.message_count} messages of {len(self.topics)} topics>"

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    @property
    def message_count(self) -> int:
        """The number of messages."""
        return sum(topic.message_count for topic in self.topics.values())

    @property
    def counts(self) -> dict[str, int]:
        """The number of messages of each topic."""
        return {name: topic.message_count for name, topic in self.topics.items()}

    @property
    def start_ns(self) -> int:
        """The time of the first message in nanoseconds since 1970; 0 without one."""
        start = min((source.start_ns for source in self._sources), default=MOST_NS)
        return 0 if start == MOST_NS else start

    @property
    def end_ns(self) -> int:
        """The time of the last message in nanoseconds since 1970; 0 without one."""
        return max((source.end_ns for source in self._sources), default=0)

    @property
    def start(self) -> Time:
        """The time of the first message; 0 without one."""
        return time_of(self.start_ns)

    @property
    def end(self) -> Time:
        """The time of the last message; 0 without one."""
        return time_of(self.end_ns)

    @property
    def duration(self) -> Duration:
        """The time from the first message to the last."""
        return Duration(nanoseconds=self.end_ns - self.start_ns)

    @property
    def files(self) -> list[tuple[int, str]]:
        """Its files in order of time, each after the time of its first message in nanoseconds."""
        if len(self._sources) == 1 and self.metadata.get("files"):
            return sorted(
                (int(file["starting_time"]["nanoseconds_since_epoch"]), str(file["path"]))
                for file in self.metadata["files"]
            )
        return sorted((source.start_ns, source.path.name) for source in self._sources)

    def read(
        self,
        topics: Iterable[str] | str | None = None,
        start: Time | Duration | None = None,
        end: Time | Duration | None = None,
    ) -> Records:
        """Return the records in order of time, for ``for`` and for ``async for``.

        Args:
            topics: The names of the topics that are wanted; all if not given.
            start: The time of the first record that is wanted, or how long after the start of the
                bag that is.
            end: The time before which the records end, or how long after the start of the bag.

        Raises:
            BagError: the bag has no such topic. While reading: a file is damaged.
        """
        wanted = None
        if topics is not None:
            wanted = {topics} if isinstance(topics, str) else set(topics)
            unknown = sorted(wanted - self.topics.keys())
            if unknown:
                there = ", ".join(sorted(self.topics)) or "none"
                raise BagError(str(self.path), f"no topic {unknown[0]}", f"its topics: {there}")
        return Records(self._sources, wanted, self._edge(start, 0), self._edge(end, MOST_NS))

    def _edge(self, value: Time | Duration | None, default: int) -> int:
        if value is None:
            return default
        if isinstance(value, Duration):
            return max(self.start_ns + value.nanoseconds, 0)
        return value.nanoseconds

    def close(self) -> None:
        """Close its files. Closing it again has no effect."""
        for source in self._sources:
            source.close()
        self._sources = []


class Records:
    """Some records of a bag: iterate over them, with ``for`` or with ``async for``.

    Each iteration begins anew. ``async for`` reads in a thread, so the event loop never waits for
    the disk.
    """

    def __init__(
        self, sources: list[Source], topics: AbstractSet[str] | None, start_ns: int, end_ns: int
    ) -> None:
        self._sources = sources
        self._limits = (topics, start_ns, end_ns)

    def __iter__(self) -> Iterator[Record]:
        """Iterate over the records in order of time.

        Raises:
            BagError: a file is damaged.
        """
        _, start_ns, end_ns = self._limits
        wanted = [s for s in self._sources if s.start_ns < end_ns and s.end_ns >= start_ns]
        return in_order([(source.start_ns, source.records(*self._limits)) for source in wanted])

    async def __aiter__(self) -> AsyncIterator[Record]:
        """Iterate over the records in order of time; they are read in a thread.

        Raises:
            BagError: a file is damaged.
        """
        records = iter(self)
        while batch := await run_in_thread(next_batch, records, lambda record: len(record.raw)):
            for record in batch:
                yield record


def next_batch(records: Iterator[T], size_of: Callable[[T], int], most: int = BATCH) -> list[T]:
    """Return the next records, as many as one call should read, by their sizes in bytes.

    In between it lets other threads run: the event loop may wait for its turn.
    """
    batch: list[T] = []
    size = 0
    for record in islice(records, most):
        batch.append(record)
        if not len(batch) % TURN:
            sleep(0)
        size += size_of(record)
        if size >= BATCH_BYTES:
            break
    return batch


def listed_topics(metadata: dict[str, Any]) -> list[TopicInfo]:
    """Return the topics that ``metadata.yaml`` lists; none if it has none."""
    if not metadata:
        return []
    try:
        return topics_in(metadata)
    except (KeyError, TypeError, ValueError):
        return []  # only the files tell


def merged_topics(sources: list[Source], listed: list[TopicInfo]) -> list[TopicInfo]:
    """Return the topics of all files, each once, with its messages added up.

    Topics without messages may be in the metadata alone; hashes may be there alone, too.
    """
    topics: dict[tuple[str, str], TopicInfo] = {}
    merged: dict[tuple[str, str, str], TopicInfo] = {}
    for source in sources:
        for topic in source.topics:
            known = merged.get(topic.key)
            if known is None:
                merged[topic.key] = topics[topic.name, topic.type] = copy(topic)
            else:
                known.message_count += topic.message_count
    for topic in listed:
        known = topics.get((topic.name, topic.type))
        if known is None:
            merged[topic.key] = topic
            topic.message_count = 0
        elif not known.type_hash:
            known.type_hash = topic.type_hash
    return list(merged.values())


def open(path: str | PathLike[str]) -> Bag:  # noqa: A001  # as in `bag.open(path)`
    """Open a bag for reading.

    Args:
        path: A folder with ``metadata.yaml``, or a single ``.mcap`` or ``.db3`` file.

    Raises:
        BagError: it is no bag, or is damaged; the text says how to repair it.
        FileNotFoundError: there is nothing of this name.
        OSError: it cannot be read.
    """
    place = Path(path)
    if not place.exists():
        raise FileNotFoundError(f"bag {path}: there is no such file or folder")
    if not place.is_dir():
        return Bag(place, [source_of(place)])
    metadata = read_metadata(place)
    if metadata["storage_identifier"] != "mcap":
        return Bag(place, [RosbagsSource(place)], metadata)
    sources: list[Source] = []
    try:
        for name in metadata["relative_file_paths"]:
            sources.append(McapSource(place / Path(name).name))  # noqa: PERF401  # closed if one fails
    except FileNotFoundError as error:
        close_all(sources)
        problem = f"{FILE_NAME} names {Path(error.filename).name}, which is not there"
        raise BagError(str(path), problem, "`aionode bag reindex` writes a new one") from error
    except BaseException:
        close_all(sources)
        raise
    return Bag(place, sources, metadata)


def close_all(sources: list[Source]) -> None:
    """Close files that were opened before one failed."""
    for source in sources:
        source.close()


def source_of(path: Path) -> Source:
    """Open a single file.

    Raises:
        BagError: it is no file of a bag.
    """
    suffix = Path(path.stem).suffix if path.suffix == ".zstd" else path.suffix
    if suffix == ".mcap":
        return McapSource(path)
    if suffix == ".db3":
        return RosbagsSource(path)
    raise BagError(str(path), "the file is neither .mcap nor .db3", "give a folder or such a file")
