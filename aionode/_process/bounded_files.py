"""Read files from others, if they are regular files of a plausible size."""

from __future__ import annotations

import errno
import os
import stat
from typing import Final

__all__ = ["LFS_POINTER", "MAX_FILE", "is_lfs_pointer", "read_file"]

MAX_FILE: Final = 16 << 20
"""The largest file that is read at once, in bytes."""

PIECE: Final = 64 << 10
"""Bytes that are read at once, or as many as were read so far, so that memory grows only with what
is there.
"""

LFS: Final = b"version https://git-lfs.github.com/spec/"
"""The start of the pointer file that Git LFS leaves in place of a file that is not fetched."""

LFS_POINTER: Final = "only the Git LFS pointer to the file; `git lfs pull` fetches the file"
"""What an error says of such a pointer."""

GIVEN: Final = ("/dev/fd/", "/dev/stdin", "/proc/self/fd/")
"""Paths of a shell's process substitution, as in ``--params-file <(xacro ...)``, which may be
pipes.
"""


def read_file(path: str | os.PathLike[str], max_bytes: int = MAX_FILE) -> bytes:
    """Read a configuration file.

    A pipe without a writer would block forever, and a device may have no end.

    Args:
        path: The file.
        max_bytes: The largest size in bytes.

    Raises:
        OSError: it cannot be read, is not a file, is larger, or is the pointer of Git LFS.
    """
    name = os.fspath(path)
    is_given = name.startswith(GIVEN)
    flags = os.O_RDONLY | os.O_CLOEXEC | (0 if is_given else os.O_NONBLOCK)
    descriptor = os.open(path, flags)
    try:
        mode = os.fstat(descriptor).st_mode
        if stat.S_ISDIR(mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), name)
        if not is_given and not stat.S_ISREG(mode):
            raise OSError(errno.EINVAL, "a pipe or a device, not a file", name)
        with os.fdopen(descriptor, "rb", closefd=False) as file:
            content = b""
            while len(content) <= max_bytes and (piece := file.read(max(PIECE, len(content)))):
                content += piece
    finally:
        os.close(descriptor)
    if len(content) > max_bytes:
        raise OSError(errno.EFBIG, f"more than {max_bytes} bytes", name)
    if is_lfs_pointer(content):
        raise OSError(errno.EINVAL, LFS_POINTER, name)
    return content


def is_lfs_pointer(content: bytes) -> bool:
    """Return whether the content of a file is what Git LFS leaves until it has fetched the file."""
    return content.startswith(LFS)
