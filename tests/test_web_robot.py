"""A web application and its robot in two processes: after any failure the robot stops."""

from __future__ import annotations

import asyncio
import re
import signal
import socket
from collections.abc import AsyncIterator, Callable, Iterator, MutableMapping
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import httpx
import pytest
import uvicorn
from fastapi.responses import StreamingResponse

from aionode.engine.context import Context
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.std_msgs.msg import Float32
from aionode.message import to_json
from aionode.node import Node
from examples import web_control
from examples.web_control import Drive, Operator, make_app
from examples.web_robot import Robot
from tests.support.peers import isolated_environment
from tests.test_examples import Program

if TYPE_CHECKING:
    from fastapi import FastAPI

FAR = 1000.0
"""Metres that the robot would drive for half an hour."""

pytestmark = [pytest.mark.timeout(60), pytest.mark.one_loop]


@pytest.fixture
def network(monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    """The environment in which both processes find each other, and no others."""
    env = isolated_environment()
    for name, value in env.items():
        monkeypatch.setenv(name, value)
    return env


class Robots:
    """Starts robots in processes of their own; the running one is `now`."""

    def __init__(self, env: dict[str, str]) -> None:
        self._env = env
        self.now = self.start()

    def start(self) -> Program:
        """Start a robot."""
        self.now = Program("examples/web_robot.py", env=self._env)
        self.now.wait_until_running()
        return self.now

    def kill(self) -> None:
        """Kill the robot, so that it cannot send anything more."""
        self.now.process.send_signal(signal.SIGKILL)
        self.now.process.wait(timeout=10)
        self.now.close()


@pytest.fixture
def robots(network: dict[str, str]) -> Iterator[Robots]:
    """A running robot."""
    robots = Robots(network)
    try:
        yield robots
    finally:
        robots.now.close()


@pytest.fixture
async def context(network: dict[str, str]) -> AsyncIterator[Context]:
    """The context of the web application."""
    async with Context() as context:
        yield context


class Wheels:
    """The speed of the last command, which the motors receive."""

    def __init__(self, node: Node) -> None:
        self.speed = 0.0
        self._heard = asyncio.Event()
        node.create_subscription(Twist, "/cmd_vel", self._hear, 10)

    def _hear(self, msg: Twist) -> None:
        self.speed = msg.linear.x
        self._heard.set()

    async def until(self, *, turning: bool) -> None:
        """Wait until the last command is to drive, or to stop."""
        async with asyncio.timeout(20):
            while (self.speed > 0.0) is not turning:
                self._heard.clear()
                await self._heard.wait()


@pytest.fixture
async def wheels(context: Context) -> AsyncIterator[Wheels]:
    """The motors, and a battery at /battery."""
    async with Node("wheels", context=context) as node:
        yield Wheels(node)


@pytest.fixture
def app(context: Context) -> FastAPI:
    """The application, with an additional route that relies on cancellation alone."""
    app = make_app(context)

    async def feedback(operator: Operator) -> AsyncIterator[str]:
        async for each in await operator.drive.send_goal(Drive.Goal(distance=FAR)):
            yield f"data: {to_json(each)}\n\n"

    @app.get("/plain")
    async def plain() -> StreamingResponse:
        return StreamingResponse(feedback(app.state.supervisor.node))

    return app


@pytest.fixture
async def web(app: FastAPI, robots: Robots, wheels: Wheels) -> AsyncIterator[httpx.AsyncClient]:
    """An HTTP client of the application, which has discovered the robot."""
    listening = socket.create_server(("127.0.0.1", 0))
    # asyncio does not take it for one of TCP: answers in two parts would wait 40 ms each.
    listening.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    config = uvicorn.Config(app, log_level="warning", loop="none", timeout_graceful_shutdown=5)
    server = uvicorn.Server(config)
    port = listening.getsockname()[1]
    async with (
        asyncio.TaskGroup() as tasks,
        httpx.AsyncClient(base_url=f"http://127.0.0.1:{port}", timeout=20) as client,
    ):
        tasks.create_task(server.serve(sockets=[listening]))
        await client.get("/healthz")
        await app.state.supervisor.node.drive.wait_for_server(timeout_sec=20)
        yield client
        server.should_exit = True
    listening.close()


@asynccontextmanager
async def driving(
    web: httpx.AsyncClient, wheels: Wheels, path: str = "/drive"
) -> AsyncIterator[AsyncIterator[str]]:
    """An HTTP client that streams a drive of a long distance."""
    async with web.stream("GET", path, params={"distance": FAR}) as response:
        lines = response.aiter_lines()
        await wheels.until(turning=True)
        yield lines


async def event(lines: AsyncIterator[str], name: str) -> str:
    """Return the data of the next event of this name."""
    async with asyncio.timeout(20):
        async for line in lines:
            if line == f"event: {name}":
                return (await anext(lines)).removeprefix("data: ")
    pytest.fail(f"the stream ended without {name}")


async def healthy(web: httpx.AsyncClient, *, restarts: int) -> None:
    """Wait until the application node has been restarted `restarts` times and runs."""
    async with asyncio.timeout(20):
        while True:
            response = await web.get("/healthz")
            health = response.json()
            assert response.status_code == (200 if health["ok"] else 503)
            if health["ok"] and health["restarts"] == restarts:
                return


async def drives_again(web: httpx.AsyncClient, app: FastAPI) -> None:
    """Check that a goal can be driven from start to end."""
    async with asyncio.timeout(20):
        await app.state.supervisor.node.drive.wait_for_server()
    async with web.stream("GET", "/drive", params={"distance": 0.1}) as response:
        assert await event(response.aiter_lines(), "result") == "SUCCEEDED"


@pytest.mark.parametrize("path", ["/drive", "/plain"])
async def test_the_robot_stops_when_the_browser_leaves(
    web: httpx.AsyncClient, wheels: Wheels, app: FastAPI, path: str
) -> None:
    """Starlette cancels the stream again and again until it has ended."""
    async with driving(web, wheels, path):
        pass

    await wheels.until(turning=False)
    await drives_again(web, app)


async def test_the_robot_stops_when_the_browser_leaves_that_waits_for_its_arrival(
    web: httpx.AsyncClient, wheels: Wheels, app: FastAPI
) -> None:
    """The route awaits the goal; without `until_disconnected` nobody would tell it."""
    async with asyncio.TaskGroup() as tasks:
        waiting = tasks.create_task(web.post("/drive", params={"distance": FAR}))
        await wheels.until(turning=True)
        waiting.cancel()

    await wheels.until(turning=False)
    await drives_again(web, app)


async def test_the_robot_stops_when_a_websocket_is_closed(
    aionode_context: Context, node_factory: Callable[..., Node]
) -> None:
    """In one process: the test plays the part of the socket."""
    app = make_app(aionode_context)
    wheels = Wheels(node_factory("wheels"))
    incoming: asyncio.Queue[dict[str, object]] = asyncio.Queue()
    sent: list[object] = []

    async def send(message: MutableMapping[str, object]) -> None:
        sent.append(message["type"])

    scope = {
        "type": "websocket",
        "path": "/ws/drive",
        "raw_path": b"/ws/drive",
        "query_string": f"distance={FAR}".encode(),
        "headers": [],
        "subprotocols": [],
    }
    async with Robot(aionode_context), app.router.lifespan_context(app):
        await app.state.supervisor.node.drive.wait_for_server()
        incoming.put_nowait({"type": "websocket.connect"})
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(app(scope, incoming.get, send))
            await wheels.until(turning=True)
            incoming.put_nowait({"type": "websocket.disconnect", "code": 1001})
            await wheels.until(turning=False)

    assert sent[:2] == ["websocket.accept", "websocket.send"]


async def test_the_robot_stops_when_the_node_of_the_application_fails(
    aionode_context: Context, node_factory: Callable[..., Node]
) -> None:
    """The stream, which is no task of the node, ends with a text, and the goal with it."""
    app = make_app(aionode_context)
    wheels = Wheels(node_factory("wheels"))
    events: list[tuple[str, str]] = []

    async def stream(operator: Operator) -> None:
        events.extend([event async for event in web_control.progress(operator, FAR)])

    async with Robot(aionode_context), app.router.lifespan_context(app):
        operator: Operator = app.state.supervisor.node
        await operator.drive.wait_for_server()
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(stream(operator))
            await wheels.until(turning=True)
            operator.create_timer(0.0, lambda: operator.on_battery(Float32(data=-1.0)))
            await wheels.until(turning=False)

    assert events[-1] == (
        "failure",
        "action client of /drive is destroyed; create a new one",
    )


@pytest.mark.slow
async def test_a_killed_robot_ends_the_stream_and_one_that_is_back_drives(
    web: httpx.AsyncClient, wheels: Wheels, robots: Robots, app: FastAPI
) -> None:
    """The application is not affected, and needs no restart."""
    async with driving(web, wheels) as lines:
        robots.kill()
        assert "the server went away" in await event(lines, "failure")
    async with asyncio.timeout(20):
        while app.state.supervisor.node.set_speed.service_is_ready():
            await app.state.supervisor.node.graph.changed()

    response = await web.post("/speed", json={"speed": 0.5})
    assert response.status_code == 504
    assert "no server is matched" in response.text
    assert (await web.get("/healthz")).json()["restarts"] == 0

    robots.start()
    await drives_again(web, app)


async def test_a_bad_request_takes_nothing_away_from_others(
    web: httpx.AsyncClient, wheels: Wheels, robots: Robots
) -> None:
    """The caller gets the error; the robot continues a goal of another client."""
    async with driving(web, wheels) as lines:
        response = await web.post("/speed", json={"speed": 17.0})

        assert response.status_code == 400
        assert "ValueError: speed=17.0 m/s; expected above 0, at most 1.0" in response.text
        assert (await web.post("/speed", json={"speed": "fast"})).status_code == 422
        assert (await web.post("/speed", json={"speed": 1.0})).json() == {"speed": 1.0}
        assert "distance" in await event(lines, "feedback")
    assert "Traceback" in robots.now.line_with("Traceback")


async def test_nodes_that_fail_are_restarted_and_nothing_drives_on(
    web: httpx.AsyncClient, wheels: Wheels, robots: Robots, app: FastAPI, context: Context
) -> None:
    """The nodes of the robot and of the application restart at the same time: the worst case."""
    async with Node("battery", context=context) as battery:
        publisher = battery.create_publisher(Float32, "/battery", 10)
        await publisher.wait_for_subscribers(2)
        async with driving(web, wheels):
            publisher.publish(Float32(data=-1.0))
            await wheels.until(turning=False)

        line = robots.now.line_with("restarting in")
        assert re.search(r"node /robot failed; restarting in 0\.5 s", line)
        await healthy(web, restarts=1)
        await drives_again(web, app)


async def test_a_robot_that_does_not_answer_is_a_failure_with_a_text(
    network: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The page showed nothing: the error of a time limit has no text of its own."""
    monkeypatch.setattr(web_control, "ANSWER_SEC", 0.2)
    async with Context() as context, Operator(context) as operator:
        events = [event async for event in web_control.progress(operator, 1.0)]

    assert events == [("failure", "no answer from the robot within 0.2 s")]
