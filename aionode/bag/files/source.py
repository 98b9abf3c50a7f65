"""Reads the MCAP files of bags; defines what all bag files have in common."""

from __future__ import annotations

import struct
import zlib
from contextlib import ExitStack
from io import BytesIO
from typing import TYPE_CHECKING, Final, Protocol

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Message

from aionode.bag.files.chunks import MESSAGE, rows_of
from aionode.bag.files.compression import LIMIT_VARIABLE, TooLargeError, plain_file, plain_message
from aionode.bag.files.order import in_order
from aionode.bag.files.qos import readable_profiles
from aionode.bag.files.record import MAX_NS, Record, TopicInfo
from aionode.bag.files.summary import heads_of, whole_summary
from aionode.errors import BagError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from collections.abc import Set as AbstractSet
    from pathlib import Path

    from mcap.records import Channel, ChunkIndex, Schema

__all__ = ["CHECK", "DAMAGE", "McapSource", "Source", "damaged", "topic_of"]

CHECK: Final = "`aionode bag check` repairs what a power cut left"
RECOVER: Final = "`sqlite3 OLD.db3 .recover | sqlite3 NEW.db3` saves what it can"
DAMAGE: Final = (
    McapError,
    struct.error,
    zlib.error,
    zstandard.ZstdError,
    EOFError,
    RuntimeError,  # of lz4
    MemoryError,
    OverflowError,
    ValueError,
    TypeError,
    LookupError,
    AssertionError,
)
"""Exceptions that the libraries raise for a damaged file."""


class Source(Protocol):
    """One file of a bag.

    Attributes:
        path: Its path.
        topics: Its topics, with counts.
        start_ns: The time of its first message; `MAX_NS` if there is none.
        end_ns: The time of its last message; 0 if there is none.
    """

    path: Path
    topics: list[TopicInfo]
    start_ns: int
    end_ns: int

    def records(
        self,
        topics: AbstractSet[str] | None,
        start_ns: int,
        end_ns: int,
        problems: list[BagError],
    ) -> Iterator[Record]:
        """Yield the records of some topics from `start_ns` until before `end_ns`, in order.

        Damaged records are skipped and reported in `problems`.
        """

    def close(self) -> None:
        """Close its files."""


def topic_of(schema: Schema | None, channel: Channel, messages: int) -> TopicInfo:
    """Return the topic that a channel of an MCAP file represents."""
    definition = "" if schema is None else schema.data.decode(errors="replace")
    qos, problem = readable_profiles(channel.metadata.get("offered_qos_profiles", ""))
    return TopicInfo(
        name=channel.topic,
        type="" if schema is None else schema.name,
        type_hash=channel.metadata.get("topic_type_hash", ""),
        qos=qos,
        message_count=messages,
        serialization_format=channel.message_encoding,
        encoding=schema.encoding if definition and schema is not None else "",
        definition=definition,
        problem=problem,
    )


