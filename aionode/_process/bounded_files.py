"""Files of others: read as far as they are files, and of a size that can be."""

from __future__ import annotations

import errno
import os
import stat
from typing import Final

__all__ = ["LARGEST_FILE", "read_file"]

LARGEST_FILE: Final = 16 << 20
"""The largest file that is read at once, in bytes."""

PIECE: Final = 64 << 10
"""Bytes that are read at once, or as many as there were before: room is made for what is there."""

GIVEN: Final = ("/dev/fd/", "/dev/stdin", "/proc/self/fd/")
"""Names of what a shell hands over, as in ``--params-file <(xacro ...)``, which may be a pipe."""


def read_file(path: str | os.PathLike[str], most: int = LARGEST_FILE) -> bytes:
    """Return the content of a file of configuration.

    A pipe that has no writer would be waited for without end, and a device has none.

    Args:
        path: The file.
        most: The largest size in bytes.

    Raises:
        OSError: it cannot be read, is no file, or is larger.
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
            raise OSError(errno.EINVAL, "a pipe or a device, and no file", name)
        with os.fdopen(descriptor, "rb", closefd=False) as file:
            content = b""
            while len(content) <= most and (piece := file.read(max(PIECE, len(content)))):
                content += piece
    finally:
        os.close(descriptor)
    if len(content) > most:
        raise OSError(errno.EFBIG, f"more than {most} bytes", name)
    return content
