"""Foxglove over WebSocket: this module is replaced by the whole protocol."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

    from aionode.gateway._session import Session

__all__ = ["SUBPROTOCOL", "serve"]

SUBPROTOCOL: Final = "foxglove.sdk.v1"


async def serve(websocket: WebSocket, session: Session) -> None:  # noqa: ARG001  # a stand-in
    """Close the connection."""
    await websocket.accept(SUBPROTOCOL)
    await websocket.close()