class McapSource:
    """An MCAP file.

    Args:
        path: The file; a ``.zstd`` file is decompressed into a temporary folder.
        compressed_messages: Whether each message is compressed individually.

    Raises:
        BagError: it is not an MCAP file, or was not closed.
        OSError: it cannot be read.
    """

    def __init__(self, path: Path, *, compressed_messages: bool = False) -> None:
        self.path = path
        self._compressed_messages = compressed_messages
        with ExitStack() as stack:
            _, self._file = plain_file(path, stack)
            try:
                summary, statistics = whole_summary(self._file, DAMAGE)
                counts = statistics.channel_message_counts
                self._chunks = summary.chunks
                self._channels = {
                    number: topic_of(
                        summary.schemas.get(channel.schema_id), channel, counts.get(number, 0)
                    )
                    for number, channel in summary.channels.items()
                }
            except DAMAGE as error:
                raise damaged(path, error) from error
            self._open = stack.pop_all()
        self.topics = list(self._channels.values())
        # Statistics of some versions of libmcap leave out messages of the time 0.
        spans = [
            (chunk.message_start_time, chunk.message_end_time)
            for chunk in self._chunks
            if chunk.message_index_offsets or chunk.message_end_time
        ]
        if statistics.message_count:
            spans.append((statistics.message_start_time, statistics.message_end_time))
        self.start_ns = min((start for start, _ in spans), default=MAX_NS)
        self.end_ns = max((end for _, end in spans), default=0)

    def records(
        self,
        topics: AbstractSet[str] | None,
        start_ns: int,
        end_ns: int,
        problems: list[BagError],
    ) -> Iterator[Record]:
        """Yield the records of some topics from `start_ns` until before `end_ns`, in order."""
        wanted = None
        if topics is not None:
            wanted = {
                number for number, channel in self._channels.items() if channel.name in topics
            }
        chunks = [
            chunk
            for chunk in self._chunks
            if chunk.message_start_time < end_ns
            and chunk.message_end_time >= start_ns
            and has_any(chunk, wanted)
        ]
        records = (
            in_order(
                [
                    (
                        chunk.message_start_time,
                        self._in_chunk(chunk, wanted, start_ns, end_ns, problems),
                    )
                    for chunk in chunks
                ]
            )
            if self._chunks
            else self._without_chunks(wanted, start_ns, end_ns, problems)
        )
        return self._plain(records, problems) if self._compressed_messages else records

    def _in_chunk(
        self,
        chunk: ChunkIndex,
        wanted: AbstractSet[int] | None,
        start_ns: int,
        end_ns: int,
        problems: list[BagError],
    ) -> Iterator[Record]:
        channels = self._channels
        where = f"the chunk at byte {chunk.chunk_start_offset}"
        try:
            content, rows = rows_of(self._file, chunk, wanted, start_ns, end_ns)
        except DAMAGE as error:
            problems.append(damaged(self.path, error, where))
            return
        unknown: set[int] = set()
        for time_ns, channel, sequence, publish_ns, begin, end in rows:
            info = channels.get(channel)
            if info is None:
                unknown.add(channel)
                continue
            yield Record(info, time_ns, publish_ns, sequence, content[begin:end])
        if unknown:
            wrong = LookupError(f"channel {min(unknown)} of a message is not in the summary")
            problems.append(damaged(self.path, wrong, where))

    def _without_chunks(
        self,
        wanted: AbstractSet[int] | None,
        start_ns: int,
        end_ns: int,
        problems: list[BagError],
    ) -> Iterator[Record]:
        """Yield messages that are not in chunks."""
        rows: list[tuple[int, int, int]] = []  # time, offset and length
        try:
            for at, length, channel, time_ns in self._lone_messages():
                if start_ns <= time_ns < end_ns and (wanted is None or channel in wanted):
                    rows.append((time_ns, at, length))
        except DAMAGE as error:
            problems.append(damaged(self.path, error))
        rows.sort()
        for time_ns, at, length in rows:
            self._file.seek(at)
            message = Message.read(ReadDataStream(BytesIO(self._file.read(length))), length)
            info = self._channels.get(message.channel_id)
            if info is None:
                unknown = LookupError(f"channel {message.channel_id} is not in the summary")
                problems.append(damaged(self.path, unknown, f"the message at byte {at}"))
                continue
            yield Record(info, time_ns, message.publish_time, message.sequence, message.data)

    def _lone_messages(self) -> Iterator[tuple[int, int, int, int]]:
        """Yield the offset, length, channel and time of each message outside chunks.

        Raises:
            McapError: the file is damaged.
        """
        for opcode, at, length in heads_of(self._file):
            if opcode == Opcode.MESSAGE:
                channel, _, time_ns, _ = MESSAGE.unpack(self._file.read(MESSAGE.size))
                yield at, length, channel, time_ns

    def expect_index(self) -> None:
        """Raise BagError if the index of a chunk leaves out messages that are in it."""
        for chunk in self._chunks:
            where = f"the index of the chunk at byte {chunk.chunk_start_offset}"
            try:
                _, rows = rows_of(self._file, chunk, None, 0, 1 << 64)
            except DAMAGE as error:
                raise damaged(self.path, error, where) from error
            messages = list(rows)
            channels = {row[1] for row in messages}
            listed = chunk.message_index_offsets
            if messages and (
                messages[0][0] < chunk.message_start_time
                or messages[-1][0] > chunk.message_end_time
                or (listed and not channels <= listed.keys())
            ):
                raise damaged(self.path, LookupError("it leaves out messages"), where)

    def _plain(self, records: Iterator[Record], problems: list[BagError]) -> Iterator[Record]:
        """Yield records after decompressing their messages individually."""
        for record in records:
            try:
                record.raw = plain_message(record.raw)
            except DAMAGE as error:
                where = f"the message of {record.topic!r} at {record.time_ns} ns"
                problems.append(damaged(self.path, error, where))
            else:
                yield record

    def close(self) -> None:
        """Close the file."""
        self._open.close()


def has_any(chunk: ChunkIndex, wanted: AbstractSet[int] | None) -> bool:
    """Return whether a chunk may contain messages of some channels, according to its index."""
    offsets = chunk.message_index_offsets
    return wanted is None or not offsets or not wanted.isdisjoint(offsets)


def damaged(path: Path, error: Exception, where: str = "the file") -> BagError:
    """Return the error for an incomplete file, or for a damaged part of one."""
    what = str(error) or type(error).__name__
    if isinstance(error, TooLargeError):
        remedy = f"{LIMIT_VARIABLE} raises the limit"
        return BagError(str(path), f"{where} cannot be read: {what}", remedy)
    or_open = ", or was not closed" if where == "the file" else ""
    remedy = RECOVER if ".db3" in path.suffixes else CHECK
    return BagError(str(path), f"{where} is damaged{or_open} ({what})", remedy)
