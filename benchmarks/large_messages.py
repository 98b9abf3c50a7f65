"""What large messages cost beside the copy: the recorder and the gateway, and many readers.

- An image of 6 MB goes from a driver to another process with a recorder and a gateway, which sends
  it to one client (cbor-raw), over a link, over Zenoh, and within one process. For each image: the
  processor time of the event loop's thread and of the whole process, the fresh memory that the
  thread touched (its page faults), and the longest processor time of a single callback of the loop.
- An image of 4 MB goes over links to one process and to five, in turns; each reads all of it, or
  nothing, and answers with a small message. For each image: the processor time of the publisher,
  and the time until the last answer. An image of 10 bytes shows how much of it is for any message,
  and "bare" how much for any program: a copy into shared memory, and a line in a pipe to each
  reader and back.

To compare two versions, run it in turns with ``PYTHONPATH`` set to either.

Run it with ``python benchmarks/large_messages.py``; it takes about a minute, and ``--quick`` a
third of that.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import logging
import mmap
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import AsyncExitStack, ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from aionode import Context, Node, bag
from aionode.gateway import Gateway, Policy
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Int32

if TYPE_CHECKING:
    from collections.abc import Iterator

READER: Final = str(Path(__file__).parent / "gateway_parts" / "reader.py")
RATE_HZ: Final = 20
WARM_UP: Final = 10
DOMAIN_ID: Final = 87


def image_of(size: int) -> Image:
    """Return an image whose pixels take a number of bytes."""
    return Image(height=1, width=size, step=size, data=bytes([1]) * size)


def node_of(name: str, context: Context) -> Node:
    """Return a node that has only what it is given."""
    return Node(name, context=context, start_parameter_services=False, enable_rosout=False)


@contextmanager
def part(*options: str) -> Iterator[subprocess.Popen[str]]:
    """Run another process of this file within the block, once it is ready."""
    command = [sys.executable, __file__, "--part", *options]
    with subprocess.Popen(  # noqa: S603  # of this file
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None  # noqa: S101  # a pipe
        process.stdout.readline()
        yield process
        process.communicate("")


# A recorder and a gateway


class Meter:
    """Measures the event loop's thread from one image to another."""

    def __init__(self) -> None:
        self.images = 0
        self._longest_ns = 0
        self._began: tuple[int, int, int] = (0, 0, 0)
        run = asyncio.Handle._run  # noqa: SLF001  # nothing public tells how long a callback took

        def timed(handle: asyncio.Handle) -> None:
            began_ns = time.thread_time_ns()
            run(handle)
            self._longest_ns = max(self._longest_ns, time.thread_time_ns() - began_ns)

        asyncio.Handle._run = timed  # type: ignore[assignment,method-assign]  # noqa: SLF001

    def count(self, _: Image) -> None:
        """Count an image; the first ones do not count."""
        self.images += 1
        if self.images == WARM_UP:
            self._began = self._now()
            self._longest_ns = 0

    def _now(self) -> tuple[int, int, int]:
        faults = resource.getrusage(resource.RUSAGE_THREAD).ru_minflt
        return time.thread_time_ns(), time.process_time_ns(), faults

    def result(self) -> dict[str, float]:
        """Return the measurements, in milliseconds and megabytes."""
        loop_ns, all_ns, faults = (
            (b - a) / (self.images - WARM_UP) for a, b in zip(self._began, self._now(), strict=True)
        )
        return {
            "loop_ms": loop_ns / 1e6,
            "process_ms": all_ns / 1e6,
            "fresh_mb": faults * mmap.PAGESIZE / 1e6,
            "longest_ms": self._longest_ns / 1e6,
        }


