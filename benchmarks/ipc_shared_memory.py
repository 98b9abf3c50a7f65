"""The size from which a payload should use shared memory, and what that costs.

Two processes send each other images over a Unix socket, alternating between two ways: all bytes
through the socket, encoded into one piece and read by `FrameParser`; or copied into memory mapped
by both, with a frame that only refers to it. Both processes run an asyncio loop and read and write
like a link, and do nothing else. The receiver decodes each image and reads all of it in place,
which takes time too.

The table gives half a round trip for each size, and the size from which memory is cheaper:
`SHARED_FROM` in ``aionode/engine/transport/link/_shared_memory.py``. After it comes the cost of
each step for 4 MB.

Run it with ``python benchmarks/ipc_shared_memory.py``; ``--quick`` takes a fifth of the time. It
prints the table and writes ``link_memory.json`` to ``benchmarks/results/``.
"""

from __future__ import annotations

import argparse
import array
import asyncio
import json
import os
import platform
import socket
import statistics
import subprocess
import sys
import time
from collections import defaultdict
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from aionode.engine.transport.link import _protocol as protocol
from aionode.engine.transport.link._protocol import BufferRef, FrameParser, Kind
from aionode.engine.transport.link._shared_memory import (
    SHARED_FROM,
    BufferMappings,
    BufferPool,
    SharedBuffer,
)
from aionode.engine.wire import cdr
from aionode.interfaces.sensor_msgs.msg import Image

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SIZES: Final = [1 << exponent for exponent in range(12, 21)]
LARGE: Final = 4_000_000
WARM_UP: Final = 20
# only the last ones count, because the first find the memory of the other way in the caches
TURN: Final = 3
READ_BYTES: Final = 1 << 15  # like a link's reads
READ_MAX: Final = 1 << 20
GID: Final = bytes(protocol.GID_SIZE)
RESULTS: Final = Path(__file__).parent / "results"

ENCODE: Final = cdr.encoder(Image)
ENCODE_PARTS: Final = cdr.parts_encoder(Image)
DECODE: Final = cdr.decoder(Image)


class End:
    """One end of the socket, which sends and receives images in either way.

    Args:
        sock: Connected.
        on_image: Called after each image, with its size, and whether it came in memory.

    Attributes:
        noting: Whether steps are noted.
        steps: How long each step of an image in memory took, in nanoseconds.
    """

    def __init__(self, sock: socket.socket, on_image: Callable[[int, bool], None]) -> None:
        self.noting = False
        self.steps: defaultdict[str, list[int]] = defaultdict(list)
        self._sock = sock
        self._on_image = on_image
        self._parser = FrameParser()
        self._pool = BufferPool()
        self._mappings = BufferMappings()
        self._lent: dict[int, SharedBuffer] = {}
        self._known: set[int] = set()
        self._returned: list[int] = []
        self._began_ns = 0
        self._rest = memoryview(b"")
        self._loop = asyncio.get_running_loop()
        self.closed: asyncio.Future[None] = self._loop.create_future()
        sock.setblocking(False)
        self._loop.add_reader(sock, self._on_readable)

    def step(self, name: str) -> None:
        """Record the time since the last step."""
        if self.noting:
            self.steps[name].append(time.perf_counter_ns() - self._began_ns)
        self._began_ns = time.perf_counter_ns()

    def send(self, msg: Image, *, shared: bool) -> None:
        """Send one image."""
        self._began_ns = time.perf_counter_ns()
        if not shared:
            self._rest = memoryview(protocol.pack(Kind.DATA, 0, 0, GID, ENCODE(msg)))
            if not self._send_rest():
                self._loop.add_writer(self._sock, self._on_writable)
            return
        parts = ENCODE_PARTS(msg)
        size = sum(map(len, parts))
        self.step("encode")
        buffer = self._pool.filled(parts, size)
        assert buffer is not None  # noqa: S101  # there are descriptors enough
        self.step("copy")
        self._lent[buffer.number] = buffer
        place = BufferRef(buffer.number, buffer.start, size).pack()
        data = b"".join(protocol.pack(Kind.RELEASE, number, 0, GID) for number in self._returned)
        data += protocol.pack(Kind.DATA, 0, 0, GID, place, in_shm=True)
        self._returned.clear()
        if buffer.number in self._known:
            self._sock.send(data)
        else:
            self._known.add(buffer.number)
            socket.send_fds(self._sock, [data], [buffer.fd])
        self.step("send")

    def _send_rest(self) -> bool:
        """Send as much as the socket accepts; return whether that was all."""
        with suppress(BlockingIOError):
            self._rest = self._rest[self._sock.send(self._rest) :]
        return not self._rest

    def _on_writable(self) -> None:
        if self._send_rest():
            self._loop.remove_writer(self._sock)

    def _on_readable(self) -> None:
        space = socket.CMSG_SPACE(array.array("i").itemsize)
        wanted = max(READ_BYTES, min(self._parser.missing, READ_MAX))
        self._began_ns = time.perf_counter_ns()
        data, ancillary, _, _ = self._sock.recvmsg(wanted, space)
        if not data:
            self._loop.remove_reader(self._sock)
            self.closed.set_result(None)
        for one in self._parser.feed(data):
            if one.kind == Kind.RELEASE:
                self._pool.release(self._lent.pop(one.sequence))
                continue
            if one.in_shm:
                self.step("receive")
            size = self._read(one, ancillary)
            self._on_image(size, one.in_shm)

    def _read(self, one: protocol.Frame, ancillary: Any) -> int:
        """Decode an image, read all of its data, and return its size."""
        if not one.in_shm:
            data = DECODE(one.payload).data
            np.frombuffer(data, np.uint64).max()
            return len(data)
        ref = BufferRef.unpack(one.payload)
        fd = int.from_bytes(ancillary[0][2], sys.byteorder) if ancillary else None
        returned = self._returned
        view = self._mappings.view(
            ref.number, ref.start, ref.size, fd, lambda: returned.append(ref.number)
        )
        self.step("view")
        data = DECODE(view).data
        self.step("decode")
        np.frombuffer(data, np.uint64).max()
        self.step("read all of it")
        return len(data)


