"""Foxglove over WebSocket: the protocol of the Foxglove app and of PlotJuggler."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from aionode.gateway.foxglove.client import serve_frames
from aionode.gateway.foxglove.frames import SUBPROTOCOLS
from aionode.gateway.server.exchange import exchange

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

    from aionode.bag import Player
    from aionode.gateway.session.session import Session

__all__ = ["SUBPROTOCOLS", "serve"]


async def serve(
    websocket: WebSocket, session: Session, subprotocol: str, player: Player | None = None
) -> None:
    """Serve a client of Foxglove's protocol until it leaves.

    Args:
        websocket: The WebSocket of the client.
        session: The session of the client.
        subprotocol: The name of the protocol that the client has chosen.
        player: A bag's player, which the client's timeline controls.
    """
    await exchange(websocket, session, partial(serve_frames, player=player), subprotocol)
