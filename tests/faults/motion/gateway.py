"""A gateway, and a page without a node of its own that drives through it.

``python -m tests.faults.motion.gateway`` is the gateway. It writes its port to a file, since each
run has its own gateway.
"""

from __future__ import annotations

import asyncio
import json
import math
import os
import struct
import sys
import time
from collections.abc import Awaitable, Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import httpx
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Subprotocol

import aionode
from aionode import Context, Node
from aionode.engine.wire import cdr
from aionode.gateway import Gateway, Policy
from tests.faults.motion.wheels import command
from tests.faults.motion.words import Mover
from tests.faults.process import Reporter

__all__ = ["TTL_S", "drive"]

TTL_S = 0.3

POLICY = f"""
[[who]]
name = "page"
token = "page"
[[who]]
name = "lax"
token = "lax"
[[allow]]
who = "page"
publish = "/**"
lease = {{ ttl_sec = {TTL_S} }}
[[allow]]
who = "page"
goal = "/**"
[[allow]]
who = "lax"
publish = "/**"
goal = "/**"
finite = false
"""
"""With a lease for the page; another client has none, and may send anything."""

TWIST = "geometry_msgs/msg/Twist"
ACTION = "test_msgs/action/Fibonacci"
DRIVE = "minibot_interfaces/msg/Drive"
APPROACH = "minibot_interfaces/action/Approach"


def port_file() -> Path:
    """Return the file with the port."""
    return Path(os.environ["XDG_RUNTIME_DIR"]) / "gateway-port"


async def serve() -> None:
    """Serve until a signal; with an argument, on all addresses, and assistants as well."""
    more: dict[str, Any] = {"host": "0.0.0.0", "mcp": True} if sys.argv[1:] else {}  # noqa: S104
    async with (
        Context() as context,
        Node("gateway", context=context) as node,
        Gateway(node, Policy.parse(POLICY), port=0, **more) as gateway,
    ):
        port_file().write_text(str(gateway.port), encoding="ascii")
        await asyncio.Event().wait()


# The page


class Page:
    """A page or program that drives.

    Lines on stdin control it: ``move`` starts, ``quiet`` lets go, and ``nan`` has it compute NaN.
    """

    def __init__(self, mover: Mover, reporter: Reporter, port: int) -> None:
        self._mover = mover
        self._port = port
        self._moves = asyncio.Event()
        self._speed = 1.0
        self._type, self._action = TWIST, ACTION
        if mover.has_defaults:
            self._type, self._action = DRIVE, APPROACH
        os.set_blocking(sys.stdin.fileno(), False)
        asyncio.get_running_loop().add_reader(sys.stdin, self._obey)
        reporter.report.ready = True

    def _obey(self) -> None:
        match sys.stdin.readline().split():
            case ["move"]:
                self._moves.set()
            case ["quiet", *_]:
                self._moves.clear()
            case ["nan", *_]:
                self._speed = math.nan
            case []:
                asyncio.get_running_loop().remove_reader(sys.stdin)

    async def run(self) -> None:
        """Drive through the gateway until cancelled."""
        await self._moves.wait()
        ways: dict[str, Callable[[], Awaitable[None]]] = {
            "rosbridge": self._rosbridge,
            "foxglove json": self._foxglove,
            "foxglove cdr": self._foxglove,
            "http": self._http,
        }
        await ways[self._mover.way]()

    def _values(self) -> dict[str, Any]:
        """Return a command as JSON: a page writes null for NaN."""
        if self._mover.has_defaults:
            return {"by": os.getpid()} | ({"for_sec": 0.0} if self._mover.sends_zeros else {})
        twist = command()
        speed = None if math.isnan(self._speed) else self._speed
        return {
            "linear": {"x": speed, "y": twist.linear.y},
            "angular": {"x": twist.angular.x},
        }

    def _goal(self) -> dict[str, Any]:
        """Return a goal in JSON."""
        if self._mover.has_defaults:
            return {"by": os.getpid()} | ({"tolerance": 0.0} if self._mover.sends_zeros else {})
        return {"order": os.getpid()}

    async def _at_its_pace(self, send: Callable[[], Awaitable[object]]) -> None:
        while True:
            await self._moves.wait()
            await send()
            await asyncio.sleep(self._mover.period_s)

    def _connect(self, *protocols: str) -> connect:
        url = f"ws://{self._mover.host}:{self._port}/?token={self._mover.client}"
        return connect(url, proxy=None, subprotocols=[*map(Subprotocol, protocols)] or None)

    async def _rosbridge(self) -> None:
        async with self._connect() as page:
            if self._mover.asks == "goal":
                op = {"op": "send_action_goal", "id": "1", "action": self._mover.topic}
                goal = {"action_type": self._action, "args": self._goal(), "feedback": True}
                await page.send(json.dumps(op | goal))
                async for _ in page:
                    pass
            op = {"op": "publish", "topic": self._mover.topic, "type": self._type}
            await self._at_its_pace(lambda: page.send(json.dumps({**op, "msg": self._values()})))

    async def _foxglove(self) -> None:
        encoding = self._mover.way.split()[1]
        channel = {"id": 1, "topic": self._mover.topic, "encoding": encoding}
        channel["schemaName"] = self._type
        async with self._connect("foxglove.sdk.v1") as app, asyncio.TaskGroup() as tasks:
            tasks.create_task(drain(app))
            await app.send(json.dumps({"op": "advertise", "channels": [channel]}))
            await self._at_its_pace(lambda: app.send(struct.pack("<BI", 1, 1) + self._data()))

    def _data(self) -> bytes:
        if self._mover.way == "foxglove json":
            return json.dumps(self._values()).encode()
        twist = command()
        twist.linear.x = self._speed
        return bytes(cdr.encode(twist))

    async def _http(self) -> None:
        headers = {"Authorization": f"Bearer {self._mover.client}"}
        url = f"http://127.0.0.1:{self._port}"
        async with httpx.AsyncClient(
            base_url=url, headers=headers, trust_env=False, timeout=60.0
        ) as client:
            if self._mover.asks == "goal":
                await client.post(
                    f"/actions{self._mover.topic}?type={self._action}", json=self._goal()
                )
            path = f"/topics{self._mover.topic}?type={self._type}"
            await self._at_its_pace(lambda: client.post(path, json=self._values()))


async def drain(app: ClientConnection) -> None:
    """Read and discard what a client does not need."""
    async for _ in app:
        pass


def drive(mover: Mover, reporter: Reporter) -> None:
    """Drive until a signal."""

    async def main() -> None:
        port = 0
        ends_s = time.monotonic() + 60.0
        is_alone = mover.way.startswith("mcp stdio")
        while not (port or is_alone) and time.monotonic() < ends_s:
            with suppress(OSError, ValueError):
                port = int(port_file().read_text(encoding="ascii"))
            await asyncio.sleep(0.05)
        if mover.way.startswith("mcp"):
            from tests.faults.motion.assistant import Assistant  # what it imports takes a second

            await Assistant(mover, reporter, f"http://{mover.host}:{port}").run()
        else:
            await Page(mover, reporter, port).run()

    aionode.run(main, reporter.go_on, args=[])


if __name__ == "__main__":
    aionode.run(serve, args=[])
