"""Reads the files of bags: MCAP by the library `mcap`, sqlite3 by the library `rosbags`."""

from __future__ import annotations

import struct
import zlib
from contextlib import ExitStack
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import IO, TYPE_CHECKING, Any, Final, Protocol

import zstandard
from mcap.exceptions import McapError
from mcap.reader import make_reader

from aionode.bag._chunks import rows_of
from aionode.bag._order import in_order
from aionode.bag._qos import profiles_from
from aionode.bag._record import MOST_NS, Record, TopicInfo
from aionode.errors import BagError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from collections.abc import Set as AbstractSet

    from mcap.records import Channel, ChunkIndex, Schema

__all__ = ["McapSource", "RosbagsSource", "Source", "topic_of"]

CHECK: Final = "`aionode bag check` repairs what a power cut left"
DAMAGE: Final = (
    McapError,
    struct.error,
    zlib.error,
    zstandard.ZstdError,
    EOFError,
    RuntimeError,  # of lz4
    OverflowError,
    UnicodeDecodeError,
    KeyError,
    IndexError,
    AssertionError,
    OSError,  # of a search before the beginning of a file that is cut short
)
"""Exceptions of the libraries for a damaged file."""


class Source(Protocol):
    """One file of a bag, or one bag that another library reads.

    Attributes:
        path: Where it is.
        topics: Its topics, with counts.
        start_ns: The time of its first message; `MOST_NS` without one.
        end_ns: The time of its last message; 0 without one.
    """

    path: Path
    topics: list[TopicInfo]
    start_ns: int
    end_ns: int

    def records(
        self, topics: AbstractSet[str] | None, start_ns: int, end_ns: int
    ) -> Iterator[Record]:
        """Yield the records of some topics from one time on until before another, in order."""

    def close(self) -> None:
        """Close its files."""


def topic_of(schema: Schema | None, channel: Channel, messages: int) -> TopicInfo:
    """Return the topic that a channel of an MCAP file is."""
    definition = "" if schema is None else schema.data.decode(errors="replace")
    return TopicInfo(
        name=channel.topic,
        type="" if schema is None else schema.name,
        type_hash=channel.metadata.get("topic_type_hash", ""),
        qos=profiles_from(channel.metadata.get("offered_qos_profiles", "")),
        message_count=messages,
        serialization_format=channel.message_encoding,
        encoding=schema.encoding if definition and schema is not None else "",
        definition=definition,
    )


