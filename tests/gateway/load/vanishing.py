"""Processes that vanish while the robot moves: clients of a gateway, or the gateway itself."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import NamedTuple

from aionode.engine.context import Context
from aionode.gateway import Gateway, Policy
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.node import Node
from aionode.testing import local_context
from tests.gateway.load.cases import Row
from tests.support.peers import free_ports
from tests.support.waiting import until

__all__ = [
    "LATE_SEC",
    "TTL_SEC",
    "Silence",
    "client_vanishes",
    "gateway_vanishes",
    "silences",
    "stops_after",
]

TTL_SEC = 0.3
LATE_SEC = 0.1
"""How much later than its time to live the stop may arrive, without waits for a core."""

POLICY = f"""
[[who]]
name = "local"
loopback = true
[[allow]]
publish = "/cmd_vel"
lease = {{ ttl_sec = {TTL_SEC} }}
"""
DRIVER = """
import json, sys, time
from websockets.sync.client import connect
with connect(sys.argv[1], proxy=None) as socket:
    while True:
        socket.send(json.dumps({"op": "publish", "topic": "/cmd_vel",
            "type": "geometry_msgs/Twist", "msg": {"linear": {"x": 1.0}}}))
        time.sleep(0.05)
"""


@contextmanager
def ended(process: subprocess.Popen[bytes]) -> Iterator[subprocess.Popen[bytes]]:
    """End a process, whatever its state."""
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def driving(port: int) -> AbstractContextManager[subprocess.Popen[bytes]]:
    """Start a client that drives, and end it afterwards."""
    url = f"ws://127.0.0.1:{port}"
    return ended(subprocess.Popen([sys.executable, "-c", DRIVER, url], stderr=subprocess.DEVNULL))


def serving(*options: str) -> AbstractContextManager[subprocess.Popen[bytes]]:
    """Start a gateway, and end it afterwards."""
    argv = [sys.executable, "-m", "aionode", "gateway", *options]
    return ended(subprocess.Popen(argv, stdout=subprocess.DEVNULL))


def waited_sec() -> float:
    """Return how long this process has waited for a core so far."""
    path = Path("/proc/self/schedstat")
    return int(path.read_text().split()[1]) / 1e9 if path.exists() else 0.0


async def stops_after(how: signal.Signals, times: int = 1) -> list[float]:
    """Return the delay of the stop in seconds, without waits for a core."""
    got: list[float] = []
    found: list[float] = []
    async with (
        local_context() as context,
        Node("gateway", context=context) as node,
        Gateway(node, Policy.parse(POLICY), port=0) as gateway,
    ):
        node.create_subscription(Twist, "/cmd_vel", lambda msg: got.append(msg.linear.x), 100)
        for _ in range(times):
            got.clear()
            with driving(gateway.port) as client:
                await until(lambda: len(got) > 2)
                began, waited = time.monotonic(), waited_sec()
                os.kill(client.pid, how)
                await until(lambda: got[-1] == 0.0)
                found.append(time.monotonic() - began - (waited_sec() - waited))
                assert got.count(0.0) == 1
    return found


class Silence(NamedTuple):
    """How the wheels of a robot noticed that its gateway was gone.

    Attributes:
        after_sec: After how many seconds, without the waits for a core.
        moved: How many commands they got in the second after it.
    """

    after_sec: float
    moved: int


async def silences(how: signal.Signals, folder: Path, times: int = 1) -> list[Silence]:
    """Return how the wheels notice that their gateway was killed or frozen while a client drives.

    Args:
        how: The signal that the gateway gets.
        folder: Where its policy is written.
        times: How often.
    """
    policy = folder / "policy.toml"
    policy.write_text(POLICY)
    (port,) = free_ports(1)
    options = ["--port", str(port), "--policy", str(policy)]
    return [await silence(how, port, options) for _ in range(times)]


async def silence(how: signal.Signals, port: int, options: list[str]) -> Silence:
    """Return how the wheels notice it once."""
    got: list[float] = []
    silent = asyncio.Event()
    async with Context() as context, Node("wheels", context=context) as wheels:
        wheels.create_subscription(
            Twist, "/cmd_vel", lambda msg: got.append(msg.linear.x), 10,
            on_silence=silent.set, silence_sec=TTL_SEC,
        )  # fmt: skip
        with serving(*options) as gateway:
            await until(lambda: wheels.graph.endpoints(name="/gateway/audit"))
            with driving(port):
                await until(lambda: len(got) > 2)
                began, waited = time.monotonic(), waited_sec()
                os.kill(gateway.pid, how)
                await silent.wait()
                after_sec = time.monotonic() - began - (waited_sec() - waited)
                moved = len(got)
                await wheels.get_clock().sleep(1.0)
    return Silence(after_sec, len(got) - moved)


# Rows of the table


async def client_vanishes(how: signal.Signals, times: int) -> Row:
    """Return how soon the robot stops when the driving client is killed or frozen."""
    after = await stops_after(how, times)
    late = sum(each > TTL_SEC + LATE_SEC for each in after)
    problems = [f"{late} stops came too late"] * bool(late)
    limit = TTL_SEC + LATE_SEC
    return Row(f"{how.name} of a client that drives", problems, counted(after, limit, "stop"))


async def gateway_vanishes(how: signal.Signals, times: int) -> Row:
    """Return how soon the wheels notice that the gateway was killed or frozen."""
    with tempfile.TemporaryDirectory() as folder:
        found = await silences(how, Path(folder), times)
    after = [each.after_sec for each in found]
    late = sum(each > TTL_SEC + LATE_SEC for each in after)
    moved = sum(each.moved > 0 for each in found)
    told = [(late, f"{late} came too late"), (moved, f"{moved} moved again")]
    limit = TTL_SEC + LATE_SEC
    problems = [text for number, text in told if number]
    return Row(f"{how.name} of the gateway", problems, counted(after, limit, "`on_silence`"))


def counted(after: list[float], limit_sec: float, what: str) -> str:
    """Return how many times are within a limit."""
    within = sum(each <= limit_sec for each in after)
    return (
        f"{what} within {limit_sec:g} s {within} of {len(after)} times, less the waits for a core; "
        f"longest {max(after):.3f} s (time to live {TTL_SEC:g} s)"
    )
