"""How long a message takes to another process and back, compared with Zenoh alone.

Two processes on loopback send one small message to and fro: with aionode (a `Node`, including
codec, callbacks and their statistics), and with zenoh-python and one `call_soon_threadsafe` for
each message into the same kind of event loop. Both are measured in turns in the same run, so that
other load affects both.

Run it with ``python benchmarks/roundtrip.py``. It prints a table and writes ``roundtrip.json`` to
``benchmarks/results/``; ``--quick`` takes a fifth of the time, for a first look.
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
import time
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Protocol

import zenoh

from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import String

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Awaitable, Callable, Iterator

PAYLOAD: Final = "x" * 23  # 32 bytes of CDR
RAW_PAYLOAD: Final = bytes(32)
ATTACHMENT: Final = bytes(33)  # sent with every ROS message
MESSAGES: Final = 2_000
ROUNDS: Final = 7
RAW_PORT: Final = 18_461
PORTS: Final = "18462,18463,18464"
RESULTS: Final = Path(__file__).parent / "results"


@dataclass(frozen=True)
class Row:
    """Round trips of one kind on one loop, in nanoseconds."""

    loop: str
    kind: str
    count: int
    p50_ns: int
    p99_ns: int
    max_ns: int


class Ball(Protocol):
    """One side's way to play: `play` returns the times of some round trips."""

    async def play(self, count: int) -> list[int]:
        """Send to and fro a number of times."""


# Zenoh alone


def raw_session(*, listen: bool) -> zenoh.Session:
    """Return a session with aionode's settings, linked only to the other process."""
    config = zenoh.Config()
    endpoint = f"tcp/127.0.0.1:{RAW_PORT}"
    for key, value in {
        "listen/endpoints": [endpoint if listen else "tcp/127.0.0.1:0"],
        "connect/endpoints": [] if listen else [endpoint],
        "scouting/multicast/enabled": False,
        "timestamping/enabled": True,
    }.items():
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)


class RawBall:
    """Zenoh-python, and `call_soon_threadsafe` for each message."""

    def __init__(self, session: zenoh.Session, hear: str, say: str) -> None:
        self._loop = asyncio.get_running_loop()
        self._publisher = session.declare_publisher(say)
        self._subscriber = session.declare_subscriber(hear, self._on_sample)
        self.times: list[int] = []
        self._done: asyncio.Future[None] | None = None
        self._left = 0
        self._began_ns = 0

    def _on_sample(self, sample: zenoh.Sample) -> None:
        self._loop.call_soon_threadsafe(self._take, sample)

    def _take(self, sample: zenoh.Sample) -> None:
        sample.payload.to_bytes()
        if self._done is None:  # the echoing side
            self.send()
            return
        now_ns = time.perf_counter_ns()
        self.times.append(now_ns - self._began_ns)
        self._left -= 1
        if self._left:
            self._began_ns = now_ns
            self.send()
        else:
            self._done.set_result(None)

    def send(self) -> None:
        """Send one message."""
        self._publisher.put(RAW_PAYLOAD, attachment=ATTACHMENT)

    async def play(self, count: int) -> list[int]:
        """Send to and fro a number of times."""
        self.times = []
        self._left = count
        self._done = asyncio.get_running_loop().create_future()
        self._began_ns = time.perf_counter_ns()
        self.send()
        await self._done
        return self.times


# aionode


class NodeBall:
    """A node with a publisher and a subscription that calls back."""

    def __init__(self, node: Node, hear: str, say: str, *, echo: bool = False) -> None:
        self._publisher = node.create_publisher(String, say, 10)
        self._echo = echo
        node.create_subscription(String, hear, self._on_message, 10)
        self._times: list[int] = []
        self._done: asyncio.Future[None] | None = None
        self._left = 0
        self._began_ns = 0

    def _on_message(self, msg: String) -> None:
        if self._echo:
            self._publisher.publish(msg)
            return
        now_ns = time.perf_counter_ns()
        self._times.append(now_ns - self._began_ns)
        self._left -= 1
        if self._left:
            self._began_ns = now_ns
            self._publisher.publish(String(data=PAYLOAD))
        elif self._done is not None:
            self._done.set_result(None)

    async def ready(self) -> None:
        """Wait for the other side."""
        await self._publisher.wait_for_subscribers()

    async def play(self, count: int) -> list[int]:
        """Send to and fro a number of times."""
        self._times = []
        self._left = count
        self._done = asyncio.get_running_loop().create_future()
        self._began_ns = time.perf_counter_ns()
        self._publisher.publish(String(data=PAYLOAD))
        await self._done
        return self._times


# The two processes


def stdin_closed() -> Awaitable[None]:
    """Return a future that is done when the other process has ended, or wants this one to end."""
    loop = asyncio.get_running_loop()
    closed: asyncio.Future[None] = loop.create_future()

    def end() -> None:
        if not closed.done():
            closed.set_result(None)

    loop.add_reader(sys.stdin, end)
    return closed


