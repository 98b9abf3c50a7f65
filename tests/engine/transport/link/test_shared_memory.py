"""Large payloads are copied once, into memory that is reused, and read in place."""

from __future__ import annotations

import fcntl
import mmap
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from aionode.engine.transport.link import _shared_memory as shared_memory
from aionode.engine.transport.link._shared_memory import BufferMappings, BufferPool, SharedBuffer
from aionode.engine.wire import cdr
from aionode.errors import FrameError
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Header

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

pytestmark = pytest.mark.skipif(
    not hasattr(os, "memfd_create"), reason="memory is shared on Linux only"
)

SIZE = 100_000


@pytest.fixture
def pool() -> Iterator[BufferPool]:
    """Return a sender's memory pool."""
    one = BufferPool()
    yield one
    one.close()


def filled(pool: BufferPool, payload: bytes) -> SharedBuffer:
    """Return a buffer with a payload: memory is always available in these tests."""
    found = pool.filled((payload,), len(payload))
    assert found is not None
    return found


def given(one: SharedBuffer) -> int:
    """Return a descriptor as if it had come out of a socket."""
    return os.dup(one.fd)


class Done:
    """Counts how often a payload was released."""

    def __init__(self) -> None:
        self.count = 0

    def __call__(self) -> None:
        """Count one release."""
        self.count += 1


def descriptors() -> int:
    """Return how many descriptors this process has."""
    return len(list(Path("/proc/self/fd").iterdir()))


# The sender


def test_parts_are_put_together_in_the_memory(pool: BufferPool) -> None:
    """They are copied from where they are, and form one payload in the buffer."""
    parts: list[cdr.Data] = [b"abc", memoryview(bytes(5000)), bytearray(b"xyz")]

    one = pool.filled(parts, 5006)

    assert one is not None
    assert one.read(5006) == b"".join(parts)


@pytest.mark.parametrize("frame_id", ["", "a", "camera", "camera_link_optical_frame"])
def test_the_largest_part_is_aligned_for_its_reader(pool: BufferPool, frame_id: str) -> None:
    """Whatever precedes the pixels: numpy reads unaligned numbers at a third of the speed."""
    image = Image(data=bytes(SIZE), header=Header(frame_id=frame_id))
    parts = cdr.parts_encoder(Image)(image)
    one = pool.filled(parts)
    assert one is not None

    payload = BufferMappings().view(one.number, one.start, sum(map(len, parts)), given(one), Done())

    pixels = np.frombuffer(cdr.decode(Image, payload).data, np.uint8)
    assert pixels.ctypes.data % shared_memory.ALIGNMENT == 0
    assert bytes(payload) == b"".join(parts)


def test_memory_that_was_released_is_used_again(pool: BufferPool) -> None:
    """Its pages are already there, and its receivers already have its descriptor."""
    first = filled(pool, b"a" * SIZE)
    pool.release(first)

    second = filled(pool, b"b" * SIZE)

    assert second is first
    assert second.users == 1
    assert second.read(SIZE) == b"b" * SIZE


def test_memory_in_use_is_left_alone(pool: BufferPool) -> None:
    """Two receivers got it, and one of them is still reading."""
    first = filled(pool, b"a" * SIZE)
    first.users += 1
    pool.release(first)

    assert filled(pool, b"b" * SIZE) is not first
    assert first.read(SIZE) == b"a" * SIZE


def test_of_equal_memories_the_last_used_is_taken(pool: BufferPool) -> None:
    """It is the one most likely to be in the caches."""
    some = [filled(pool, bytes(SIZE)) for _ in range(3)]
    for number in (2, 0, 1):
        pool.release(some[number])

    assert filled(pool, bytes(SIZE)) is some[1]


def test_small_payloads_leave_large_memory_to_others(pool: BufferPool) -> None:
    """The smallest buffer that fits is taken, and none that is far too large."""
    large, middle = filled(pool, bytes(40 * SIZE)), filled(pool, bytes(2 * SIZE))
    pool.release(middle)
    pool.release(large)

    assert filled(pool, bytes(SIZE)) is middle
    assert filled(pool, bytes(SIZE)) is not large


def test_payloads_that_vary_a_little_share_a_memory(pool: BufferPool) -> None:
    """Compressed images do this: sizes are rounded up by a few percent."""
    sizes = range(1_000_000, 1_040_000, 1000)
    numbers = set()
    for size in sizes:
        one = filled(pool, bytes(size))
        numbers.add(one.number)
        pool.release(one)

    assert len(numbers) <= 2
    assert all(
        size <= shared_memory.rounded(size) <= size * 1.13 + shared_memory.PAGE for size in sizes
    )