async def robot(route: str, count: int) -> None:
    """Record images, and send them to a client."""
    async with AsyncExitStack() as stack:
        context = await stack.enter_async_context(
            Context(domain_id=DOMAIN_ID, transport="local")
            if route == "local"
            else Context(domain_id=DOMAIN_ID, link=route == "link")
        )
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        node = await stack.enter_async_context(node_of("robot", context))
        gateway = await stack.enter_async_context(Gateway(node, Policy.default(), port=0))
        await stack.enter_async_context(
            bag.Recorder(
                Path(folder) / "run", topics=["/images"], context=context, compression="none"
            )
        )
        subscribe = {"op": "subscribe", "topic": "/images", "type": "sensor_msgs/msg/Image"}
        options = {
            "port": gateway.port, "clients": 1, "count": count, "wait_sec": 10.0,
            "subscribe": subscribe | {"compression": "cbor-raw"},
        }  # fmt: skip
        client = await asyncio.create_subprocess_exec(
            sys.executable, "-S", READER, json.dumps(options),
            stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE,
        )  # fmt: skip
        assert client.stdout is not None  # noqa: S101  # a pipe
        await client.stdout.readline()
        meter = Meter()
        if route == "local":
            publisher = node.create_publisher(Image, "/images", 10)
            await drive(publisher, count, meter)
        else:
            node.create_subscription(Image, "/images", meter.count, 10)
            print("ready", flush=True)
            await asyncio.to_thread(sys.stdin.read)
        print(json.dumps(meter.result()), flush=True)
        await client.communicate(b"")


async def drive(publisher: Any, count: int, meter: Meter | None = None) -> None:
    """Publish images at a rate."""
    image = image_of(6_000_000)
    image.data = np.frombuffer(image.data, np.uint8).copy()  # which the driver writes again
    await asyncio.sleep(1)
    for _ in range(count):
        publisher.publish(image)
        if meter is not None:
            meter.count(image)
        await asyncio.sleep(1 / RATE_HZ)


async def recorder_and_gateway(route: str, count: int) -> dict[str, float]:
    """Return what an image costs a process with a recorder and a gateway."""
    command = [sys.executable, __file__, "--part", "robot", route, str(count)]
    process = await asyncio.create_subprocess_exec(
        *command, stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE
    )
    assert process.stdout is not None  # noqa: S101  # a pipe
    if route != "local":
        await process.stdout.readline()
        async with (
            Context(domain_id=DOMAIN_ID, link=route == "link") as context,
            node_of("driver", context) as node,
        ):
            publisher = node.create_publisher(Image, "/images", 10)
            await publisher.wait_for_subscribers(3)
            await drive(publisher, count)
            output, _ = await process.communicate(b"")
    else:
        output, _ = await process.communicate(b"")
    found: dict[str, float] = json.loads(output)
    return found


# Many readers


async def reader(topic: str, *, reads: bool) -> None:
    """Answer each image with a small message."""
    async with Context(domain_id=DOMAIN_ID) as context, node_of("reader", context) as node:
        seen = node.create_publisher(Int32, f"{topic}_seen", 100)

        def answer(image: Image) -> None:
            data = int(np.frombuffer(image.data, np.uint64).max() % 2) if reads else 0
            seen.publish(Int32(data=data))

        node.create_subscription(Image, topic, answer, 10)
        print("ready", flush=True)
        await asyncio.to_thread(sys.stdin.read)


class Readers:
    """A publisher, and the answers of its readers."""

    def __init__(self, node: Node, topic: str, readers: int) -> None:
        self.publisher = node.create_publisher(Image, topic, 10)
        node.create_subscription(Int32, f"{topic}_seen", self._on_answer, 100)
        self._readers = readers
        self._left = 0
        self._done = asyncio.Event()

    def _on_answer(self, _: Int32) -> None:
        self._left -= 1
        if not self._left:
            self._done.set()

    async def play(self, image: Image, count: int) -> list[tuple[int, int]]:
        """Return the processor time of each `publish`, and the time to the last answer."""
        times = []
        for _ in range(count):
            await asyncio.sleep(1 / RATE_HZ)
            self._left = self._readers
            self._done.clear()
            began_ns, busy_ns = time.perf_counter_ns(), time.thread_time_ns()
            self.publisher.publish(image)
            busy_ns = time.thread_time_ns() - busy_ns
            await self._done.wait()
            times.append((busy_ns, time.perf_counter_ns() - began_ns))
        return times


def bare_reader(path: str, *, reads: bool) -> None:
    """Answer each line on stdin, for which there is an image in shared memory."""
    with open(path, "rb") as file:  # noqa: PTH123  # a descriptor of another process
        pixels = np.frombuffer(mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ), np.uint64)
    print("ready", flush=True)
    for _ in iter(sys.stdin.readline, ""):
        print(int(pixels.max() % 2) if reads else 0, flush=True)


