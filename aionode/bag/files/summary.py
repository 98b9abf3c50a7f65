"""The summary at the end of an MCAP file: its topics, its counts, and where its chunks are."""

from __future__ import annotations

import zlib
from io import BytesIO
from typing import IO, TYPE_CHECKING, Final, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, ChunkIndex, Footer, Schema, Statistics

from aionode.bag.files.chunks import HEAD, size_of

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["MAGIC", "Summary", "read_summary", "records_from"]

MAGIC: Final = b"\x89MCAP0\r\n"
FOOTER: Final = HEAD.size + 20
"""The length of the last record of a file."""

CRC: Final = 4


class Summary(NamedTuple):
    """What the summary of a file has.

    Attributes:
        statistics: Counts and times; None if the file has none, or no summary.
        schemas: The types by number.
        channels: The channels by number.
        chunks: Where the chunks are.
    """

    statistics: Statistics | None
    schemas: dict[int, Schema]
    channels: dict[int, Channel]
    chunks: list[ChunkIndex]


def read_summary(file: IO[bytes]) -> Summary:
    """Return the summary of a file.

    Raises:
        McapError: the file is damaged, or was not closed; so are errors of the libraries.
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
    """Return the records of the summary; nothing if the file has none.

    Raises:
        McapError: the end of the file is damaged.
    """
    size = size_of(file)
    file.seek(0)
    if file.read(len(MAGIC)) != MAGIC:
        raise McapError("it does not begin as an MCAP file")
    at = size - FOOTER - len(MAGIC)
    if at < len(MAGIC):
        raise McapError("it ends after its first bytes")
    file.seek(at)
    end = file.read()
    if not end.endswith(MAGIC) or HEAD.unpack_from(end) != (Opcode.FOOTER, FOOTER - HEAD.size):
        raise McapError("it has no end")
    footer = Footer.read(ReadDataStream(BytesIO(end[HEAD.size :])))
    if not footer.summary_start:
        return b""
    if not len(MAGIC) <= footer.summary_start <= at:
        raise McapError(f"its summary would begin at byte {footer.summary_start} of {size}")
    file.seek(footer.summary_start)
    summary = file.read(at - footer.summary_start)
    checked = zlib.crc32(end[: FOOTER - CRC], zlib.crc32(summary))
    if footer.summary_crc and checked != footer.summary_crc:
        raise McapError("the checksum of its summary does not fit")
    return summary


def records_from(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield the records in a piece of a file: the kind of each, and its bytes.

    Raises:
        McapError: one goes beyond the end.
    """
    at = 0
    while at < len(data):
        opcode, length = HEAD.unpack_from(data, at)
        at += HEAD.size + length
        if at > len(data):
            raise McapError("a record goes beyond its end")
        yield opcode, data[at - length : at]
