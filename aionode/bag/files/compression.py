"""Decompresses parts of bags, and whole files, as far as their size is believable."""

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

from aionode.errors import BagError

if TYPE_CHECKING:
    from contextlib import ExitStack

__all__ = [
    "LIMIT_VARIABLE",
    "TooLargeError",
    "decompressed",
    "expect_no_pointer",
    "expect_plain_size",
    "plain_file",
    "plain_message",
]

LARGEST_PART: Final = 128 << 20
"""A chunk or message may have so many bytes, and more if its compressed form justifies it."""

LARGEST_FILE: Final = 256 << 20
"""The limit for a whole file, which is decompressed to a temporary folder."""

LIMIT_VARIABLE: Final = "AIONODE_BAG_LARGEST_BYTES"
"""The variable of the environment that raises both."""

PART_RATIO: Final = 20
FILE_RATIO: Final = 100
PIECE: Final = 1 << 20

LFS: Final = b"version https://git-lfs.github.com/spec/"
"""How the text begins that Git has in place of a large file."""


class TooLargeError(McapError):
    """A part of a bag is larger than is believable, which is no damage that can be repaired."""


def limit_of(largest: int, ratio: int, compressed_size: int) -> int:
    """Return how many bytes so many compressed ones may stand for."""
    given = os.environ.get(LIMIT_VARIABLE, "")
    raised = int(given) if given.isascii() and given.isdigit() else 0
    return max(largest + ratio * compressed_size, raised)


def expect_plain_size(size: int, compressed_size: int) -> None:
    """Raise `TooLargeError` if a part that says that it is so large cannot be one of a bag."""
    most = limit_of(LARGEST_PART, PART_RATIO, compressed_size)
    if size > most:
        raise TooLargeError(
            f"{compressed_size} bytes that say they are {size} when decompressed, "
            f"where at most {most} are taken"
        )


def decompressed(compression: str, data: bytes, size: int) -> bytes:
    """Return the plain form of a part of a bag, which says how large that is.

    Raises:
        McapError: it is larger than it says, or than is believable, or its compression is unknown.
    """
    expect_plain_size(size, len(data))
    if not compression:
        return data
    if compression == "zstd":
        declared = zstandard.frame_content_size(data)
        if declared not in {-1, size}:  # the library would take that much memory at once
            raise McapError(f"{declared} bytes where its head says {size}")
        plain = zstandard.ZstdDecompressor().decompress(data, max_output_size=size) if size else b""
    elif compression == "lz4":
        plain = lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=size + 1)
    else:
        raise McapError(f"unknown compression {compression!r}")
    if len(plain) != size:
        raise McapError(f"more or fewer than the {size} bytes that its head says")
    return plain


def plain_message(data: bytes) -> bytes:
    """Return a message that rosbag2 has compressed by itself.

    Raises:
        McapError: it is larger than is believable; so are errors of the compression's library.
    """
    size = zstandard.frame_content_size(data)
    if size >= 0:
        return decompressed("zstd", data, size)
    return zstandard.ZstdDecompressor().decompress(
        data, max_output_size=limit_of(LARGEST_PART, PART_RATIO, len(data))
    )


def plain_file(path: Path, stack: ExitStack) -> tuple[Path, IO[bytes]]:
    """Return a file of a bag and a stream of it; a compressed one is decompressed first.

    Args:
        path: The file.
        stack: What closes the file, and removes the decompressed one.

    Raises:
        BagError: it is no file of a bag, or decompresses to more than is believable.
        OSError: it cannot be read.
    """
    state = path.stat()
    if not stat.S_ISREG(state.st_mode):
        raise BagError(str(path), "it is a folder, a pipe or a device", "give a file")
    file = stack.enter_context(path.open("rb"))
    expect_no_pointer(path, file.peek(len(LFS)))
    if path.suffix != ".zstd":
        return path, file
    folder = Path(stack.enter_context(TemporaryDirectory(prefix="aionode-bag-")))
    plain = folder / path.stem
    try:
        write_plain(path, file, plain, limit_of(LARGEST_FILE, FILE_RATIO, state.st_size))
    except zstandard.ZstdError as error:
        raise BagError(str(path), f"it cannot be decompressed ({error})") from error
    except OSError as error:
        if error.errno not in {errno.ENOSPC, errno.EDQUOT}:
            raise
        raise BagError(
            str(path),
            f"{gettempdir()} has no space for what it decompresses to",
            "decompress it by `zstd -d` where there is space, or set TMPDIR",
        ) from error
    return plain, stack.enter_context(plain.open("rb"))


def expect_no_pointer(path: Path, content: bytes) -> None:
    """Raise `BagError` if the content of a file is a pointer of Git LFS."""
    if content.startswith(LFS):
        raise BagError(
            str(path),
            "it is the pointer that Git LFS has in place of the file",
            "`git lfs pull` fetches the file",
        )


def write_plain(path: Path, compressed: IO[bytes], plain: Path, most: int) -> None:
    """Decompress a file into another one, as long as that is not larger than `most`."""
    problem = f"it decompresses to more than {most} bytes, which no bag of its size does"
    with plain.open("wb") as out:
        reader = zstandard.ZstdDecompressor().stream_reader(compressed, read_across_frames=True)
        while piece := reader.read(PIECE):
            if out.tell() + len(piece) > most:
                raise BagError(str(path), problem, f"{LIMIT_VARIABLE} raises the limit")
            out.write(piece)
