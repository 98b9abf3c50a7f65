"""A WebSocket and the session of its client: frames in, frames out."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Final, TypeAlias

from starlette.websockets import WebSocketDisconnect

from aionode.gateway.session.encoding.frames import Fragmented
from aionode.gateway.session.refusals import Refusal

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

    from aionode.gateway.session.delivery.outbox import Outbox
    from aionode.gateway.session.session import Session

__all__ = ["TRY_AGAIN_LATER", "close", "exchange"]

Serve: TypeAlias = Callable[["Session", AsyncIterator[bytes | str]], Awaitable[None]]

POLICY_VIOLATION: Final = 1008
"""Closes a WebSocket whose client sends no valid ops, or reads no answers (RFC 6455)."""

TRY_AGAIN_LATER: Final = 1013
"""Closes a WebSocket whose place another client takes (IANA's registry for RFC 6455)."""

CLOSING_SEC: Final = 1.0
"""How long a client that reads nothing may delay the end of its WebSocket, in seconds."""

MAX_REASON: Final = 120
"""The longest reason in a close frame, in bytes of UTF-8: RFC 6455 allows 123."""


async def close(websocket: WebSocket, code: int, reason: str) -> None:
    """Close a WebSocket with a reason, unless it is closed, or its client reads nothing."""
    short = reason.encode()[:MAX_REASON].decode(errors="ignore")
    with suppress(WebSocketDisconnect, RuntimeError, TimeoutError):
        async with asyncio.timeout(CLOSING_SEC):
            await websocket.close(code, short)


async def exchange(
    websocket: WebSocket, session: Session, serve: Serve, subprotocol: str | None = None
) -> None:
    """Run a protocol with a client until either side ends it.

    Args:
        websocket: The WebSocket, which is accepted here.
        session: The session of the client, whose outbox holds the frames for it.
        serve: Consumes the frames of the client, until they end or it stops.
        subprotocol: The name of the protocol.
    """
    await websocket.accept(subprotocol)
    async with asyncio.TaskGroup() as tasks:
        writing = tasks.create_task(write(websocket, session.outbox))
        has_left = False

        async def frames() -> AsyncIterator[bytes | str]:
            nonlocal has_left
            while (message := await websocket.receive())["type"] == "websocket.receive":
                text = message.get("text")
                yield text if text is not None else message["bytes"]
            has_left = True

        await serve(session, frames())
        writing.cancel()
        if not has_left:
            session.rights.note(Refusal.DISCONNECTED, "connection", "too many malformed frames")
            await websocket.close(POLICY_VIOLATION, "too many malformed frames")


async def write(websocket: WebSocket, outbox: Outbox) -> None:
    """Send the frames of the outbox; if the outbox is closed, disconnect the client."""
    try:
        async for frame in outbox:
            if isinstance(frame, Fragmented):
                for part in frame.parts():
                    await websocket.send_text(part)
            elif isinstance(frame, str):
                await websocket.send_text(frame)
            else:
                await websocket.send({"type": "websocket.send", "bytes": frame})
        await websocket.close(POLICY_VIOLATION, "too many unread answers")
    except WebSocketDisconnect:
        return  # the reading side is notified as well
