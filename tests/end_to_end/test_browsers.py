"""Browsers that are killed while a route of a real web server awaits a node."""

from __future__ import annotations

import asyncio
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from contextlib import contextmanager

import pytest
import uvicorn
from fastapi import FastAPI, Request, Response
from starlette.middleware.base import BaseHTTPMiddleware

from aionode.fastapi import until_disconnected
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.node import Node

pytestmark = [pytest.mark.timeout(60), pytest.mark.one_loop]

BROWSER = """
import socket, sys
port, text = int(sys.argv[1]), sys.argv[2]
connection = socket.create_connection(("127.0.0.1", port))
connection.sendall(text.encode())
connection.recv(1)
"""

REQUEST = "GET /{} HTTP/1.1\r\nHost: robot\r\n\r\n"
POST = 'POST /{} HTTP/1.1\r\nHost: robot\r\nContent-Length: 7\r\n\r\n{{"a":1}}'

Ends = asyncio.Queue[str]


def socket_client(text: str, port: int, path: str) -> list[str]:
    """Return a program that sends `text`, and waits for a response."""
    return [sys.executable, "-c", BROWSER, str(port), text.format(path)]


def curl(_: str, port: int, path: str) -> list[str]:
    """Return a curl command that does the same."""
    return ["curl", "--silent", f"http://127.0.0.1:{port}/{path}"]


@contextmanager
def running(command: list[str]) -> Iterator[subprocess.Popen[bytes]]:
    """Start a browser, which is killed at the end."""
    with subprocess.Popen(command) as browser:
        try:
            yield browser
        finally:
            browser.kill()


async def pass_on(
    request: Request, call_next: Callable[[Request], Awaitable[Response]]
) -> Response:
    """Do nothing, as a middleware."""
    return await call_next(request)


@pytest.fixture
def ends() -> Ends:
    """How the waiting routes end."""
    return asyncio.Queue()


@pytest.fixture
async def app(node_factory: Callable[..., Node], ends: Ends) -> FastAPI:
    """An application whose routes await a service that does not answer."""

    async def never(_request: AddTwoInts.Request) -> AddTwoInts.Response:
        await asyncio.Event().wait()
        raise AssertionError

    node_factory("slow").create_service(AddTwoInts, "/slow", never, concurrent=True)
    client = node_factory("web").create_client(AddTwoInts, "/slow")
    app = FastAPI()

    async def wait() -> None:
        ends.put_nowait("began")
        try:
            await client.call(AddTwoInts.Request(), timeout_sec=20)
        except BaseException as error:
            ends.put_nowait(type(error).__name__)
            raise

    @app.api_route("/guarded", methods=["GET", "POST"])
    async def guarded(request: Request) -> None:
        async with until_disconnected(request):
            await wait()

    @app.get("/alone")
    async def alone() -> None:
        await wait()

    return app


@pytest.fixture
async def server(app: FastAPI, request: pytest.FixtureRequest) -> AsyncIterator[int]:
    """A server of the application; its port."""
    if getattr(request, "param", "") == "middleware":
        app.add_middleware(BaseHTTPMiddleware, dispatch=pass_on)
    listening = socket.create_server(("127.0.0.1", 0))
    # asyncio does not take it for one of TCP: answers in two parts would wait 40 ms each.
    listening.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    config = uvicorn.Config(app, log_level="warning", loop="none", timeout_graceful_shutdown=1)
    server = uvicorn.Server(config)
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(server.serve(sockets=[listening]))
        yield listening.getsockname()[1]
        server.should_exit = True
    listening.close()


@pytest.mark.parametrize(
    ("command", "text"),
    [
        pytest.param(socket_client, REQUEST, id="get"),
        pytest.param(socket_client, POST, id="post"),
        pytest.param(
            curl,
            "",
            id="curl",
            marks=pytest.mark.skipif(not shutil.which("curl"), reason="needs curl"),
        ),
    ],
)
@pytest.mark.parametrize("server", ["", "middleware"], indirect=True)
async def test_a_killed_browser_cancels_the_call_of_its_route(
    server: int,
    ends: Ends,
    command: Callable[[str, int, str], list[str]],
    text: str,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """The kernel closes its connection, and the server reports it; nothing is logged."""
    with running(command(text, server, "guarded")) as browser:
        async with asyncio.timeout(20):
            assert await ends.get() == "began"
            browser.kill()
            assert await ends.get() == "CancelledError"

    assert caplog.records == []


async def test_without_the_helper_the_route_goes_on(server: int, ends: Ends) -> None:
    """The request then ends with its own timeout, or with the server."""
    with running(socket_client(REQUEST, server, "alone")) as browser:
        async with asyncio.timeout(20):
            assert await ends.get() == "began"
        browser.kill()
        browser.wait(timeout=20)
        with running(socket_client(REQUEST, server, "guarded")) as other:
            async with asyncio.timeout(20):
                assert await ends.get() == "began"
                other.kill()
                assert await ends.get() == "CancelledError"

    assert ends.empty()


async def test_a_browser_that_is_frozen_keeps_its_connection(server: int, ends: Ends) -> None:
    """As behind a cut cable, no server can notice. A lease ends what it has requested."""
    with running(socket_client(REQUEST, server, "guarded")) as browser:
        async with asyncio.timeout(20):
            assert await ends.get() == "began"
            browser.send_signal(signal.SIGSTOP)
            with pytest.raises(TimeoutError):
                async with asyncio.timeout(0.5):
                    await ends.get()
            browser.send_signal(signal.SIGCONT)
            browser.kill()
            assert await ends.get() == "CancelledError"
