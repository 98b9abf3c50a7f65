"""A mover that moves in a FastAPI route while its browser is connected."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Callable, Coroutine
from typing import Any

import uvicorn
from fastapi import FastAPI, Request
from fastapi.responses import StreamingResponse

from aionode import Context, Supervisor
from aionode.fastapi import stopping_at_signals, until_disconnected
from tests.faults.motion.words import Mover

__all__ = ["serve"]


def serve(
    mover: Mover, make_node: Callable[[Context], Any], reporting: Coroutine[Any, Any, None]
) -> None:
    """Serve until a signal.

    Args:
        mover: Its description.
        make_node: Creates its node, also after a failure.
        reporting: Runs concurrently.
    """

    @contextlib.asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        async with asyncio.TaskGroup() as tasks:
            task = tasks.create_task(reporting)
            async with Context() as context, Supervisor(lambda: make_node(context)) as supervisor:
                app.state.supervisor = supervisor
                async with stopping_at_signals(supervisor):
                    yield
            task.cancel()

    app = FastAPI(lifespan=lifespan)

    @app.get("/awaited")
    async def awaited(request: Request) -> None:
        async with until_disconnected(request):
            await app.state.supervisor.node.move()

    @app.get("/streamed")
    async def streamed() -> StreamingResponse:
        async def moving() -> AsyncIterator[str]:
            yield "moving\n"
            await app.state.supervisor.node.move()

        return StreamingResponse(moving())

    uvicorn.run(
        app,
        port=mover.port,
        log_level="warning",
        timeout_graceful_shutdown=mover.graceful_s,
    )
