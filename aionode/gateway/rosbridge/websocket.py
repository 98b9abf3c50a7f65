"""Rosbridge over WebSocket: the protocol of roslibjs, roslibpy and their like."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.gateway.rosbridge.client import serve_frames
from aionode.gateway.server.websocket import exchange

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

    from aionode.gateway.session.session import Session

__all__ = ["serve"]


async def serve(websocket: WebSocket, session: Session) -> None:
    """Serve a client of rosbridge until it leaves."""
    # Browsers want to hear one of those that they offer; the door has taken out the token.
    chosen = next(iter(websocket.scope["subprotocols"]), None)
    await exchange(websocket, session, serve_frames, chosen)
