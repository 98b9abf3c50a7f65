"""What a link between two processes of one host costs, beside its floors in the same run.

Everything goes from this process to another one and back, in slices that take turns, so that a
noisy minute hits all rows alike: as fast as it goes ("full rate"), and with a sleep of 10 ms before
each round trip ("100 Hz").

- Round trips of one small message: over a bare Unix socket in the same kind of loop, which is the
  floor; over zenoh-python with one `call_soon_threadsafe` for each message; over aionode with
  Zenoh; and over aionode with a link (`Node`, codec, callbacks and statistics included).
- Service calls: one coroutine that awaits `Client.call` again and again. Beside them a coroutine
  that awaits each answer of a bare Unix socket, as waking a coroutine has its price too.
- Images of 4 MB, all of whose data is read in place; a small message answers. Half of a small
  round trip taken off gives the time of one way. The floor copies 4 MB into memory that both
  processes have mapped, says so over a bare Unix socket, and reads it there with the same call.
- All this with each process on a core of its own, and the round trips and calls of small messages
  once more with both processes on one core. Left alone, the system chooses one or the other, and
  times differ by a factor of up to six: to wake another core takes time, above all in a virtual
  machine, while on one core neither process ever has to be woken from idleness.
- Bursts of 20 000 small messages into one callback; the rate is that of arrival.
- The processor time of a publisher with a timer of 100 Hz and of its reader: fresh processes that
  contain nothing else, over a link, over Zenoh, and as a bare timer and Unix socket.
- With rclpy, where `import rclpy` works: the round trip of a `std_msgs/String` between two further
  processes, each with rclpy's events executor and the middleware that is set up there. At full rate
  the callback publishes the next message; at 100 Hz the thread that spins sleeps in between.

The last table puts each target beside what was found. p50 is the median of the slices' medians,
p99 is of all round trips, and the first round trips of each slice do not count.

Run it with ``python benchmarks/ipc.py``; it takes up to six minutes, and ``--quick`` gives a
first look within a minute. It prints the tables and writes ``link.json`` to
``benchmarks/results/``.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import mmap
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from contextlib import AsyncExitStack, asynccontextmanager, contextmanager, suppress
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any, Final, Protocol

import numpy as np
import zenoh

from aionode import Context, Node
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Int32, String

TEXT: Final = "x" * 23  # 32 bytes of CDR
SIZE: Final = 72  # with the header of a frame
IMAGE_BYTES: Final = 4_000_000
BURST: Final = 20_000
PERIOD_S: Final = 0.01
SILENCE_NS: Final = 1_500_000_000  # after which the rest of a burst is lost
RESULTS: Final = Path(__file__).parent / "results"

FULL: Final = "full rate"
PACED: Final = "100 Hz"
SOCKET: Final = "bare Unix socket"
AWAITED: Final = "bare Unix socket, awaited"
ZENOH: Final = "bare zenoh"
OVER_ZENOH: Final = "aionode over Zenoh"
OVER_LINK: Final = "aionode over a link"
CALL_ZENOH: Final = "service over Zenoh"
CALL_LINK: Final = "service over a link"
RCLPY: Final = "rclpy, events executor"
RCLPY_S: Final = 600.0
"""Longer than a measurement takes, which has a limit of its own."""
OWN: Final = "own"
ONE: Final = "one"
CORES: Final = {OWN: "own cores", ONE: "one core", "any": "any core"}
OTHERS: Final = ("echo", "reader", "rclpy-echo")  # parts that run on the second core
IMAGE_FLOOR: Final = "4 MB, bare memory and socket"
IMAGE_ZENOH: Final = "4 MB image over Zenoh"
IMAGE_LINK: Final = "4 MB image over a link"
SMALL_OF: Final = {IMAGE_FLOOR: SOCKET, IMAGE_ZENOH: OVER_ZENOH, IMAGE_LINK: OVER_LINK}
FLOOR_OF: Final = {IMAGE_ZENOH: IMAGE_FLOOR, IMAGE_LINK: IMAGE_FLOOR, IMAGE_FLOOR: IMAGE_FLOOR}


@dataclass(frozen=True)
class Plan:
    """How much is measured on each loop."""

    rounds: int = 20
    full: int = 120
    paced: int = 20
    bursts: int = 7
    duty_rounds: int = 5
    duty_s: float = 2.0


QUICK: Final = Plan(rounds=3, full=100, paced=8, bursts=2, duty_rounds=2, duty_s=1.0)
SETTLE: Final = {FULL: 10, PACED: 2}  # round trips at the begin of a slice that do not count


# Round trips


class Player(Protocol):
    """One way to and fro."""

    async def play(self, count: int, pause_s: float) -> list[int]:
        """Return the times of so many round trips in nanoseconds, with a sleep before each."""


class Ball:
    """Callbacks on both sides: `send` sends, and whoever hears the answer calls `back`."""

    send: Callable[[], object]

    def __init__(self) -> None:
        self._times: list[int] = []
        self._left = 0
        self._began_ns = 0
        self._done: asyncio.Future[None] | None = None

    def back(self) -> None:
        """Note one round trip, and begin the next."""
        self._times.append(time.perf_counter_ns() - self._began_ns)
        self._left -= 1
        if self._left:
            self._throw()
        else:
            assert self._done is not None  # noqa: S101  # somebody plays
            self._done.set_result(None)

    def _throw(self) -> None:
        self._began_ns = time.perf_counter_ns()
        self.send()

    async def _go(self, count: int) -> None:
        self._left = count
        self._done = asyncio.get_running_loop().create_future()
        self._throw()
        await self._done

    async def play(self, count: int, pause_s: float) -> list[int]:
        """Return the times of so many round trips in nanoseconds, with a sleep before each."""
        self._times = []
        if not pause_s:
            await self._go(count)
            return self._times
        for _ in range(count):
            await asyncio.sleep(pause_s)
            await self._go(1)
        return self._times


class Caller:
    """One coroutine that awaits one answer after the other."""

    def __init__(self, call: Callable[[], Awaitable[object]]) -> None:
        self._call = call

    async def play(self, count: int, pause_s: float) -> list[int]:
        """Return the times of so many calls in nanoseconds, with a sleep before each."""
        times = []
        for _ in range(count):
            if pause_s:
                await asyncio.sleep(pause_s)
            began_ns = time.perf_counter_ns()
            await self._call()
            times.append(time.perf_counter_ns() - began_ns)
        return times


# The floors


class SocketBall(Ball, asyncio.Protocol):
    """A bare Unix socket."""

    def connection_made(self, transport: Any) -> None:
        """Keep the transport."""
        self.send = lambda: transport.write(bytes(SIZE))

    def data_received(self, data: bytes) -> None:  # noqa: ARG002  # its time counts
        """Take the answer."""
        self.back()


class SocketAsk(asyncio.Protocol):
    """A bare Unix socket whose answers are awaited."""

    def connection_made(self, transport: Any) -> None:
        """Keep the transport."""
        self._write = transport.write

    def ask(self) -> asyncio.Future[None]:
        """Send, and return what the answer ends."""
        self._answer: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._write(bytes(SIZE))
        return self._answer

    def data_received(self, data: bytes) -> None:  # noqa: ARG002  # its time counts
        """Take the answer."""
        self._answer.set_result(None)


class SocketEcho(asyncio.Protocol):
    """The other end."""

    def connection_made(self, transport: Any) -> None:
        """Send back what comes."""
        self.write = transport.write

    def data_received(self, data: bytes) -> None:
        """Send it back."""
        self.write(data)


class SocketThrow(SocketEcho):
    """The other end for bursts."""

    def data_received(self, data: bytes) -> None:  # noqa: ARG002  # anything begins
        """Send a burst."""
        for _ in range(BURST):
            self.write(bytes(SIZE))


class MemoryEcho(SocketEcho):
    """The other end for memory that both have mapped."""

    def __init__(self, buffer: mmap.mmap) -> None:
        self._memory = buffer

    def data_received(self, data: bytes) -> None:
        """Read all of it, and answer."""
        read_all(self._memory)
        self.write(data)


def read_all(data: Any) -> int:
    """Read all of `data`, in place."""
    return int(np.frombuffer(data, np.uint64).max())


def shared_memory(folder: str) -> mmap.mmap:
    """Return memory that the other process can map too."""
    with (Path(folder) / "memory").open("a+b") as file:
        file.truncate(IMAGE_BYTES)
        return mmap.mmap(file.fileno(), IMAGE_BYTES)


async def connect(protocol: Callable[[], Any], folder: str, name: str) -> Any:
    """Return the connected protocol."""
    loop = asyncio.get_running_loop()
    _, connected = await loop.create_unix_connection(protocol, f"{folder}/{name}")
    return connected


def raw_session(port: int, *, listen: bool) -> zenoh.Session:
    """Return a plain session that is linked to the other process only."""
    config = zenoh.Config()
    endpoint = f"tcp/127.0.0.1:{port}"
    for key, value in {
        "listen/endpoints": [endpoint if listen else "tcp/127.0.0.1:0"],
        "connect/endpoints": [] if listen else [endpoint],
        "scouting/multicast/enabled": False,
    }.items():
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)


def zenoh_pair(
    session: zenoh.Session, hear: str, say: str, take: Callable[[], object]
) -> Callable[[], object]:
    """Return what sends one message; `take` is called on the loop for each that comes."""
    loop = asyncio.get_running_loop()
    publisher = session.declare_publisher(say, congestion_control=zenoh.CongestionControl.BLOCK)

    def on_sample(sample: zenoh.Sample) -> None:
        loop.call_soon_threadsafe(lambda: (sample.payload.to_bytes(), take()))

    subscriber = session.declare_subscriber(hear, on_sample)
    return lambda: (publisher.put(bytes(32), attachment=bytes(33)), subscriber)


# aionode


@dataclass(frozen=True)
class BufferRef:
    """Where the processes of one run meet, and nobody else: a folder, and ports from `port` on.

    `cores` are those of the process that measures and of the other one; empty for any.
    """

    folder: str
    loop: str
    port: int
    cores: tuple[int, ...]

    @property
    def cores_text(self) -> str:
        """The cores in a word, for tables."""
        return {0: "any", 1: ONE, 2: OWN}[len(set(self.cores))]

    def context(self, number: int, *, link: bool) -> Context:
        """Return a context that hears those of the same number only: it meets no strangers."""
        first = self.port + 2 + 3 * number
        os.environ["AIONODE_ROUTER_PORT"] = str(self.port + 1)
        os.environ["AIONODE_MEETING_PORTS"] = f"{first},{first + 1},{first + 2}"
        return Context(link=link)


def node_of(name: str, context: Context) -> Node:
    """Return a node that has only what it is given."""
    return Node(name, context=context, start_parameter_services=False, enable_rosout=False)


def is_linked(publisher: Any) -> bool:
    """Return whether the messages of `publisher` take a link, and nothing else."""
    linked: int = publisher._writers[1].linked  # noqa: SLF001  # to measure nothing else
    return linked > 0


class NodeBall(Ball):
    """A publisher, and a subscription that calls back."""

    def __init__(self, node: Node) -> None:
        super().__init__()
        self.publisher = node.create_publisher(String, "ping", 10)
        node.create_subscription(String, "pong", lambda _: self.back(), 10)
        self.send = lambda: self.publisher.publish(String(data=TEXT))


class ImageBall(Ball):
    """A publisher of images, and a subscription for the answers."""

    def __init__(self, node: Node) -> None:
        super().__init__()
        self.publisher = node.create_publisher(Image, "images", 10)
        node.create_subscription(Int32, "seen", lambda _: self.back(), 10)
        msg = Image(height=1000, width=4000, step=4000, data=bytes([1]) * IMAGE_BYTES)
        self.send = lambda: self.publisher.publish(msg)


class MemoryBall(SocketBall):
    """Bare memory that both have mapped, and a bare Unix socket."""

    def __init__(self, buffer: mmap.mmap) -> None:
        super().__init__()
        self._memory = buffer
        self._data = bytes([1]) * IMAGE_BYTES

    def connection_made(self, transport: Any) -> None:
        """Copy and say so."""

        def send() -> None:
            self._memory[:] = self._data
            transport.write(bytes(SIZE))

        self.send = send


# Bursts


class Burst:
    """Bursts from the other process: `begin` asks for one, `take` is called for what comes."""

    begin: Callable[[], object]

    def __init__(self) -> None:
        self.sent: list[int] = []  # rates as well, where the other side tells
        self.rates: list[float] = []
        self.lost = 0
        self._clear()

    def _clear(self) -> None:
        self._count = self._first = self._first_ns = self._last_ns = 0

    def take(self, count: int = 1) -> None:
        """Note what has come."""
        self._last_ns = time.perf_counter_ns()
        if not self._count:
            self._first, self._first_ns = count, self._last_ns
        self._count += count

    async def play(self) -> float:
        """Return the rate of arrival of one burst, in messages a second."""
        self._clear()
        began_ns = time.perf_counter_ns()
        self.begin()
        self._last_ns = time.perf_counter_ns()
        # Polled, as an event would cost time with each message.
        while self._count < BURST and time.perf_counter_ns() - self._last_ns < SILENCE_NS:  # noqa: ASYNC110
            await asyncio.sleep(0.02)
        self.lost += BURST - self._count
        if self._count == self._first:  # all came at once, or nothing at all
            return self._count / (self._last_ns - began_ns) * 1e9
        return (self._count - self._first) / (self._last_ns - self._first_ns) * 1e9


class SocketBurst(Burst, asyncio.Protocol):
    """Over a bare Unix socket."""

    def connection_made(self, transport: Any) -> None:
        """Keep the transport."""
        self.begin = lambda: transport.write(b"x")
        self._rest = 0

    def data_received(self, data: bytes) -> None:
        """Count whole messages."""
        count, self._rest = divmod(self._rest + len(data), SIZE)
        self.take(count)


class NodeBurst(Burst):
    """Over aionode."""

    def __init__(self, node: Node) -> None:
        super().__init__()
        self.publisher = node.create_publisher(Int32, "throw", 10)
        self.begin = lambda: self.publisher.publish(Int32(data=BURST))
        node.create_subscription(Int32, "burst", lambda _: self.take(), 2 * BURST)
        node.create_subscription(Int32, "thrown", lambda msg: self.sent.append(msg.data), 10)


# The other process


async def echo(place: BufferRef) -> None:
    """Answer everything until stdin is closed."""
    loop = asyncio.get_running_loop()
    buffer = shared_memory(place.folder)
    protocols: dict[str, Callable[[], Any]] = {
        "raw": SocketEcho,
        "throw": SocketThrow,
        "image": lambda: MemoryEcho(buffer),
    }
    servers = [
        await loop.create_unix_server(protocol, f"{place.folder}/{name}")
        for name, protocol in protocols.items()
    ]
    session = raw_session(place.port, listen=True)
    answer: list[Callable[[], object]] = []
    answer.append(zenoh_pair(session, "raw/ping", "raw/pong", lambda: answer[0]()))  # noqa: PLW0108  # made below
    throw: list[Callable[[], object]] = []
    throw.append(
        zenoh_pair(session, "raw/throw", "raw/burst", lambda: [throw[0]() for _ in range(BURST)])
    )
    async with (
        place.context(0, link=False) as plain,
        place.context(1, link=True) as linked,
        node_of("echo", plain) as first,
        node_of("echo", linked) as second,
    ):
        for node in (first, second):
            answer_all(node)
        await lines(lambda _: "")
    session.close()
    for server in servers:
        server.close()


def answer_all(node: Node) -> None:
    """Make what answers the balls, calls, images and bursts of the other process."""
    pongs = node.create_publisher(String, "pong", 10)
    node.create_subscription(String, "ping", pongs.publish, 10)
    seen = node.create_publisher(Int32, "seen", 10)
    node.create_subscription(
        Image, "images", lambda msg: seen.publish(Int32(data=read_all(msg.data) % 2)), 10
    )
    node.create_service(AddTwoInts, "add", lambda _: AddTwoInts.Response(sum=3))
    burst = node.create_publisher(Int32, "burst", 2 * BURST)
    thrown = node.create_publisher(Int32, "thrown", 10)

    def throw(msg: Int32) -> None:
        began = time.perf_counter()
        for number in range(msg.data):
            burst.publish(Int32(data=number))
        thrown.publish(Int32(data=round(msg.data / (time.perf_counter() - began))))

    node.create_subscription(Int32, "throw", throw, 10)


async def lines(work: Callable[[str], Any]) -> None:
    """Say "ready", then answer each line of stdin with what `work` returns or awaits, as JSON."""
    reader = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(reader), sys.stdin
    )
    print('"ready"', flush=True)
    async for line in reader:
        print(json.dumps(await work(line.decode())), flush=True)


class Child:
    """Another process of this file, which answers lines with lines."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        assert process.stdin is not None  # noqa: S101  # both are pipes
        assert process.stdout is not None  # noqa: S101
        self._stdin, self._stdout = process.stdin, process.stdout

    async def answer(self) -> Any:
        """Return the next answer."""
        line = await self._stdout.readline()
        if not line:
            raise RuntimeError("the other process ended too early")
        return json.loads(line)

    async def ask(self, line: str) -> Any:
        """Return the answer to one line."""
        self._stdin.write(line.encode() + b"\n")
        return await self.answer()


