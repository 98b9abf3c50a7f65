"""Clients in processes of their own, which vanish while the robot moves: the stop is sent."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import time  # noqa: TID251  # real processes, so real time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import pytest

from aionode.context import Context
from aionode.gateway import Gateway, Policy
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.node import Node
from aionode.testing import local_context
from tests.support.peers import free_ports, isolated_environment
from tests.support.waiting import until

TTL_SEC = 0.3
SOON_SEC = 5.0
"""How late it may be on a busy machine; the cases of `make motion` measure it."""

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
    """End a process, in whatever state it is then."""
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def driving(port: int) -> AbstractContextManager[subprocess.Popen[bytes]]:
    """Start a client that drives, and end it."""
    url = f"ws://127.0.0.1:{port}"
    return ended(subprocess.Popen([sys.executable, "-c", DRIVER, url], stderr=subprocess.DEVNULL))


def serving(*options: str) -> AbstractContextManager[subprocess.Popen[bytes]]:
    """Start a gateway, and end it."""
    return ended(subprocess.Popen([sys.executable, "-m", "aionode", "gateway", *options]))


def waited_sec() -> float:
    """Return for how long this process has waited for a core so far."""
    path = Path("/proc/self/schedstat")
    return int(path.read_text().split()[1]) / 1e9 if path.exists() else 0.0


async def stops_after(how: signal.Signals, times: int = 1) -> list[float]:
    """Return after how many seconds the stop came, without the waits for a core."""
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


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP])
async def test_the_stop_is_sent_when_a_client_is_killed_or_frozen(how: signal.Signals) -> None:
    """Neither says goodbye; the frozen one even keeps its connection."""
    assert len(await stops_after(how)) == 1


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP])
async def test_the_wheels_stop_when_the_gateway_is_killed_or_frozen(
    how: signal.Signals, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Nobody sends a stop then: it is the wheels that notice the silence."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    policy = tmp_path / "policy.toml"
    policy.write_text(POLICY)
    (port,) = free_ports(1)
    options = ["--port", str(port), "--policy", str(policy)]
    got: list[float] = []
    silent = asyncio.Event()
    async with Context() as context, Node("wheels", context=context) as wheels:
        wheels.create_subscription(
            Twist, "/cmd_vel", lambda msg: got.append(msg.linear.x), 10,
            on_silence=silent.set, silence_sec=TTL_SEC,
        )  # fmt: skip
        with serving(*options) as it:
            await until(lambda: wheels.graph.endpoints(name="/gateway/audit"))
            with driving(port):
                await until(lambda: len(got) > 2)
                began, waited = time.monotonic(), waited_sec()
                os.kill(it.pid, how)
                await silent.wait()
                late_sec = time.monotonic() - began - (waited_sec() - waited) - TTL_SEC
                moved = len(got)
                await wheels.get_clock().sleep(1.0)

    assert late_sec < SOON_SEC
    assert len(got) == moved


@pytest.mark.stress
@pytest.mark.timeout(300)
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP])
async def test_the_stop_comes_within_the_time_to_live(how: signal.Signals) -> None:
    """And 0.1 s, less the waits for a core: 50 of 50 times for either."""
    late = [seconds for seconds in await stops_after(how, 50) if seconds > TTL_SEC + 0.1]

    assert late == []
