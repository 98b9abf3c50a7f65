"""Bodies, errors and streams of HTTP, for the routes."""

from __future__ import annotations

import asyncio
import math
from contextlib import aclosing, asynccontextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import msgspec
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response

from aionode import errors
from aionode.errors import AionodeError, RefusedError
from aionode.fastapi import watching
from aionode.gateway.server.door import STATUS
from aionode.gateway.session.encoding.client_json import decoded

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, AsyncIterator, Awaitable, Callable

    from starlette.types import Receive, Scope, Send

    from aionode.gateway.session.delivery.outbox import Frame
    from aionode.gateway.session.session import Session

__all__ = [
    "ALIVE",
    "CLIENT_GONE",
    "EVENTS",
    "HEADERS",
    "MAX_SEC",
    "Asked",
    "Stream",
    "body_of",
    "error_of",
    "error_response",
    "event",
    "json_response",
    "until_ended",
]

EVENTS: Final = "text/event-stream"

ALIVE: Final = b": alive\n\n"
"""A comment in server-sent events that keeps the connection alive."""

MAX_SEC: Final = 3600.0
"""The longest wait that a request may ask for, in seconds."""

ALIVE_SEC: Final = 2.0
"""The time between two keep-alive comments of a stream, in seconds: proxies and firewalls cut
silent connections, and the network reports a client that is gone only to a server that sends."""

CLIENT_GONE: Final = 499
"""The status of a request whose client has disconnected, as in nginx's log; nobody receives it."""

HEADERS: Final = {"Cache-Control": "no-store"}

FAILURES: Final[tuple[tuple[type[BaseException], int, str], ...]] = (
    (errors.MessageError, 400, "invalid_message"),
    (errors.NameValidationException, 400, "invalid_name"),
    (errors.InterfaceNotFoundError, 404, "unknown_type"),
    (errors.NodeNameNonExistentError, 404, "not_found"),
    (errors.GoalRejectedError, 409, "rejected"),
    (errors.GoalError, 502, "goal_failed"),
    (errors.ServiceUnavailableError, 503, "unavailable"),
    (errors.ServiceError, 502, "call_failed"),
    (errors.EntityDestroyedError, 503, "unavailable"),
    (errors.NodeNotRunningError, 503, "unavailable"),
    (TimeoutError, 504, "timeout"),
    (AionodeError, 500, "failed"),
)
"""The status and code of other errors; the first match is used."""

CODES: Final = {
    400: "bad_request",
    404: "not_found",
    405: "method_not_allowed",
    406: "not_acceptable",
    408: "timeout",
    409: "rejected",
    415: "unsupported",
    422: "unsupported_image",
    501: "not_installed",
    503: "unavailable",
    504: "timeout",
}
"""The code for each status that the routes themselves return."""


# Answers


def json_response(value: Any, status: int = 200) -> Response:
    """Return an answer in JSON; bytes are taken as JSON."""
    text = value if isinstance(value, bytes) else msgspec.json.encode(value)
    return Response(text, status, HEADERS, "application/json")


def error_of(error: Exception) -> tuple[int, str, str]:
    """Return the status, code and text of the answer to an error.

    Raises:
        Exception: `error`, if it is a bug in aionode.
    """
    if isinstance(error, RefusedError):
        return STATUS[error.code], error.code, str(error)
    if isinstance(error, HTTPException):
        return error.status_code, CODES.get(error.status_code, "failed"), error.detail
    for kind, status, code in FAILURES:
        if isinstance(error, kind):
            return status, code, str(error) or "the time limit has passed"
    raise error


def error_response(error: Exception) -> Response:
    """Return the answer to an error, in JSON.

    Raises:
        Exception: `error`, if it is a bug in aionode.
    """
    status, code, text = error_of(error)
    response = json_response({"code": code, "error": text}, status)
    if status == 401:
        response.headers["WWW-Authenticate"] = "Bearer"
    if isinstance(error, HTTPException) and error.headers:
        response.headers.update(error.headers)
    return response


# Requests


async def body_of(request: Request, timeout_sec: float) -> bytes:
    """Return the body of a request; the door has already limited its size.

    Args:
        request: The request.
        timeout_sec: Timeout for the body to arrive, in seconds.

    Raises:
        RefusedError: the body is too large.
        HTTPException: it takes too long (408), or the client has gone.
    """
    try:
        async with asyncio.timeout(timeout_sec):
            return b"".join([part async for part in request.stream()])
    except TimeoutError:
        text = f"the body of the request has not arrived within {timeout_sec:g} s"
        raise HTTPException(408, text) from None
    except ClientDisconnect:
        raise HTTPException(CLIENT_GONE, "the client has disconnected") from None


