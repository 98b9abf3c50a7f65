"""MCP over streamable HTTP, at a path of the gateway's port."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from mcp.server.auth.middleware.bearer_auth import AuthenticatedUser
from mcp.server.auth.provider import AccessToken
from mcp.server.streamable_http_manager import StreamableHTTPSessionManager
from starlette.routing import Route

from aionode.errors import RefusedError
from aionode.gateway.mcp.server import McpServer

if TYPE_CHECKING:
    from starlette.routing import BaseRoute
    from starlette.types import Receive, Scope, Send

    from aionode.gateway._clients import Clients
    from aionode.gateway.policy.identity import Identity

__all__ = ["McpOverHttp"]

PATH: Final = "/mcp"


class McpOverHttp:
    """Serves MCP to the clients of a gateway, each of which is identified by its requests.

    Args:
        clients: The gateway.
        about: The owner's description of the robot.
        bags: The folder of the bags that may be read; empty for none.

    Attributes:
        mcp: The server of all of them.
    """

    def __init__(self, clients: Clients, about: str = "", bags: str = "") -> None:
        self.mcp = McpServer(clients, nobody, about, bags)
        self._clients = clients
        limits = clients.policy.limits
        self._manager = StreamableHTTPSessionManager(
            self.mcp.server,
            max_request_body_size=limits.frame_bytes,
            max_sessions=limits.clients,
        )
        self._has_started = asyncio.Event()
        self._has_to_end = asyncio.Event()

    def routes(self) -> list[BaseRoute]:
        """Return the routes, for a Starlette application."""
        return [Route(PATH, self)]

    async def run(self) -> None:
        """Keep the sessions of the older revisions, until `stop`."""
        # In a task of its own: the SDK has to be left in the task that entered it.
        async with self._manager.run(), asyncio.TaskGroup() as tasks:
            telling = tasks.create_task(self.mcp.run())
            self._has_started.set()
            await self._has_to_end.wait()
            telling.cancel()

    async def started(self) -> None:
        """Wait until requests can be served."""
        await self._has_started.wait()

    def stop(self) -> None:
        """End the sessions, and thereby the calls in progress."""
        self._has_to_end.set()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request, whose client the door has let in."""
        identity = self._clients.policy.identify(scope["aionode.credentials"])
        # A session of the SDK belongs to the identity that began it.
        token = AccessToken(token="", client_id=identity.name, scopes=[])  # none is needed
        scope["user"] = AuthenticatedUser(token)
        # A client whose cable was cut cannot end its session.
        scope["state"]["aionode_connection"].lose_after(self._clients.policy.limits.client_lost_sec)
        await self._manager.handle_request(scope, receive, send)


def nobody() -> Identity:
    """Refuse a client without a request: all clients of a gateway have one.

    Raises:
        RefusedError: always.
    """
    raise RefusedError("client", "it has not sent a request over HTTP", "unauthorized")
