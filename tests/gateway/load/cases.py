"""A gateway under load, in the process of the robot's nodes; its clients run in others."""

from __future__ import annotations

import asyncio
import json
import sys
import time
from asyncio.subprocess import PIPE, Process
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, NamedTuple

from aionode.gateway import Gateway, Policy
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.node import Node
from aionode.testing import local_context
from tests.faults.process import LONG_S, CoreWait

__all__ = ["Heard", "Row", "crowd", "garbage", "images"]

GARBAGE = Path(__file__).parent / "garbage.py"
READER = Path(__file__).parents[3] / "benchmarks" / "gateway_parts" / "reader.py"
TICK_S = 0.002
TOPIC = "/load"

GAP_LIMIT_S = 0.02
"""How much longer the robot's loop may stall by itself than without clients."""

GARBAGE_LIMIT = 0.05
"""The share of a core that the gateway may use for garbage."""

GROWTH_BYTES = 8 << 20
"""How much more memory may be in use at the end than in the first seconds: the size of a frame."""

SETTLE_S = 5.0
"""When memory is measured first: queues have filled up, and buffers have reached their size."""

PADDING = "x" * 4000
"""Makes messages long, so that the sockets of a client that reads nothing are full in ten
seconds."""


class Row(NamedTuple):
    """The outcome of a case.

    Attributes:
        what: The case.
        problems: Why it was not held; empty if it was.
        figures: What was measured.
    """

    what: str
    problems: list[str]
    figures: str


class Heard(NamedTuple):
    """What the clients of one run received, and how the robot's process performed meanwhile.

    Attributes:
        local: How many of the messages a local subscription lacks.
        lost: How many each client lacks.
        doubled: How many each client got twice.
        reordered: How many each client got out of order.
        gap_s: The longest time for which the robot's loop did not turn.
        own_gap_s: The same without the time for which its thread waited for a core.
        core: The processor time of the robot's process, in seconds a second.
        memory_bytes: The most memory that it took within `SETTLE_S`, and what it took at the end.
        dropped: How many frames the gateway has dropped, for clients that do not read.
    """

    local: int
    lost: list[int]
    doubled: list[int]
    reordered: list[int]
    gap_s: float
    own_gap_s: float
    core: float
    memory_bytes: tuple[int, int]
    dropped: int


class Gaps:
    """Measures the longest stall of the event loop, from `begin` on."""

    def __init__(self) -> None:
        self.gap_s = self.own_gap_s = 0.0
        self._last_s = 0.0
        self._core_wait: CoreWait | None = None
        self._timer: asyncio.TimerHandle | None = None

    def begin(self) -> None:
        """Start over."""
        self.end()
        self.gap_s = self.own_gap_s = 0.0
        self._core_wait = CoreWait()
        self._last_s = time.monotonic()
        self._timer = asyncio.get_running_loop().call_later(TICK_S, self._tick)

    def end(self) -> None:
        """Stop measuring."""
        if self._timer is not None:
            self._timer.cancel()

    def _tick(self) -> None:
        assert self._core_wait is not None
        now_s = time.monotonic()
        gap_s = now_s - self._last_s - TICK_S
        own_gap_s = gap_s - self._core_wait.own()
        if own_gap_s > LONG_S:
            own_gap_s -= self._core_wait.largest_of_others()
        self.gap_s, self.own_gap_s = max(self.gap_s, gap_s), max(self.own_gap_s, own_gap_s)
        self._last_s = time.monotonic()
        self._timer = asyncio.get_running_loop().call_later(TICK_S, self._tick)


