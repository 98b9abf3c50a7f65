"""Rosbridge over WebSocket: what roslibjs, roslibpy and their like speak."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from aionode.gateway._rosbridge_client import serve_frames
from aionode.gateway._websocket import exchange

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

    from aionode.gateway._session import Session

__all__ = ["serve"]


async def serve(websocket: WebSocket, session: Session) -> None:
    """Serve a client of rosbridge until it leaves."""
    await exchange(websocket, session, serve_frames, subprotocol(websocket.scope["subprotocols"]))


def subprotocol(offered: Sequence[str]) -> str | None:
    """Return which of the offered subprotocols to answer with: browsers want one of them.

    One of them may be there only for its token.
    """
    named = [name for name in offered if not name.startswith("bearer.")]
    return next(iter([*named, *offered]), None)
