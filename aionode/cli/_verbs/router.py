"""``aionode router``: a Zenoh router where there is no ``rmw_zenohd``."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from aionode.cli._support.output import Output

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["route"]


async def route(endpoints: Sequence[str], *, output: Output) -> int:
    """Run a router that listens on Zenoh endpoints, until cancelled.

    Raises:
        TransportError: it cannot listen there.
    """
    from aionode.transport.zenoh._session import close_session, open_router

    session = await open_router(endpoints)
    try:
        output.item(
            f"Router is listening on {', '.join(endpoints)}. Ctrl-C ends it.",
            {"listen": list(endpoints)},
        )
        await asyncio.get_running_loop().create_future()
    finally:
        await asyncio.shield(close_session(session))
    return 0
