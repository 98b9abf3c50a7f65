"""Routes that end with the browser that asked: the server and the browser are played by tests.

`tests/end_to_end/test_browsers.py` has a real server, and browsers that are killed.
"""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterator, Awaitable, Callable, MutableMapping
from typing import Any

import pytest
from fastapi import FastAPI, Request, Response
from fastapi.responses import StreamingResponse
from starlette.exceptions import HTTPException
from starlette.middleware.base import BaseHTTPMiddleware

from aionode._process.concurrency import checkpoint
from aionode.engine.context import Context
from aionode.fastapi import stopping_at_signals, until_disconnected
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import Float32
from aionode.node import Node
from aionode.testing import settle
from examples import fastapi_app, web_control
from examples.web_control import Operator, SetSpeed

LEAVES: dict[str, object] = {"type": "http.disconnect"}


class Browser:
    """One request: what it sends, and the response."""

    def __init__(
        self, app: FastAPI, path: str, method: str = "GET", body: bytes | None = b""
    ) -> None:
        self.status: object = None
        self.received = b""
        self._app = app
        self._incoming: asyncio.Queue[dict[str, object]] = asyncio.Queue()
        path, _, query = path.partition("?")
        self._scope = {
            "type": "http",
            "asgi": {"version": "3.0", "spec_version": "2.3"},
            "method": method,
            "path": path,
            "query_string": query.encode(),
            "headers": [(b"content-type", b"application/json")],
        }
        if body is not None:
            self.send(body)

    def send(self, body: bytes, *, more_body: bool = False) -> None:
        """Send a part of the body."""
        self._incoming.put_nowait({"type": "http.request", "body": body, "more_body": more_body})

    def leave(self) -> None:
        """Close the connection; the server says so as often as it is asked."""
        for _ in range(9):
            self._incoming.put_nowait(LEAVES)

    async def run(self) -> object:
        """Have the request answered, and return the status of the response."""

        async def send(message: MutableMapping[str, Any]) -> None:
            self.status = message.get("status", self.status)
            self.received += message.get("body", b"")

        await self._app(self._scope, self._incoming.get, send)
        return self.status


@pytest.fixture
def app() -> FastAPI:
    """An application without routes."""
    return FastAPI()


async def pass_on(
    request: Request, call_next: Callable[[Request], Awaitable[Response]]
) -> Response:
    """Do nothing, as a middleware."""
    return await call_next(request)


async def left(browser: Browser) -> object:
    """Have the browser leave as soon as its route waits; return the status of the response."""
    async with asyncio.TaskGroup() as tasks:
        answering = tasks.create_task(browser.run())
        await settle()
        assert not answering.done()
        browser.leave()
    return answering.result()


@pytest.mark.parametrize("middleware", [False, True])
async def test_the_block_is_cancelled_when_the_browser_leaves(
    app: FastAPI, *, middleware: bool
) -> None:
    """The status is nginx's for a client that has gone; the server sees no error."""
    ends: list[str] = []
    if middleware:
        app.add_middleware(BaseHTTPMiddleware, dispatch=pass_on)

    @app.get("/")
    async def wait(request: Request) -> None:
        async with until_disconnected(request):
            try:
                await asyncio.Event().wait()
            except asyncio.CancelledError:
                ends.append("cancelled")
                raise

    assert await left(Browser(app, "/")) == 499
    assert ends == ["cancelled"]


async def run_until_signalled(app: FastAPI) -> None:
    """Run an application with two routes, of which one cleans up as the signal arrives."""
    cleaned_up = asyncio.Event()

    @app.get("/left")
    async def clean_up(request: Request) -> None:
        async with until_disconnected(request):
            try:
                await asyncio.Event().wait()
            finally:
                await cleaned_up.wait()

    @app.get("/open")
    async def wait(request: Request) -> None:
        async with until_disconnected(request):
            await asyncio.Event().wait()

    before = signal.signal(signal.SIGTERM, signal.SIG_IGN)  # the server's own
    try:
        async with (
            Node("web", context=Context(transport="local")) as node,
            stopping_at_signals(node),
            asyncio.TaskGroup() as tasks,
        ):
            left_browser = Browser(app, "/left")
            leaving = tasks.create_task(left_browser.run())
            waiting = tasks.create_task(Browser(app, "/open").run())
            await settle()
            left_browser.leave()
            await settle()
            signal.raise_signal(signal.SIGTERM)
            assert await waiting == 503
            cleaned_up.set()
            assert await leaving == 503
    finally:
        signal.signal(signal.SIGTERM, before)


async def test_a_signal_ends_all_routes_while_one_cleans_up_after_its_browser(
    app: FastAPI,
) -> None:
    """A block that is being cancelled cannot be cancelled again, and kept the others open."""
    await run_until_signalled(app)


def test_a_signal_ends_the_routes_of_each_application_of_a_process() -> None:
    """An event that the first waits for belongs to its loop, and no node of the second ended."""
    for _ in range(2):
        asyncio.run(run_until_signalled(FastAPI()))


