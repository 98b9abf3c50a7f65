"""``aionode router``: a Zenoh router where there is no ``rmw_zenohd``."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from aionode.cli._support.output import Output

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["route"]


async def route(endpoints: Sequence[str], peers: Sequence[str] = (), *, output: Output) -> int:
    """Run a router that listens on Zenoh endpoints, until cancelled.

    Args:
        endpoints: Where it listens.
        peers: The Zenoh endpoints of the routers with which it is linked.
        output: Where to print.

    Raises:
        TransportError: it cannot listen there.
    """
    from aionode.transport.zenoh._session import close_session, open_router

    session = await open_router(endpoints, peers)
    try:
        linked = f", and links this machine with {', '.join(peers)}" if peers else ""
        output.item(
            f"Router is listening on {', '.join(endpoints)}{linked}. Ctrl-C ends it.",
            {"listen": list(endpoints), "connect": list(peers)},
        )
        await asyncio.get_running_loop().create_future()
    finally:
        await asyncio.shield(close_session(session))
    return 0