class Robot:
    """A node that publishes numbered messages, a subscription to them, and a gateway."""

    def __init__(self, node: Node, gateway: Gateway, message: Callable[[int], Any]) -> None:
        self.gateway = gateway
        self.gaps = Gaps()
        self._heard: set[int] = set()
        self._message = message
        first = message(0)
        self._publisher = node.create_publisher(type(first), TOPIC, 100)
        node.create_subscription(type(first), TOPIC, self._hear, 100)
        self._sleep = node.get_clock().sleep

    def _hear(self, message: Any) -> None:
        self._heard.add(number_of(message))

    async def until(self, ready: Awaitable[Any]) -> None:
        """Publish the number 0 until something exists."""
        waiting = asyncio.ensure_future(ready)
        while not waiting.done():
            self._publisher.publish(self._message(0))
            await self._sleep(0.3)

    async def run(self, rate_hz: float, seconds: float) -> Heard:
        """Publish numbers, and return how the process performed, yet without clients' results."""
        count = round(rate_hz * seconds)
        memory = memory_bytes()
        self.gaps.begin()
        began_s, cpu_s = time.monotonic(), time.process_time()
        for number in range(1, count + 1):
            await self._sleep(max(began_s + number / rate_hz - time.monotonic(), 0.0))
            self._publisher.publish(self._message(number))
            if time.monotonic() - began_s < SETTLE_S:
                memory = max(memory, memory_bytes())
        core = (time.process_time() - cpu_s) / (time.monotonic() - began_s)
        await self._sleep(0.5)
        self.gaps.end()
        lacking = count - len(self._heard - {0})
        return Heard(
            lacking, [], [], [], self.gaps.gap_s, self.gaps.own_gap_s, core,
            (memory, memory_bytes()), 0,
        )  # fmt: skip


def number_of(message: Any) -> int:
    """Return the number of a message."""
    return message.header.stamp.sec if isinstance(message, Image) else int(message.data[:10])


def text(number: int) -> String:
    """Return a numbered text."""
    return String(data=f"{number:010} {PADDING}")