@asynccontextmanager
async def child(part: str, place: BufferRef, kind: str = "") -> AsyncIterator[Child]:
    """Run another process meanwhile, which is ready."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, __file__, "--part", part, "--folder", place.folder, "--loop", place.loop,
        "--port", str(place.port), "--kind", kind, "--cores", ",".join(map(str, place.cores)),
        stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE,
    )  # fmt: skip
    try:
        other = Child(process)
        await other.answer()
        yield other
    finally:
        assert process.stdin is not None  # noqa: S101  # a pipe
        process.stdin.close()
        try:
            await asyncio.wait_for(process.wait(), 10)
        except TimeoutError:
            process.kill()
            await process.wait()


# A publisher of 100 Hz and its reader, each alone in a process


async def duty(part: str, kind: str, place: BufferRef) -> None:
    """Publish 100 times a second, or read that, as long as each line of stdin says."""
    count = 0

    def take(_: object = None) -> None:
        nonlocal count
        count += 1

    async with AsyncExitStack() as stack:
        if kind == SOCKET:
            beat = await socket_duty(part, place, take, stack)
        else:
            beat = await node_duty(part, kind, place, take, stack)

        async def work(line: str) -> dict[str, float]:
            nonlocal count
            count = 0
            with beat():
                began, before = time.perf_counter(), time.process_time()
                await asyncio.sleep(float(line))
                used, took = time.process_time() - before, time.perf_counter() - began
            return {"percent": 100 * used / took, "count": count}

        await lines(work)


Beat = Callable[[], Any]  # a context in which messages are sent 100 times a second


@contextmanager
def silence() -> Iterator[None]:
    """Send nothing: this side reads."""
    yield


async def socket_duty(
    part: str, place: BufferRef, take: Callable[..., None], stack: AsyncExitStack
) -> Beat:
    """Return the floor: a timer of the loop, and a bare Unix socket."""
    loop = asyncio.get_running_loop()

    class Reader(asyncio.Protocol):
        def data_received(self, data: bytes) -> None:  # noqa: ARG002  # its time counts
            take()

    if part == "reader":
        server = await loop.create_unix_server(Reader, f"{place.folder}/duty")
        stack.callback(server.close)
        return silence
    transport, _ = await loop.create_unix_connection(asyncio.Protocol, f"{place.folder}/duty")
    timer: asyncio.TimerHandle

    def fire(due_s: float) -> None:
        nonlocal timer
        take()
        transport.write(bytes(SIZE))
        timer = loop.call_at(due_s + PERIOD_S, fire, due_s + PERIOD_S)

    @contextmanager
    def beat() -> Iterator[None]:
        nonlocal timer
        due_s = loop.time() + PERIOD_S
        timer = loop.call_at(due_s, fire, due_s)
        yield
        timer.cancel()

    return beat


async def node_duty(
    part: str, kind: str, place: BufferRef, take: Callable[..., None], stack: AsyncExitStack
) -> Beat:
    """Return what a node does: with all that a node has of its own, as users have it."""
    link = kind == OVER_LINK
    context = await stack.enter_async_context(place.context(3 if link else 2, link=link))
    node = await stack.enter_async_context(Node(part, context=context))
    if part == "reader":
        node.create_subscription(String, "beat", take, 10)
        return silence
    publisher = node.create_publisher(String, "beat", 10)
    await publisher.wait_for_subscribers()
    while link and not is_linked(publisher):  # noqa: ASYNC110  # nothing tells
        await asyncio.sleep(PERIOD_S)

    def fire() -> None:
        take()
        publisher.publish(String(data=TEXT))

    @contextmanager
    def beat() -> Iterator[None]:
        timer = node.create_timer(PERIOD_S, fire)
        yield
        timer.destroy()

    return beat


async def duties(place: BufferRef, plan: Plan) -> list[dict[str, Any]]:
    """Return what share of a core publishers and readers take, in turns."""
    found: dict[str, list[tuple[Any, Any]]] = {}
    async with AsyncExitStack() as stack:

        async def pair_of(kind: str) -> tuple[Child, Child]:
            reader = await stack.enter_async_context(child("reader", place, kind))
            return await stack.enter_async_context(child("publisher", place, kind)), reader

        kinds = (SOCKET, OVER_ZENOH, OVER_LINK)
        pairs = dict(zip(kinds, await asyncio.gather(*map(pair_of, kinds)), strict=True))
        for _ in range(plan.duty_rounds):
            for kind, pair in pairs.items():
                one, other = await asyncio.gather(*(side.ask(str(plan.duty_s)) for side in pair))
                found.setdefault(kind, []).append((one, other))
    return [
        {
            "loop": place.loop,
            "what": kind,
            "publisher_percent": round(statistics.median(o["percent"] for o, _ in both), 2),
            "reader_percent": round(statistics.median(o["percent"] for _, o in both), 2),
            "sent": sum(one["count"] for one, _ in both),
            "received": sum(other["count"] for _, other in both),
        }
        for kind, both in found.items()
    ]


# rclpy


class RclpyBall:
    """A process with rclpy, which plays with another one."""

    def __init__(self, player: Child) -> None:
        self._player = player

    async def play(self, count: int, pause_s: float) -> list[int]:
        """Return the times of so many round trips in nanoseconds, with a sleep before each."""
        times: list[int] = await self._player.ask(f"{count} {pause_s}")
        return times


def rclpy_process(part: str) -> None:
    """Play, or echo, until stdin is closed."""
    import rclpy  # type: ignore[import-not-found]  # from a ROS installation, as the next ones
    import std_msgs.msg  # type: ignore[import-not-found]
    from rclpy.experimental.events_executor import (  # type: ignore[import-not-found]
        EventsExecutor,
    )
    from rclpy.task import Future  # type: ignore[import-not-found]

    rclpy.init()
    node = rclpy.create_node(part.replace("-", "_"))
    executor = EventsExecutor()
    executor.add_node(node)
    message = std_msgs.msg.String(data=TEXT)
    if part == "rclpy-echo":
        pongs = node.create_publisher(std_msgs.msg.String, "rclpy_pong", 10)
        node.create_subscription(std_msgs.msg.String, "rclpy_ping", pongs.publish, 10)
        print('"ready"', flush=True)
        threading.Thread(target=lambda: (sys.stdin.read(), os._exit(0)), daemon=True).start()
        # Without a limit it takes a core and calls nothing.
        executor.spin_until_future_complete(Future(), timeout_sec=RCLPY_S)
        return
    pings = node.create_publisher(std_msgs.msg.String, "rclpy_ping", 10)
    times: list[int] = []
    left, began_ns, done = 0, 0, Future()

    def throw() -> None:
        nonlocal began_ns
        began_ns = time.perf_counter_ns()
        pings.publish(message)

    def back(_: object) -> None:
        nonlocal left
        times.append(time.perf_counter_ns() - began_ns)
        left -= 1
        if left:
            throw()
        else:
            done.set_result(None)

    def go(count: int) -> None:
        nonlocal left, done
        left, done = count, Future()
        throw()
        executor.spin_until_future_complete(done, timeout_sec=RCLPY_S)

    node.create_subscription(std_msgs.msg.String, "rclpy_pong", back, 10)
    while not (pings.get_subscription_count() and node.count_publishers("rclpy_pong")):
        time.sleep(0.1)
    print('"ready"', flush=True)
    for line in sys.stdin:
        count, pause_s = line.split()
        times.clear()
        if float(pause_s):
            for _ in range(int(count)):
                time.sleep(float(pause_s))
                go(1)
        else:
            go(int(count))
        print(json.dumps(times), flush=True)


def has_rclpy() -> bool:
    """Return whether rclpy and its events executor can be imported here."""
    try:
        import rclpy.experimental.events_executor  # type: ignore[import-not-found]  # noqa: F401
    except ImportError:
        return False
    return True


async def rclpy_ball(place: BufferRef, stack: AsyncExitStack) -> dict[str, Player]:
    """Return rclpy's ball, where rclpy is installed."""
    if not has_rclpy():
        return {}
    await stack.enter_async_context(child("rclpy-echo", place))
    return {RCLPY: RclpyBall(await stack.enter_async_context(child("rclpy-ping", place)))}


