"""The door: every request passes it before any code of a way in runs."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, MutableMapping
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode.errors import RefusedError
from aionode.gateway._identity import check_browser, from_scope, take_token

if TYPE_CHECKING:
    from aionode.gateway._clients import Clients

__all__ = ["Door"]

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]

PUBLIC: Final = ("/page/",)
"""The files of the page: nothing of the robot is in them, and a page asks for them without a token.
"""

HEADERS: Final = [
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"x-content-type-options", b"nosniff"),
    (b"x-frame-options", b"DENY"),
    (b"referrer-policy", b"no-referrer"),
]
"""On each answer: other origins may not embed it, and no address with a token is passed on."""

STATUS: Final = {
    "unauthorized": 401,
    "not_allowed": 403,
    "not_confirmed": 403,
    "out_of_limits": 422,
    "held": 409,
    "too_old": 409,
    "too_large": 413,
    "too_fast": 429,
    "too_many": 429,
}
"""The HTTP status of each code of RefusedError."""


class Door:
    """Identifies the client of each request, and refuses what pages of other origins ask for.

    In the scope it leaves ``aionode.credentials``.
    """

    def __init__(self, app: Any, gateway: Clients) -> None:
        self._app = app
        self._gateway = gateway

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        """Serve one request, or one WebSocket."""
        if scope["type"] not in {"http", "websocket"}:
            return
        token = take_token(scope)
        credentials = from_scope(scope, token)
        policy = self._gateway.policy
        answer = Answer(send, allowed_origin(credentials.origin, policy.page_origins))
        try:
            if is_preflight(scope):
                check_browser(credentials, policy.hosts, policy.page_origins)
                await preflight(answer)
                return
            if is_public(scope):
                check_browser(credentials, policy.hosts, policy.page_origins)
            else:
                policy.identify(credentials)
            scope["aionode.credentials"] = credentials
            limited = limit_body(scope, receive, policy.limits.frame_bytes)
            await self._app(scope, limited, answer)
        except RefusedError as error:
            self._gateway.note_refusal(credentials, error)
            if not answer.has_begun:
                await refuse(scope, answer, error)


def is_public(scope: Message) -> bool:
    """Return whether a request is for the page or the health, which tell nothing of the robot."""
    path: str = scope["path"]
    if scope["type"] != "http" or scope["method"] not in {"GET", "HEAD"}:
        return False
    return path in {"/", "/healthz"} or path.startswith(PUBLIC)


def is_preflight(scope: Message) -> bool:
    """Return whether a browser asks what a page of another origin may do."""
    return bool(scope["type"] == "http" and scope["method"] == "OPTIONS")


def allowed_origin(origin: str | None, origins: frozenset[str]) -> str | None:
    """Return the origin of a page that may read the answers, if it is not the gateway's own."""
    return origin if origin in origins else None


class Answer:
    """Sends an answer, with the headers that each one has.

    Args:
        send: Sends it.
        origin: The origin of a page that may read it, if it is not the gateway's own.

    Attributes:
        has_begun: Whether its first part was sent.
    """

    def __init__(self, send: Send, origin: str | None) -> None:
        self.has_begun = False
        self._send = send
        self._headers = list(HEADERS)
        if origin is not None:
            allowed = (b"access-control-allow-origin", origin.encode("latin-1", "replace"))
            self._headers += [allowed, (b"vary", b"Origin")]

    async def __call__(self, message: Message) -> None:
        """Send one part."""
        if not self.has_begun:
            self.has_begun = True
            if message["type"] != "websocket.accept":
                message["headers"] = [*message.get("headers", ()), *self._headers]
        await self._send(message)


async def preflight(send: Send) -> None:
    """Answer a browser that asks for a page which may connect."""
    headers = [
        (b"access-control-allow-methods", b"GET, POST, PUT"),
        (b"access-control-allow-headers", b"authorization, content-type"),
        (b"access-control-max-age", b"600"),
    ]
    await send({"type": "http.response.start", "status": 204, "headers": headers})
    await send({"type": "http.response.body", "body": b""})


def limit_body(scope: Message, receive: Receive, most: int) -> Receive:
    """Return a `receive` that refuses the body of a request beyond so many bytes."""
    if scope["type"] != "http":
        return receive
    received = 0

    async def receive_limited() -> Message:
        nonlocal received
        message = await receive()
        received += len(message.get("body", b""))
        if received > most:
            raise RefusedError("request", f"its body has more than {most} bytes", "too_large")
        return message

    return receive_limited


async def refuse(scope: Message, send: Send, error: RefusedError) -> None:
    """Answer with the reason, and the HTTP status that fits it."""
    kind = "http.response" if scope["type"] == "http" else "websocket.http.response"
    body = msgspec.json.encode({"error": str(error), "code": error.code})
    headers = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode())]
    if error.code == "unauthorized":
        headers.append((b"www-authenticate", b'Bearer realm="aionode"'))
    status = STATUS[error.code]
    await send({"type": f"{kind}.start", "status": status, "headers": headers})
    await send({"type": f"{kind}.body", "body": body})
