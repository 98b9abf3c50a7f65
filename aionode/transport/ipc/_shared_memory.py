"""Large payloads: in memory that two processes share, and say the place of.

The sender copies a payload, once, into memory that it keeps and uses again, because fresh pages
cost far more than the copy. Sealed, the memory can neither shrink nor be written to by whoever
receives it. The first frame to a process brings the descriptor; the receiver maps the memory
read-only, decodes in place, and keeps the mapping, so that later frames bring a number only. When
the last array that looks at a payload is gone, the receiver gives the memory back.
"""

from __future__ import annotations

import mmap
import os
import weakref
from contextlib import suppress
from itertools import count
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import FrameError

with suppress(ImportError):  # of Windows, where nobody links, but this is imported all the same
    import fcntl

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.wire.cdr import Data

__all__ = ["SHARED_FROM", "BufferMappings", "BufferPool", "SharedBuffer"]

SHARED_FROM: Final = 1 << 17
"""From this size on, in bytes, a payload is shared: below it costs less to send it.

As `benchmarks/ipc_shared_memory.py` measures it: 210 µs against 210 at this size, 320 against 1030
at twice that, which is more than the buffer of a socket takes at once, and 157 against 148 at half.
"""

MAX_IDLE: Final = 1 << 26
"""How much memory is kept for later, in bytes."""

MOST_IDLE: Final = 8
"""How many pieces of memory are kept for later; each takes two descriptors, and one at the peer."""

STEPS: Final = 8
"""How many sizes of memory there are between a power of two and the next.

Payloads whose size varies a little, as of compressed images, then fit where another one was.
"""

MAX_MAPPINGS: Final = 400
"""How many pieces of memory one sender may give; it lends fewer, and keeps a few."""

F_SEAL_FUTURE_WRITE: Final = 0x0010
"""Linux 5.1: nobody can make another writable mapping. Python does not name it."""

SEALS: Final = 0x0002 | 0x0004
"""F_SEAL_SHRINK and F_SEAL_GROW of Linux, which other systems do not name."""

PAGE: Final = mmap.PAGESIZE


# Sending