@dataclass(frozen=True, slots=True)
class Asked:
    """A request over HTTP.

    Attributes:
        session: The session of the request.
        request: The request.
        body: Its body.
    """

    session: Session
    request: Request
    body: bytes

    @property
    def name(self) -> str:
        """The name in the path, which a program may have written with its leading slash."""
        return f"/{self.request.path_params['name'].lstrip('/')}"

    @property
    def type_name(self) -> str | None:
        """The type named in the query."""
        return self.request.query_params.get("type")

    @property
    def accept(self) -> str:
        """The media types that the caller accepts."""
        return self.request.headers.get("accept", "")

    def lose_silent_client(self) -> None:
        """Treat the caller as gone if its host has been silent for the time set in the policy."""
        connection: Any = self.request.scope["state"].get("aionode_connection")
        if connection is not None:
            connection.lose_after(self.session.rights.limits.client_lost_sec)

    def json(self) -> Any:
        """Return the JSON of the body.

        Raises:
            HTTPException: it is not JSON (400), or is not declared as JSON (415): a page of another
                origin could send such a body without a preflight request.
        """
        given = self.request.headers.get("content-type", "").partition(";")[0].strip().lower()
        if given != "application/json":
            text = f"the body is {given or 'of no type'}; send application/json, as by curl --json"
            raise HTTPException(415, text)
        try:
            return decoded(self.body, self.session.rights.limits.frame_parts, "body")
        except errors.MessageError as error:
            raise HTTPException(400, str(error)) from None

    def number(self, name: str, default: float, max_value: float) -> float:
        """Return a number from the query, between 0 and `max_value`.

        Raises:
            HTTPException: it is not a number in that range (400).
        """
        text = self.request.query_params.get(name)
        if text is None:
            return default
        try:
            number = float(text)
        except ValueError:
            number = math.nan
        if not 0 <= number <= max_value:
            text = f"{name}={text[:40]!r}: use a number from 0 to {max_value:g}"
            raise HTTPException(400, text)
        return number


# Streams


def event(name: str, data: bytes, id_: str = "") -> bytes:
    """Return a server-sent event with JSON as data, which contains no line breaks."""
    head = f"event: {name}\n" if name else ""
    number = f"id: {id_}\n" if id_ else ""
    return b"".join((head.encode(), number.encode(), b"data: ", data, b"\n\n"))


@asynccontextmanager
async def until_ended(session: Session) -> AsyncIterator[None]:
    """Cancel the block when a session ends because the gateway or the caller's rights end.

    Raises:
        HTTPException: the session has ended (503).
        RefusedError: another client has taken its place.
    """
    scope = asyncio.timeout(None)
    try:
        async with scope, watching(session.ended.wait, scope):
            yield
    except TimeoutError:
        if not scope.expired():
            raise
        if session.end_reason:
            raise RefusedError("connection", session.end_reason, "too_many") from None
        raise HTTPException(503, "the gateway is stopping, or its policy has changed") from None


class Stream(Response):
    """A response without a length, whose chunks are sent as they arrive.

    It ends with its session. The generator of the chunks is closed when the client disconnects.

    Args:
        session: The session.
        chunks: The chunks.
        media_type: The media type of the whole response.
        first: Sent before the chunks.
        alive: Sent to keep the connection alive; empty for nothing.
    """

    def __init__(
        self,
        session: Session,
        chunks: AsyncGenerator[Frame, None],
        media_type: str,
        *,
        first: bytes,
        alive: bytes = b"",
    ) -> None:
        self.status_code = 200
        self.background = None
        self.media_type = media_type
        self.init_headers({**HEADERS, "X-Accel-Buffering": "no"})  # nginx passes each chunk on
        self._session = session
        self._chunks = chunks
        self._first = first
        self._alive = alive

    async def __call__(self, scope: Scope, _receive: Receive, send: Send) -> None:
        """Send the chunks, or none for a HEAD request. Cancelling closes the generator."""

        async def put(chunk: Frame) -> None:
            data = chunk.encode() if isinstance(chunk, str) else chunk
            await send({"type": "http.response.body", "body": data, "more_body": True})

        head = {"status": self.status_code, "headers": self.raw_headers}
        async with aclosing(self._chunks):
            await send({"type": "http.response.start", **head})
            if scope["method"] != "HEAD":  # otherwise the response would never end
                await self._send_chunks(put)
        await send({"type": "http.response.body", "body": b"", "more_body": False})

    async def _send_chunks(self, put: Callable[[Frame], Awaitable[None]]) -> None:
        # The stream ends with its session.
        with suppress(HTTPException, RefusedError):
            async with until_ended(self._session), asyncio.TaskGroup() as tasks:
                living = tasks.create_task(self._stay_alive(put))
                await put(self._first)
                async for chunk in self._chunks:
                    await put(chunk)
                living.cancel()

    async def _stay_alive(self, put: Callable[[Frame], Awaitable[None]]) -> None:
        """Keep the connection alive while nothing else is sent."""
        while self._alive:
            try:
                async with asyncio.timeout(ALIVE_SEC):
                    await asyncio.Event().wait()
            except TimeoutError:
                await put(self._alive)
