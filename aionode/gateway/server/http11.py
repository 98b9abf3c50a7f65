"""HTTP/1.1 over a connection, by h11, which does no I/O of its own."""

from __future__ import annotations

import asyncio
import contextlib
import socket
from typing import TYPE_CHECKING, Any, Final

import h11

from aionode._process.socket_queue import queued_bytes
from aionode.gateway.server.connection import Connection, is_encrypted, logger, response, scope_of
from aionode.gateway.server.websocket import WebSocketConnection

if TYPE_CHECKING:
    from aionode.gateway.server.connection import Application, Shared

__all__ = ["HttpConnection"]

MAX_HEAD: Final = 16 << 10
"""The largest head of a request, in bytes."""

MAX_TOGETHER: Final = 64 << 10
"""Size up to which a part of an answer is copied, so that it is sent together with others."""

MAX_BODY: Final = 64 << 10
"""Bytes of a body that may wait for the application before reading pauses."""


class HttpConnection(Connection):
    """A connection whose client must send its request, and read the answer, within some seconds.

    The scope's state tells the application the identity in the client's TLS certificate.
    """

    def __init__(self, shared: Shared) -> None:
        super().__init__(shared)
        self._http = h11.Connection(h11.SERVER, MAX_HEAD)
        self._request: Request | None = None
        self._is_paused = False
        self._is_ending = False
        self._timer: asyncio.TimerHandle | None = None
        self._unread_bytes: int | None = None
        self._state: dict[str, Any] = {}

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Start the timeout for the first request."""
        self.use(transport)
        if not self._shared.admit(self):
            self.abort()
            return
        self._state = {"aionode_certificate": common_name(transport), "aionode_connection": self}
        self._begin_time()

    # Requests

    def is_ready(self) -> bool:
        """Return whether to read more: no request waits for another, and no body buffer is full."""
        return not self._is_paused

    def take(self, data: bytes) -> None:
        """Process a part of a request."""
        self._http.receive_data(data)
        self._handle_events()

    def go_on(self) -> None:
        """Continue reading after the application has consumed what was read."""
        self._is_paused = False
        self._portions.go_on()

    def _handle_events(self) -> None:
        while not self.transport.is_closing():
            try:
                event = self._http.next_event()
            except h11.RemoteProtocolError as error:
                self._refuse(error.error_status_hint)
                return
            if event is h11.NEED_DATA:
                return
            if event is h11.PAUSED:  # further requests wait for this one
                self._is_paused = True
                return
            if isinstance(event, h11.Request):
                self._begin(event)
            elif self._request is not None and isinstance(event, h11.Data):
                self._request.add(bytes(event.data))
                self._is_paused = self._request.waiting_bytes > MAX_BODY
            elif self._request is not None and isinstance(event, h11.EndOfMessage):
                self._request.end_body()
                self._begin_next()

    def _begin(self, event: h11.Request) -> None:
        """Pass a request to the application."""
        scope = {**scope_of(event, self.transport), "state": dict(self._state)}
        if asks_for_websocket(event):
            self._become_websocket(scope)
            return
        scope["type"] = "http"
        scope["scheme"] = "https" if is_encrypted(self.transport) else "http"
        scope["method"] = event.method.decode("ascii")
        self._request = Request(self, self._http, scope)
        self._shared.start(self._request.run(self._shared.app))

    def _become_websocket(self, scope: dict[str, Any]) -> None:
        """Lift the time limit for a WebSocket; take the largest frame from the current policy."""
        self._http.next_event()  # the end of the request, which has no body
        rest = self._http.trailing_data[0] + self._portions.close()
        self._stop_time()
        websocket = WebSocketConnection(self._shared, self._http)
        websocket.made_s, websocket.has_session = self.made_s, self.has_session
        self.transport.set_protocol(websocket)
        self._shared.connections.discard(self)
        self._shared.connections.add(websocket)
        websocket.begin(self.transport, scope, rest)

    def _refuse(self, status: int) -> None:
        """Answer anything that is not HTTP with an error, and close the connection."""
        if self._http.our_state in {h11.IDLE, h11.SEND_RESPONSE}:
            headers = [(b"content-type", b"text/plain"), (b"connection", b"close")]
            text = b"this cannot be read as a request of HTTP"
            self.write(response(status, headers), h11.Data(data=text), h11.EndOfMessage())
        self.transport.close()

    # Answers

    def write(self, *events: h11.Event) -> None:
        """Send parts of an answer, joined if they are small."""
        small: list[bytes] = []
        for event in events:
            data = self._http.send(event) or b""
            if len(data) <= MAX_TOGETHER:
                small.append(data)
            else:
                self.transport.write(b"".join(small))
                self.transport.write(data)
                small = []
        if any(small):
            self.transport.write(b"".join(small))

    def end_answer(self) -> None:
        """Continue after the last part of an answer, and start the timeout for the next request."""
        if self.transport.is_closing():
            return
        if self._is_ending or self._http.our_state is h11.MUST_CLOSE:
            self.transport.close()
            return
        self._begin_time()
        self.go_on()
        self._begin_next()

    def _begin_next(self) -> None:
        """Start the next request, once the last one is read and answered."""
        if self._http.our_state is h11.DONE and self._http.their_state is h11.DONE:
            self._http.start_next_cycle()
            self._request = None
            self._handle_events()

    def resume_writing(self) -> None:
        """Record that the client is reading."""
        self._unread_bytes = None
        super().resume_writing()

    # Time limits

    def _begin_time(self) -> None:
        self._stop_time()
        seconds = self._shared.policy().limits.handshake_sec
        self._timer = self._loop.call_later(seconds, self._look)

    def _stop_time(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _look(self) -> None:
        """Close the connection if its client has not sent its request, or reads nothing."""
        left = unread_bytes(self.transport)
        if left:
            is_idle = self._unread_bytes is not None and left >= self._unread_bytes
        else:  # the application limits the time for the body
            is_idle = self._request is None or self._request.is_answered
        self._unread_bytes = left or None
        if is_idle:
            self.abort()
        else:
            self._begin_time()

    def lose_after(self, seconds: float) -> None:
        """Treat a client as disconnected when its host has acknowledged nothing for some seconds.

        TCP by itself waits for a quarter of an hour. This works on Linux only, and only the host
        acknowledges: a frozen program goes unnoticed.
        """
        connected = self.transport.get_extra_info("socket")
        if connected is not None and hasattr(socket, "TCP_USER_TIMEOUT"):
            connected.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_KEEPIDLE, 1)
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_KEEPINTVL, 1)
            timeout_ms = round(seconds * 1000)
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, timeout_ms)

    # The end

    def end(self) -> None:
        """End after the answer to a request; immediately if there is no request."""
        self._is_ending = True
        request = self._request
        if request is None or request.is_answered or request.more_body:
            self.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """Cancel the timeout, and notify the application."""
        self._stop_time()
        super().connection_lost(exc)
        if self._request is not None:
            self._request.changed.set()


class Request:
    """A request and its answer, as an ASGI application sees them.

    Attributes:
        changed: Set when `receive` has something to return.
        more_body: Whether parts of the body are still to arrive.
        is_answered: Whether the answer is complete.
    """

    def __init__(
        self, connection: HttpConnection, http: h11.Connection, scope: dict[str, Any]
    ) -> None:
        self._connection = connection
        self._http = http
        self._scope = scope
        self._body = bytearray()
        self.changed = asyncio.Event()
        self.more_body = True
        self._head: h11.Response | None = None  # sent with the first part of the body
        self._is_begun = False
        self.is_answered = False

    async def run(self, app: Application) -> None:
        """Call the application; if it raises, answer with an error status, and log it."""
        try:
            await app(self._scope, self.receive, self.send)
            if not self._is_over:
                logger.error("gateway: a request was not answered")
        except Exception:  # noqa: BLE001  # of any kind; clients are told so, and the log why
            logger.exception("gateway: a request failed")
            if not self._is_begun:
                head = {"status": 500, "headers": [(b"connection", b"close")]}
                await self.send({"type": "http.response.start", **head})
                await self.send({"type": "http.response.body", "body": b"Internal Server Error"})
        finally:
            if not self.is_answered:
                self._connection.transport.close()

    def add(self, data: bytes) -> None:
        """Add a part of the body; anything after the answer is discarded."""
        if not self.is_answered:
            self._body += data
            self.changed.set()

    @property
    def waiting_bytes(self) -> int:
        """The number of body bytes waiting for the application."""
        return len(self._body)

    def end_body(self) -> None:
        """Handle the end of the body."""
        self.more_body = False
        self.changed.set()

    async def receive(self) -> dict[str, Any]:
        """Return the next part of the body, or that the client has disconnected."""
        if self._http.they_are_waiting_for_100_continue and not self._is_over:
            self._connection.write(
                h11.InformationalResponse(status_code=100, headers=[], reason=b"Continue")
            )
        if not self._is_over:
            self._connection.go_on()
            await self.changed.wait()
            self.changed.clear()
        if self._is_over:
            return {"type": "http.disconnect"}
        body = bytes(self._body)
        self._body.clear()
        return {"type": "http.request", "body": body, "more_body": self.more_body}

    @property
    def _is_over(self) -> bool:
        return self.is_answered or self._connection.transport.is_closing()

    async def send(self, message: Any) -> None:
        """Send a part of the answer once the client has read enough, unless it has disconnected."""
        await self._connection.writable.wait()
        if self._connection.transport.is_closing():
            return
        if message["type"] == "http.response.start":
            self._head = response(message["status"], message.get("headers", ()))
            return
        events: list[h11.Event] = []
        if self._head is not None:
            self._is_begun = True
            events.append(self._head)
            self._head = None
        body, is_last = message.get("body", b""), not message.get("more_body", False)
        if body and self._scope["method"] != "HEAD":
            events.append(h11.Data(data=body))
        if is_last:
            events.append(h11.EndOfMessage())
        self._connection.write(*events)
        if is_last:
            self.is_answered = True
            self._body.clear()
            self.changed.set()
            self._connection.end_answer()


def asks_for_websocket(request: h11.Request) -> bool:
    """Return whether a request asks for a WebSocket, which only GET without a body can do."""
    headers: dict[bytes, bytes] = {}
    for name, value in request.headers:
        headers[name] = headers[name] + b"," + value if name in headers else value
    options = {option.strip().lower() for option in headers.get(b"connection", b"").split(b",")}
    is_upgrade = b"upgrade" in options and headers.get(b"upgrade", b"").lower() == b"websocket"
    has_body = b"transfer-encoding" in headers or headers.get(b"content-length", b"0") != b"0"
    is_get = (request.method, request.http_version) == (b"GET", b"1.1")
    return is_get and is_upgrade and not has_body


def unread_bytes(transport: asyncio.Transport) -> int:
    """Return the number of sent bytes not yet received: here, and in the kernel's buffers.

    A socket reports free space only when a third of its buffer has been sent.
    """
    waiting = transport.get_write_buffer_size()
    connected = transport.get_extra_info("socket")
    with contextlib.suppress(OSError):
        waiting += queued_bytes(connected)
    return waiting


def common_name(transport: asyncio.Transport) -> str:
    """Return the common name of the client's certificate; empty without one."""
    certificate = transport.get_extra_info("peercert") or {}
    for part in certificate.get("subject", ()):
        for name, value in part:
            if name == "commonName":
                return str(value)
    return ""
