"""HTTP: this module is replaced by the whole of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from starlette.responses import JSONResponse
from starlette.routing import Route

if TYPE_CHECKING:
    from starlette.requests import Request
    from starlette.responses import Response
    from starlette.routing import BaseRoute

    from aionode.gateway._clients import Clients

__all__ = ["routes"]


def routes(gateway: Clients) -> list[BaseRoute]:
    """Return the routes of HTTP."""

    async def topics(request: Request) -> Response:
        async with gateway.session_of(request.scope, "http") as session:
            return JSONResponse(session.topics())

    return [Route("/topics", topics)]
