"""Counts the bytes that wait in a socket."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import socket

__all__ = ["queued_bytes", "unsent_bytes"]

SIOCOUTQNSD: Final = 0x894B
"""Asks a TCP socket of Linux for the bytes that it could not send yet: not those on their way."""


def queued_bytes(one: socket.socket) -> int:
    """Return how many sent bytes the other end has not acknowledged; 0 if unknown.

    Raises:
        OSError: the socket is closed.
    """
    try:
        import termios
    except ImportError:  # Windows
        return 0
    return asked(one, termios.TIOCOUTQ)


def unsent_bytes(one: socket.socket) -> int:
    """Return how many bytes of a TCP socket the other end has no room for yet; 0 if unknown.

    Raises:
        OSError: the socket is closed.
    """
    if not sys.platform.startswith("linux"):
        return 0
    try:
        return asked(one, SIOCOUTQNSD)
    except OSError:  # a sandbox may not know this question
        return queued_bytes(one)


def asked(one: socket.socket, question: int) -> int:
    """Return the number with which the system answers a question about a socket."""
    try:
        import fcntl
    except ImportError:
        return 0
    return int.from_bytes(fcntl.ioctl(one, question, bytes(4)), sys.byteorder)
