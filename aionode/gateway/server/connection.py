"""A connection of a client, for any protocol, and what all connections share."""

from __future__ import annotations

import asyncio
import email.utils
import logging
from collections.abc import Awaitable, Callable, Coroutine, Iterable
from http import HTTPStatus
from typing import TYPE_CHECKING, Any, Final, TypeAlias
from urllib.parse import unquote

import h11

from aionode.gateway.server.outgoing import Framing
from aionode.gateway.server.portions import Portions

if TYPE_CHECKING:
    from aionode.gateway.policy.policy import Policy

__all__ = ["GOODBYE_SEC", "Application", "Connection", "Shared", "is_encrypted", "logger"]
__all__ += ["response", "scope_of"]

logger = logging.getLogger("aionode.gateway")

Application: TypeAlias = Callable[[Any, Any, Any], Awaitable[None]]
"""An application of ASGI."""

PHRASES: Final = {status.value: status.phrase.encode() for status in HTTPStatus}
"""The reason phrase of each status."""

GOODBYE_SEC: Final = 5.0
"""How long a client may take to read the end of a connection, in seconds."""

SPARE: Final = 16
"""Connections beyond the limit of clients: for pages, and for clients that are refused as too
many."""


class Shared:
    """What the connections of a server share.

    Args:
        app: The application of ASGI that they serve.
        policy: Returns the policy as it is now.
        tasks: The group in which requests are handled.

    Attributes:
        framing: Frames messages for all WebSockets.
        connections: The open connections.
        requests: The tasks of the application.
        has_lost_one: Set when a connection has ended.
    """

    def __init__(
        self, app: Application, policy: Callable[[], Policy], tasks: asyncio.TaskGroup
    ) -> None:
        self.app = app
        self.policy = policy
        self.framing = Framing()
        self.connections: set[Connection] = set()
        self.requests: set[asyncio.Task[None]] = set()
        self.has_lost_one = asyncio.Event()
        self._tasks = tasks

    def start(self, work: Coroutine[Any, Any, None]) -> None:
        """Handle a request."""
        task = self._tasks.create_task(work)
        self.requests.add(task)
        task.add_done_callback(self.requests.discard)

    def admit(self, connection: Connection) -> bool:
        """Accept a new connection if there is room, and return whether there is.

        The oldest connection without a session makes room: clients state at once what they want, so
        those that only hold connections, or read nothing, must not keep others out.
        """
        self.connections.add(connection)
        if len(self.connections) <= self.policy().limits.clients + SPARE:
            return True
        without = [
            other for other in self.connections if other is not connection and not other.has_session
        ]
        oldest = min(without, key=lambda other: other.made_s, default=None)
        if oldest is None:
            return False
        oldest.abort()
        self.connections.discard(oldest)  # its end is reported only in the next loop iteration
        return True


class Connection(asyncio.Protocol):
    """A connection: received data is passed on in parts, as fast as they are processed.

    Attributes:
        made_s: The loop time at which it was made.
        has_session: Whether a session uses it; set by the application.
        transport: Its transport.
        writable: Set while the client has read enough of what was sent.
        is_lost: Whether it has ended.
    """

    transport: asyncio.Transport

    def __init__(self, shared: Shared) -> None:
        self._shared = shared
        self._loop = asyncio.get_running_loop()
        self.made_s = self._heard_s = self._loop.time()
        self.has_session = False
        self.is_lost = False
        self.writable = asyncio.Event()
        self.writable.set()

    def use(self, transport: asyncio.Transport) -> None:
        """Start with a transport."""
        self.transport = transport
        self._portions = Portions(transport, self.take, self.is_ready)

    def data_received(self, data: bytes) -> None:
        """Record the time, and process received data, a part at a time."""
        self._heard_s = self._loop.time()
        self._portions.add(data)

    def pause_writing(self) -> None:
        """Pause sending until the client has read enough."""
        self.writable.clear()

    def resume_writing(self) -> None:
        """Resume sending."""
        self.writable.set()

    def connection_lost(self, exc: Exception | None) -> None:  # noqa: ARG002  # asyncio's name
        """Discard pending data, and notify the server, which may wait for its last connection."""
        self.is_lost = True
        self._portions.close()
        self.writable.set()  # nothing else sets it after this
        self._shared.connections.discard(self)
        self._shared.has_lost_one.set()

    def silent_sec(self) -> float:
        """Return for how long nothing has arrived, in seconds."""
        return self._loop.time() - self._heard_s

    def abort(self) -> None:
        """Close the connection without a message, which nobody would read."""
        self.transport.abort()

    # The protocol

    def take(self, data: bytes) -> None:
        """Process a part of the received data."""
        raise NotImplementedError

    def is_ready(self) -> bool:
        """Return whether `take` may be called now."""
        raise NotImplementedError

    def end(self) -> None:
        """End when the server ends."""
        raise NotImplementedError


def scope_of(request: h11.Request, transport: asyncio.Transport) -> dict[str, Any]:
    """Return the ASGI scope of a request, without its type."""
    path, _, query = request.target.partition(b"?")
    return {
        "asgi": {"version": "3.0", "spec_version": "2.3"},
        "http_version": request.http_version.decode("ascii"),
        "server": address(transport, "sockname"),
        "client": client_address(transport),
        "root_path": "",
        "path": unquote(path.decode("ascii")),
        "raw_path": path,
        "query_string": query,
        "headers": list(request.headers),
    }


def client_address(transport: asyncio.Transport) -> tuple[str, int] | None:
    """Return where a client connects from."""
    return address(transport, "peername")


def address(transport: asyncio.Transport, end: str) -> tuple[str, int] | None:
    """Return the host and port of one end of a connection; None where it has none."""
    known = transport.get_extra_info(end)
    return (str(known[0]), int(known[1])) if isinstance(known, tuple) else None


def is_encrypted(transport: asyncio.Transport) -> bool:
    """Return whether a connection uses TLS."""
    return transport.get_extra_info("ssl_object") is not None


def response(status: int, headers: Iterable[tuple[bytes, bytes]]) -> h11.Response:
    """Return the head of an answer, with the current date."""
    now = email.utils.formatdate(usegmt=True).encode()
    return h11.Response(
        status_code=status, headers=[(b"date", now), *headers], reason=PHRASES.get(status, b"")
    )
