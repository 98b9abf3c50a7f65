"""Rosbridge over WebSocket: this module is replaced by the whole protocol."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from starlette.websockets import WebSocketDisconnect

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

    from aionode.gateway._session import Session

__all__ = ["serve"]


async def serve(websocket: WebSocket, session: Session) -> None:
    """Publish what the client publishes, until it leaves."""
    await websocket.accept()
    try:
        while True:
            op: Any = json.loads(await websocket.receive_text())
            if op.get("op") == "publish":
                await session.publish(op["topic"], op["msg"], op.get("type"))
    except WebSocketDisconnect:
        return