async def test_what_the_route_does_after_the_block_is_not_cancelled(app: FastAPI) -> None:
    """As after `asyncio.timeout`: the cancellation is used up."""
    after: list[int] = []

    @app.get("/")
    async def wait(request: Request) -> None:
        task = asyncio.current_task()
        assert task is not None
        try:
            async with until_disconnected(request):
                await asyncio.Event().wait()
        except HTTPException:
            await checkpoint()
            after.append(task.cancelling())

    assert await left(Browser(app, "/")) == 200
    assert after == [0]


async def test_a_request_that_is_answered_is_not_touched(app: FastAPI) -> None:
    """Its body can be read in the block, as it is kept."""

    @app.post("/")
    async def echo(request: Request) -> object:
        async with until_disconnected(request):
            await settle()
            return await request.json()

    browser = Browser(app, "/", "POST", b'{"a": 1}')

    assert await browser.run() == 200
    assert browser.received == b'{"a":1}'


async def test_a_body_that_was_read_as_a_stream_before_is_none_to_read(app: FastAPI) -> None:
    """Then only the end of the connection is left to wait for."""

    @app.post("/")
    async def wait(request: Request) -> None:
        assert [part async for part in request.stream() if part] == [b"one", b"two"]
        async with until_disconnected(request):
            await asyncio.Event().wait()

    browser = Browser(app, "/", "POST", None)
    browser.send(b"one", more_body=True)
    browser.send(b"two")

    assert await left(browser) == 499


async def test_a_browser_that_leaves_during_its_upload_is_not_an_error(app: FastAPI) -> None:
    """The block does not begin: the request is not complete."""
    began: list[str] = []

    @app.post("/")
    async def wait(request: Request) -> None:
        async with until_disconnected(request):
            began.append("block")

    browser = Browser(app, "/", "POST", None)
    browser.send(b"one", more_body=True)

    assert await left(browser) == 499
    assert began == []


@pytest.mark.parametrize("error", [HTTPException(504), ValueError("no map"), TimeoutError()])
async def test_an_error_of_the_block_comes_out_as_it_is(app: FastAPI, error: Exception) -> None:
    """This includes a TimeoutError, which says nothing of the browser."""
    seen: list[Exception] = []

    @app.get("/")
    async def fail(request: Request) -> None:
        try:
            async with until_disconnected(request):
                raise error  # noqa: TRY301  # as what the block awaits would
        except Exception as raised:  # noqa: BLE001  # whatever it is
            seen.append(raised)

    await Browser(app, "/").run()

    assert seen == [error]


async def test_a_request_that_is_cancelled_by_others_stays_cancelled(app: FastAPI) -> None:
    """A server that ends cancels requests, for example."""

    @app.get("/")
    async def wait(request: Request) -> None:
        async with until_disconnected(request):
            await asyncio.Event().wait()

    answering = asyncio.get_running_loop().create_task(Browser(app, "/").run())
    await settle()
    answering.cancel()
    with pytest.raises(asyncio.CancelledError):
        await answering


async def test_the_response_may_be_a_stream_that_ends_with_the_browser(app: FastAPI) -> None:
    """Nothing listens to the server any more after the block."""
    ends: list[str] = []

    async def events() -> AsyncIterator[str]:
        try:
            yield "began"
            await asyncio.Event().wait()
        finally:
            ends.append("stream")

    @app.get("/")
    async def stream(request: Request) -> StreamingResponse:
        async with until_disconnected(request):
            await settle()
        return StreamingResponse(events())

    await left(Browser(app, "/"))

    assert ends == ["stream"]


# The examples


async def test_a_call_of_the_example_is_dropped_when_the_browser_leaves(
    aionode_context: Context, node_factory: Callable[..., Node]
) -> None:
    """A request that the service has not begun to serve is never served."""
    began: list[int] = []
    may_answer = asyncio.Event()

    async def add(request: AddTwoInts.Request) -> AddTwoInts.Response:
        began.append(request.a)
        await may_answer.wait()
        return AddTwoInts.Response()

    node_factory("adder").create_service(AddTwoInts, "/add_two_ints", add)
    app = fastapi_app.make_app(aionode_context)
    async with app.router.lifespan_context(app), asyncio.TaskGroup() as tasks:
        stays = tasks.create_task(Browser(app, "/add?a=1&b=1").run())
        await settle()
        assert await left(Browser(app, "/add?a=2&b=2")) == 499
        may_answer.set()

    assert stays.result() == 200
    assert began == [1]


async def test_a_call_that_ends_with_its_node_is_answered_with_503(
    aionode_context: Context, node_factory: Callable[..., Node]
) -> None:
    """The route is no task of the node: it gets an error, and the browser its text."""
    served = asyncio.Event()

    async def never(_request: SetSpeed.Request) -> SetSpeed.Response:
        served.set()
        await asyncio.Event().wait()
        raise AssertionError

    node_factory("robot").create_service(SetSpeed, "/set_speed", never)
    battery = node_factory("battery").create_publisher(Float32, "/battery", 10)
    app = web_control.make_app(aionode_context)
    async with app.router.lifespan_context(app):
        operator: Operator = app.state.supervisor.node
        await operator.set_speed.wait_for_service()
        async with asyncio.TaskGroup() as tasks:
            browser = Browser(app, "/speed", "POST", b'{"speed": 1.0}')
            answering = tasks.create_task(browser.run())
            await served.wait()
            battery.publish(Float32(data=-1.0))

    assert answering.result() == 503
    assert b"client of /set_speed is destroyed" in browser.received
