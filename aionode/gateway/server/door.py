"""The door: every request passes it before any code of a protocol runs."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, MutableMapping
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode._process.recent import Recent
from aionode.clock import S_TO_NS
from aionode.errors import RefusedError
from aionode.gateway.policy.identity import from_scope, place_of, take_token
from aionode.gateway.policy.origin import check_browser, check_host

if TYPE_CHECKING:
    from aionode.gateway._clients import Clients
    from aionode.gateway.policy.identity import Credentials

__all__ = ["Door"]

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]

PUBLIC: Final = ("/page/",)
"""The files of the page: they reveal nothing of the robot, and a page requests them without a
token."""

MAX_WRONG: Final = 10
"""Number of wrong tokens accepted from one place in a burst."""

WRONG_NS: Final = S_TO_NS
"""Time after which a wrong token is forgotten, in nanoseconds."""

MAX_PLACES: Final = 10_000

HEADERS: Final = [
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"x-content-type-options", b"nosniff"),
    (b"x-frame-options", b"DENY"),
    (b"referrer-policy", b"no-referrer"),
]
"""Headers of every answer: other origins may not embed it, and addresses with tokens are not passed
on."""

STATUS: Final = {
    "unauthorized": 401,
    "not_allowed": 403,
    "not_confirmed": 403,
    "out_of_limits": 422,
    "held": 409,
    "too_old": 409,
    "too_large": 413,
    "unsupported": 400,
    "too_fast": 429,
    "too_many": 429,
}
"""The HTTP status of each code of RefusedError."""


class Door:
    """Identifies the client of each request, and refuses requests of pages of other origins.

    It adds ``aionode.credentials`` to the scope.
    """

    def __init__(self, app: Any, clients: Clients) -> None:
        self._app = app
        self._clients = clients
        self._guesses = Guesses(clients.robot.time_base.steady_ns)
        self._of_pages = Guesses(clients.robot.time_base.steady_ns)

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        """Serve one request, or one WebSocket."""
        if scope["type"] not in {"http", "websocket"}:
            return
        address_bytes = len(scope["query_string"])
        token = take_token(scope)
        credentials = from_scope(scope, token)
        is_in_address = len(scope["query_string"]) < address_bytes
        policy = self._clients.policy
        answer = Answer(send, allowed_origin(credentials.origin, policy.page_origins))
        try:
            # Before the token is checked: requests made by another page say nothing about who is
            # guessing. A browser sends the origin with each script, even of the gateway's own page.
            if is_script(scope):
                check_host(credentials, policy.hosts)
            else:
                check_browser(credentials, policy.hosts, policy.page_origins)
            if is_preflight(scope):
                await preflight(answer)
                return
            if not is_public(scope):
                by_any_page = is_in_address and hides_its_page(scope, credentials)
                self._check(credentials, self._of_pages if by_any_page else self._guesses)
            scope["aionode.credentials"] = credentials
            limited = limit_body(scope, receive, policy.limits.frame_bytes)
            await self._app(scope, limited, answer)
        except RefusedError as error:
            self._clients.note_refusal(credentials, error)
            if not answer.has_begun:
                await refuse(scope, answer, error)

    def _check(self, credentials: Credentials, guesses: Guesses) -> None:
        """Refuse a client that the policy does not know.

        Raises:
            RefusedError: the policy does not know it, or too many wrong tokens came from its place.
        """
        if credentials.token:
            guesses.check(credentials.address)
        try:
            self._clients.policy.identify(credentials)
        except RefusedError:
            if credentials.token:
                guesses.note_wrong(credentials.address)
            raise


class Guesses:
    """Limits attempts with tokens: a burst per place, and then one per second.

    Valid tokens from that place have to wait as well, or an attacker would see at once which one is
    valid. Clients that are already connected stay connected.

    Args:
        now_ns: The steady clock, in nanoseconds.
    """

    def __init__(self, now_ns: Callable[[], int]) -> None:
        self._now_ns = now_ns
        # Forgets first the place with the least recent attempt.
        self._free_ns: Recent[str, int] = Recent(
            MAX_PLACES
        )  # by place: when none of its wrong tokens count any more

    def check(self, address: str) -> None:
        """Refuse a token if too many wrong ones came from the same place.

        Raises:
            RefusedError: there were too many; its code is ``too_fast``.
        """
        ahead_ns = self._free_ns.get(place_of(address), 0) - self._now_ns()
        if ahead_ns > (MAX_WRONG - 1) * WRONG_NS:
            raise RefusedError(
                f"client of {address}",
                "too many wrong tokens came from there; try again later",
                "too_fast",
            )

    def note_wrong(self, address: str) -> None:
        """Record a wrong token."""
        now_ns, place = self._now_ns(), place_of(address)
        free_ns = max(self._free_ns.pop(place, 0), now_ns) + WRONG_NS
        self._free_ns.put(place, free_ns)


def is_public(scope: Message) -> bool:
    """Return whether a request is for the page or the health check, which reveal nothing."""
    if scope["type"] != "http" or scope["method"] not in {"GET", "HEAD"}:
        return False
    return scope["path"] in {"/", "/healthz"} or is_script(scope)


def is_script(scope: Message) -> bool:
    """Return whether a request is for a file of the page; other origins cannot embed it."""
    is_read = scope["type"] == "http" and scope["method"] in {"GET", "HEAD"}
    return is_read and bool(scope["path"].startswith(PUBLIC))


def hides_its_page(scope: Message, credentials: Credentials) -> bool:
    """Return whether a browser request does not name its page, as for images over plain HTTP.

    Any page can put a token into the address of an image, so such tokens are counted separately:
    they do not lock out a client that presents its token elsewhere.
    """
    if credentials.origin is not None or credentials.sec_fetch_site:
        return False
    return any(
        name == b"user-agent" and value.startswith(b"Mozilla/") for name, value in scope["headers"]
    )


def is_preflight(scope: Message) -> bool:
    """Return whether a request is a browser's preflight for a page of another origin."""
    return bool(scope["type"] == "http" and scope["method"] == "OPTIONS")


