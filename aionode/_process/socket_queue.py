"""Counts the unacknowledged bytes in a socket."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import socket

__all__ = ["queued_bytes"]


def queued_bytes(one: socket.socket) -> int:
    """Return how many sent bytes the other end has not acknowledged; 0 if unknown.

    Raises:
        OSError: the socket is closed.
    """
    try:
        import fcntl
        import termios
    except ImportError:  # Windows
        return 0
    return int.from_bytes(fcntl.ioctl(one, termios.TIOCOUTQ, bytes(4)), sys.byteorder)
