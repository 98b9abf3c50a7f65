"""Large payloads: in memory that two processes share, handed over as a descriptor.

The sender copies a payload into memory that it keeps and uses again, because fresh pages cost more
than the copy. Sealed, it can neither shrink nor be written to by whoever receives it. The receiver
maps it read-only and decodes in place; when the last array that looks at it is gone, the memory
goes back to the sender.
"""

from __future__ import annotations

import fcntl
import mmap
import os
import weakref
from itertools import count
from typing import TYPE_CHECKING, Final

from aionode.errors import FrameError

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["SHARED_FROM", "Memory", "Pool", "mapped"]

SHARED_FROM: Final = 1 << 16
"""From this size on, in bytes, a payload is shared: below it costs less to send it."""

MAX_IDLE: Final = 1 << 26
"""How much memory is kept for later, in bytes."""

F_SEAL_FUTURE_WRITE: Final = 0x0010
"""Linux 5.1: nobody can make another writable mapping. Python does not name it."""

SEALS: Final = fcntl.F_SEAL_SHRINK | fcntl.F_SEAL_GROW if hasattr(fcntl, "F_SEAL_SHRINK") else 0
PAGE: Final = mmap.PAGESIZE


class Memory:
    """A piece of memory and its descriptor.

    Attributes:
        number: Its name in `Place` and `RELEASE`.
        fd: Its descriptor.
        users: How many queues and receivers hold it.
        spoiled: Whether a receiver may look at it for ever: it is not used again.
    """

    __slots__ = ("_map", "fd", "number", "spoiled", "users")

    def __init__(self, number: int, size: int) -> None:
        self.number = number
        self.users = 0
        self.spoiled = False
        self.fd = os.memfd_create("aionode", os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
        try:
            os.ftruncate(self.fd, size)
            self._map = mmap.mmap(self.fd, size)
            fcntl.fcntl(self.fd, fcntl.F_ADD_SEALS, SEALS | F_SEAL_FUTURE_WRITE)
        except OSError:
            os.close(self.fd)
            raise

    def __len__(self) -> int:
        return len(self._map)

    def fill(self, payload: bytes) -> None:
        """Copy `payload` to the beginning."""
        self._map[: len(payload)] = payload

    def close(self) -> None:
        """Give it back to the system; who has mapped it keeps it."""
        self._map.close()
        os.close(self.fd)


class Pool:
    """The memory of one sender."""

    def __init__(self) -> None:
        self._numbers = count(1)
        self._idle: list[Memory] = []
        self._closed = False

    def filled(self, payload: bytes) -> Memory | None:
        """Return memory that holds `payload` for its first user; None if the system has none."""
        size = len(payload)
        fitting = [one for one in self._idle if size <= len(one) <= 4 * size + PAGE]
        if fitting:
            memory = min(fitting, key=len)
            self._idle.remove(memory)
        else:
            try:
                memory = Memory(next(self._numbers), -(-size // PAGE) * PAGE)
            except OSError:  # no descriptors or no memory left: it is sent without
                return None
        memory.fill(payload)
        memory.users = 1
        return memory

    def release(self, memory: Memory) -> None:
        """Note that one user is done with `memory`."""
        memory.users -= 1
        if memory.users:
            return
        if self._closed or memory.spoiled or sum(map(len, self._idle)) + len(memory) > MAX_IDLE:
            memory.close()
        else:
            self._idle.append(memory)

    def close(self) -> None:
        """Give back what is idle now, and the rest when it is released."""
        self._closed = True
        while self._idle:
            self._idle.pop().close()


def mapped(fd: int, size: int, done: Callable[[], object]) -> memoryview:
    """Return the first `size` bytes behind `fd`, read-only; `fd` is closed.

    Args:
        fd: A descriptor from another process.
        size: How much of it to map.
        done: Called, on any thread, when nobody looks at the memory any more.

    Raises:
        FrameError: it is no sealed memory of this size.
    """
    try:
        seals = fcntl.fcntl(fd, fcntl.F_GET_SEALS)
        if not size or seals & SEALS != SEALS or os.fstat(fd).st_size < size:
            raise FrameError(f"memory that is not sealed, or smaller than {size} bytes")
        memory = mmap.mmap(fd, size, flags=mmap.MAP_SHARED, prot=mmap.PROT_READ)
    except OSError as error:
        raise FrameError(f"memory that cannot be mapped: {error}") from error
    finally:
        os.close(fd)
    weakref.finalize(memory, done).atexit = False
    return memoryview(memory)
