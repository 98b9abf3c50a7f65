"""Shared memory for large payloads.

The sender copies a payload once into a buffer that it keeps and reuses, because fresh pages cost
far more than the copy. The buffer is sealed: it cannot shrink, and its receivers cannot write to
it. The first frame to a process carries the buffer's descriptor; the receiver maps the buffer
read-only, decodes in place, and keeps the mapping, so later frames only contain the buffer's
number. When the last array that refers to a payload is gone, the receiver releases the buffer.

The largest part of a payload, such as the pixels of an image, starts at a multiple of `ALIGNMENT`:
reading 4 MB as 64-bit numbers takes numpy three times as long if they are not aligned.
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

with suppress(ImportError):  # on Windows, which has no links, but imports this module anyway
    import fcntl

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.engine.wire.cdr import Data

__all__ = ["SHARED_FROM", "BufferMappings", "BufferPool", "SharedBuffer"]

SHARED_FROM: Final = 1 << 17
"""Size from which a payload is shared, in bytes; smaller ones are cheaper to send.

Shared vs. sent, by `benchmarks/ipc_shared_memory.py`: 210 µs vs. 210 at this size, 320 vs. 1030 at
twice the size, which a socket does not accept at once, and 157 vs. 148 at half the size.
"""

MAX_IDLE_BYTES: Final = 1 << 26
"""Maximum number of bytes to keep in idle buffers."""

MAX_IDLE_BUFFERS: Final = 8
"""Maximum number of idle buffers; each takes two descriptors, and one in the other process."""

STEPS: Final = 8
"""Number of buffer sizes between two powers of two.

Payloads whose size varies slightly, like compressed images, then fit into the same buffer.
"""

MAX_MAPPINGS: Final = 400
"""Maximum mapped buffers of one sender, which lends fewer, and keeps a few idle."""

F_SEAL_FUTURE_WRITE: Final = 0x0010
"""Linux 5.1: no further writable mappings can be created. Python has no name for it."""

SEALS: Final = 0x0002 | 0x0004
"""F_SEAL_SHRINK and F_SEAL_GROW of Linux; Python on other systems has no names for them."""

PAGE: Final = mmap.PAGESIZE

ALIGNMENT: Final = 64
"""Alignment of a payload's largest part in bytes: a cache line, and the widest vector."""


# Sending


class SharedBuffer:
    """A piece of shared memory and its descriptor.

    Attributes:
        number: Identifies it in `BufferRef`, `Release` and `Forget`; unique within the pool,
            forever.
        size: Its size in bytes.
        fd: Its descriptor.
        start: Where its payload starts, in bytes.
        users: Number of queues and receivers that hold it.
        retired: Whether it must not be reused, as a receiver may never release it.
    """

    __slots__ = ("_map", "fd", "number", "retired", "size", "start", "users")

    def __init__(self, number: int, size: int) -> None:
        self.number = number
        self.size = size
        self.start = 0
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

    def fill(self, parts: Sequence[Data], start: int) -> None:
        """Copy `parts`, which must fit, one after the other, from `start` on."""
        self.start = place = start
        for part in parts:
            end = place + len(part)
            self._map[place:end] = part
            place = end

    def read(self, size: int) -> bytes:
        """Return a copy of the payload of `size` bytes, to send it without the buffer."""
        return self._map[self.start : self.start + size]

    def close(self) -> None:
        """Unmap the buffer; processes that have mapped it can still read it."""
        self._map.close()
        os.close(self.fd)


SIZE_OF: Final = attrgetter("size")


class BufferPool:
    """The buffers of one sender.

    Attributes:
        listeners: Called with the number of each closed buffer, so that receivers can be told to
            forget it. Each open connection has one.
    """

    def __init__(self) -> None:
        self.listeners: set[Callable[[int], object]] = set()
        self._numbers = count(1)
        # Unused buffers, most recently used last: from their release until they are filled again or
        # closed.
        self._idle: list[SharedBuffer] = []
        self._closed = False

    def filled(self, parts: Data | Sequence[Data], size: int | None = None) -> SharedBuffer | None:
        """Return a buffer with a payload, held by one user; None if the system is out of memory.

        Args:
            parts: The payload, or its parts, which must be buffers of single bytes.
            size: The size of all parts together, in bytes.
        """
        if isinstance(parts, bytes | bytearray | memoryview):
            parts = (parts,)
        if size is None:
            size = sum(map(len, parts))
        start = start_of(parts)
        buffer = self._taken(start + size)
        if buffer is None:
            try:
                buffer = SharedBuffer(next(self._numbers), rounded(start + size))
            except OSError:  # out of descriptors or memory: the payload goes through the stream
                return None
        buffer.fill(parts, start)
        buffer.users = 1
        return buffer

    def _taken(self, size: int) -> SharedBuffer | None:
        """Return the best-fitting idle buffer, preferring the last used, which caches may hold."""
        fitting = [
            buffer for buffer in reversed(self._idle) if size <= buffer.size <= 4 * size + PAGE
        ]
        if not fitting:
            return None
        buffer = min(fitting, key=SIZE_OF)
        self._idle.remove(buffer)
        return buffer

    def release(self, buffer: SharedBuffer) -> None:
        """Remove one user of `buffer`; without users it becomes idle or is closed."""
        buffer.users -= 1
        if buffer.users:
            return
        if self._closed or buffer.retired or buffer.size > MAX_IDLE_BYTES:
            self._close(buffer)
            return
        self._idle.append(buffer)
        while len(self._idle) > MAX_IDLE_BUFFERS or sum(map(SIZE_OF, self._idle)) > MAX_IDLE_BYTES:
            self._close(self._idle.pop(0))

    def _close(self, buffer: SharedBuffer) -> None:
        buffer.close()
        for listener in tuple(self.listeners):
            listener(buffer.number)

    def close(self) -> None:
        """Close the idle buffers now, and the others when they are released."""
        self._closed = True
        while self._idle:
            self._close(self._idle.pop())