# Measuring


def row(what: str, speed: str, times: list[list[int]]) -> dict[str, Any]:
    """Return one line of the table, in microseconds: the median of the slices' medians."""
    everything = sorted(t for part in times for t in part)
    return {
        "what": what,
        "speed": speed,
        "p50_us": round(statistics.median(statistics.median(part) for part in times) / 1e3, 1),
        "p99_us": round(everything[len(everything) * 99 // 100] / 1e3, 1),
        "count": len(everything),
    }


async def in_turns(players: dict[str, Player], plan: Plan) -> list[dict[str, Any]]:
    """Return one line for each player and speed."""
    times: dict[tuple[str, str], list[list[int]]] = {}
    for _ in range(plan.rounds):
        for speed, count, pause_s in ((FULL, plan.full, 0.0), (PACED, plan.paced, PERIOD_S)):
            for name, player in players.items():
                fewer = 5 if name in SMALL_OF else 1
                found = await player.play(max(count // fewer, 4) + SETTLE[speed], pause_s)
                times.setdefault((speed, name), []).append(found[SETTLE[speed] :])
    return [row(name, speed, found) for (speed, name), found in times.items()]


def one_way(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the lines of the images again, less half of a small message's round trip."""
    small = {(one["what"], one["speed"]): one["p50_us"] / 2 for one in rows}
    return [
        one
        | {
            "what": f"{one['what']}, one way",
            "p50_us": round(one["p50_us"] - small[SMALL_OF[one["what"]], one["speed"]], 1),
            "p99_us": round(one["p99_us"] - small[SMALL_OF[one["what"]], one["speed"]], 1),
        }
        for one in rows
        if one["what"] in SMALL_OF
    ]


async def measure(place: BufferRef, plan: Plan) -> dict[str, list[dict[str, Any]]]:
    """Return the tables of one loop."""
    async with AsyncExitStack() as stack:
        await stack.enter_async_context(child("echo", place))
        first = await stack.enter_async_context(
            node_of("ping", await stack.enter_async_context(place.context(0, link=False)))
        )
        second = await stack.enter_async_context(
            node_of("ping", await stack.enter_async_context(place.context(1, link=True)))
        )
        session = await asyncio.to_thread(raw_session, place.port, listen=False)
        stack.callback(session.close)
        buffer = shared_memory(place.folder)
        bare = Ball()
        bare.send = zenoh_pair(session, "raw/pong", "raw/ping", bare.back)
        small, large = (NodeBall(first), NodeBall(second)), (ImageBall(first), ImageBall(second))
        for ball in (*small, *large):
            await ball.publisher.wait_for_subscribers()
        asked = await connect(SocketAsk, place.folder, "raw")
        players: dict[str, Player] = {
            SOCKET: await connect(SocketBall, place.folder, "raw"),
            AWAITED: Caller(asked.ask),
            ZENOH: bare,
            OVER_ZENOH: small[0],
            OVER_LINK: small[1],
            CALL_ZENOH: await caller(first),
            CALL_LINK: await caller(second),
            **await rclpy_ball(place, stack),
            IMAGE_FLOOR: await connect(lambda: MemoryBall(buffer), place.folder, "image"),
            IMAGE_ZENOH: large[0],
            IMAGE_LINK: large[1],
        }
        for name, player in players.items():  # to warm up, and to hand over
            await player.play(20 if name in SMALL_OF else 300, 0)
        for ball in (small[1], large[1]):
            while not is_linked(ball.publisher):
                await ball.play(10, PERIOD_S)
        if place.cores_text == ONE:
            players = {name: player for name, player in players.items() if name not in SMALL_OF}
        rows = await in_turns(players, plan)
        bursts = []
        if place.cores_text != ONE:
            bursts = await burst_in_turns(place, session, (first, second), plan)
    return {
        "round_trips": [
            {"loop": place.loop, "cores": place.cores_text, **one} for one in rows + one_way(rows)
        ],
        "bursts": [{"loop": place.loop, **one} for one in bursts],
        "duties": [] if place.cores_text == ONE else await duties(place, plan),
    }


async def caller(node: Node) -> Caller:
    """Return what calls a service."""
    client = node.create_client(AddTwoInts, "add")
    await client.wait_for_service()
    return Caller(lambda: client.call(AddTwoInts.Request(a=1, b=2)))


async def burst_in_turns(
    place: BufferRef, session: zenoh.Session, nodes: tuple[Node, Node], plan: Plan
) -> list[dict[str, Any]]:
    """Return how many messages a second arrive in one callback."""
    bare = Burst()
    bare.begin = zenoh_pair(session, "raw/burst", "raw/throw", bare.take)
    over_zenoh, over_link = (NodeBurst(node) for node in nodes)
    for node, thrower in zip(nodes, (over_zenoh, over_link), strict=True):
        await thrower.publisher.wait_for_subscribers()
        while node.count_publishers("burst") == 0:
            await node.graph.changed()
    bursts: dict[str, Burst] = {
        SOCKET: await connect(SocketBurst, place.folder, "throw"),
        ZENOH: bare,
        OVER_ZENOH: over_zenoh,
        OVER_LINK: over_link,
    }
    for turn in range(plan.bursts + 1):
        for burst in bursts.values():
            rate = await burst.play()
            if turn:  # the first one hands over
                burst.rates.append(rate)
    return [
        {
            "what": name,
            "messages_per_s": round(statistics.median(burst.rates)),
            "best_per_s": round(max(burst.rates)),
            "published_per_s": round(statistics.median(burst.sent)) if burst.sent else None,
            "lost": burst.lost,
        }
        for name, burst in bursts.items()
    ]


# What is printed


def targets(loop: str, tables: dict[str, list[dict[str, Any]]]) -> list[tuple[str, ...]]:
    """Return a line for each target of one loop: what, figure, target, met or missed, the floor."""
    trips = [one for one in tables["round_trips"] if one["loop"] == loop]
    found = {(one["cores"], one["what"], one["speed"]): one for one in trips}
    bursts = {o["what"]: o for o in tables["bursts"] if o["loop"] == loop}
    duty = {o["what"]: o for o in tables["duties"] if o["loop"] == loop}
    placed = list(dict.fromkeys(one["cores"] for one in trips))
    table: list[tuple[str, ...]] = []

    def add(what: str, figure: float, bound: float, unit: str, floor: float) -> None:
        met = figure >= bound if unit == "msg/s" else figure <= bound
        sign = ">=" if unit == "msg/s" else "<="
        form = {"msg/s": ",.0f", "ms": ".3f"}.get(unit, ".2f")
        found_here = f"{figure:{form}} {unit}"
        verdict = "met" if met else "MISSED"
        table.append((loop, what, found_here, f"{sign} {bound:{form}}", verdict, f"{floor:{form}}"))

    for cores in placed:
        for name in (OVER_LINK, CALL_LINK):
            for speed, bound in ((FULL, 1.6), (PACED, 1.4)):
                one, floor = found[cores, name, speed], found[cores, SOCKET, speed]
                what = f"{name}, {speed}, {CORES[cores]}"
                add(f"{what}: p50", one["p50_us"] / floor["p50_us"], bound, "x floor", 1)
                tail = floor["p99_us"] / floor["p50_us"]
                add(f"{what}: p99", one["p99_us"] / one["p50_us"], 2, "x its p50", tail)
    add(
        "burst into a callback", bursts[OVER_LINK]["messages_per_s"], 200_000, "msg/s",
        bursts[SOCKET]["messages_per_s"],
    )  # fmt: skip
    for speed in (FULL, PACED):
        one, floor = (
            found[placed[0], f"{name}, one way", speed]["p50_us"]
            for name in (IMAGE_LINK, IMAGE_FLOOR)
        )
        add(f"{IMAGE_LINK}, one way, {speed}", one / 1e3, 1, "ms", floor / 1e3)
    for side in ("publisher", "reader"):
        one, floor = (duty[name][f"{side}_percent"] for name in (OVER_LINK, SOCKET))
        add(f"100 Hz, {side}", one, 1.5, "% of a core", floor)
    return table


def print_tables(tables: dict[str, list[dict[str, Any]]]) -> list[tuple[str, ...]]:
    """Print everything, and return the lines of the last table."""
    floors = {
        (o["loop"], o["cores"], o["what"], o["speed"]): o["p50_us"] for o in tables["round_trips"]
    }
    print(
        f"{'loop':8} {'cores':5} {'to another process and back, in us':38} {'speed':10} "
        f"{'p50':>8} {'p99':>8} {'p99/p50':>8} {'x floor':>8} {'count':>6}"
    )
    for one in tables["round_trips"]:
        name, _, route = one["what"].partition(", one way")
        floor = FLOOR_OF.get(name, SOCKET) + (", one way" if route or one["what"] != name else "")
        times_floor = one["p50_us"] / floors[one["loop"], one["cores"], floor, one["speed"]]
        print(
            f"{one['loop']:8} {one['cores']:5} {one['what']:38} {one['speed']:10} "
            f"{one['p50_us']:8.1f} {one['p99_us']:8.1f} {one['p99_us'] / one['p50_us']:8.2f} "
            f"{times_floor:8.2f} {one['count']:6}"
        )
    print(
        f"\n{'loop':8} {f'bursts of {BURST:,} into a callback':38} {'msg/s':>10} {'best':>10} "
        f"{'published':>10} lost"
    )
    for one in tables["bursts"]:
        print(
            f"{one['loop']:8} {one['what']:38} {one['messages_per_s']:10,} "
            f"{one['best_per_s']:10,} {one['published_per_s'] or '':>10} {one['lost']:4}"
        )
    print(f"\n{'loop':8} {'100 Hz, % of a core':38} {'publisher':>10} {'reader':>10}  messages")
    for one in tables["duties"]:
        print(
            f"{one['loop']:8} {one['what']:38} {one['publisher_percent']:10.2f} "
            f"{one['reader_percent']:10.2f}  {one['received']} of {one['sent']}"
        )
    print(f"\n{'loop':8} {'target':50} {'figure':>18} {'bound':>11} {'':7} {'the floor has':>14}")
    checked = [
        line
        for loop in dict.fromkeys(one["loop"] for one in tables["duties"])
        for line in targets(loop, tables)
    ]
    for loop, what, figure, bound, met, floor in checked:
        print(f"{loop:8} {what:50} {figure:>18} {bound:>11} {met:7} {floor:>14}")
    return checked


def loop_factory(name: str) -> Callable[[], asyncio.AbstractEventLoop] | None:
    """Return what makes the event loop called `name`."""
    if name != "uvloop":
        return None
    import uvloop

    factory: Callable[[], asyncio.AbstractEventLoop] = uvloop.new_event_loop
    return factory


def run(loop: str, work: Awaitable[Any], limit_s: float | None = None) -> Any:
    """Run `work` on the loop called `loop`."""

    async def main() -> Any:
        async with asyncio.timeout(limit_s):
            return await work

    with asyncio.Runner(loop_factory=loop_factory(loop)) as runner:
        return runner.run(main())


def placements() -> list[tuple[int, ...]]:
    """Return where the two processes run: on a core each, on one core, or anywhere if need be."""
    if not hasattr(os, "sched_setaffinity"):
        return [()]
    cores = sorted(os.sched_getaffinity(0))
    return [(cores[0], cores[1]), (cores[0], cores[0])] if len(cores) > 1 else [()]


def part_of(args: argparse.Namespace) -> None:
    """Do what another process of this program is for."""
    cores = tuple(int(core) for core in args.cores.split(",") if core)
    if cores:  # before there are threads, which do the same
        os.sched_setaffinity(0, {cores[args.part in OTHERS]})
    place = BufferRef(args.folder, args.loop, args.port, cores)
    if args.part.startswith("rclpy"):
        rclpy_process(args.part)
    elif args.part == "measure":
        plan = QUICK if args.quick else Plan()
        print(json.dumps(run(args.loop, measure(place, plan), limit_s=300)))
    else:
        run(args.loop, echo(place) if args.part == "echo" else duty(args.part, args.kind, place))


def tables_of(args: argparse.Namespace, loop: str, cores: tuple[int, ...]) -> dict[str, list[Any]]:
    """Measure in a process of its own, and return its tables."""
    buffer = "/dev/shm" if Path("/dev/shm").is_dir() else None  # noqa: S108  # memory, not a file
    with tempfile.TemporaryDirectory(dir=buffer) as folder:
        command = [
            sys.executable, __file__, "--part", "measure", "--folder", folder, "--loop", loop,
            "--port", str(args.port), "--cores", ",".join(map(str, cores)),
        ]  # fmt: skip
        if args.quick:
            command.append("--quick")
        output = subprocess.check_output(command)  # noqa: S603  # of this file
        tables: dict[str, list[Any]] = json.loads(output)
    return tables


def main() -> None:
    """Measure on both loops, print the tables and write the file."""
    assert __doc__ is not None  # noqa: S101  # -OO has no business here
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="a first look within a minute")
    parser.add_argument("--loop", choices=["asyncio", "uvloop"], help="only this event loop")
    for hidden in ("--part", "--folder", "--kind", "--cores"):
        parser.add_argument(hidden, default="", help=argparse.SUPPRESS)
    # Below the ports that the system gives away, and seldom those of another run beside this one.
    port = 18_600 + os.getpid() % 600 * 20
    parser.add_argument("--port", type=int, default=port, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.part:
        with suppress(KeyboardInterrupt):
            part_of(args)
        return
    tables: dict[str, list[dict[str, Any]]] = {}
    for loop in [args.loop] if args.loop else ["asyncio", "uvloop"]:
        for cores in placements():
            for name, rows in tables_of(args, loop, cores).items():
                tables.setdefault(name, []).extend(rows)
    checked = print_tables(tables)
    if not has_rclpy():
        print("\nrclpy is not installed here, so it has no row.")
    RESULTS.mkdir(exist_ok=True)
    result = {
        "python": platform.python_version(),
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        "eclipse-zenoh": metadata.version("eclipse-zenoh"),
        **tables,
        "targets": checked,
    }
    (RESULTS / "link.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
