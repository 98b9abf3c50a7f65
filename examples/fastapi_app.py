"""A web application that awaits a service and streams a topic to the browser.

Run it with ``python examples/fastapi_app.py`` and open http://127.0.0.1:8000. It calls the service
/add_two_ints (``python examples/service_client_server.py``) and shows the messages of
/robot/message (``python examples/simple_publisher.py``). It needs ``pip install fastapi uvicorn``.
"""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import uvicorn
from fastapi import FastAPI, HTTPException, Request
from fastapi.responses import HTMLResponse, StreamingResponse

import aionode
from aionode import Context, Node
from aionode.fastapi import stopping_at_signals, until_disconnected
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.message import to_json

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, AsyncIterator

PAGE = """<!doctype html>
<title>aionode</title>
<h1>/robot/message</h1>
<ul id="messages"></ul>
<script>
  new EventSource("/messages").onmessage = (event) => {
    const line = document.createElement("li");
    line.textContent = JSON.parse(event.data).data;
    document.getElementById("messages").prepend(line);
  };
</script>
"""


def make_app(context: Context | None = None) -> FastAPI:
    """Return the application; its node runs as long as the application."""

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncGenerator[None, None]:
        async with Node("web", context=context) as node, stopping_at_signals(node):
            app.state.node = node
            app.state.adder = node.create_client(AddTwoInts, "/add_two_ints")
            yield

    app = FastAPI(title="aionode", lifespan=lifespan)

    @app.get("/", response_class=HTMLResponse)
    async def page() -> str:
        return PAGE

    @app.get("/add")
    async def add(request: Request, a: int, b: int) -> dict[str, int]:
        try:
            async with until_disconnected(request), asyncio.timeout(2):
                response = await app.state.adder.call(AddTwoInts.Request(a=a, b=b))
        except TimeoutError as error:
            raise HTTPException(504, "/add_two_ints does not answer") from error
        return {"sum": response.sum}

    @app.get("/messages")
    async def messages() -> StreamingResponse:
        return StreamingResponse(events(app.state.node), media_type="text/event-stream")

    return app


async def events(node: Node) -> AsyncIterator[str]:
    """Yield each message of /robot/message as a server-sent event, until the browser leaves."""
    subscription = node.create_subscription(String, "/robot/message")
    try:
        yield ": listening\n\n"
        async for msg in subscription:
            yield f"data: {to_json(msg)}\n\n"
    finally:
        subscription.destroy()


async def serve() -> None:
    """Serve the application on port 8000."""
    config = uvicorn.Config(make_app(), port=8000)
    await uvicorn.Server(config).serve()


if __name__ == "__main__":
    aionode.run(serve)
