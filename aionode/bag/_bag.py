"""Reads bags written by any program."""

from __future__ import annotations

from copy import copy
from errno import ENAMETOOLONG
from itertools import islice
from pathlib import Path
from time import sleep  # noqa: TID251  # for no time: it only releases the interpreter
from typing import TYPE_CHECKING, Any, Final, Generic, Self, TypeVar

from aionode._process.concurrency import run_in_thread
from aionode.bag.files.losses import LOSSES, MISSING, losses_from, missing_from
from aionode.bag.files.metadata import FILE_NAME, counts_in, read_metadata, start_in, topics_in
from aionode.bag.files.order import in_order
from aionode.bag.files.record import MAX_NS, Record, TopicInfo, time_of
from aionode.bag.files.source import CHECK, McapSource
from aionode.bag.files.sqlite import SqliteSource
from aionode.clock import Duration, Time
from aionode.errors import BagError, brief

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Iterable, Iterator
    from collections.abc import Set as AbstractSet
    from os import PathLike
    from types import TracebackType

    from aionode.bag.files.source import Source

__all__ = ["Bag", "Records", "open"]

T = TypeVar("T")

END_NS: Final = 1 << 64
"""A time after everything that a bag can contain."""

BATCH: Final = 256
"""Records that an async iteration reads at a time, in a thread."""

TURN: Final = 64
"""Records to read before other threads get a turn."""

BATCH_BYTES: Final = 8 << 20
"""A batch ends with the record that makes it at least this large."""


class Bag:
    """A bag that is open for reading; ``with`` closes it.

    Attributes:
        path: The folder or file.
        topics: Its topics by name. If the type of a topic changed, its first type is listed, with
            the messages of all types; `connections` lists them separately.
        connections: Each topic with each of its types.
        custom_data: Additional metadata from its recorder.
        losses: What its recorder lost, for each topic with losses; None if it does not report any.
        missing: How many messages of each topic are counted in its metadata, but no longer in its
            files, because one was cut or removed.
    """

    def __init__(
        self, path: Path, sources: list[Source], metadata: dict[str, Any] | None = None
    ) -> None:
        self.path = path
        self.metadata = metadata or {}
        custom = self.metadata.get("custom_data")
        self.custom_data: dict[str, str] = dict(custom) if isinstance(custom, dict) else {}
        self.losses = losses_from(self.custom_data)
        if self.losses is not None:
            del self.custom_data[LOSSES]
        self._sources = sources
        self._start_ns = first_ns(sources, start_in(self.metadata))
        self.connections = merged_topics(sources, topics_in(self.metadata))
        self.topics: dict[str, TopicInfo] = {}
        for topic in self.connections:
            known = self.topics.get(topic.name)
            if known is None:
                self.topics[topic.name] = copy(topic)
            else:
                known.message_count += topic.message_count
        self.missing = missing_from(self.custom_data)
        if self.missing:
            del self.custom_data[MISSING]
        for name, count in counts_in(self.metadata).items():
            there = self.topics[name].message_count if name in self.topics else 0
            if count > there:
                self.missing[name] = self.missing.get(name, 0) + count - there

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
        return 0 if self._start_ns == MAX_NS else self._start_ns

    @property
    def end_ns(self) -> int:
        """The time of the last message in nanoseconds since 1970; 0 if there is none."""
        return max((source.end_ns for source in self._sources), default=0)

    @property
    def start(self) -> Time:
        """The time of the first message; 0 if there is none."""
        return time_of(self.start_ns)

    @property
    def end(self) -> Time:
        """The time of the last message; 0 if there is none."""
        return time_of(self.end_ns)

    @property
    def duration(self) -> Duration:
        """The time from the first message to the last."""
        return Duration(nanoseconds=min(max(self.end_ns - self.start_ns, 0), MAX_NS))

    @property
    def files(self) -> list[tuple[int, str]]:
        """Its files in time order, as pairs of first message time in nanoseconds and name."""
        return sorted((source.start_ns, source.path.name) for source in self._sources)

    def read(
        self,
        topics: Iterable[str] | str | None = None,
        start: Time | Duration | None = None,
        end: Time | Duration | None = None,
    ) -> Records:
        """Return the records in time order, for use with ``for`` or ``async for``.

        Args:
            topics: Names of the topics to read; all by default.
            start: The time of the first record to read, or how long after the start of the bag to
                begin.
            end: The time before which to stop, or how long after the start of the bag.

        Raises:
            BagError: the bag has no such topic. After the last record: some could not be read.
        """
        wanted = None
        if topics is not None:
            wanted = {topics} if isinstance(topics, str) else set(topics)
            unknown = sorted(wanted - self.topics.keys())
            if unknown:
                there = ", ".join(sorted(self.topics)) or "none"
                raise BagError(str(self.path), f"no topic {unknown[0]}", f"its topics: {there}")
        start_ns = self._edge(start, 0)
        if isinstance(start, Duration) and start_ns <= self.start_ns:
            start_ns = 0  # so that no index decides what the first message is
        return Records(self, self._sources, wanted, start_ns, self._edge(end, END_NS))

    def _edge(self, value: Time | Duration | None, default: int) -> int:
        if value is None:
            return default
        if isinstance(value, Duration):
            return max(self.start_ns + value.nanoseconds, 0)
        return END_NS if value.nanoseconds == MAX_NS else value.nanoseconds

    def close(self) -> None:
        """Close its files. Closing it again has no effect."""
        for source in self._sources:
            source.close()
        self._sources = []