class BareReaders:
    """The same without aionode and an event loop."""

    def __init__(self, readers: int, reads: str, size: int, parts: ExitStack) -> None:
        descriptor = os.memfd_create("bare")
        os.ftruncate(descriptor, size)
        self._shared = mmap.mmap(descriptor, size)
        path = f"/proc/{os.getpid()}/fd/{descriptor}"
        self._readers = [parts.enter_context(part("bare", path, reads)) for _ in range(readers)]

    async def play(self, image: Image, count: int) -> list[tuple[int, int]]:
        """Return the processor time of each image, and the time to the last answer."""
        times = []
        for _ in range(count):
            await asyncio.sleep(1 / RATE_HZ)
            began_ns, busy_ns = time.perf_counter_ns(), time.thread_time_ns()
            self._shared[:] = image.data
            for process in self._readers:
                assert process.stdin is not None  # noqa: S101  # a pipe
                process.stdin.write("\n")
                process.stdin.flush()
            busy_ns = time.thread_time_ns() - busy_ns
            for process in self._readers:
                assert process.stdout is not None  # noqa: S101  # a pipe
                process.stdout.readline()
            times.append((busy_ns, time.perf_counter_ns() - began_ns))
        return times


async def many_readers(rounds: int) -> dict[tuple[int, str], tuple[float, float]]:
    """Return both times in milliseconds, by the number of readers and what they read.

    For "small" they get an image of 10 bytes, and otherwise one of 4 MB.
    """
    large = image_of(4_000_000)
    images = {"small": image_of(10), "nothing": large, "all": large}
    bare = {"bare nothing": "nothing", "bare all": "all"}
    found: dict[tuple[int, str], list[tuple[int, int]]] = {}
    players: dict[tuple[int, str], Readers | BareReaders] = {}
    with ExitStack() as parts:
        async with Context(domain_id=DOMAIN_ID) as context, node_of("camera", context) as node:
            for readers in (1, 5):
                for reads in images:
                    topic = f"images_{readers}_{reads}"
                    players[readers, reads] = Readers(node, topic, readers)
                    for _ in range(readers):
                        parts.enter_context(part("reader", topic, reads))
                for name, reads in bare.items():
                    players[readers, name] = BareReaders(readers, reads, 4_000_000, parts)
            for (readers, _), player in players.items():
                if isinstance(player, Readers):
                    await player.publisher.wait_for_subscribers(readers)
            for turn in range(rounds + 1):
                for key, player in players.items():
                    times = await player.play(images.get(key[1], large), 10)
                    if turn:  # the first one hands over to the link
                        found.setdefault(key, []).extend(times[2:])
    return {
        key: (
            statistics.median(busy for busy, _ in times) / 1e6,
            statistics.median(all_ns for _, all_ns in times) / 1e6,
        )
        for key, times in found.items()
    }


def main() -> None:
    """Measure, and print both tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="a third of the messages")
    parser.add_argument("--part", nargs="+", help=argparse.SUPPRESS)
    args = parser.parse_args()
    logging.disable(logging.WARNING)  # this machine may be busy
    if args.part:
        kind, first, second = args.part
        if kind == "bare":
            bare_reader(first, reads=second == "all")
        elif kind == "robot":
            asyncio.run(robot(first, int(second)))
        else:
            asyncio.run(reader(first, reads=second == "all"))
        return
    count = 70 if args.quick else 210
    print("an image of 6 MB to a recorder and a gateway with one client; for each image:")
    for route in ("link", "zenoh", "local"):
        found = asyncio.run(recorder_and_gateway(route, count))
        print(
            f"{route:6} event loop {found['loop_ms']:5.2f} ms, process {found['process_ms']:5.2f} "
            f"ms, fresh memory in the loop {found['fresh_mb']:5.2f} MB, longest callback "
            f"{found['longest_ms']:5.2f} ms",
            flush=True,
        )
    print("an image of 4 MB over links:")
    kinds = {
        "small": "of 10 bytes instead",
        "nothing": "of which nothing is read",
        "all": "all of which is read",
        "bare nothing": "bare, nothing is read",
        "bare all": "bare, all is read",
    }
    times = asyncio.run(many_readers(3 if args.quick else 10))
    for (readers, reads), (busy_ms, all_ms) in times.items():
        base = times[1, reads]
        print(
            f"{readers} readers, {kinds[reads]:24}: publisher {busy_ms:5.2f} ms "
            f"({busy_ms / base[0]:.2f}), last answer after {all_ms:5.2f} ms "
            f"({all_ms / base[1]:.2f})"
        )


if __name__ == "__main__":
    main()