def allowed_origin(origin: str | None, origins: frozenset[str]) -> str | None:
    """Return the origin of a page that may read the answers, if it is not the gateway's."""
    return origin if origin in origins else None


class Answer:
    """Sends an answer, with the headers that all answers have.

    Args:
        send: Sends it.
        origin: The origin of a page that may read it, if it differs from the gateway's own.

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
    """Answer the preflight of a browser whose page may connect."""
    headers = [
        (b"access-control-allow-methods", b"GET, POST, PUT"),
        (b"access-control-allow-headers", b"authorization, content-type"),
        (b"access-control-max-age", b"600"),
    ]
    await send({"type": "http.response.start", "status": 204, "headers": headers})
    await send({"type": "http.response.body", "body": b""})


def limit_body(scope: Message, receive: Receive, max_bytes: int) -> Receive:
    """Return a `receive` that refuses request bodies above a size."""
    if scope["type"] != "http":
        return receive
    received = 0
    declared = next((int(size) for name, size in scope["headers"] if name == b"content-length"), 0)

    def check(size: int) -> None:
        if size > max_bytes:
            raise RefusedError("request", f"its body has more than {max_bytes} bytes", "too_large")

    async def receive_limited() -> Message:
        nonlocal received
        check(declared)  # before `receive` asks a client that waits for "100 Continue" to send it
        message = await receive()
        received += len(message.get("body", b""))
        check(received)
        return message

    return receive_limited


async def refuse(scope: Message, send: Send, error: RefusedError) -> None:
    """Answer with the reason, and the corresponding HTTP status."""
    kind = "http.response" if scope["type"] == "http" else "websocket.http.response"
    body = msgspec.json.encode({"error": str(error), "code": error.code})
    headers = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode())]
    if error.code == "unauthorized":
        headers.append((b"www-authenticate", b'Bearer realm="aionode"'))
    if error.code == "too_fast":
        headers.append((b"retry-after", b"1"))
    status = STATUS[error.code]
    await send({"type": f"{kind}.start", "status": status, "headers": headers})
    await send({"type": f"{kind}.body", "body": body})
