"""The web server of the gateway: runs in the running loop, and leaves the process alone."""

from __future__ import annotations

import asyncio
import ssl
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from aionode.gateway.server.connection import GOODBYE_SEC, Shared
from aionode.gateway.server.http11 import HttpConnection

if TYPE_CHECKING:
    import socket

    from aionode.gateway.policy.policy import Policy, Tls
    from aionode.gateway.server.connection import Application

__all__ = ["Server"]

CLOSING_SEC: Final = 1.0
"""Longest time for requests to end with the server, in seconds."""


class Server:
    """Serves an application of ASGI on a socket, within the limits of a policy.

    h11 and websockets parse what clients send; this class limits how much they accept, and for how
    long.

    Args:
        app: The application.
        policy: Returns the policy as it is now.

    Attributes:
        has_started: Set when clients can connect.

    Raises:
        OSError: the certificate of the policy cannot be read.
    """

    def __init__(self, app: Application, policy: Callable[[], Policy]) -> None:
        self._app = app
        self._policy = policy
        tls = policy().tls
        self._tls: dict[str, Any] = {}
        if tls is not None:
            # asyncio's default would give a client a minute for the handshake, without counting it.
            self._tls = {
                "ssl": tls_context(tls),
                "ssl_handshake_timeout": policy().limits.handshake_sec,
                "ssl_shutdown_timeout": GOODBYE_SEC,
            }
        self.has_started = asyncio.Event()
        self._has_to_end = asyncio.Event()

    async def serve(self, listener: socket.socket) -> None:
        """Serve clients until `stop` is called, then disconnect them."""
        loop = asyncio.get_running_loop()
        async with asyncio.TaskGroup() as tasks:
            shared = Shared(self._app, self._policy, tasks)
            server = await loop.create_server(
                lambda: HttpConnection(shared), sock=listener, **self._tls
            )
            self.has_started.set()
            try:
                await self._has_to_end.wait()
            finally:
                server.close()
                await end_connections(shared)

    def stop(self) -> None:
        """Make `serve` disconnect its clients and return."""
        self._has_to_end.set()


async def end_connections(shared: Shared) -> None:
    """Disconnect the clients; after `CLOSING_SEC`, cancel the requests still running."""
    for connection in list(shared.connections):
        connection.end()
    try:
        async with asyncio.timeout(CLOSING_SEC):
            while shared.connections:
                shared.has_lost_one.clear()
                await shared.has_lost_one.wait()
            if shared.requests:
                await asyncio.wait(shared.requests)
    except TimeoutError:
        for request in list(shared.requests):
            request.cancel()
        for connection in list(shared.connections):
            connection.abort()


def tls_context(tls: Tls) -> ssl.SSLContext:
    """Return the TLS context for connections; with a client CA, it requires certificates."""
    context = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
    context.load_cert_chain(tls.certificate, tls.key)
    if tls.clients:
        context.load_verify_locations(tls.clients)
        context.verify_mode = ssl.CERT_OPTIONAL
    return context
