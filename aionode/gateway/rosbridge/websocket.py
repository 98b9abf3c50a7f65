"""Rosbridge over WebSocket: the protocol of roslibjs, roslibpy and their like."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.gateway.rosbridge.client import serve_frames
from aionode.gateway.server.exchange import exchange

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

    from aionode.gateway.session.session import Session

__all__ = ["serve"]


async def serve(websocket: WebSocket, session: Session, subprotocol: str | None = None) -> None:
    """Serve a client of rosbridge until it leaves.

    Args:
        websocket: The WebSocket of the client.
        session: The session of the client.
        subprotocol: The client's name of the protocol; None without one.
    """
    await exchange(websocket, session, serve_frames, subprotocol)
