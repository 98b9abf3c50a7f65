"""Rosbridge over WebSocket: what roslibjs, roslibpy and their like speak."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import TYPE_CHECKING, Final

from starlette.websockets import WebSocketDisconnect

from aionode.gateway._rosbridge_client import serve_frames
from aionode.gateway._rosbridge_frames import Fragmented

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

    from aionode.gateway._outbox import Outbox
    from aionode.gateway._session import Session

__all__ = ["serve"]

POLICY_VIOLATION: Final = 1008
"""Why a WebSocket is closed whose client sends no ops, or reads no answers (RFC 6455)."""


async def serve(websocket: WebSocket, session: Session) -> None:
    """Serve a client of rosbridge until it leaves."""
    await websocket.accept()
    async with asyncio.TaskGroup() as tasks:
        writing = tasks.create_task(write(websocket, session.outbox))
        has_left = False

        async def frames() -> AsyncIterator[str | bytes]:
            nonlocal has_left
            while (message := await websocket.receive())["type"] == "websocket.receive":
                text = message.get("text")
                yield text if text is not None else message["bytes"]
            has_left = True

        await serve_frames(session, frames())
        writing.cancel()
        if not has_left:
            await websocket.close(POLICY_VIOLATION, "too many frames that are no ops of rosbridge")


async def write(websocket: WebSocket, outbox: Outbox) -> None:
    """Send what leaves the outbox; if that is closed, the client is disconnected."""
    try:
        async for frame in outbox:
            if isinstance(frame, Fragmented):
                for part in frame.parts():
                    await websocket.send_text(part)
            elif isinstance(frame, str):
                await websocket.send_text(frame)
            else:
                await websocket.send_bytes(frame)
        await websocket.close(POLICY_VIOLATION, "too many answers that the client does not read")
    except WebSocketDisconnect:
        return  # the reader is told as well
