"""A robot controlled from a web page: the web application.

Run it with ``python examples/web_control.py``, the robot with ``python examples/web_robot.py``, and
open http://127.0.0.1:8001. The robot stops when the page is closed. It needs
``pip install fastapi uvicorn websockets``.

The types are those of the robot's program: a type is known by its name and its fields, and so this
file needs no other one.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncGenerator, AsyncIterator
from typing import Annotated

import uvicorn
from fastapi import Body, FastAPI, Request, Response, WebSocket, WebSocketDisconnect
from fastapi.responses import HTMLResponse, JSONResponse, StreamingResponse

import aionode
from aionode import Context, Health, Node, Supervisor
from aionode.errors import (
    AionodeError,
    EntityDestroyedError,
    GoalError,
    NodeNotRunningError,
    ServiceError,
    ServiceUnavailableError,
)
from aionode.fastapi import until_disconnected
from aionode.interfaces.std_msgs.msg import Float32
from aionode.message import ActionType, Message, ServiceType, float64, to_json

ANSWER_SEC = 5.0

PAGE = """<!doctype html>
<title>Robot</title>
<button onclick="drive()">Drive</button> <button onclick="stop()">Stop</button>
<p id="progress"></p>
<script>
  let events;
  function show(event) { document.getElementById("progress").textContent = event.data; }
  function stop() { events?.close(); }
  function drive() {
    stop();
    events = new EventSource("/drive?distance=3");
    events.addEventListener("feedback", show);
    for (const end of ["result", "failure"])
      events.addEventListener(end, (event) => { show(event); stop(); });
  }
</script>
"""


class SetSpeed(ServiceType, typename="tutorial_interfaces/srv/SetSpeed"):
    """Sets the speed, in m/s."""

    class Request(Message):
        """The requested speed."""

        speed: float64 = 0.0

    class Response(Message):
        """The new speed."""

        speed: float64 = 0.0


class Drive(ActionType, typename="tutorial_interfaces/action/Drive"):
    """Drives straight ahead; distances are in metres."""

    class Goal(Message):
        """The distance to drive."""

        distance: float64 = 0.0

    class Result(Message):
        """The distance driven."""

        distance: float64 = 0.0

    class Feedback(Message):
        """The distance driven so far."""

        distance: float64 = 0.0


class Operator(Node):
    """The application's node: clients of the robot."""

    def __init__(self, context: Context | None = None) -> None:
        super().__init__("operator", context=context)
        self.set_speed = self.create_client(SetSpeed, "/set_speed")
        self.drive = self.create_action_client(Drive, "/drive")
        self.create_subscription(Float32, "/battery", self.on_battery, 10)
        self.volts = 0.0

    def on_battery(self, msg: Float32) -> None:
        """Keep the voltage."""
        if msg.data < 0.0:
            raise ValueError(f"battery at {msg.data} V: the sensor is broken")
        self.volts = msg.data


def make_app(context: Context | None = None) -> FastAPI:
    """Return the application; its node runs as long as the application."""

    @contextlib.asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncGenerator[None, None]:
        async with Supervisor(lambda: Operator(context)) as supervisor:
            app.state.supervisor = supervisor
            yield

    app = FastAPI(title="Robot", lifespan=lifespan)
    app.add_exception_handler(AionodeError, answer_error)

    @app.get("/", response_class=HTMLResponse)
    async def page() -> str:
        return PAGE

    @app.get("/healthz")
    async def healthz(response: Response) -> Health:
        health: Health = app.state.supervisor.health()
        response.status_code = 200 if health.ok else 503
        return health

    @app.post("/speed")
    async def speed(
        request: Request, requested_speed: Annotated[SetSpeed.Request, Body()]
    ) -> SetSpeed.Response:
        operator: Operator = app.state.supervisor.node
        async with until_disconnected(request):
            return await operator.set_speed.call(requested_speed, timeout_sec=ANSWER_SEC)

    @app.post("/drive")
    async def drive_there(request: Request, distance: float) -> Drive.Result:
        operator: Operator = app.state.supervisor.node
        async with until_disconnected(request):  # the robot stops when the browser leaves
            return await operator.drive.call(Drive.Goal(distance=distance))

    @app.get("/drive")
    async def drive(distance: float) -> StreamingResponse:
        operator: Operator = app.state.supervisor.node
        return StreamingResponse(server_sent(operator, distance), media_type="text/event-stream")

    @app.websocket("/ws/drive")
    async def drive_socket(websocket: WebSocket, distance: float) -> None:
        operator: Operator = app.state.supervisor.node
        await websocket.accept()
        async with asyncio.TaskGroup() as tasks:
            browser = tasks.create_task(until_closed(websocket))
            robot = tasks.create_task(send_progress(websocket, operator, distance))
            await asyncio.wait([browser, robot], return_when=asyncio.FIRST_COMPLETED)
            browser.cancel()
            robot.cancel()

    return app


def answer_error(_request: Request, error: Exception) -> JSONResponse:
    """Answer with the text of an error, and the HTTP status that fits it."""
    status = 500
    if isinstance(error, NodeNotRunningError | EntityDestroyedError | ServiceUnavailableError):
        status = 503
    elif isinstance(error, GoalError):  # the robot is busy, for example
        status = 409
    elif isinstance(error, TimeoutError):
        status = 504
    elif isinstance(error, ServiceError):  # last, as ServiceUnavailableError is one too
        status = 400
    return JSONResponse({"detail": str(error)}, status)


async def server_sent(operator: Operator, distance: float) -> AsyncIterator[str]:
    """Yield the progress as server-sent events."""
    async with contextlib.aclosing(progress(operator, distance)) as events:
        async for name, text in events:
            yield f"event: {name}\ndata: {text}\n\n"


async def send_progress(websocket: WebSocket, operator: Operator, distance: float) -> None:
    """Send the progress as JSON, then close."""
    async with contextlib.aclosing(progress(operator, distance)) as events:
        async for name, text in events:
            await websocket.send_json({"event": name, "data": text})
    await websocket.close()


async def until_closed(websocket: WebSocket) -> None:
    """Return when the browser disconnects; what it sends is ignored."""
    with contextlib.suppress(WebSocketDisconnect):
        while True:
            await websocket.receive_text()


async def progress(operator: Operator, distance: float) -> AsyncGenerator[tuple[str, str], None]:
    """Drive, and yield the progress; closing or cancelling this generator stops the robot."""
    try:
        async with asyncio.timeout(ANSWER_SEC):
            goal = await operator.drive.send_goal(Drive.Goal(distance=distance))
    except AionodeError as error:
        yield "failure", str(error)
        return
    except TimeoutError:  # of the time limit, which has no text
        yield "failure", f"no answer from the robot within {ANSWER_SEC:g} s"
        return
    try:
        async for feedback in goal:
            yield "feedback", to_json(feedback)
        outcome = await goal.result()
        yield "result", outcome.status.name
    except AionodeError as error:  # the robot is gone
        yield "failure", str(error)
    finally:
        if not goal.done:  # the generator was closed between two events
            with contextlib.suppress(AionodeError):
                await goal.cancel()


async def serve() -> None:
    """Serve the application on port 8001."""
    config = uvicorn.Config(make_app(), port=8001, timeout_graceful_shutdown=1)
    await uvicorn.Server(config).serve()


if __name__ == "__main__":
    aionode.run(serve)
