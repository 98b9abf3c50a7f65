"""What a link between two processes of one host costs, beside its floors in the same run.

Round trips of one small message between two processes, in turns: over a bare Unix socket in the
same kind of loop, over zenoh-python with one `call_soon_threadsafe` for each message, over aionode
with Zenoh and over aionode with a link (`Node`, codec, callbacks and statistics included); as fast
as they go, and 100 times a second. Then a service call over the link, a burst into one callback,
and an image of 4 MB one way whose data is read in place.

Run it with ``python benchmarks/link.py``; ``--quick`` takes a fifth of the time. It prints a table
and writes ``link.json`` to ``benchmarks/results/``.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from importlib import metadata
from pathlib import Path
from typing import Any, Final

import numpy as np
import zenoh

from aionode import Context, Node
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Int32, String

TEXT: Final = "x" * 23  # 32 bytes of CDR
SIZE: Final = 72  # with the header of a frame
RAW_PORT: Final = 18_571
PORTS: Final = {False: "18572,18573,18574", True: "18576,18577,18578"}
IMAGE_BYTES: Final = 4_000_000
BURST: Final = 20_000
RESULTS: Final = Path(__file__).parent / "results"


class Ball:
    """One way to and fro: `send` sends, and whoever hears the answer calls `back`."""

    send: Callable[[], object]

    def __init__(self) -> None:
        self._times: list[int] = []
        self._left = 0
        self._pause_s = 0.0
        self._began_ns = 0
        self._done: asyncio.Future[None] | None = None

    def back(self) -> None:
        """Note one round trip, and begin the next."""
        self._times.append(time.perf_counter_ns() - self._began_ns)
        self._left -= 1
        if not self._left:
            assert self._done is not None  # noqa: S101  # somebody plays
            self._done.set_result(None)
        elif self._pause_s:
            asyncio.get_running_loop().call_later(self._pause_s, self._throw)
        else:
            self._throw()

    def _throw(self) -> None:
        self._began_ns = time.perf_counter_ns()
        self.send()

    async def play(self, count: int, pause_s: float) -> list[int]:
        """Return the times of so many round trips, in nanoseconds."""
        self._times = []
        self._left = count
        self._pause_s = pause_s
        self._done = asyncio.get_running_loop().create_future()
        self._throw()
        await self._done
        return self._times


class SocketBall(Ball, asyncio.Protocol):
    """A bare Unix socket."""

    def connection_made(self, transport: Any) -> None:
        """Keep the transport."""
        self.send = lambda: transport.write(bytes(SIZE))

    def data_received(self, data: bytes) -> None:  # noqa: ARG002  # its time counts
        """Take the answer."""
        self.back()


class SocketEcho(asyncio.Protocol):
    """The other end."""

    def connection_made(self, transport: Any) -> None:
        """Send back what comes."""
        self._write = transport.write

    def data_received(self, data: bytes) -> None:
        """Send it back."""
        self._write(data)


def raw_session(*, listen: bool) -> zenoh.Session:
    """Return a plain session that is linked to the other process only."""
    config = zenoh.Config()
    endpoint = f"tcp/127.0.0.1:{RAW_PORT}"
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
    publisher = session.declare_publisher(say)

    def on_sample(sample: zenoh.Sample) -> None:
        loop.call_soon_threadsafe(lambda: (sample.payload.to_bytes(), take()))

    subscriber = session.declare_subscriber(hear, on_sample)
    return lambda: (publisher.put(bytes(32), attachment=bytes(33)), subscriber)


def context_of(*, link: bool) -> Context:
    """Return a context that hears its own kind only: who is linked meets no strangers."""
    os.environ["AIONODE_MEETING_PORTS"] = PORTS[link]
    return Context(link=link)


def node_of(name: str, context: Context) -> Node:
    """Return a node that has only what it is given."""
    return Node(name, context=context, start_parameter_services=False, enable_rosout=False)


class NodeBall(Ball):
    """A publisher and a subscription that calls back."""

    def __init__(self, node: Node) -> None:
        super().__init__()
        self.publisher = node.create_publisher(String, "ping", 10)
        node.create_subscription(String, "pong", lambda _: self.back(), 10)
        self.send = lambda: self.publisher.publish(String(data=TEXT))


class CallBall(Ball):
    """A client that calls again and again."""

    def __init__(self, node: Node, tasks: asyncio.TaskGroup) -> None:
        super().__init__()
        self.client: Any = node.create_client(AddTwoInts, "add")
        self.send = lambda: tasks.create_task(self._call())

    async def _call(self) -> None:
        await self.client.call(AddTwoInts.Request(a=1, b=2))
        self.back()


# The other process


async def echo(folder: str) -> None:
    """Answer everything until stdin is closed."""
    loop = asyncio.get_running_loop()
    ended: asyncio.Future[None] = loop.create_future()
    loop.add_reader(sys.stdin, lambda: None if ended.done() else ended.set_result(None))
    server = await loop.create_unix_server(SocketEcho, f"{folder}/raw.sock")
    session = raw_session(listen=True)
    sends: list[Callable[[], object]] = []
    sends.append(zenoh_pair(session, "raw/ping", "raw/pong", lambda: sends[0]()))  # noqa: PLW0108  # made below
    async with (
        context_of(link=False) as plain,
        context_of(link=True) as linked,
        node_of("echo", plain) as first,
        node_of("echo", linked) as second,
    ):
        for node in (first, second):
            publisher = node.create_publisher(String, "pong", 10)
            node.create_subscription(String, "ping", publisher.publish, 10)
        images = second.create_publisher(Int32, "seen", 10)
        second.create_subscription(Image, "images", lambda msg: images.publish(seen(msg)), 10)
        second.create_service(AddTwoInts, "add", lambda _: AddTwoInts.Response(sum=3))
        burst = second.create_publisher(Int32, "burst", 2 * BURST)

        def throw(msg: Int32) -> None:
            for number in range(msg.data):
                burst.publish(Int32(data=number))

        second.create_subscription(Int32, "throw", throw, 10)
        print("ready", flush=True)
        await ended
    session.close()
    server.close()


def seen(msg: Image) -> Int32:
    """Read all data of an image, in place."""
    return Int32(data=int(np.frombuffer(msg.data, np.uint64).max() > 0))


@asynccontextmanager
async def other_process(loop: str, folder: str) -> AsyncIterator[None]:
    """Run the answering process meanwhile."""
    command = [sys.executable, __file__, "--echo", folder, "--loop", loop]
    with subprocess.Popen(  # noqa: ASYNC220, S603  # this file
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as process:
        assert process.stdin is not None  # noqa: S101  # both are pipes
        assert process.stdout is not None  # noqa: S101
        try:
            await asyncio.to_thread(process.stdout.readline)
            yield
        finally:
            process.stdin.close()


# Measuring


def row(loop: str, what: str, times: list[list[int]]) -> dict[str, Any]:
    """Return one line of the table, in microseconds: the median of the rounds' medians."""
    everything = sorted(t for part in times for t in part)
    return {
        "loop": loop,
        "what": what,
        "p50_us": round(statistics.median(statistics.median(part) for part in times) / 1e3, 1),
        "p99_us": round(everything[len(everything) * 99 // 100] / 1e3, 1),
        "count": len(everything),
    }


async def in_turns(
    loop: str, balls: dict[str, Ball], count: int, rounds: int, pause_s: float
) -> list[dict[str, Any]]:
    """Return one line for each ball."""
    times: dict[str, list[list[int]]] = {name: [] for name in balls}
    for _ in range(rounds):
        for name, ball in balls.items():
            times[name].append(await ball.play(count, pause_s))
    speed = "100 Hz" if pause_s else "full rate"
    return [row(loop, f"{name}, {speed}", found) for name, found in times.items()]


async def measure(loop: str, scale: int, folder: str) -> list[dict[str, Any]]:
    """Return the table of one loop."""
    rows: list[dict[str, Any]] = []
    async with (
        other_process(loop, folder),
        context_of(link=False) as plain,
        context_of(link=True) as linked,
        node_of("ping", plain) as first,
        node_of("ping", linked) as second,
        asyncio.TaskGroup() as tasks,
    ):
        _, raw = await asyncio.get_running_loop().create_unix_connection(
            SocketBall, f"{folder}/raw.sock"
        )
        session = await asyncio.to_thread(raw_session, listen=False)
        bare = Ball()
        bare.send = zenoh_pair(session, "raw/pong", "raw/ping", bare.back)
        over_zenoh, over_link = NodeBall(first), NodeBall(second)
        call = CallBall(second, tasks)
        for ball in (over_zenoh, over_link):
            await ball.publisher.wait_for_subscribers()
        await call.client.wait_for_service()
        balls: dict[str, Ball] = {
            "bare Unix socket": raw,
            "bare zenoh": bare,
            "aionode over Zenoh": over_zenoh,
            "aionode over a link": over_link,
            "service over a link": call,
        }
        await in_turns(loop, balls, 500, 1, 0)  # to warm up, and to hand over
        rows += await in_turns(loop, balls, 300 * scale, 5, 0)
        rows += await in_turns(loop, balls, 20 * scale, 3, 0.01)
        rows += [await burst(loop, second, scale), await images(loop, second, 20 * scale)]
        session.close()
    return rows


async def burst(loop: str, node: Node, scale: int) -> dict[str, Any]:
    """Return how many messages per second one callback gets."""
    begin = node.create_publisher(Int32, "throw", 10)
    stamps: list[int] = []
    done = asyncio.Event()

    def take(msg: Int32) -> None:
        stamps.append(time.perf_counter_ns())
        if msg.data == BURST - 1:
            done.set()

    subscription = node.create_subscription(Int32, "burst", take, 2 * BURST)
    await begin.wait_for_subscribers()
    while subscription.get_publisher_count() == 0:
        await node.graph.changed()
    rates = []
    for turn in range(scale + 1):
        stamps.clear()
        done.clear()
        begin.publish(Int32(data=BURST))
        await done.wait()
        if turn:  # the first one hands over
            rates.append(len(stamps) / (stamps[-1] - stamps[0]) * 1e9)
    subscription.destroy()
    return {
        "loop": loop,
        "what": "burst into a callback",
        "messages_per_s": round(statistics.median(rates)),
        "lost": subscription.stats.lost,
    }


async def images(loop: str, node: Node, count: int) -> dict[str, Any]:
    """Return how long a large image takes one way: to and fro, less a small message's half."""
    publisher = node.create_publisher(Image, "images", 10)
    ball = Ball()
    node.create_subscription(Int32, "seen", lambda _: ball.back(), 10)
    await publisher.wait_for_subscribers()
    msg = Image(height=1000, width=4000, step=4000, data=bytes([1]) * IMAGE_BYTES)
    ball.send = lambda: publisher.publish(msg)
    await ball.play(20, 0)
    return row(loop, "image of 4 MB, read, and a small answer", [await ball.play(count, 0)])


def loop_factory(name: str) -> Callable[[], asyncio.AbstractEventLoop] | None:
    """Return what makes the event loop called `name`."""
    if name != "uvloop":
        return None
    import uvloop

    factory: Callable[[], asyncio.AbstractEventLoop] = uvloop.new_event_loop
    return factory


def run(loop: str, work: Awaitable[Any]) -> Any:
    """Run `work` on the loop called `loop`."""

    async def main() -> Any:
        return await work

    with asyncio.Runner(loop_factory=loop_factory(loop)) as runner:
        return runner.run(main())


def main() -> None:
    """Measure on both loops, print the table and write the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a fifth of the messages")
    parser.add_argument("--loop", choices=["asyncio", "uvloop"], help="only this event loop")
    parser.add_argument("--echo", help=argparse.SUPPRESS)
    args = parser.parse_args()
    os.environ["AIONODE_ROUTER_PORT"] = "18575"
    if args.echo:
        run(args.loop, echo(args.echo))
        return
    rows: list[dict[str, Any]] = []
    for loop in [args.loop] if args.loop else ["asyncio", "uvloop"]:
        with tempfile.TemporaryDirectory() as folder:
            rows += run(loop, measure(loop, 1 if args.quick else 5, folder))
    for one in rows:
        floor = next(
            (
                other["p50_us"]
                for other in rows
                if other["loop"] == one["loop"]
                and "p50_us" in one
                and other["what"] == f"bare Unix socket, {one['what'].rpartition(', ')[2]}"
            ),
            None,
        )
        ratio = f"{one['p50_us'] / floor:6.2f} x" if floor else ""
        figures = " ".join(f"{k}={v}" for k, v in one.items() if k not in {"loop", "what"})
        print(f"{one['loop']:8} {one['what']:40} {ratio:9} {figures}")
    RESULTS.mkdir(exist_ok=True)
    result = {
        "python": platform.python_version(),
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        "eclipse-zenoh": metadata.version("eclipse-zenoh"),
        "rows": rows,
    }
    (RESULTS / "link.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