class Records:
    """Some records of a bag, to iterate over with ``for`` or ``async for``.

    Each iteration starts over. ``async for`` reads in a thread, so the event loop never waits for
    the disk. Damaged records are skipped; the error is raised after all others.
    """

    def __init__(
        self,
        bag: Bag,
        sources: list[Source],
        topics: AbstractSet[str] | None,
        start_ns: int,
        end_ns: int,
    ) -> None:
        self._bag = bag
        self._sources = sources
        self._limits = (topics, start_ns, end_ns)

    def __iter__(self) -> Iterator[Record]:
        """Iterate over the records in time order.

        Raises:
            BagError: after the last record: some could not be read.
        """
        topics, start_ns, end_ns = self._limits
        wanted = [s for s in self._sources if s.start_ns < end_ns and s.end_ns >= start_ns]
        problems: list[BagError] = []
        count = 0
        streams = [(source.start_ns, source.records(*self._limits, problems)) for source in wanted]
        for count, record in enumerate(in_order(streams), 1):  # noqa: B007  # the last one is used
            yield record
        if len(problems) == 1:
            raise problems[0]
        if problems:
            first = problems[0]
            more = f"{first.problem}, and {len(problems) - 1} more problems"
            raise BagError(first.path, more, first.remedy)
        promised = sum(
            topic.message_count
            for topic in self._bag.connections
            if topics is None or topic.name in topics
        )
        if count != promised and start_ns <= self._bag.start_ns and end_ns == END_NS:
            problem = f"it claims to have {promised} messages, but {count} can be read"
            raise BagError(str(self._bag.path), problem, CHECK)

    async def __aiter__(self) -> AsyncIterator[Record]:
        """Iterate over the records in time order, reading them in a thread.

        Raises:
            BagError: after the last record: some could not be read.
        """
        batches = Batches(iter(self), lambda record: len(record.raw))
        while batch := await run_in_thread(batches.next):
            for record in batch:
                yield record


class Batches(Generic[T]):
    """Records in batches, each as large as one call should read.

    Args:
        records: The records.
        size_of: The size of each in bytes.
        max_records: Maximum number of records per batch.
    """

    def __init__(
        self, records: Iterator[T], size_of: Callable[[T], int], max_records: int = BATCH
    ) -> None:
        self._records = records
        self._size_of = size_of
        self._max_records = max_records
        self._error: BagError | None = None

    def next(self) -> list[T]:
        """Return the next records; an empty list at the end.

        It yields to other threads while reading: the event loop may be waiting for its turn.

        Raises:
            BagError: some records could not be read; the others were returned before.
        """
        if self._error is not None:
            raise self._error
        batch: list[T] = []
        size = 0
        try:
            for record in islice(self._records, self._max_records):
                batch.append(record)
                if not len(batch) % TURN:
                    sleep(0)
                size += self._size_of(record)
                if size >= BATCH_BYTES:
                    break
        except BagError as error:
            if not batch:
                raise
            self._error = error
        return batch


