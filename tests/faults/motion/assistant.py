"""A language model's client that drives by MCP: over a command's streams, or over HTTP."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from pathlib import Path
from typing import Any

import httpx2
import mcp
import psutil
from mcp.client.streamable_http import streamable_http_client

from aionode.message import to_builtins
from tests.faults.motion.wheels import command
from tests.faults.motion.words import Mover
from tests.faults.process import Reporter

__all__ = ["Assistant"]

POLICY = """
[[who]]
name = "assistant"
loopback = true
[[allow]]
publish = "/**"
lease = { ttl_sec = 0.3 }
[[allow]]
goal = "/**"
"""


def close_streams() -> None:
    """Close this end of the pipes to the command, without a message."""
    (server,) = psutil.Process().children()
    pipes = set()
    for path in Path(f"/proc/{server.pid}/fd").iterdir():
        with suppress(OSError):
            pipes.add(path.readlink())
    for path in list(Path("/proc/self/fd").iterdir()):
        with suppress(OSError):
            if path.readlink() in pipes and "pipe:" in str(path.readlink()):
                os.close(int(path.name))


class Assistant:
    """Calls tools as lines on stdin request.

    ``move`` calls the tool that moves, ``cancel`` cancels the call, and ``leave`` closes the
    streams of the command without a message.
    """

    def __init__(self, mover: Mover, reporter: Reporter, address: str) -> None:
        self._mover = mover
        self._address = address
        self._moves = asyncio.Event()
        self._calling: asyncio.Task[Any] | None = None
        os.set_blocking(sys.stdin.fileno(), False)
        asyncio.get_running_loop().add_reader(sys.stdin, self._obey)
        reporter.report.ready = True

    def _obey(self) -> None:
        match sys.stdin.readline().split():
            case ["move"]:
                self._moves.set()
            case ["cancel", *_] if self._calling is not None:
                self._calling.cancel()
            case ["leave", *_]:
                close_streams()
            case []:
                asyncio.get_running_loop().remove_reader(sys.stdin)

    async def run(self) -> None:
        """Drive until cancelled."""
        await self._moves.wait()
        async with self._client() as client, asyncio.TaskGroup() as tasks:
            while True:
                await self._moves.wait()
                self._calling = tasks.create_task(self._called(client))
                await asyncio.wait([self._calling])
                self._moves.clear()  # it may have been told again meanwhile

    async def _called(self, client: Any) -> None:
        with suppress(mcp.MCPError):
            await client.call_tool(*self._call())

    def _call(self) -> tuple[str, dict[str, Any]]:
        """Return the tool and its arguments, which identify the process that asked."""
        seconds = self._mover.seconds
        if self._mover.asks == "goal":
            goal = {"order": os.getpid()}
            return "do", {"action": self._mover.topic, "goal": goal, "seconds": seconds}
        message = to_builtins(command())
        return "move", {"topic": self._mover.topic, "message": message, "seconds": seconds}

    @asynccontextmanager
    async def _client(self) -> AsyncIterator[Any]:
        """Yield a client that is connected as the mover specifies."""
        _, transport, era = self._mover.way.split()
        mode: Any = "auto" if era == "new" else "legacy"
        async with AsyncExitStack() as stack:
            target: Any
            if transport == "stdio":
                path = Path(os.environ["XDG_RUNTIME_DIR"]) / f"policy-{os.getpid()}.toml"
                path.write_text(POLICY, encoding="utf-8")
                words = ["-m", "aionode", "mcp", "--policy", str(path)]
                target = mcp.StdioServerParameters(
                    command=sys.executable, args=words, env=dict(os.environ)
                )
            else:
                headers = {"Authorization": f"Bearer {self._mover.client}"}
                http = await stack.enter_async_context(
                    httpx2.AsyncClient(headers=headers, trust_env=False, timeout=60.0)
                )
                target = streamable_http_client(f"{self._address}/mcp", http_client=http)
            yield await stack.enter_async_context(mcp.Client(target, mode=mode))
