"""Reads the chunks of MCAP files message by message.

The library `mcap` creates objects for all messages of a chunk before it yields the first one. That
takes many milliseconds, during which the event loop hardly runs.
"""

from __future__ import annotations

import os
import struct
import zlib
from operator import itemgetter
from typing import IO, TYPE_CHECKING, Final

from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Chunk

from aionode.bag.files.compression import decompressed

if TYPE_CHECKING:
    from collections.abc import Container, Iterator

    from mcap.records import ChunkIndex

__all__ = ["HEAD", "MESSAGE", "Row", "checked_content", "rows_of", "size_of"]

HEAD: Final = struct.Struct("<BQ")
"""The header of each record: opcode and length."""

MESSAGE: Final = struct.Struct("<HIQQ")
"""The header of a message: channel, sequence number, log time and publish time."""

CHUNK: Final = struct.Struct("<QQQII")
"""The beginning of a chunk: times, size, checksum, and the length of its compression's name."""

LENGTH: Final = struct.Struct("<Q")

Row = tuple[int, int, int, int, int, int]
"""A message: log time, channel, sequence, publish time, and the start and end of its bytes."""


def checked_content(chunk: Chunk) -> bytes:
    """Return the records of a chunk.

    Raises:
        McapError: it is damaged; errors of the compression library also mean damage.
    """
    content = decompressed(chunk.compression, chunk.data, chunk.uncompressed_size)
    if len(content) != chunk.uncompressed_size or (
        chunk.uncompressed_crc and zlib.crc32(content) != chunk.uncompressed_crc
    ):
        raise McapError("its checksum does not match")
    return content


def size_of(file: IO[bytes]) -> int:
    """Return the size of an open file in bytes."""
    return os.fstat(file.fileno()).st_size


def rows_of(
    file: IO[bytes], index: ChunkIndex, channels: Container[int] | None, start_ns: int, end_ns: int
) -> tuple[bytes, Iterator[Row]]:
    """Return the content of a chunk, and its messages on some channels in time order.

    Args:
        file: The file.
        index: The chunk's entry in the summary.
        channels: The channels to read; all if None.
        start_ns: The time of the first message to read.
        end_ns: The time before which to stop.
    """
    size = size_of(file)
    if not 0 <= index.chunk_start_offset <= size - HEAD.size:
        raise McapError(f"it would begin beyond the {size} bytes of the file")
    file.seek(index.chunk_start_offset)
    opcode, length = HEAD.unpack(file.read(HEAD.size))
    if opcode != Opcode.CHUNK or length > size - index.chunk_start_offset - HEAD.size:
        raise McapError("there is no complete chunk")
    content = checked_content(chunk_of(file, length))
    rows = list(wanted_rows(content, channels, start_ns, end_ns))
    rows.sort(key=itemgetter(0))
    return content, iter(rows)


def chunk_of(file: IO[bytes], length: int) -> Chunk:
    """Return the chunk that begins where a file is, without copying what is in it."""
    start_ns, end_ns, size, crc, text_length = CHUNK.unpack(file.read(CHUNK.size))
    if text_length > length - CHUNK.size - LENGTH.size:
        raise McapError("the name of its compression extends beyond it")
    compression = file.read(text_length).decode()
    (data_length,) = LENGTH.unpack(file.read(LENGTH.size))
    if data_length > length - CHUNK.size - text_length - LENGTH.size:
        raise McapError("its messages extend beyond it")
    return Chunk(compression, file.read(data_length), end_ns, start_ns, crc, size)


def wanted_rows(
    content: bytes, channels: Container[int] | None, start_ns: int, end_ns: int
) -> Iterator[Row]:
    """Yield the messages of a chunk in file order."""
    at, size = 0, len(content)
    head, message = HEAD.unpack_from, MESSAGE.unpack_from
    while at < size:
        opcode, length = head(content, at)
        body = at + HEAD.size
        at = body + length
        if opcode != Opcode.MESSAGE:
            continue
        if at > size or length < MESSAGE.size:
            raise McapError("a record extends beyond the chunk, or is not a valid message")
        channel, sequence, log_ns, publish_ns = message(content, body)
        if start_ns <= log_ns < end_ns and (channels is None or channel in channels):
            yield log_ns, channel, sequence, publish_ns, body + MESSAGE.size, at