def first_ns(sources: list[Source], told_ns: int) -> int:
    """Return the time of the first message; `MAX_NS` without one.

    Args:
        sources: The files.
        told_ns: What the metadata say. If it is earlier than what the files' summaries say, one of
            the two is wrong, and the first messages are read.
    """
    start_ns = min((source.start_ns for source in sources), default=MAX_NS)
    if told_ns < start_ns:
        for source in sources:
            for record in islice(source.records(None, 0, END_NS, []), 1):
                start_ns = min(start_ns, record.time_ns)
    return start_ns


def merged_topics(sources: list[Source], listed: list[TopicInfo]) -> list[TopicInfo]:
    """Merge the topics of all files, adding up their messages.

    Name and type identify a topic: files and metadata may describe its QoS differently. Topics
    without messages, and type hashes, may appear only in the metadata.
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
                known.qos = known.qos or topic.qos
    for topic in listed:
        known = topics.get((topic.name, topic.type))
        if known is None:
            merged[topic.key] = topic
        else:
            known.type_hash = known.type_hash or topic.type_hash
            known.qos = known.qos or topic.qos
    return list(merged.values())


def open(path: str | PathLike[str]) -> Bag:  # noqa: A001  # as in `bag.open(path)`
    """Open a bag for reading.

    Args:
        path: A folder with ``metadata.yaml``, or a single ``.mcap`` or ``.db3`` file.

    Raises:
        BagError: it is not a bag, or is damaged; the message says how to repair it.
        FileNotFoundError: there is no such file or folder.
        OSError: it cannot be read.
    """
    place = Path(path)
    if not place.exists():
        raise FileNotFoundError(f"bag {path}: there is no such file or folder")
    if not place.is_dir():
        return Bag(place, [source_of(place)])
    metadata = read_metadata(place)
    mode = str(metadata.get("compression_mode") or "").lower()
    form = str(metadata.get("compression_format") or "").lower()
    if mode == "message" and form != "zstd":
        raise BagError(
            str(path), f"its messages are compressed by {form!r}", "only zstd can be read"
        )
    storage = metadata["storage_identifier"]
    kinds: dict[str, type[McapSource | SqliteSource]] = {
        "mcap": McapSource,
        "sqlite3": SqliteSource,
    }
    kind = kinds.get(storage)
    if kind is None:
        problem = f"{FILE_NAME} names the storage {storage!r}"
        raise BagError(str(path), problem, "only mcap and sqlite3 can be read")
    sources: list[Source] = []
    try:
        for name in dict.fromkeys(Path(name).name for name in metadata["relative_file_paths"]):
            if mode == "file" and not (place / name).exists():
                name = name.removesuffix(".zstd")  # noqa: PLW2901  # it was decompressed by hand
            sources.append(kind(place / name, compressed_messages=mode == "message"))
    except BaseException as error:
        close_all(sources)
        if isinstance(error, FileNotFoundError) or getattr(error, "errno", 0) == ENAMETOOLONG:
            problem = f"{FILE_NAME} lists {brief(name)}, which does not exist"
            remedy = "`aionode bag reindex` rebuilds it"
            raise BagError(str(path), problem, remedy) from error
        raise
    return Bag(place, sources, metadata)


def close_all(sources: list[Source]) -> None:
    """Close files that were opened before one failed to open."""
    for source in sources:
        source.close()


def source_of(path: Path) -> Source:
    """Open a single file.

    Raises:
        BagError: it is not a bag file.
    """
    suffix = Path(path.stem).suffix if path.suffix == ".zstd" else path.suffix
    if suffix == ".mcap":
        return McapSource(path)
    if suffix == ".db3":
        return SqliteSource(path)
    raise BagError(str(path), "the file is neither .mcap nor .db3", "give a folder or such a file")
