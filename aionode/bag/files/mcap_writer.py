"""Writes one MCAP file: chunks are built here, all other records by the library `mcap`.

The library copies each message several times. Here, the bytes of a message are passed to the system
without copying, and small messages are joined once. Checksums, compression and writing release the
GIL, so a writer belongs in a thread of its own.
"""

from __future__ import annotations

import contextlib
import errno
import os
import struct
import zlib
from dataclasses import dataclass
from itertools import accumulate
from typing import TYPE_CHECKING, Any, Final, Protocol

import lz4.frame
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Channel,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)

from aionode.errors import BagWriteError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from pathlib import Path

__all__ = [
    "COMPRESSIONS",
    "LIBRARY",
    "MAGIC",
    "ChunkWriter",
    "McapWriter",
    "Parts",
    "record_bytes",
    "write_error",
]

Pieces = list[bytes | memoryview]
Parts = bytes | Pieces
"""The bytes of a message, or a list of their parts."""

MAGIC: Final = b"\x89MCAP0\r\n"
LIBRARY: Final = "aionode"
COMPRESSIONS: Final = ("zstd", "zstd_small", "lz4", "none")
LEVELS: Final = {"zstd": 1, "zstd_small": 19}
CHUNK_BYTES: Final = 1 << 20
"""Size at which a chunk is written; readers have to decompress whole chunks."""

LARGE_BYTES: Final = 64 << 10
"""Size from which messages are not copied, and a sample decides whether to compress them."""

WORTH_SAVING: Final = 0.95
"""A chunk with large messages is compressed if a sample of the last one shrinks below this."""

MESSAGE_HEADER: Final = struct.Struct("<BQHIQQ")
CHUNK_HEADER: Final = struct.Struct("<BQQQQI")
INDEX_HEADER: Final = struct.Struct("<BQHI")
FULL: Final = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
MAX_PARTS: Final = 512
"""Maximum number of pieces per `writev`; systems have a limit, which is 1024 on Linux."""

MAX_AT_ONCE: Final = 256 << 10
"""Maximum number of bytes per write. Many kernels run nothing else on that processor meanwhile,
and the event loop may have to wait: 6 MB were seen to take 15 ms and longer."""


def record_bytes(*records: McapRecord) -> bytes:
    """Serialize records of the library."""
    builder = RecordBuilder()
    for record in records:
        record.write(builder)
    return bytes(builder.end())  # type: ignore[no-untyped-call]  # of the library


@dataclass(frozen=True, slots=True)
class Span:
    """A chunk that was written, as listed in the summary.

    Attributes:
        index: Its entry in the summary.
        counts: Number of messages by channel.
    """

    index: ChunkIndex
    counts: dict[int, int]

    @property
    def end(self) -> int:
        """The offset at which the chunk's records end."""
        index = self.index
        return index.chunk_start_offset + index.chunk_length + index.message_index_length


def write_error(path: Path, error: OSError) -> BagWriteError:
    """Return the error for a file that the system cannot write."""
    problem = error.strerror or str(error)
    return BagWriteError(str(path), problem, is_full=error.errno in FULL)


class ChunkWriter:
    """Collects the messages of one chunk."""

    def __init__(self) -> None:
        self.parts: list[bytes | memoryview] = []
        self.size = 0
        self.start_ns = 2**64 - 1
        self.end_ns = 0
        self.entries: dict[int, list[int]] = {}
        """The time and the offset of each message, in one list for each channel."""
        self.largest: bytes | memoryview = b""

    def add_record(self, data: bytes) -> None:
        """Add a schema or a channel."""
        self.parts.append(data)
        self.size += len(data)

    def add(self, channel: int, sequence: int, log_ns: int, publish_ns: int, raw: Parts) -> None:
        """Add a message. Its bytes are kept and must not change."""
        if isinstance(raw, list):
            parts, size, largest = raw, sum(map(len, raw)), max(raw, key=len)
        else:
            parts, size, largest = [raw], len(raw), raw
        entries = self.entries.get(channel)
        if entries is None:
            entries = self.entries[channel] = []
        entries += (log_ns, self.size)
        self.parts += (
            MESSAGE_HEADER.pack(
                Opcode.MESSAGE, 22 + size, channel, sequence & 0xFFFFFFFF, log_ns, publish_ns
            ),
            *parts,
        )
        self.size += MESSAGE_HEADER.size + size
        if log_ns < self.start_ns:  # noqa: PLR1730  # for each message: a call takes longer
            self.start_ns = log_ns
        if log_ns > self.end_ns:  # noqa: PLR1730  # as above
            self.end_ns = log_ns
        if len(largest) >= LARGE_BYTES:
            self.largest = largest

    def joined(self) -> list[bytes | memoryview]:
        """Return the chunk's bytes, with small pieces joined and large messages as they are."""
        if not self.largest:
            return [b"".join(self.parts)]
        pieces: list[bytes | memoryview] = []
        small: list[bytes | memoryview] = []
        for part in self.parts:
            if len(part) < LARGE_BYTES:
                small.append(part)
            else:
                pieces += (b"".join(small), part)
                small = []
        return [*pieces, b"".join(small)]


