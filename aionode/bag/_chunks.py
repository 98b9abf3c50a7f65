"""The chunks of MCAP files, read one message after the other.

The library `mcap` makes objects of all messages of a chunk before it yields the first. While it
does, which takes many milliseconds, the event loop hardly runs.
"""

from __future__ import annotations

import struct
import zlib
from operator import itemgetter
from typing import IO, TYPE_CHECKING, Final

import lz4.frame
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Chunk

if TYPE_CHECKING:
    from collections.abc import Container, Iterator

    from mcap.records import ChunkIndex

__all__ = ["HEAD", "MESSAGE", "Row", "checked_content", "rows_of"]

HEAD: Final = struct.Struct("<BQ")
"""The head of each record: its kind and its length."""

MESSAGE: Final = struct.Struct("<HIQQ")
"""The head of a message: channel, sequence, and the times of logging and publishing."""

MOST_CHUNK: Final = 1 << 32
"""A chunk that claims to be larger, in bytes, is damaged."""

Row = tuple[int, int, int, int, int, int]
"""A message: log time, channel, sequence, publish time, and where its bytes begin and end."""


def checked_content(chunk: Chunk) -> bytes:
    """Return the records of a chunk.

    Raises:
        McapError: it is damaged; so are errors of the compression's library.
    """
    if chunk.uncompressed_size > MOST_CHUNK:
        raise McapError("the chunk is too large")
    content = decompressed(chunk)
    if len(content) != chunk.uncompressed_size or (
        chunk.uncompressed_crc and zlib.crc32(content) != chunk.uncompressed_crc
    ):
        raise McapError("the chunk is damaged")
    return content


def decompressed(chunk: Chunk) -> bytes:
    """Return the records of a chunk, which may be damaged."""
    if chunk.compression == "zstd":
        return zstandard.ZstdDecompressor().decompress(
            chunk.data, max_output_size=chunk.uncompressed_size
        )
    if chunk.compression == "lz4":
        plain: bytes = lz4.frame.decompress(chunk.data)
        return plain
    if chunk.compression:
        raise McapError(f"unknown compression {chunk.compression}")
    return chunk.data


def rows_of(
    file: IO[bytes], index: ChunkIndex, channels: Container[int] | None, start_ns: int, end_ns: int
) -> tuple[bytes, Iterator[Row]]:
    """Return the content of a chunk, and its messages of some channels in order of time.

    Args:
        file: The file.
        index: Where the chunk is.
        channels: Which channels are wanted; all if not given.
        start_ns: The time of the first message that is wanted.
        end_ns: The time before which they end.
    """
    file.seek(index.chunk_start_offset + HEAD.size)
    content = checked_content(Chunk.read(ReadDataStream(file)))
    rows = list(wanted_rows(content, channels, start_ns, end_ns))
    rows.sort(key=itemgetter(0))
    return content, iter(rows)


def wanted_rows(
    content: bytes, channels: Container[int] | None, start_ns: int, end_ns: int
) -> Iterator[Row]:
    """Yield the messages of a chunk in the order in which they are there."""
    at, size = 0, len(content)
    head, message = HEAD.unpack_from, MESSAGE.unpack_from
    while at < size:
        opcode, length = head(content, at)
        body = at + HEAD.size
        at = body + length
        if opcode != Opcode.MESSAGE:
            continue
        if at > size:
            raise McapError("a message goes beyond its chunk")
        channel, sequence, log_ns, publish_ns = message(content, body)
        if start_ns <= log_ns < end_ns and (channels is None or channel in channels):
            yield log_ns, channel, sequence, publish_ns, body + MESSAGE.size, at
