"""What all parts of the ipc benchmark share: names, sizes, sockets, sessions and processes."""

from __future__ import annotations

import asyncio
import json
import mmap
import os
import sys
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import zenoh

from aionode import Context, Node

PROGRAM: Final = str(Path(__file__).parents[1] / "ipc.py")
TEXT: Final = "x" * 23  # 32 bytes of CDR
SIZE: Final = 72  # with the header of a frame
IMAGE_BYTES: Final = 4_000_000
BURST: Final = 20_000
PERIOD_S: Final = 0.01
SILENCE_NS: Final = 1_500_000_000  # after which the rest of a burst counts as lost
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
    """How much to measure on each loop."""

    rounds: int = 20
    full: int = 120
    paced: int = 20
    bursts: int = 7
    duty_rounds: int = 5
    duty_s: float = 2.0


QUICK: Final = Plan(rounds=3, full=100, paced=8, bursts=2, duty_rounds=2, duty_s=1.0)
SETTLE: Final = {FULL: 10, PACED: 2}  # round trips at the beginning of a slice that do not count


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
    """Return a plain session that is linked only to the other process."""
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
    """Return a function that sends one message; `take` is called on the loop for each arrival."""
    loop = asyncio.get_running_loop()
    publisher = session.declare_publisher(say, congestion_control=zenoh.CongestionControl.BLOCK)

    def on_sample(sample: zenoh.Sample) -> None:
        loop.call_soon_threadsafe(lambda: (sample.payload.to_bytes(), take()))

    subscriber = session.declare_subscriber(hear, on_sample)
    return lambda: (publisher.put(bytes(32), attachment=bytes(33)), subscriber)


SPIN = "AIONODE_BENCHMARK_SPIN_US"
"""How long the linked contexts spin, for the processes that `ipc.py --spin-us` starts."""


@dataclass(frozen=True)
class Run:
    """The state shared by the processes of one measurement: a folder, and ports from `port` on.

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
        """Return a context that only communicates with those of the same number."""
        first = self.port + 2 + 3 * number
        os.environ["AIONODE_ROUTER_PORT"] = str(self.port + 1)
        os.environ["AIONODE_MEETING_PORTS"] = f"{first},{first + 1},{first + 2}"
        return Context(link=link, spin_us=float(os.environ.get(SPIN, "0")) if link else 0)


def node_of(name: str, context: Context) -> Node:
    """Return a node that has only what it is given."""
    return Node(name, context=context, start_parameter_services=False, enable_rosout=False)


def is_linked(publisher: Any) -> bool:
    """Return whether the messages of `publisher` use only a link."""
    linked: int = publisher._writers[1].linked  # noqa: SLF001  # to measure nothing else
    return linked > 0


async def lines(work: Callable[[str], Any]) -> None:
    """Print "ready", then answer each line of stdin with the result of `work`, awaited, as JSON."""
    reader = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(reader), sys.stdin
    )
    print('"ready"', flush=True)
    async for line in reader:
        print(json.dumps(await work(line.decode())), flush=True)


class Child:
    """Another process of this file, which answers line by line."""

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
async def child(part: str, place: Run, kind: str = "") -> AsyncIterator[Child]:
    """Run another process within the block, once it is ready."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, PROGRAM, "--part", part, "--folder", place.folder, "--loop", place.loop,
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