PIXELS = bytes(range(256)) * (6_000_000 // 256)


def image(number: int) -> Image:
    """Return a numbered image of 6 MB."""
    header = Header(stamp=Time(sec=number))
    return Image(header=header, height=1000, width=2000, encoding="rgb8", step=6000, data=PIXELS)


def memory_bytes() -> int:
    """Return the memory used by this process; 0 where the system does not report it."""
    path = Path("/proc/self/statm")
    return int(path.read_text("ascii").split()[1]) * 4096 if path.exists() else 0


@asynccontextmanager
async def robot_with_gateway(
    message: Callable[[int], Any], policy: Policy | None = None
) -> AsyncIterator[Robot]:
    """Yield a robot and its gateway."""
    async with (
        local_context() as context,
        Node("robot", context=context) as robot,
        Node("gateway", context=context) as node,
        Gateway(node, policy, port=0) as gateway,
    ):
        yield Robot(robot, gateway, message)


async def reader(robot: Robot, compression: str, clients: int, last: int, deaf: int = 0) -> Process:
    """Start clients, and wait until each of them has received a message."""
    op = {"op": "subscribe", "topic": TOPIC, "compression": compression, "queue_length": 1000}
    options = {
        "port": robot.gateway.port,
        "clients": clients,
        "deaf": deaf,
        "subscribe": op,
        "last": last,
    }
    process = await started(READER, json.dumps(options))
    assert process.stdout is not None
    await robot.until(process.stdout.readline())
    return process


async def started(program: Path, *arguments: str) -> Process:
    """Start a program that needs only Python."""
    argv = (sys.executable, "-S", str(program), *arguments)
    return await asyncio.create_subprocess_exec(*argv, stdin=PIPE, stdout=PIPE)


async def run_with_clients(
    message: Callable[[int], Any],
    rate_hz: float,
    seconds: float,
    compression: str,
    clients: int,
    deaf: int = 0,
) -> tuple[Heard, Heard]:
    """Run a robot without clients, and with them; return how it performed in each case."""
    async with robot_with_gateway(message) as robot:
        await robot.until(asyncio.sleep(0.2))
        control = await robot.run(rate_hz, seconds / 3)
    async with robot_with_gateway(message) as robot:
        process = await reader(robot, compression, clients, round(rate_hz * seconds), deaf)
        heard = await robot.run(rate_hz, seconds)
        assert process.stdout is not None
        verdicts = json.loads(await process.stdout.readline())
        dropped = sum(robot.gateway.stats.dropped.values())
        await process.communicate(b"")
    lost, doubled, reordered = ([each[i] for each in verdicts] for i in range(3))
    return control, heard._replace(lost=lost, doubled=doubled, reordered=reordered, dropped=dropped)


def judged(what: str, count: int, control: Heard, heard: Heard) -> Row:
    """Return the row for a run with clients."""
    more_s = heard.own_gap_s - control.own_gap_s
    before, after = heard.memory_bytes
    told = [
        (heard.local > 0, f"the local reader lacks {heard.local}"),
        (any(heard.lost), f"clients lack {sum(heard.lost)} messages"),
        (any(heard.doubled), f"clients got {sum(heard.doubled)} messages twice"),
        (any(heard.reordered), f"clients got {sum(heard.reordered)} messages out of order"),
        (more_s > GAP_LIMIT_S, f"the loop stood still for {1000 * more_s:.0f} ms more"),
        (after > before + GROWTH_BYTES, "the memory grew"),
    ]
    figures = (
        f"{len(heard.lost)} clients got {count} messages each; "
        f"longest gap {1000 * heard.own_gap_s:.1f} ms of its own ({1000 * heard.gap_s:.1f} with "
        f"the waits for a core), without clients {1000 * control.own_gap_s:.1f} "
        f"({1000 * control.gap_s:.1f}); {100 * heard.core:.0f} % of a core "
        f"({100 * control.core:.0f} % without clients); {before / 2**20:.0f} MiB in the first "
        f"{SETTLE_S:.0f} s, {after / 2**20:.0f} at the end; {heard.dropped} frames dropped"
    )
    return Row(what, [problem for is_so, problem in told if is_so], figures)


async def crowd(seconds: float, clients: int = 49, rate_hz: float = 100.0) -> Row:
    """Return what many clients receive beside one that reads nothing."""
    what = f"{clients} clients and one that reads nothing, {rate_hz:.0f} Hz, JSON of 4 kB"
    control, heard = await run_with_clients(text, rate_hz, seconds, "none", clients, deaf=1)
    row = judged(what, round(rate_hz * seconds), control, heard)
    if not heard.dropped and seconds > 2 * SETTLE_S:
        row.problems.append("the client that reads nothing was given everything")
    return row


async def images(seconds: float, compression: str, clients: int, rate_hz: float) -> Row:
    """Return what clients receive of images of 6 MB."""
    kind = "JSON" if compression == "none" else compression
    what = f"images of 6 MB at {rate_hz:.0f} Hz to {clients} clients by {kind}"
    control, heard = await run_with_clients(image, rate_hz, seconds, compression, clients)
    return judged(what, round(rate_hz * seconds), control, heard)


async def garbage(seconds: float, kind: str, rate_hz: float = 10_000.0) -> Row:
    """Return what the garbage of one client costs the gateway."""
    what = f"garbage at {rate_hz:.0f} frames/s: {kind}"
    async with robot_with_gateway(text, Policy.default()) as robot:
        await asyncio.sleep(0.2)
        idle = await cost(robot, seconds / 3)
        port = str(robot.gateway.port)
        process = await started(GARBAGE, port, str(seconds), str(rate_hz), kind)
        assert process.stdout is not None
        await process.stdout.readline()
        loaded = await cost(robot, seconds - 1.0)
        offered, sent, disconnected = json.loads(await process.stdout.readline())
        await process.wait()
    core = max(loaded.core - idle.core, 0.0)
    told = [
        (offered < 0.99 * rate_hz * seconds, f"only {offered} frames were offered"),
        (core > GARBAGE_LIMIT, f"{100 * core:.1f} % of a core"),
        (
            loaded.own_gap_s > idle.own_gap_s + GAP_LIMIT_S,
            f"the loop stood still for {1000 * loaded.own_gap_s:.0f} ms",
        ),
    ]
    figures = (
        f"{offered} frames offered in {seconds:.0f} s, {sent} read or on their way, disconnected "
        f"{disconnected} times; {100 * core:.1f} % of a core; longest gap "
        f"{1000 * loaded.own_gap_s:.1f} ms of its own, idle {1000 * idle.own_gap_s:.1f}"
    )
    return Row(what, [problem for is_so, problem in told if is_so], figures)


async def cost(robot: Robot, seconds: float) -> Heard:
    """Return how the process performs for some seconds without publishing."""
    robot.gaps.begin()
    began_s, cpu_s = time.monotonic(), time.process_time()
    await asyncio.sleep(seconds)
    core = (time.process_time() - cpu_s) / (time.monotonic() - began_s)
    robot.gaps.end()
    gaps = robot.gaps
    return Heard(0, [], [], [], gaps.gap_s, gaps.own_gap_s, core, (0, 0), 0)