def image_of(size: int) -> Image:
    """Return an image whose pixels take a number of bytes."""
    return Image(height=1, width=size, step=size, data=bytes([1]) * size)


async def echo(fd: int) -> None:
    """Send back images in the size and way they arrive, until the socket is closed."""
    sizes = {size: image_of(size) for size in (*SIZES, LARGE)}
    end = End(socket.socket(fileno=fd), lambda size, shared: end.send(sizes[size], shared=shared))
    await end.closed


async def play(end: End, answers: asyncio.Event, msg: Image, *, shared: bool) -> float:
    """Return half a round trip, in microseconds."""
    answers.clear()
    began_ns = time.perf_counter_ns()
    end.send(msg, shared=shared)
    await answers.wait()
    return (time.perf_counter_ns() - began_ns) / 2e3


@contextmanager
def other_process() -> Iterator[socket.socket]:
    """Run the answering process meanwhile."""
    ours, theirs = socket.socketpair()
    command = [sys.executable, __file__, "--echo", str(theirs.fileno())]
    with ours, theirs, subprocess.Popen(command, pass_fds=[theirs.fileno()]) as process:  # noqa: S603  # this file
        theirs.close()
        yield ours
        ours.close()
        process.wait()


async def measure(scale: int) -> dict[str, Any]:
    """Return the table, the crossover size, and the steps."""
    rows: list[dict[str, Any]] = []
    answers = asyncio.Event()
    with other_process() as sock:
        end = End(sock, lambda *_: answers.set())
        for size in (*SIZES, LARGE):
            msg = image_of(size)
            found: dict[bool, list[float]] = {False: [], True: []}
            for number in range(WARM_UP + 60 * scale):
                for shared, times in found.items():
                    for turn in range(TURN):
                        end.noting = turn == TURN - 1 and number >= WARM_UP and size == LARGE
                        took_us = await play(end, answers, msg, shared=shared)
                    if number >= WARM_UP:
                        times.append(took_us)
            through, over = (round(statistics.median(found[route]), 1) for route in (False, True))
            rows.append({"bytes": size, "socket_us": through, "memory_us": over})
        asyncio.get_running_loop().remove_reader(sock)
    steps = {name: round(statistics.median(times) / 1e3, 1) for name, times in end.steps.items()}
    steps["waking, and the rest"] = round(rows[-1]["memory_us"] - sum(steps.values()), 1)
    cheaper = [row["memory_us"] < row["socket_us"] for row in rows]
    first = next((n for n in range(len(rows)) if all(cheaper[n:])), None)
    return {
        "rows": rows,
        "memory_is_cheaper_from": None if first is None else rows[first]["bytes"],
        "shared_from": SHARED_FROM,
        "steps_of_4_MB_us": steps,
    }


def main() -> None:
    """Measure, print the table and write the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a fifth of the messages")
    parser.add_argument("--echo", type=int, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.echo is not None:
        asyncio.run(echo(args.echo))
        return
    result = asyncio.run(measure(1 if args.quick else 5))
    print(f"{'bytes':>9} {'socket':>12} {'memory':>12}")
    for row in result["rows"]:
        print(f"{row['bytes']:9} {row['socket_us']:9.1f} µs {row['memory_us']:9.1f} µs")
    print(f"memory is cheaper from {result['memory_is_cheaper_from']} bytes on")
    print("an image of 4 MB over memory consists of:")
    for name, took_us in result["steps_of_4_MB_us"].items():
        print(f"  {name:25} {took_us:9.1f} µs")
    RESULTS.mkdir(exist_ok=True)
    result |= {
        "python": platform.python_version(),
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
    }
    (RESULTS / "link_memory.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