def test_the_pool_keeps_few_and_says_which_it_closes(pool: BufferPool) -> None:
    """The least recently used one is closed, so that receivers can forget it."""
    closed: list[int] = []
    pool.listeners.add(closed.append)
    some = [filled(pool, bytes(SIZE)) for _ in range(shared_memory.MAX_IDLE_BUFFERS + 2)]
    before = descriptors()

    for one in some:
        pool.release(one)

    assert closed == [some[0].number, some[1].number]
    assert descriptors() == before - 4


def test_the_pool_keeps_a_limited_number_of_bytes(
    pool: BufferPool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A buffer larger than the limit does not replace the others."""
    monkeypatch.setattr(shared_memory, "MAX_IDLE_BYTES", 3 * SIZE)
    closed: list[int] = []
    pool.listeners.add(closed.append)
    small, huge, other = (filled(pool, bytes(size)) for size in (SIZE, 4 * SIZE, 2 * SIZE))

    pool.release(small)
    pool.release(huge)
    assert closed == [huge.number]

    pool.release(other)
    assert closed == [huge.number, small.number]


def test_memory_of_a_dead_receiver_is_not_used_again(pool: BufferPool) -> None:
    """Its process may still be reading it, and the other receivers must forget it."""
    closed: list[int] = []
    pool.listeners.add(closed.append)
    one = filled(pool, bytes(SIZE))
    one.retired = True

    pool.release(one)

    assert closed == [one.number]
    assert filled(pool, bytes(SIZE)).number != one.number


def test_a_closed_pool_keeps_nothing() -> None:
    """Memory in use is closed when it is returned."""
    before = descriptors()
    pool = BufferPool()
    idle, busy = filled(pool, bytes(SIZE)), filled(pool, bytes(SIZE))
    pool.release(idle)

    pool.close()
    pool.release(busy)

    assert descriptors() == before


def test_without_descriptors_there_is_no_memory(
    pool: BufferPool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The caller sends the bytes over the socket instead."""

    def exhausted(*_: Any) -> int:
        raise OSError(24, "Too many open files")

    monkeypatch.setattr(os, "memfd_create", exhausted)

    assert pool.filled([bytes(SIZE)], SIZE) is None


# The receiver


def test_a_payload_is_read_in_place(pool: BufferPool) -> None:
    """The receiver sees the sender's memory itself, to which only the sender can write."""
    one = filled(pool, b"a" * SIZE)
    mappings = BufferMappings()

    view = mappings.view(one.number, 0, SIZE, given(one), Done())
    one.fill([b"b"], 0)

    assert len(view) == SIZE
    assert bytes(view[:2]) == b"ba"
    assert view.readonly
    assert not np.frombuffer(view, np.uint8).flags.writeable


def test_the_second_time_a_number_is_enough(pool: BufferPool) -> None:
    """The mapping is kept: the same pages at the same address, for the whole memory."""
    one = filled(pool, b"a" * 1000)
    mappings = BufferMappings()
    first = np.frombuffer(mappings.view(one.number, 0, 1000, given(one), Done()), np.uint8)

    again = mappings.view(one.number, 0, one.size, None, Done())

    assert len(mappings) == 1
    assert len(again) == one.size
    assert np.shares_memory(first, np.frombuffer(again, np.uint8))


def a_slice(view: memoryview) -> object:
    """Return a slice of the view."""
    return view[10:20][1:3]


def a_cast(view: memoryview) -> object:
    """Return a slice of the view, cast to numbers."""
    return view[8:88].cast("Q").toreadonly()


def an_array(view: memoryview) -> object:
    """Return an array over a slice."""
    return np.frombuffer(view[8:88], np.uint64)


def an_array_of_an_array(view: memoryview) -> object:
    """Return an array over the object that the view is of."""
    return np.asarray(view)[3:].reshape(-1, 1)[5:].view(np.int8)


def an_image(view: memoryview) -> object:
    """Return the pixels of a message."""
    return cdr.decode(Image, view).data


@pytest.mark.parametrize("look", [a_slice, a_cast, an_array, an_array_of_an_array, an_image])
def test_a_payload_is_released_when_the_last_reference_to_it_is_gone(
    pool: BufferPool, look: Callable[[memoryview], object]
) -> None:
    """Views and arrays of any part keep it, but no other payload in the same memory."""
    payload = cdr.encode(Image(data=bytes(SIZE)))
    one = filled(pool, payload)
    mappings = BufferMappings()
    done, other = Done(), Done()
    view = mappings.view(one.number, 0, len(payload), given(one), done)
    kept = mappings.view(one.number, 0, len(payload), None, other)

    seen: object | None = look(view)
    del view
    assert done.count == 0
    assert seen is not None
    del seen
    assert done.count == 1
    assert other.count == 0
    assert len(kept) == len(payload)


def test_what_is_looked_at_outlives_its_mapping(pool: BufferPool) -> None:
    """Readers keep their memory when the sender closes it and when the link ends."""
    one = filled(pool, b"a" * SIZE)
    mappings = BufferMappings()
    done = Done()
    view = mappings.view(one.number, 0, SIZE, given(one), done)

    pool.close()
    pool.release(one)
    mappings.forget(one.number)
    mappings.close()

    assert len(mappings) == 0
    assert bytes(view) == b"a" * SIZE
    del view
    assert done.count == 0  # # the link is closed, so the sender cannot be informed


def test_a_forgotten_mapping_leaves_nothing_open(pool: BufferPool) -> None:
    """No descriptor and no page remains; forgetting an unknown buffer does nothing."""
    one = filled(pool, bytes(SIZE))
    before = descriptors_and_maps()
    mappings = BufferMappings()
    mappings.view(one.number, 0, SIZE, given(one), Done())
    assert descriptors_and_maps() != before

    mappings.forget(one.number)
    mappings.forget(one.number)

    assert descriptors_and_maps() == before


def descriptors_and_maps() -> tuple[int, int]:
    """Return how many descriptors and mappings of shared memory this process has."""
    return descriptors(), Path("/proc/self/maps").read_text().count("memfd:aionode")


def test_a_number_without_its_descriptor_is_refused(pool: BufferPool) -> None:
    """It was never mapped, or has been forgotten, so there is nothing to read."""
    one = filled(pool, bytes(SIZE))
    mappings = BufferMappings()
    mappings.view(one.number, 0, SIZE, given(one), Done())
    mappings.forget(one.number)

    for number in (one.number, 99):
        with pytest.raises(FrameError, match=r"descriptor of shared buffer .* is missing"):
            mappings.view(number, 0, SIZE, None, Done())


@pytest.mark.parametrize("size", [0, -1, 1 << 20, 1 << 63])
def test_a_payload_larger_than_its_memory_is_refused(pool: BufferPool, size: int) -> None:
    """With or without a descriptor: reading past the end would kill the process (SIGBUS)."""
    one = filled(pool, bytes(SIZE))
    mappings = BufferMappings()
    done = Done()
    with pytest.raises(FrameError, match="smaller"):
        mappings.view(one.number, 0, size, given(one), done)
    mappings.view(one.number, 0, SIZE, given(one), Done())

    with pytest.raises(FrameError, match="in a shared buffer of"):
        mappings.view(one.number, 0, size, None, done)
    with pytest.raises(FrameError, match="in a shared buffer of"):
        mappings.view(one.number, one.size, 1, None, done)
    assert done.count == 0


def unsealed() -> int:
    """Return memory that could shrink while it is being read."""
    fd = os.memfd_create("test", os.MFD_ALLOW_SEALING)
    os.ftruncate(fd, SIZE)
    return fd


def half_sealed() -> int:
    """Return memory that cannot grow, but could shrink."""
    fd = unsealed()
    fcntl.fcntl(fd, fcntl.F_ADD_SEALS, fcntl.F_SEAL_GROW)
    return fd


def empty() -> int:
    """Return memory of no size."""
    fd = os.memfd_create("test", os.MFD_ALLOW_SEALING)
    fcntl.fcntl(fd, fcntl.F_ADD_SEALS, shared_memory.SEALS)
    return fd


def a_file() -> int:
    """Return the descriptor of a regular file."""
    return os.open(__file__, os.O_RDONLY)


def a_pipe() -> int:
    """Return the descriptor of a pipe, which has no size."""
    read, write = os.pipe()
    os.close(write)
    return read


@pytest.mark.parametrize("make", [unsealed, half_sealed, empty, a_file, a_pipe])
def test_what_is_no_sealed_memory_is_refused(make: Callable[[], int]) -> None:
    """Its descriptor is closed, and nothing is kept."""
    fd = make()
    mappings = BufferMappings()

    with pytest.raises(FrameError, match=r"a shared buffer (cannot be mapped|is not sealed)"):
        mappings.view(1, 0, 100, fd, Done())

    assert len(mappings) == 0
    with pytest.raises(OSError, match="Bad file"):
        os.fstat(fd)


def test_only_the_sender_can_write_to_sealed_memory(pool: BufferPool) -> None:
    """A receiver that tries gets an error; the sender's mapping was made before the seal."""
    one = filled(pool, bytes(SIZE))

    with pytest.raises(PermissionError):
        mmap.mmap(one.fd, SIZE)


def test_numpy_is_imported_with_the_first_payload_only() -> None:
    """The import takes a tenth of a second, and processes with small messages never need it."""
    code = "import sys, aionode.engine.transport.link._shared_memory as m; m.BufferPool()"
    code += "; m.BufferMappings(); assert 'numpy' not in sys.modules"

    subprocess.run([sys.executable, "-c", code], check=True)
