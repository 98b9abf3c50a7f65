"""What a router beside two linked processes costs them, compared with the same two without one.

Two pairs of processes send one small message to and fro over a link, in slices that take turns: one
pair has ``aionode router`` on its port, the other has nothing. Sessions behind the router may
subscribe unseen, so a process has to find out whether one does: until it knows, each message also
goes over Zenoh, which is the third row. There a plain Zenoh program subscribes behind the router.

Run it with ``python benchmarks/router.py``; it takes a minute. p50 is the median of the slices'
medians; the processor time is that of this process, Zenoh's threads included, for each round trip.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import AsyncExitStack, ExitStack, asynccontextmanager, contextmanager
from pathlib import Path
from typing import Final

import zenoh

sys.path.insert(0, str(Path(__file__).parents[1]))  # run as a program, it finds its own parts

from aionode import Context
from benchmarks.ipc_parts.common import is_linked, node_of
from benchmarks.roundtrip import NodeBall, stdin_closed

MESSAGES: Final = 500
ROUNDS: Final = 30
ALONE: Final = "without a router"
BESIDE: Final = "beside a router"
HEARD: Final = "beside a router, with a subscriber behind it"
PORTS: Final = {ALONE: 18_470, BESIDE: 18_475}
"""The first of four ports; the last one is the router's."""


def meet(kind: str) -> str:
    """Let this process meet only those of one kind, and return the port of their router."""
    first = PORTS[kind]
    os.environ["AIONODE_MEETING_PORTS"] = f"{first},{first + 1},{first + 2}"
    os.environ["AIONODE_ROUTER_PORT"] = port = str(first + 3)
    return port


async def echo() -> None:
    """Send back whatever arrives, until stdin is closed."""
    async with Context(link=True) as context, node_of("echo", context) as node:
        NodeBall(node, "ping", "pong", echo=True)
        print("ready", flush=True)
        await stdin_closed()


@contextmanager
def process(*command: str) -> Iterator[None]:
    """Run another process within the block, once it is ready."""
    with subprocess.Popen(  # noqa: S603  # aionode's own programs
        [sys.executable, *command], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as other:
        assert other.stdout is not None  # noqa: S101  # a pipe
        try:
            other.stdout.readline()
            yield
        finally:
            other.terminate()


@asynccontextmanager
async def pair(kind: str) -> AsyncIterator[NodeBall]:
    """Return this side of a pair of linked processes."""
    with ExitStack() as stack:
        port = meet(kind)
        if kind == BESIDE:
            listen = f"tcp/127.0.0.1:{port}"
            stack.enter_context(process("-m", "aionode", "router", "--listen", listen))
        stack.enter_context(process(__file__, "--echo"))
        async with Context(link=True) as context, node_of(f"ping_{kind[:6]}", context) as node:
            ball = NodeBall(node, "pong", "ping")
            await ball.ready()
            while not is_linked(ball._publisher):  # noqa: SLF001  # to measure nothing else
                await ball.play(10)
            yield ball


@contextmanager
def subscriber() -> Iterator[None]:
    """Run a plain Zenoh subscriber behind the router."""
    config = zenoh.Config()
    port = PORTS[BESIDE] + 3
    for key, value in {
        "mode": "client",
        "connect/endpoints": [f"tcp/127.0.0.1:{port}"],
        "scouting/multicast/enabled": False,
    }.items():
        config.insert_json5(key, json.dumps(value))
    with zenoh.open(config) as session:
        session.declare_subscriber("**", lambda _: None)
        yield


class Times:
    """The measurements of one kind."""

    def __init__(self) -> None:
        self.slices_ns: list[float] = []
        self.cpu_ns: list[float] = []

    async def play(self, ball: NodeBall) -> None:
        """Add one slice."""
        began_ns = time.process_time_ns()
        times = await ball.play(MESSAGES)
        self.cpu_ns.append((time.process_time_ns() - began_ns) / MESSAGES)
        self.slices_ns.append(statistics.median(times))


async def measure(rounds: int) -> dict[str, Times]:
    """Return what was measured of each kind."""
    found = {kind: Times() for kind in (ALONE, BESIDE, HEARD)}
    async with AsyncExitStack() as stack:
        balls = {kind: await stack.enter_async_context(pair(kind)) for kind in PORTS}
        await asyncio.sleep(3)  # until the router has told who is behind it
        for ball in balls.values():
            await ball.play(MESSAGES)  # to warm up
        for _ in range(rounds):
            for kind, ball in balls.items():
                await found[kind].play(ball)
        with subscriber():
            await balls[BESIDE].play(MESSAGES)
            for _ in range(max(rounds // 3, 1)):
                await found[HEARD].play(balls[BESIDE])
    return found


def main() -> None:
    """Measure, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="slices of each kind")
    parser.add_argument("--echo", action="store_true", help=argparse.SUPPRESS)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if args.echo:
            asyncio.run(echo())
            return
        os.environ["XDG_RUNTIME_DIR"] = folder
        found = asyncio.run(measure(args.rounds))
    alone_us = statistics.median(found[ALONE].slices_ns) / 1e3
    for kind, times in found.items():
        p50_us = statistics.median(times.slices_ns) / 1e3
        lowest, highest = min(times.slices_ns) / 1e3, max(times.slices_ns) / 1e3
        print(
            f"{kind:45} p50 {p50_us:6.1f} us ({lowest:.1f} to {highest:.1f}), "
            f"{p50_us / alone_us:.2f} x; "
            f"processor {statistics.median(times.cpu_ns) / 1e3:6.1f} us"
        )


if __name__ == "__main__":
    main()