def start_of(parts: Sequence[Data]) -> int:
    """Return where a payload has to start for its largest part to be aligned, in bytes."""
    sizes = [len(part) for part in parts]
    return -sum(sizes[: sizes.index(max(sizes))]) % ALIGNMENT


def rounded(size: int) -> int:
    """Return the buffer size for `size` bytes; unused pages cost nothing."""
    step = max(PAGE, (1 << size.bit_length()) // (2 * STEPS))
    return -(-size // step) * step


# Receiving


class BufferMappings:
    """The buffers of one sender that are mapped by its receiver.

    A mapping is kept until the sender closes its buffer or the link ends, so that pages are mapped
    once, not for each payload. The sender decides how many there are: it keeps few idle ones
    (`BufferPool`) besides those still being read here.
    """

    def __init__(self) -> None:
        # By buffer number, from its first frame until `forget` or `close`.
        self._maps: dict[int, mmap.mmap] = {}
        # By the id of a weak reference to a payload, which this keeps alive: the reference, and
        # what to call when the payload is gone. One is added per payload.
        self._watched: dict[int, tuple[weakref.ref[Any], Callable[[], object]]] = {}

    def __len__(self) -> int:
        return len(self._maps)

    def view(
        self, number: int, start: int, size: int, fd: int | None, done: Callable[[], object]
    ) -> memoryview:
        """Return a payload in a buffer, read-only.

        Args:
            number: The buffer's number.
            start: Where the payload starts in it, in bytes.
            size: The size of the payload in bytes.
            fd: The buffer's descriptor, if it came with the frame; it is closed.
            done: Called once, on any thread, when nothing refers to this payload any more: no view,
                no slice of one, and no array made from one. Not called if this raises, nor after
                `close`.

        Raises:
            FrameError: the buffer is unknown or not sealed, or the payload is not within it.
        """
        if fd is not None:
            if len(self._maps) >= MAX_MAPPINGS:
                os.close(fd)
                raise FrameError(f"more than {MAX_MAPPINGS} shared buffers")
            self._maps[number] = sealed_map(fd, start + size)
        mapping = self._maps.get(number)
        if mapping is None:
            raise FrameError(f"the descriptor of shared buffer {number} is missing")
        if not 0 < size <= len(mapping) - start:
            raise FrameError(
                f"a payload of {size} bytes from byte {start} on, in a shared buffer of "
                f"{len(mapping)}"
            )
        import numpy as np

        # A slice of a view only keeps the object behind the view alive. So each payload gets an
        # object of its own that can be weakly referenced; payloads share a mapping.
        payload: Any = np.frombuffer(mapping, np.uint8, size, start)
        watch = weakref.ref(payload, self._on_gone)  # weakref.finalize costs three times as much
        self._watched[id(watch)] = watch, done
        return memoryview(payload)

    def _on_gone(self, watch: weakref.ref[Any]) -> None:
        watched = self._watched.pop(id(watch), None)
        if watched is not None:
            watched[1]()

    def forget(self, number: int) -> None:
        """Drop the mapping of a buffer that its sender has closed; views of it stay valid."""
        self._maps.pop(number, None)

    def close(self) -> None:
        """Drop all mappings; views stay valid."""
        self._maps.clear()
        self._watched.clear()


def sealed_map(fd: int, size: int) -> mmap.mmap:
    """Map the whole buffer behind `fd` read-only, and close `fd`.

    Pages are mapped when they are read: `MAP_POPULATE` takes just as long.

    Raises:
        FrameError: it is not a sealed buffer of at least `size` bytes. Reading one that shrinks
            would kill the process.
    """
    try:
        seals = fcntl.fcntl(fd, fcntl.F_GET_SEALS)
        whole = os.fstat(fd).st_size
        fits = seals & SEALS == SEALS and 0 < size <= whole
        mapping = mmap.mmap(fd, whole, mmap.MAP_SHARED, mmap.PROT_READ) if fits else None
    except OSError as error:
        raise FrameError(f"a shared buffer cannot be mapped: {error}") from error
    finally:
        os.close(fd)
    if mapping is None:
        raise FrameError(f"a shared buffer is not sealed, or smaller than {size} bytes")
    return mapping
