"""Reading the output of all programs of a system, at a bounded number of turns each second."""

from __future__ import annotations

import asyncio
import os
import select
from contextlib import suppress
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from aionode.system._log import SystemLog

__all__ = ["OutputReader"]

PAUSE_SEC: Final = 0.04
"""Between two turns, in seconds. A program may write a line at a time, a hundred thousand a second:
each would wake the loop."""

SMALL_PIPE: Final = 1 << 16
"""How large a pipe is at first, in bytes."""

LARGE_PIPE: Final = 1 << 20
"""How large a pipe becomes that was full, in bytes: what an ordinary user may ask for."""

PIECE: Final = 1 << 18
"""How much of a large pipe is read at once, in bytes. The allocator gives buffers that are much
larger back to the system each time, whose pages cost more than the copy."""

F_SETPIPE_SZ: Final = 1031
"""Of fcntl; Python 3.10 has a name for it on Linux alone."""


class OutputReader:
    """Reads the pipes of programs into the log.

    All pipes are in one epoll, and the event loop watches that: after each turn it does not for
    40 ms, however many programs print however often. While the log takes no more, nothing is read.

    Args:
        log: Where the output goes.
    """

    def __init__(self, log: SystemLog) -> None:
        self._log = log
        self._loop = asyncio.get_running_loop()
        self._names: dict[int, str] = {}
        self._epoll = select.epoll()
        self._large: set[int] = set()  # pipes that were full
        self._pause: asyncio.TimerHandle | None = None
        self._loop.add_reader(self._epoll.fileno(), self._turn)

    def add(self, pipe: int, name: str) -> None:
        """Read a pipe from now on, until `remove`; it must not block."""
        self._names[pipe] = name
        self._epoll.register(pipe, select.EPOLLIN)

    def remove(self, pipe: int) -> None:
        """Read what is left in a pipe, and close it."""
        while pipe in self._names and (self._read(pipe) or 0) > 0:
            pass
        name = self._names.pop(pipe, None)
        if name is not None:
            self._log.end_line(name)
            self._log.flush()
            self._large.discard(pipe)
            with suppress(FileNotFoundError):  # it was at its end
                self._epoll.unregister(pipe)
        os.close(pipe)

    def _turn(self) -> None:
        self._loop.remove_reader(self._epoll.fileno())
        for pipe, _ in self._epoll.poll(0):
            count = self._read(pipe)
            for _ in range(LARGE_PIPE // PIECE - 1):
                if count != PIECE or not self._log.flush():
                    break
                count = self._read(pipe)
            if count == 0:
                with suppress(FileNotFoundError):
                    self._epoll.unregister(pipe)  # at its end; `remove` closes it
        self._log.flush()
        self._pause = self._loop.call_later(PAUSE_SEC, self._resume)

    def _resume(self) -> None:
        if self._log.flush():
            self._loop.add_reader(self._epoll.fileno(), self._turn)
        else:
            self._pause = self._loop.call_later(PAUSE_SEC, self._resume)

    def _read(self, pipe: int) -> int | None:
        """Read once, and return how many bytes: 0 at the end of the pipe, None if it is empty."""
        try:
            output = os.read(pipe, PIECE if pipe in self._large else SMALL_PIPE)
        except BlockingIOError:
            return None
        if not output:
            return 0
        if len(output) == SMALL_PIPE and pipe not in self._large:
            self._large.add(pipe)
            with suppress(OSError):  # the user's pipes have a limit
                import fcntl  # not on Windows

                fcntl.fcntl(pipe, F_SETPIPE_SZ, LARGE_PIPE)
        self._log.write(self._names[pipe], output)
        return len(output)

    def close(self) -> None:
        """Read no more; the pipes of programs that are left are closed."""
        if self._pause is not None:
            self._pause.cancel()
        self._loop.remove_reader(self._epoll.fileno())
        for pipe in list(self._names):
            self.remove(pipe)
        self._epoll.close()
