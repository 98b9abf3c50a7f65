"""Read the output of all programs of a system, a bounded number of times per second."""

from __future__ import annotations

import asyncio
import os
import select
from contextlib import suppress
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.system._log import SystemLog

__all__ = ["OutputReader", "open_output"]

PAUSE_SEC: Final = 0.04
"""Time between two reads, in seconds. A program may write a hundred thousand single lines per
second, each of which would wake the loop.
"""

PIECE: Final = 1 << 16
"""Bytes that are read at once: the capacity of a new pipe. The allocator returns much larger
buffers to the system each time, and their page faults cost more than the copies.
"""

TERMINAL_PIECE: Final = 4095
"""Bytes of terminal output that Linux returns at once if there is more."""

LARGE_PIPE: Final = 1 << 20
"""New size of a pipe that was full, in bytes: the largest that an ordinary user may request."""

F_SETPIPE_SZ: Final = 1031
"""A constant of fcntl, which Python defines only on Linux."""


def open_output(*, terminal: bool) -> tuple[int, int]:
    """Create a pipe; return its read end, which does not block, and the end for a program.

    Args:
        terminal: Whether to create a terminal instead, to which programs write unbuffered and in
            colours.
    """
    if terminal:
        import termios  # not on Windows

        output, pipe = os.openpty()
        attributes = termios.tcgetattr(pipe)
        attributes[1] &= ~termios.OPOST  # line ends are not translated
        termios.tcsetattr(pipe, termios.TCSANOW, attributes)
    else:
        output, pipe = os.pipe()
    os.set_blocking(output, False)
    return output, pipe


class OutputReader:
    """Reads the pipes of programs into the log.

    All pipes are in one epoll, which the event loop watches. After each read it pauses for 40 ms,
    however much and often programs print. While the log accepts no more, nothing is read.

    Args:
        log: Receives the output.
    """

    def __init__(self, log: SystemLog) -> None:
        self._log = log
        self._loop = asyncio.get_running_loop()
        self._names: dict[int, str] = {}
        self._streams: dict[int, int] = {}
        self._listeners: dict[int, Callable[[bytes, int], object]] = {}
        self._epoll = select.epoll()
        self._large: set[int] = set()  # pipes that were full
        self._pause: asyncio.TimerHandle | None = None
        self._loop.add_reader(self._epoll.fileno(), self._turn)

    def add(
        self,
        pipe: int,
        name: str,
        stream: int = 1,
        listener: Callable[[bytes, int], object] | None = None,
    ) -> None:
        """Read a pipe from now on, until `remove`; it must not block.

        Args:
            pipe: The pipe.
            name: The member that prints to it.
            stream: 1 for standard output, 2 for standard error.
            listener: Called with everything read and with `stream`.
        """
        self._names[pipe], self._streams[pipe] = name, stream
        if listener is not None:
            self._listeners[pipe] = listener
        self._epoll.register(pipe, select.EPOLLIN)

    def remove(self, pipe: int) -> None:
        """Read the rest of a pipe, and close it."""
        while pipe in self._names and (self._read(pipe) or 0) > 0:
            pass
        name = self._names.pop(pipe, None)
        if name is not None:
            self._log.end_line(name, self._streams.pop(pipe))
            self._log.flush()
            self._listeners.pop(pipe, None)
            self._large.discard(pipe)
            with suppress(FileNotFoundError):  # it was already at its end
                self._epoll.unregister(pipe)
        os.close(pipe)

    def _turn(self) -> None:
        self._loop.remove_reader(self._epoll.fileno())
        for pipe, _ in self._epoll.poll(0):
            for _ in range(LARGE_PIPE // PIECE):
                count = self._read(pipe)
                if count not in {PIECE, TERMINAL_PIECE} or not self._log.flush():
                    break
            if count == 0:
                with suppress(FileNotFoundError):
                    self._epoll.unregister(pipe)  # end of file; `remove` closes it
        self._log.flush()
        self._pause = self._loop.call_later(PAUSE_SEC, self._resume)

    def _resume(self) -> None:
        if self._log.flush():
            self._loop.add_reader(self._epoll.fileno(), self._turn)
        else:
            self._pause = self._loop.call_later(PAUSE_SEC, self._resume)

    def _read(self, pipe: int) -> int | None:
        """Read once; return the number of bytes, 0 at the end of the pipe, None if it is empty."""
        try:
            output = os.read(pipe, PIECE)
        except BlockingIOError:
            return None
        except OSError:  # a terminal that nobody has open any more
            return 0
        if not output:
            return 0
        if len(output) == PIECE and pipe not in self._large:
            self._large.add(pipe)
            with suppress(OSError):  # the user's pipes have a limit
                import fcntl  # not on Windows

                fcntl.fcntl(pipe, F_SETPIPE_SZ, LARGE_PIPE)
        self._log.write(self._names[pipe], output, self._streams[pipe])
        if listener := self._listeners.get(pipe):
            # Deferred, so that its exceptions do not affect the programs whose output is read next.
            self._loop.call_soon(listener, output, self._streams[pipe])
        return len(output)

    def close(self) -> None:
        """Stop reading, and close the remaining pipes."""
        if self._pause is not None:
            self._pause.cancel()
        self._loop.remove_reader(self._epoll.fileno())
        for pipe in list(self._names):
            self.remove(pipe)
        self._epoll.close()
