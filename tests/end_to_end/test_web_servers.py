"""Web applications around nodes, under the servers that people run them with."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Final

import pytest

from tests.support.peers import free_ports

if TYPE_CHECKING:
    from collections.abc import Iterator

APP: Final = """
import asyncio
from contextlib import asynccontextmanager
from fastapi import FastAPI, Request
from fastapi.responses import StreamingResponse
from aionode import Context, Node
from aionode.fastapi import stopping_at_signals, until_disconnected
from aionode.interfaces.std_msgs.msg import Float64

@asynccontextmanager
async def lifespan(app):
    async with Node("web", context=Context(transport="local")) as node, stopping_at_signals(node):
        app.state.node = node
        app.state.wheels = node.create_publisher(Float64, "/speed", 10)
        node.create_subscription(Float64, "/speed", lambda msg: print(msg.data, flush=True))
        yield

app = FastAPI(lifespan=lifespan)

@app.get("/drive")
async def drive(request: Request):
    async with until_disconnected(request):
        async with app.state.wheels.lease(stop=Float64(), ttl_sec=60.0) as lease:
            lease.publish(Float64(data=1.0))
            await asyncio.Event().wait()

@app.get("/events")
async def events():
    async def stream():
        yield "data: hello\\n\\n"
        async for _ in app.state.node.create_subscription(Float64, "/nothing"):
            yield "data: never\\n\\n"
    return StreamingResponse(stream(), media_type="text/event-stream")
"""

SERVERS: Final = {
    "uvicorn": ("uvicorn", "app:app", "--port"),
    "fastapi": ("fastapi", "run", "app.py", "--port"),
    "hypercorn": ("hypercorn", "app:app", "--workers", "0", "--bind"),
    "gunicorn": ("gunicorn", "app:app", "--worker-class", "uvicorn_worker.UvicornWorker", "--bind"),
}


class Server:
    """A web server that runs the application."""

    def __init__(self, folder: Path, name: str) -> None:
        (folder / "app.py").write_text(textwrap.dedent(APP), encoding="utf-8")
        (self.port,) = free_ports(1)
        command = SERVERS[name]
        address = str(self.port) if command[-1] == "--port" else f"127.0.0.1:{self.port}"
        self.process = subprocess.Popen(
            [sys.executable, "-m", *command, address],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": str(Path.cwd())},
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )

    def ask(self, path: str) -> socket.socket:
        """Send a request as soon as the server listens, and return its connection."""
        while True:
            try:
                client = socket.create_connection(("127.0.0.1", self.port), timeout=20)
            except ConnectionRefusedError:
                assert self.process.poll() is None
                continue
            client.sendall(f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
            return client

    def line(self) -> str:
        """Return the next command of the wheels."""
        assert self.process.stdout is not None
        while True:
            line = self.process.stdout.readline()
            if not line or line in ("0.0\n", "1.0\n"):
                return line


@pytest.fixture
def server(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Server]:
    """Return a server of the given kind."""
    server = Server(tmp_path, request.param)
    yield server
    server.process.kill()
    server.process.wait()
    assert server.process.stdout is not None
    server.process.stdout.close()


@pytest.mark.slow
@pytest.mark.parametrize("server", SERVERS, indirect=True)
def test_the_first_signal_ends_motion_whatever_is_open(server: Server) -> None:
    """A server waits for its routes and streams, while the robot must not drive on."""
    with server.ask("/events") as stream, server.ask("/drive") as drive:
        assert stream.recv(1000)
        assert server.line() == "1.0\n"

        server.process.send_signal(signal.SIGTERM)

        assert server.line() == "0.0\n"
        assert drive.recv(1000).startswith(b"HTTP/1.1 503 ")
        assert server.process.wait(20) is not None
