"""Decompresses parts of bags, and whole files, up to a plausible size."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from tempfile import TemporaryDirectory, gettempdir
from typing import IO, TYPE_CHECKING, Final

import lz4.frame
import zstandard
from mcap.exceptions import McapError

from aionode._process.bounded_files import LFS_POINTER, is_lfs_pointer
from aionode.errors import BagError

if TYPE_CHECKING:
    from contextlib import ExitStack

__all__ = [
    "LIMIT_VARIABLE",
    "TooLargeError",
    "decompressed",
    "expect_plain_size",
    "plain_file",
    "plain_message",
]

MAX_PART: Final = 128 << 20
"""Bytes that a chunk or message may have; more if its compressed size justifies it."""

MAX_FILE: Final = 256 << 20
"""The same limit for a whole file, which is decompressed to a temporary folder."""

LIMIT_VARIABLE: Final = "AIONODE_BAG_LARGEST_BYTES"
"""The environment variable that raises both limits."""

PART_RATIO: Final = 20
FILE_RATIO: Final = 100
PIECE: Final = 1 << 20


class TooLargeError(McapError):
    """A part of a bag is implausibly large, which is not damage that could be repaired."""


def limit_of(largest: int, ratio: int, compressed_size: int) -> int:
    """Return how many bytes a given number of compressed bytes may plausibly expand to."""
    given = os.environ.get(LIMIT_VARIABLE, "")
    raised = int(given) if given.isascii() and given.isdigit() else 0
    return max(largest + ratio * compressed_size, raised)


def expect_plain_size(size: int, compressed_size: int) -> None:
    """Raise `TooLargeError` if the declared size of a part is implausible."""
    max_bytes = limit_of(MAX_PART, PART_RATIO, compressed_size)
    if size > max_bytes:
        raise TooLargeError(
            f"{compressed_size} bytes claim to be {size} when decompressed, "
            f"but at most {max_bytes} are allowed"
        )


def decompressed(compression: str, data: bytes, size: int) -> bytes:
    """Decompress a part of a bag that declares its size.

    Raises:
        McapError: it is larger than declared, implausibly large, or its compression is unknown.
    """
    expect_plain_size(size, len(data))
    if not compression:
        return data
    if compression == "zstd":
        declared = zstandard.frame_content_size(data)
        if declared not in {-1, size}:  # the library would allocate that much memory right away
            raise McapError(f"{declared} bytes, but its header says {size}")
        plain = zstandard.ZstdDecompressor().decompress(data, max_output_size=size) if size else b""
    elif compression == "lz4":
        plain = lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=size + 1)
    else:
        raise McapError(f"unknown compression {compression!r}")
    if len(plain) != size:
        raise McapError(f"more or fewer than the {size} bytes that its header says")
    return plain


def plain_message(data: bytes) -> bytes:
    """Decompress a message that rosbag2 compressed individually.

    Raises:
        McapError: it is implausibly large; errors of the compression library also mean damage.
    """
    size = zstandard.frame_content_size(data)
    if size >= 0:
        return decompressed("zstd", data, size)
    return zstandard.ZstdDecompressor().decompress(
        data, max_output_size=limit_of(MAX_PART, PART_RATIO, len(data))
    )


def plain_file(path: Path, stack: ExitStack) -> tuple[Path, IO[bytes]]:
    """Return the path and stream of a bag file, decompressing it first if necessary.

    Args:
        path: The file.
        stack: Closes the file, and removes the decompressed copy.

    Raises:
        BagError: it is not a bag file, or decompresses to an implausible size.
        OSError: it cannot be read.
    """
    state = path.stat()
    if not stat.S_ISREG(state.st_mode):
        raise BagError(str(path), "it is a folder, a pipe or a device", "give a file")
    file = stack.enter_context(path.open("rb"))
    if is_lfs_pointer(file.peek()):
        raise BagError(str(path), f"it is {LFS_POINTER}")
    if path.suffix != ".zstd":
        return path, file
    folder = Path(stack.enter_context(TemporaryDirectory(prefix="aionode-bag-")))
    plain = folder / path.stem
    try:
        write_plain(path, file, plain, limit_of(MAX_FILE, FILE_RATIO, state.st_size))
    except zstandard.ZstdError as error:
        raise BagError(str(path), f"it cannot be decompressed ({error})") from error
    except OSError as error:
        if error.errno not in {errno.ENOSPC, errno.EDQUOT}:
            raise
        raise BagError(
            str(path),
            f"{gettempdir()} does not have enough space for the decompressed file",
            "decompress it with `zstd -d` where there is space, or set TMPDIR",
        ) from error
    return plain, stack.enter_context(plain.open("rb"))


def write_plain(path: Path, compressed: IO[bytes], plain: Path, max_bytes: int) -> None:
    """Decompress a file into another one, up to a size of `max_bytes` bytes."""
    problem = f"it decompresses to more than {max_bytes} bytes, which is implausible for its size"
    with plain.open("wb") as out:
        reader = zstandard.ZstdDecompressor().stream_reader(compressed, read_across_frames=True)
        while piece := reader.read(PIECE):
            if out.tell() + len(piece) > max_bytes:
                raise BagError(str(path), problem, f"{LIMIT_VARIABLE} raises the limit")
            out.write(piece)
