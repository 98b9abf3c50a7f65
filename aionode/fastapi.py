"""For routes of FastAPI and Starlette: end with the browser that asked.

It needs ``pip install fastapi``, or Starlette alone::

    from aionode.fastapi import until_disconnected


    @app.post("/drive")
    async def drive(request: Request, distance: float) -> str:
        async with until_disconnected(request):
            await robot.call(Drive.Goal(distance=distance))
        return "arrived"
"""

from __future__ import annotations

import asyncio
import contextlib
from typing import TYPE_CHECKING

from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Awaitable, Callable

    from starlette.requests import Request

__all__ = ["until_disconnected"]

CLIENT_CLOSED_REQUEST = 499
"""The HTTP status of a request whose client has gone, as nginx logs it."""


@contextlib.asynccontextmanager
async def until_disconnected(request: Request) -> AsyncIterator[None]:
    """Cancel the block when the client of `request` disconnects.

    A web server goes on with a route whose browser has left. Within the block, the wait of the
    route is cancelled instead, as by `asyncio.timeout`: a call is forgotten on both sides, and a
    goal is canceled.

    The body of the request is read first and kept for ``request.body()``, unless the route has
    read it already. The block has to end before the response begins: a server reports the client
    of a complete response as disconnected.

    Args:
        request: The request, as FastAPI gives it to an ``async def`` route that has a parameter of
            type `fastapi.Request`.

    Raises:
        HTTPException: the client has disconnected; its status is 499. Nobody gets the response, and
            nothing is logged.
    """
    gone = HTTPException(CLIENT_CLOSED_REQUEST, "the client has disconnected")
    # The server tells of the disconnection in the place of the next part of the body.
    try:
        await request.body()
    except ClientDisconnect:
        raise gone from None
    except RuntimeError:
        pass  # the route has read the body as a stream
    scope = asyncio.timeout(None)
    try:
        async with scope, watching(lambda: disconnected(request), scope):
            yield
    except TimeoutError:
        if not scope.expired():
            raise
        raise gone from None


async def disconnected(request: Request) -> None:
    """Wait until the client of a request disconnects."""
    while (await request.receive())["type"] != "http.disconnect":
        pass  # the empty end of the body


@contextlib.asynccontextmanager
async def watching(
    sign: Callable[[], Awaitable[object]], scope: asyncio.Timeout
) -> AsyncIterator[None]:
    """Let `scope` expire when `sign` returns."""

    async def watch() -> None:
        await sign()
        scope.reschedule(0.0)  # in the past: at the next turn of the loop

    error: BaseException | None = None
    async with asyncio.TaskGroup() as tasks:
        watcher = tasks.create_task(watch(), name="until_disconnected")
        try:
            yield
        except BaseException as raised:  # noqa: BLE001  # raised below, without a group around it
            error = raised
        finally:
            watcher.cancel()
    if error is not None:
        raise error