class SharedBuffer:
    """A piece of memory and its descriptor.

    Attributes:
        number: Its name in `BufferRef` and `RELEASE`; no other memory of the pool ever has it.
        size: How many bytes it has room for.
        fd: Its descriptor.
        users: How many queues and receivers hold it.
        retired: Whether a receiver may look at it for ever: it is not used again.
    """

    __slots__ = ("_map", "fd", "number", "retired", "size", "users")

    def __init__(self, number: int, size: int) -> None:
        self.number = number
        self.size = size
        self.users = 0
        self.retired = False
        self.fd = os.memfd_create("aionode", os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
        try:
            os.ftruncate(self.fd, size)
            self._map = mmap.mmap(self.fd, size)
            fcntl.fcntl(self.fd, fcntl.F_ADD_SEALS, SEALS | F_SEAL_FUTURE_WRITE)
        except OSError:
            os.close(self.fd)
            raise

    def fill(self, parts: Sequence[Data]) -> None:
        """Copy `parts` to the beginning, one after the other; they fit."""
        place = 0
        for part in parts:
            end = place + len(part)
            self._map[place:end] = part
            place = end

    def read(self, size: int) -> bytes:
        """Return a copy of the first `size` bytes, for where the memory itself cannot go."""
        return self._map[:size]

    def close(self) -> None:
        """Give it back to the system; who has mapped it keeps it."""
        self._map.close()
        os.close(self.fd)


SIZE_OF: Final = attrgetter("size")


class BufferPool:
    """The memory of one sender.

    Attributes:
        listeners: Called with the number of each memory that is closed, so that who was given it
            can be told to forget its mapping.
    """

    def __init__(self) -> None:
        self.listeners: set[Callable[[int], object]] = set()
        self._numbers = count(1)
        self._idle: list[SharedBuffer] = []  # the last used last
        self._closed = False

    def filled(self, parts: Data | Sequence[Data], size: int | None = None) -> SharedBuffer | None:
        """Return memory that holds a payload for its first user; None if the system has none.

        Args:
            parts: The payload, or what it consists of, each of single bytes.
            size: Of all parts together, in bytes.
        """
        if isinstance(parts, bytes | bytearray | memoryview):
            parts = (parts,)
        if size is None:
            size = sum(map(len, parts))
        buffer = self._taken(size)
        if buffer is None:
            try:
                buffer = SharedBuffer(next(self._numbers), rounded(size))
            except OSError:  # no descriptors or no memory left: it is sent without
                return None
        buffer.fill(parts)
        buffer.users = 1
        return buffer

    def _taken(self, size: int) -> SharedBuffer | None:
        """Return the idle memory that fits best; the last used of those, as caches know it."""
        fitting = [one for one in reversed(self._idle) if size <= one.size <= 4 * size + PAGE]
        if not fitting:
            return None
        buffer = min(fitting, key=SIZE_OF)
        self._idle.remove(buffer)
        return buffer

    def release(self, buffer: SharedBuffer) -> None:
        """Note that one user is done with `buffer`."""
        buffer.users -= 1
        if buffer.users:
            return
        if self._closed or buffer.retired or buffer.size > MAX_IDLE:
            self._close(buffer)
            return
        self._idle.append(buffer)
        while len(self._idle) > MOST_IDLE or sum(map(SIZE_OF, self._idle)) > MAX_IDLE:
            self._close(self._idle.pop(0))

    def _close(self, buffer: SharedBuffer) -> None:
        buffer.close()
        for listener in tuple(self.listeners):
            listener(buffer.number)

    def close(self) -> None:
        """Give back what is idle now, and the rest when it is released."""
        self._closed = True
        while self._idle:
            self._close(self._idle.pop())


def rounded(size: int) -> int:
    """Return how large memory for `size` bytes is made; pages that are not used cost nothing."""
    step = max(PAGE, (1 << size.bit_length()) // (2 * STEPS))
    return -(-size // step) * step


# Receiving


class BufferMappings:
    """The memory of one sender, as its receiver has mapped it.

    A mapping is kept until the sender forgets its memory or the link ends: its pages are looked up
    once, not for each payload. How many there are is up to the sender, which keeps few
    (`BufferPool`) beside those that somebody here still looks at.
    """

    def __init__(self) -> None:
        self._maps: dict[int, mmap.mmap] = {}
        # By the identity of the reference, which this keeps alive.
        self._watched: dict[int, tuple[weakref.ref[Any], Callable[[], object]]] = {}

    def __len__(self) -> int:
        return len(self._maps)

    def view(
        self, number: int, size: int, fd: int | None, done: Callable[[], object]
    ) -> memoryview:
        """Return the first `size` bytes of a memory, read-only.

        Args:
            number: The memory's, from its sender.
            size: Of the payload.
            fd: The memory's descriptor, if it came with the frame; it is closed.
            done: Called once, on any thread, when nothing looks at this payload any more: no view,
                no slice of one, and no array made of one. Not called if this raises, nor after
                `close`.

        Raises:
            FrameError: the memory is not known, not sealed, or smaller than `size`.
        """
        if fd is not None:
            if len(self._maps) >= MAX_MAPPINGS:
                os.close(fd)
                raise FrameError(f"more than {MAX_MAPPINGS} pieces of memory")
            self._maps[number] = sealed_map(fd, size)
        found = self._maps.get(number)
        if found is None:
            raise FrameError(f"memory {number}, whose descriptor never came")
        if not 0 < size <= len(found):
            raise FrameError(f"{size} bytes in a memory of {len(found)}")
        import numpy as np

        # Slices of a view keep alive only what it is a view of. Each payload has one of its own,
        # which also can say when it goes; neither holds for the mapping.
        payload: Any = np.frombuffer(found, np.uint8, size)
        watch = weakref.ref(payload, self._on_gone)  # weakref.finalize costs three times as much
        self._watched[id(watch)] = watch, done
        return memoryview(payload)

    def _on_gone(self, watch: weakref.ref[Any]) -> None:
        watched = self._watched.pop(id(watch), None)
        if watched is not None:
            watched[1]()

    def forget(self, number: int) -> None:
        """Drop the mapping of a memory that its sender has closed; views of it stay valid."""
        self._maps.pop(number, None)

    def close(self) -> None:
        """Drop all; views stay valid."""
        self._maps.clear()
        self._watched.clear()


def sealed_map(fd: int, size: int) -> mmap.mmap:
    """Return all that is behind `fd`, at least `size` bytes, read-only; `fd` is closed.

    Pages are left to be found when they are read: `MAP_POPULATE` takes as long as that does.

    Raises:
        FrameError: it is no sealed memory of this size. Reading one that shrinks ends the process.
    """
    try:
        seals = fcntl.fcntl(fd, fcntl.F_GET_SEALS)
        whole = os.fstat(fd).st_size
        fits = seals & SEALS == SEALS and 0 < size <= whole
        found = mmap.mmap(fd, whole, mmap.MAP_SHARED, mmap.PROT_READ) if fits else None
    except OSError as error:
        raise FrameError(f"memory that cannot be mapped: {error}") from error
    finally:
        os.close(fd)
    if found is None:
        raise FrameError(f"memory that is not sealed, or smaller than {size} bytes")
    return found