class Scanned(Protocol):
    """The usable part of a file that was not closed; `rest` follows its `end`."""

    end: int
    rest: bytes
    spans: list[Span]
    schemas: dict[int, Schema]
    channels: dict[int, Channel]
    metadata: list[MetadataIndex]


class McapWriter:
    """An MCAP file with profile ros2 that is open for writing.

    Args:
        path: The file, which must not exist.
        compression: One of `COMPRESSIONS`.
        chunk_bytes: The size at which a chunk is written.

    Attributes:
        size: The number of bytes in the file, and pending.
        counts: Number of messages added, by channel.
        spans: The chunks in the file.

    Raises:
        OSError: the file cannot be created.
    """

    def __init__(
        self, path: Path, *, compression: str = "zstd", chunk_bytes: int = CHUNK_BYTES
    ) -> None:
        self.path = path
        self.compression = "" if compression == "none" else compression.split("_", maxsplit=1)[0]
        self.spans: list[Span] = []
        self.counts: dict[int, int] = {}
        self._compress = compressor(compression)
        self._chunk_bytes = chunk_bytes
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, Channel] = {}
        self._metadata: list[MetadataIndex] = []
        self._chunk = ChunkWriter()
        self._offset = 0
        self._failure: BagWriteError | None = None
        self._fd = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
        try:
            self._write([MAGIC, record_bytes(Header("ros2", LIBRARY))])
        except BagWriteError:
            self.abandon()
            raise

    @classmethod
    def resume(cls, path: Path, scan: Scanned) -> McapWriter:
        """Open a file that was not closed, for writing after its last complete chunk.

        Args:
            path: The file.
            scan: Its usable content.

        Raises:
            OSError: it cannot be opened.
            BagWriteError: the disk is full or fails.
        """
        writer = cls.__new__(cls)
        writer.path, writer.compression, writer.spans = path, "", scan.spans
        writer._schemas, writer._channels = scan.schemas, scan.channels
        writer._metadata, writer._chunk = scan.metadata, ChunkWriter()
        writer.counts = dict.fromkeys(scan.channels, 0)
        for span in scan.spans:
            for channel, count in span.counts.items():
                writer.counts[channel] = writer.counts.get(channel, 0) + count
        writer._offset, writer._failure = scan.end, None
        writer._fd = os.open(path, os.O_WRONLY | os.O_CLOEXEC)
        os.ftruncate(writer._fd, scan.end)
        os.lseek(writer._fd, scan.end, os.SEEK_SET)
        writer._write([scan.rest])
        return writer

    @property
    def size(self) -> int:
        """The number of bytes in the file, and pending."""
        return self._offset + self._chunk.size

    @property
    def message_count(self) -> int:
        """The number of messages added."""
        return sum(self.counts.values())

    @property
    def start_ns(self) -> int:
        """The earliest time of a message; 2**64 - 1 if there is none."""
        return min(
            [span.index.message_start_time for span in self._filled()] + [self._chunk.start_ns]
        )

    @property
    def end_ns(self) -> int:
        """The latest time of a message; 0 if there is none."""
        return max([span.index.message_end_time for span in self._filled()] + [self._chunk.end_ns])

    def _filled(self) -> list[Span]:
        return [span for span in self.spans if span.counts]

    def add_channel(
        self, topic: str, encoding: str, metadata: dict[str, str], schema: tuple[str, str, str]
    ) -> int:
        """Add a channel, and its schema if it is new; return the channel's id.

        Args:
            topic: The name of the topic.
            encoding: How its messages are encoded.
            metadata: Additional information about it.
            schema: The name of its type, and the format and text of the definition.
        """
        name, schema_encoding, text = schema
        data = text.encode()
        schema_id = next(
            (
                known.id
                for known in self._schemas.values()
                if (known.name, known.encoding, known.data) == (name, schema_encoding, data)
            ),
            0,
        )
        if not schema_id:
            schema_id = len(self._schemas) + 1
            new = Schema(id=schema_id, name=name, encoding=schema_encoding, data=data)
            self._schemas[schema_id] = new
            self._chunk.add_record(record_bytes(new))
        channel = Channel(
            id=len(self._channels) + 1,
            topic=topic,
            message_encoding=encoding,
            metadata=metadata,
            schema_id=schema_id,
        )
        self._channels[channel.id] = channel
        self.counts[channel.id] = 0
        self._chunk.add_record(record_bytes(channel))
        return channel.id

    def add_message(
        self, channel: int, sequence: int, log_ns: int, publish_ns: int, raw: Parts
    ) -> None:
        """Add a message, and write the chunk if it is full.

        Raises:
            BagWriteError: the file cannot grow.
        """
        self._chunk.add(channel, sequence, log_ns, publish_ns, raw)
        self.counts[channel] += 1
        if self._chunk.size >= self._chunk_bytes:
            self.flush()

    def add_metadata(self, name: str, values: dict[str, str]) -> None:
        """Write a metadata record.

        Raises:
            BagWriteError: the file cannot grow.
        """
        if self._failure is None:
            self.flush()
        data = record_bytes(Metadata(name=name, metadata=values))
        index = MetadataIndex(offset=self._offset, length=len(data), name=name)
        self._write([data])
        self._metadata.append(index)

    def flush(self) -> None:
        """Write the current chunk, so that it survives if the process is killed.

        Raises:
            BagWriteError: the file cannot grow; it ends with the previous chunk.
        """
        if self._failure is not None:
            raise self._failure  # the remaining space is reserved for the summary and the metadata
        chunk = self._chunk
        if not chunk.size:
            return
        pieces, compression = chunk.joined(), self.compression
        crc = 0
        for piece in pieces:
            crc = zlib.crc32(piece, crc)
        if compression and (not chunk.largest or self._saves(chunk.largest)):
            pieces = self._compress(pieces, chunk.size)
        else:
            compression = ""
        stored = sum(map(len, pieces))
        name = compression.encode()
        length = CHUNK_HEADER.size - 9 + 4 + len(name) + 8 + stored
        start_ns = chunk.start_ns if chunk.entries else 0
        header = CHUNK_HEADER.pack(
            Opcode.CHUNK, length, start_ns, chunk.end_ns, chunk.size, crc
        ) + struct.pack(f"<I{len(name)}sQ", len(name), name, stored)
        began = self._offset
        offsets: dict[int, int] = {}
        at = began + 9 + length
        indexes: list[bytes] = []
        for channel, entries in chunk.entries.items():
            offsets[channel] = at
            indexes.append(index_record(channel, entries))
            at += len(indexes[-1])
        self._write([header, *pieces, b"".join(indexes)])
        self._chunk = ChunkWriter()
        index = ChunkIndex(
            chunk_length=9 + length,
            chunk_start_offset=began,
            compression=compression,
            compressed_size=stored,
            message_end_time=chunk.end_ns,
            message_index_length=at - began - 9 - length,
            message_index_offsets=offsets,
            message_start_time=start_ns,
            uncompressed_size=chunk.size,
        )
        counts = {channel: len(entries) // 2 for channel, entries in chunk.entries.items()}
        self.spans.append(Span(index, counts))

    def _saves(self, raw: bytes | memoryview) -> bool:
        """Return whether compressing a large message is worthwhile, from a sample of its middle."""
        middle = len(raw) // 2
        sample = bytes(raw[middle - LARGE_BYTES // 2 : middle + LARGE_BYTES // 2])
        stored = sum(map(len, self._compress([sample], len(sample))))
        return stored < WORTH_SAVING * len(sample)

    def sync(self) -> None:
        """Sync the file to disk, so that its content survives a power cut.

        A removed file accepts bytes without an error, and they are gone when it is closed.

        Raises:
            BagWriteError: the file was removed.
            OSError: the disk fails.
        """
        os.fdatasync(self._fd)
        if not os.fstat(self._fd).st_nlink:
            self.spans = []
            self.counts = dict.fromkeys(self.counts, 0)
            raise BagWriteError(str(self.path), "the file was removed, and its messages are lost")

    def close(self) -> None:
        """Write pending messages and the summary, and close the file.

        On a full disk, chunks are removed from the end until there is room for the summary.

        Raises:
            BagWriteError: messages were lost because the file could not grow. It has a summary
                nevertheless, unless not even that could be written; `counts` is what it contains.
        """
        failure: BagWriteError | None = None
        try:
            self.flush()
        except BagWriteError as error:
            failure = error
            self._forget_chunk()
        while True:
            try:
                self._write(self._summary())
                break
            except BagWriteError as error:
                failure = failure or error
                if not self._take_back():
                    break
        try:
            self.sync()
        except BagWriteError as error:
            failure = error
        except OSError as error:
            failure = failure or write_error(self.path, error)
        self.abandon()
        if failure is not None:
            raise failure

    def abandon(self) -> None:
        """Close the file as it is, without a summary. Closing again has no effect."""
        fd, self._fd = self._fd, -1
        if fd >= 0:
            os.close(fd)

    def _forget_chunk(self) -> None:
        """Count the messages of the current chunk as lost."""
        for channel, entries in self._chunk.entries.items():
            self.counts[channel] -= len(entries) // 2
        self._chunk = ChunkWriter()

    def _take_back(self) -> bool:
        """Remove the last chunk from the file; return whether there was one."""
        if not self.spans:
            return False
        span = self.spans.pop()
        for channel, count in span.counts.items():
            self.counts[channel] -= count
        self._offset = span.index.chunk_start_offset
        os.lseek(self._fd, self._offset, os.SEEK_SET)
        self._metadata = [entry for entry in self._metadata if entry.offset < self._offset]
        os.ftruncate(self._fd, self._offset)
        return True

    def _summary(self) -> list[bytes]:
        """Return everything that follows the last chunk."""
        data_end = record_bytes(DataEnd(data_section_crc=0))
        start = self._offset + len(data_end)
        groups: list[tuple[Opcode, Iterable[McapRecord]]] = [
            (Opcode.SCHEMA, self._schemas.values()),
            (Opcode.CHANNEL, self._channels.values()),
            (Opcode.STATISTICS, [self._statistics()]),
            (Opcode.CHUNK_INDEX, [span.index for span in self.spans]),
            (Opcode.METADATA_INDEX, self._metadata),
        ]
        pieces: list[bytes] = []
        offsets: list[bytes] = []
        at = start
        for opcode, records in groups:
            data = record_bytes(*records)
            if data:
                offset = SummaryOffset(group_opcode=opcode, group_start=at, group_length=len(data))
                offsets.append(record_bytes(offset))
                pieces.append(data)
                at += len(data)
        summary = b"".join([*pieces, *offsets])
        footer = record_bytes(Footer(summary_start=start, summary_offset_start=at, summary_crc=0))
        crc = zlib.crc32(footer[:-4], zlib.crc32(summary))
        return [data_end, summary, footer[:-4] + struct.pack("<I", crc), MAGIC]

    def _statistics(self) -> Statistics:
        count = self.message_count
        return Statistics(
            attachment_count=0,
            channel_count=len(self._channels),
            channel_message_counts=dict(self.counts),
            chunk_count=len(self.spans),
            message_count=count,
            message_end_time=self.end_ns if count else 0,
            message_start_time=self.start_ns if count else 0,
            metadata_count=len(self._metadata),
            schema_count=len(self._schemas),
        )

    def _write(self, pieces: Sequence[bytes | memoryview]) -> None:
        """Append pieces to the file, all or none.

        Raises:
            BagWriteError: the disk is full or fails.
        """
        try:
            write_all(self._fd, pieces)
        except OSError as error:
            with contextlib.suppress(OSError):
                os.ftruncate(self._fd, self._offset)
                os.lseek(self._fd, self._offset, os.SEEK_SET)
            self._failure = BagWriteError(
                str(self.path), os.strerror(error.errno or 0), is_full=error.errno in FULL
            )
            raise self._failure from error
        self._offset += sum(map(len, pieces))


def write_all(fd: int, pieces: Iterable[bytes | memoryview]) -> None:
    """Write all pieces, in as many calls as necessary, keeping each call short."""
    waiting = [
        memoryview(piece)[at : at + MAX_AT_ONCE]
        for piece in pieces
        for at in range(0, len(piece), MAX_AT_ONCE)
    ]
    while waiting:
        ends = accumulate(len(piece) for piece in waiting[:MAX_PARTS])
        count = sum(end <= MAX_AT_ONCE for end in ends)
        written = os.writev(fd, waiting[: max(count, 1)])
        while waiting and written >= len(waiting[0]):
            written -= len(waiting.pop(0))
        if written:
            waiting[0] = waiting[0][written:]


def index_record(channel: int, entries: list[int]) -> bytes:
    """Return the index record for the messages of a channel in a chunk."""
    size = 8 * len(entries)
    header = INDEX_HEADER.pack(Opcode.MESSAGE_INDEX, 6 + size, channel, size)
    return header + struct.pack(f"<{len(entries)}Q", *entries)


def compressor(compression: str) -> Callable[[Pieces, int], Pieces]:
    """Return a function that compresses the pieces of a chunk, given their total size."""
    if compression == "lz4":
        return lambda pieces, _: [lz4.frame.compress(b"".join(pieces))]
    if compression == "none":
        return lambda pieces, _: pieces
    context = zstandard.ZstdCompressor(level=LEVELS[compression])

    def compress(pieces: Pieces, size: int) -> Pieces:
        if len(pieces) == 1:
            return [context.compress(pieces[0])]
        stream: Any = context.compressobj(size=size)
        return [*(stream.compress(piece) for piece in pieces), stream.flush()]

    return compress
