"""A gateway on a port of this host, clients with custom headers, and a cable that can be cut."""

from __future__ import annotations

import asyncio
import gc
import json
import ssl
import time  # noqa: TID251  # how long the loop's thread is busy
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import Any

import httpx
import psutil
from websockets.asyncio.client import ClientConnection, connect

from aionode.gateway import Gateway, Policy, Session
from aionode.node import Node
from aionode.testing import local_context

__all__ = ["Cable", "address", "busiest_turn", "cable", "drive", "get", "http_client"]
__all__ += ["connections_of", "raw_connect", "serving", "session_of", "sessions_of"]
__all__ += ["subscribers_of", "upgraded"]

UPGRADE = (
    "GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n{more}\r\n"
)
"""The request by which a WebSocket begins."""

PERIOD_SEC = 0.002
"""The interval at which `busiest_turn` looks at the event loop."""


@asynccontextmanager
async def serving(policy: Policy | None = None, **options: Any) -> AsyncIterator[Gateway]:
    """Yield a gateway on a free port, in a context of its own."""
    async with (
        local_context() as context,
        Node("gateway", context=context) as node,
        Gateway(node, policy, port=0, **options) as gateway,
    ):
        yield gateway


def address(gateway: Gateway, path: str = "/") -> str:
    """Return the address of a WebSocket."""
    return f"ws://127.0.0.1:{gateway.port}{path}"


def sessions_of(gateway: Gateway) -> list[Session]:
    """Return the sessions of the clients, of which `stats` has only the counts."""
    return gateway.clients.sessions


def session_of(gateway: Gateway) -> Session:
    """Return the session of the only client."""
    (session,) = sessions_of(gateway)
    return session


def subscribers_of(gateway: Gateway) -> int:
    """Return how many clients have a subscription."""
    return sum(bool(session.dropped()) for session in sessions_of(gateway))


def connections_of(gateway: Gateway) -> int:
    """Return the gateway's number of client sockets, according to the operating system."""
    sockets = psutil.Process().net_connections("tcp")
    mine = [each for each in sockets if each.laddr.port == gateway.port]
    return sum(each.status != psutil.CONN_LISTEN for each in mine)


def http_client() -> httpx.AsyncClient:
    """Return a client that loads no certificates, and waits as long as a busy machine takes."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    return httpx.AsyncClient(trust_env=False, verify=context, timeout=50)


async def get(
    gateway: Gateway, path: str = "/topics", headers: dict[str, str] | None = None
) -> httpx.Response:
    """Return the answer to a request."""
    async with http_client() as client:
        return await client.get(f"http://127.0.0.1:{gateway.port}{path}", headers=headers)


@asynccontextmanager
async def raw_connect(
    gateway: Gateway, path: str, headers: dict[str, str], protocols: list[str]
) -> AsyncIterator[ClientConnection]:
    """Connect with custom headers, which a page could not set."""
    host = headers.get("host", f"127.0.0.1:{gateway.port}")
    others = {name: value for name, value in headers.items() if name != "host"}
    async with connect(
        f"ws://{host}{path}" if ":" in host else f"ws://{host}:{gateway.port}{path}",
        host="127.0.0.1",
        port=gateway.port,
        additional_headers=others,
        subprotocols=protocols or None,  # type: ignore[arg-type]  # names of protocols
        proxy=None,
    ) as websocket:
        yield websocket


async def upgraded(
    gateway: Gateway, more: str = "", path: str = "/"
) -> tuple[asyncio.StreamReader, asyncio.StreamWriter, str]:
    """Open a WebSocket whose frames the test writes itself.

    Args:
        gateway: The gateway.
        more: Further headers, each with its line break.
        path: The path.

    Returns:
        The reader, the writer, and the head of the answer.
    """
    reader, writer = await asyncio.open_connection("127.0.0.1", gateway.port)
    writer.write(UPGRADE.format(path=path, more=more).encode())
    head = await reader.readuntil(b"\r\n\r\n")
    return reader, writer, head.decode()


def drive(speed: float) -> str:
    """Return a command as a rosbridge client sends it."""
    command = {"linear": {"x": speed}}
    op = {"op": "publish", "topic": "/cmd_vel", "type": "geometry_msgs/Twist", "msg": command}
    return json.dumps(op)


Kept = asyncio.Queue[bytes]


class Cable:
    """The connection between a client and the gateway; it keeps what is sent while it is cut.

    TCP does the same, by retransmission.

    Attributes:
        port: Where the client connects.
        to_gateway: Set while bytes of the client arrive.
        to_client: Set while bytes of the gateway arrive.
        sent_bytes: How many bytes the client has sent.
    """

    def __init__(self, gateway_port: int) -> None:
        self.port = 0
        self.to_gateway = asyncio.Event()
        self.to_client = asyncio.Event()
        self.sent_bytes = 0
        self._gateway_port = gateway_port
        self.join()

    def cut(self) -> None:
        """Pass nothing on."""
        self.to_gateway.clear()
        self.to_client.clear()

    def join(self) -> None:
        """Pass everything on, first what was sent meanwhile."""
        self.to_gateway.set()
        self.to_client.set()

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Connect one client."""
        far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self._gateway_port)

        async def take(source: asyncio.StreamReader, kept: Kept) -> None:
            data = b"first"
            while data:
                try:
                    data = await source.read(1 << 16)
                except OSError:
                    data = b""
                self.sent_bytes += len(data) if source is reader else 0
                kept.put_nowait(data)

        async def give(target: asyncio.StreamWriter, whole: asyncio.Event, kept: Kept) -> None:
            with suppress(OSError):
                while data := await kept.get():
                    await whole.wait()
                    target.write(data)
                    await target.drain()
                await whole.wait()
            target.close()

        there, back = Kept(), Kept()
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(take(reader, there))
            tasks.create_task(take(far_reader, back))
            tasks.create_task(give(far_writer, self.to_gateway, there))
            tasks.create_task(give(writer, self.to_client, back))


@asynccontextmanager
async def cable(gateway: Gateway) -> AsyncIterator[Cable]:
    """Yield a cable to a gateway, which is joined at the end."""
    made = Cable(gateway.port)
    server = await asyncio.start_server(made.serve, "127.0.0.1", 0)
    made.port = server.sockets[0].getsockname()[1]
    try:
        yield made
    finally:
        made.join()
        server.close()


class Busy:
    """The longest busy time of the loop's thread in a turn, in seconds, and the number of looks."""

    longest_sec = 0.0
    looks = 0


@asynccontextmanager
async def busiest_turn() -> AsyncIterator[Busy]:
    """Yield the duration of turns of the event loop, as processor time without waits for a core.

    Short turns are counted together, as one of at most twice `PERIOD_SEC`.
    """
    gc.collect()
    gc.freeze()  # else a turn with a full collection looks at what all tests before have left
    busy = Busy()

    async def watch() -> None:
        last = time.thread_time()
        while True:
            await asyncio.sleep(PERIOD_SEC)  # noqa: TID251  # in each turn, a core would be busy
            now = time.thread_time()
            busy.longest_sec = max(busy.longest_sec, now - last)
            last = now
            busy.looks += 1

    async with asyncio.TaskGroup() as tasks:
        watching = tasks.create_task(watch())
        yield busy
        watching.cancel()