async def echo(kind: str) -> None:
    """Send back whatever arrives, until stdin is closed."""
    if kind == "zenoh":
        session = await asyncio.to_thread(raw_session, listen=True)
        RawBall(session, "ping", "pong")
        print("ready", flush=True)
        await stdin_closed()
        session.close()
        return
    async with Node("echo", start_parameter_services=False, enable_rosout=False) as node:
        NodeBall(node, "ping", "pong", echo=True)
        print("ready", flush=True)
        await stdin_closed()


@contextmanager
def other_process(kind: str, loop: str) -> Iterator[None]:
    """Run the echoing side of `kind` within the block."""
    command = [sys.executable, __file__, "--echo", kind, "--loop", loop]
    with subprocess.Popen(  # noqa: S603  # this file
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdin is not None  # noqa: S101  # both are pipes
        assert process.stdout is not None  # noqa: S101
        try:
            process.stdout.readline()
            yield
        finally:
            process.stdin.close()


async def measure(loop: str, messages: int, rounds: int) -> AsyncIterator[Row]:
    """Yield one row for each kind."""
    times: dict[str, list[int]] = {"zenoh": [], "aionode": []}
    medians: dict[str, list[float]] = {"zenoh": [], "aionode": []}
    with other_process("zenoh", loop), other_process("aionode", loop):
        session = await asyncio.to_thread(raw_session, listen=False)
        async with (
            Context() as context,
            Node(
                "ping", context=context, start_parameter_services=False, enable_rosout=False
            ) as node,
        ):
            ball = NodeBall(node, "pong", "ping")
            await ball.ready()
            balls: dict[str, Ball] = {"zenoh": RawBall(session, "pong", "ping"), "aionode": ball}
            for played in balls.values():
                await played.play(messages // 4)  # to warm up
            for _ in range(rounds):
                for kind, played in balls.items():
                    found = await played.play(messages)
                    times[kind] += found
                    medians[kind].append(statistics.median(found))
        session.close()
    for kind, found in times.items():
        found.sort()
        yield Row(
            loop,
            kind,
            len(found),
            # The median of the rounds' medians, so that one disturbed round does not count.
            int(statistics.median(medians[kind])),
            found[len(found) * 99 // 100],
            found[-1],
        )


def loop_factory(name: str) -> Callable[[], asyncio.AbstractEventLoop] | None:
    """Return the factory of the event loop called `name`."""
    if name != "uvloop":
        return None
    import uvloop

    factory: Callable[[], asyncio.AbstractEventLoop] = uvloop.new_event_loop
    return factory


async def collect(loop: str, messages: int, rounds: int) -> list[Row]:
    """Return the rows of one loop."""
    return [row async for row in measure(loop, messages, rounds)]


def machine() -> dict[str, Any]:
    """Return the machine and versions that the figures depend on."""
    return {
        "python": platform.python_version(),
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        "eclipse-zenoh": metadata.version("eclipse-zenoh"),
        "uvloop": metadata.version("uvloop"),
    }


def main() -> None:
    """Measure on both loops, print the table and write the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a fifth of the messages")
    parser.add_argument("--loop", choices=["asyncio", "uvloop"], help="only this event loop")
    parser.add_argument("--echo", choices=["zenoh", "aionode"], help=argparse.SUPPRESS)
    args = parser.parse_args()
    os.environ["AIONODE_MEETING_PORTS"] = PORTS  # do not meet other processes
    os.environ["AIONODE_ROUTER_PORT"] = "18465"
    os.environ["AIONODE_LINK"] = "off"  # link.py measures what a link makes of it
    if args.echo:
        with asyncio.Runner(loop_factory=loop_factory(args.loop)) as runner:
            runner.run(echo(args.echo))
        return
    rows: list[Row] = []
    messages = MESSAGES // 5 if args.quick else MESSAGES
    for loop in [args.loop] if args.loop else ["asyncio", "uvloop"]:
        with asyncio.Runner(loop_factory=loop_factory(loop)) as runner:
            rows += runner.run(collect(loop, messages, ROUNDS))
    print(f"{'loop':8} {'':8} {'p50':>8} {'p99':>8} {'max':>9}   round trips of 32 bytes, in us")
    for row in rows:
        beside = next(r for r in rows if r.loop == row.loop and r.kind == "zenoh")
        ratio = f"  {row.p50_ns / beside.p50_ns:.2f} x zenoh" if row is not beside else ""
        print(
            f"{row.loop:8} {row.kind:8} {row.p50_ns / 1e3:8.0f} {row.p99_ns / 1e3:8.0f} "
            f"{row.max_ns / 1e3:9.0f}{ratio}"
        )
    RESULTS.mkdir(exist_ok=True)
    result = {**machine(), "rows": [asdict(row) for row in rows]}
    (RESULTS / "roundtrip.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
