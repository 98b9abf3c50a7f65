"""The summary at the end of an MCAP file: its topics, counts and chunk offsets."""

from __future__ import annotations

import zlib
from collections import Counter
from contextlib import suppress
from io import BytesIO
from typing import IO, TYPE_CHECKING, Final, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, ChunkIndex, Footer, Schema, Statistics

from aionode.bag.files.chunks import HEAD, MESSAGE, checked_content, size_of

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = [
    "MAGIC",
    "Summary",
    "heads_of",
    "index_of",
    "read_summary",
    "records_from",
    "whole_summary",
]

MAGIC: Final = b"\x89MCAP0\r\n"
FOOTER: Final = HEAD.size + 20
"""The length of the last record of a file."""

CRC: Final = 4


class Summary(NamedTuple):
    """The contents of a file's summary.

    Attributes:
        statistics: Counts and times; None if the file has none, or no summary.
        schemas: The types by id.
        channels: The channels by id.
        chunks: The entries of the chunks.
    """

    statistics: Statistics | None
    schemas: dict[int, Schema]
    channels: dict[int, Channel]
    chunks: list[ChunkIndex]


def read_summary(file: IO[bytes]) -> Summary:
    """Return the summary of a file.

    Raises:
        McapError: the file is damaged or was not closed; errors of the libraries also mean damage.
    """
    found = Summary(None, {}, {}, [])
    statistics = None
    for opcode, body in records_from(summary_bytes(file)):
        fields = ReadDataStream(BytesIO(body))
        if opcode == Opcode.SCHEMA:
            schema = Schema.read(fields)
            found.schemas[schema.id] = schema
        elif opcode == Opcode.CHANNEL:
            channel = Channel.read(fields)
            found.channels[channel.id] = channel
        elif opcode == Opcode.CHUNK_INDEX:
            found.chunks.append(ChunkIndex.read(fields))
        elif opcode == Opcode.STATISTICS:
            statistics = Statistics.read(fields)
    return found._replace(statistics=statistics)


def summary_bytes(file: IO[bytes]) -> bytes:
    """Return the records of the summary; empty if the file has none.

    Raises:
        McapError: the end of the file is damaged.
    """
    size = size_of(file)
    file.seek(0)
    if file.read(len(MAGIC)) != MAGIC:
        raise McapError("it does not start like an MCAP file")
    at = size - FOOTER - len(MAGIC)
    if at < len(MAGIC):
        raise McapError("it ends after its first bytes")
    file.seek(at)
    end = file.read()
    if not end.endswith(MAGIC) or HEAD.unpack_from(end) != (Opcode.FOOTER, FOOTER - HEAD.size):
        raise McapError("its end is missing")
    footer = Footer.read(ReadDataStream(BytesIO(end[HEAD.size :])))
    if not footer.summary_start:
        return b""
    if not len(MAGIC) <= footer.summary_start <= at:
        raise McapError(f"its summary would begin at byte {footer.summary_start} of {size}")
    file.seek(footer.summary_start)
    summary = file.read(at - footer.summary_start)
    checked = zlib.crc32(end[: FOOTER - CRC], zlib.crc32(summary))
    if footer.summary_crc and checked != footer.summary_crc:
        raise McapError("the checksum of its summary does not match")
    return summary


def records_from(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield the opcode and bytes of each record in a part of a file.

    Raises:
        McapError: one extends beyond the end.
    """
    at = 0
    while at < len(data):
        opcode, length = HEAD.unpack_from(data, at)
        at += HEAD.size + length
        if at > len(data):
            raise McapError("a record extends beyond its end")
        yield opcode, data[at - length : at]


def heads_of(file: IO[bytes]) -> Iterator[tuple[int, int, int]]:
    """Yield the kind of each record before the summary, where its bytes begin, and how many.

    Raises:
        McapError: the file is damaged.
    """
    at, size = len(MAGIC), size_of(file)
    while at <= size - HEAD.size:
        file.seek(at)
        opcode, length = HEAD.unpack(file.read(HEAD.size))
        at += HEAD.size
        if opcode == Opcode.DATA_END:
            return
        if length > size - at or (opcode == Opcode.MESSAGE and length < MESSAGE.size):
            raise McapError(f"the record at byte {at - HEAD.size} goes beyond the end")
        yield opcode, at, length
        at += length


def whole_summary(
    file: IO[bytes], damage: tuple[type[Exception], ...]
) -> tuple[Summary, Statistics]:
    """Return the summary of a file, with its statistics.

    A writer may leave out any part of it, as rosbag2 does by ``noSummary``, ``noStatistics``,
    ``noChunkIndex`` and ``noRepeatedChannels``: then all records of the file are read.

    Args:
        file: The file.
        damage: Exceptions for a damaged chunk, whose messages are not counted then.

    Raises:
        McapError: the file is damaged or was not closed; errors of the libraries also mean that.
    """
    found = read_summary(file)
    told = found.statistics
    if (
        told is not None
        and told.chunk_count == len(found.chunks)
        and (told.channel_message_counts or not told.message_count)
        and told.channel_message_counts.keys() <= found.channels.keys()
        and all(each.schema_id in {0, *found.schemas} for each in found.channels.values())
    ):
        return found, told
    return summary_of_content(file, damage)


def summary_of_content(
    file: IO[bytes], damage: tuple[type[Exception], ...]
) -> tuple[Summary, Statistics]:
    """Return what the summary of a file should contain, from all its records."""
    found = Summary(None, {}, {}, [])
    counts: Counter[int] = Counter()
    first_ns, last_ns = 1 << 64, 0

    def take(opcode: int, body: bytes) -> None:
        nonlocal first_ns, last_ns
        if opcode == Opcode.MESSAGE:
            channel, _, time_ns, _ = MESSAGE.unpack_from(body)
            counts[channel] += 1
            first_ns, last_ns = min(first_ns, time_ns), max(last_ns, time_ns)
        elif opcode == Opcode.SCHEMA:
            schema = Schema.read(ReadDataStream(BytesIO(body)))
            found.schemas[schema.id] = schema
        elif opcode == Opcode.CHANNEL:
            known = Channel.read(ReadDataStream(BytesIO(body)))
            found.channels[known.id] = known

    for opcode, at, length in heads_of(file):
        file.seek(at)
        if opcode != Opcode.CHUNK:
            take(opcode, file.read(MESSAGE.size if opcode == Opcode.MESSAGE else length))
            continue
        chunk = Chunk.read(ReadDataStream(BytesIO(file.read(length))))
        found.chunks.append(index_of(chunk, at - HEAD.size, length + HEAD.size))
        with suppress(*damage):
            for kind, body in records_from(checked_content(chunk)):
                take(kind, body)
    count = sum(counts.values())
    statistics = Statistics(
        attachment_count=0,
        channel_count=len(found.channels),
        channel_message_counts=dict(counts),
        chunk_count=len(found.chunks),
        message_count=count,
        message_end_time=last_ns,
        message_start_time=first_ns if count else 0,
        metadata_count=0,
        schema_count=len(found.schemas),
    )
    return found._replace(statistics=statistics), statistics


def index_of(chunk: Chunk, start: int, length: int) -> ChunkIndex:
    """Return the index of a chunk, without those of its messages."""
    return ChunkIndex(
        chunk_length=length,
        chunk_start_offset=start,
        compression=chunk.compression,
        compressed_size=len(chunk.data),
        message_end_time=chunk.message_end_time,
        message_index_length=0,
        message_index_offsets={},
        message_start_time=chunk.message_start_time,
        uncompressed_size=chunk.uncompressed_size,
    )