class McapSource:
    """An MCAP file.

    Args:
        path: The file; one that ends in ``.zstd`` is decompressed into a temporary folder.

    Raises:
        BagError: it is no MCAP file, or was not closed.
        OSError: it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._open = ExitStack()
        try:
            self._file = self._open.enter_context(plain_file(path, self._open))
            self._reader = make_reader(self._file, validate_crcs=True)
            summary = self._reader.get_summary()
            if summary is None or summary.statistics is None:
                raise BagError(str(path), "the file has no summary", CHECK)  # noqa: TRY301  # closed below
            counts = summary.statistics.channel_message_counts
            schemas = summary.schemas
            self._channels = {
                number: topic_of(schemas.get(channel.schema_id), channel, counts.get(number, 0))
                for number, channel in summary.channels.items()
            }
        except (FileNotFoundError, PermissionError):
            self._open.close()
            raise
        except DAMAGE as error:
            self._open.close()
            raise damaged(path, error) from error
        except BaseException:
            self._open.close()
            raise
        self._chunks = summary.chunk_indexes
        self.topics = list(self._channels.values())
        has_messages = summary.statistics.message_count > 0
        self.start_ns = summary.statistics.message_start_time if has_messages else MOST_NS
        self.end_ns = summary.statistics.message_end_time if has_messages else 0

    def records(
        self, topics: AbstractSet[str] | None, start_ns: int, end_ns: int
    ) -> Iterator[Record]:
        """Yield the records of some topics from one time on until before another, in order.

        Raises:
            BagError: the file is damaged.
        """
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
        if not self._chunks:
            return self._without_chunks(topics, start_ns, end_ns)
        return in_order(
            [
                (chunk.message_start_time, self._in_chunk(chunk, wanted, start_ns, end_ns))
                for chunk in chunks
            ]
        )

    def _in_chunk(
        self, chunk: ChunkIndex, wanted: AbstractSet[int] | None, start_ns: int, end_ns: int
    ) -> Iterator[Record]:
        channels = self._channels
        try:
            content, rows = rows_of(self._file, chunk, wanted, start_ns, end_ns)
            for time_ns, channel, sequence, publish_ns, begin, end in rows:
                yield Record(channels[channel], time_ns, publish_ns, sequence, content[begin:end])
        except DAMAGE as error:
            raise damaged(self.path, error) from error

    def _without_chunks(
        self, topics: AbstractSet[str] | None, start_ns: int, end_ns: int
    ) -> Iterator[Record]:
        messages = self._reader.iter_messages(
            topics=None if topics is None else sorted(topics),
            starting_at=start_ns,
            ending_before=end_ns,
        )
        try:
            for _, channel, message in messages:
                yield Record(
                    self._channels[channel.id],
                    message.log_time,
                    message.publish_time,
                    message.sequence,
                    message.data,
                )
        except DAMAGE as error:
            raise damaged(self.path, error) from error

    def close(self) -> None:
        """Close the file."""
        self._open.close()


def has_any(chunk: ChunkIndex, wanted: AbstractSet[int] | None) -> bool:
    """Return whether a chunk may have messages of some channels, as far as its index tells."""
    offsets = chunk.message_index_offsets
    return wanted is None or not offsets or not wanted.isdisjoint(offsets)


def plain_file(path: Path, stack: ExitStack) -> IO[bytes]:
    """Return a file that is open for reading; a compressed one is decompressed first."""
    if path.suffix != ".zstd":
        return path.open("rb")
    folder = stack.enter_context(TemporaryDirectory(prefix="aionode-bag-"))
    plain = Path(folder) / path.stem
    with path.open("rb") as compressed, plain.open("wb") as out:
        zstandard.ZstdDecompressor().copy_stream(compressed, out)
    return plain.open("rb")


def damaged(path: Path, error: Exception) -> BagError:
    """Return the error for a file that is no complete MCAP file."""
    what = str(error) or type(error).__name__
    return BagError(str(path), f"the file is damaged, or was not closed ({what})", CHECK)


class RosbagsSource:
    """A bag that the library `rosbags` reads: sqlite3 in any version, split or compressed.

    Args:
        path: The folder, or a file.

    Raises:
        BagError: `rosbags` cannot read it.
        OSError: it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        from rosbags.rosbag2 import Reader, ReaderError

        self.path = path
        self._error = ReaderError
        self._reader: Any = None
        try:
            self._reader = Reader(path)
            self._reader.open()
        except ReaderError as error:
            raise BagError(str(path), f"it cannot be read: {error}") from error
        connections = self._reader.connections
        self._topics = {
            number: topic_from(connection) for number, connection in enumerate(connections)
        }
        self.topics = list(self._topics.values())
        has_messages = self._reader.message_count > 0
        self.start_ns = self._reader.start_time if has_messages else MOST_NS
        self.end_ns = self._reader.end_time - 1 if has_messages else 0

    def records(
        self, topics: AbstractSet[str] | None, start_ns: int, end_ns: int
    ) -> Iterator[Record]:
        """Yield the records of some topics from one time on until before another, in order.

        Raises:
            BagError: the file is damaged.
        """
        wanted = {
            id(connection): self._topics[number]
            for number, connection in zip(count(), self._reader.connections)
            if topics is None or connection.topic in topics
        }
        connections = [
            connection for connection in self._reader.connections if id(connection) in wanted
        ]
        if not connections:
            return
        try:
            for connection, time_ns, raw in self._reader.messages(connections, start_ns, end_ns):
                yield Record(wanted[id(connection)], time_ns, time_ns, 0, bytes(raw))
        except self._error as error:
            raise BagError(str(self.path), f"it cannot be read: {error}") from error

    def close(self) -> None:
        """Close its files."""
        self._reader.close()


FORMATS: Final[dict[str, str]] = {"MSG": "ros2msg", "IDL": "ros2idl"}


def topic_from(connection: Any) -> TopicInfo:
    """Return the topic that a connection of `rosbags` is."""
    from rosbags.rosbag2.metadata import dump_qos_v9

    definition = connection.msgdef
    return TopicInfo(
        name=connection.topic,
        type=connection.msgtype,
        type_hash=connection.digest or "",
        qos=profiles_from(dump_qos_v9(connection.ext.offered_qos_profiles)),
        message_count=connection.msgcount,
        serialization_format=connection.ext.serialization_format,
        encoding=FORMATS.get(definition.format.name, ""),
        definition=definition.data if definition.format.name in FORMATS else "",
    )
