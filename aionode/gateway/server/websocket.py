"""A WebSocket over a connection, by websockets' protocol, which does no I/O of its own."""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections.abc import Callable, Iterable
from functools import partial
from http import HTTPStatus
from typing import TYPE_CHECKING, Any, Final

import h11
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode, Frame, Opcode
from websockets.http11 import Request
from websockets.protocol import SEND_EOF, State
from websockets.server import ServerProtocol

from aionode._process.recent import Recent
from aionode.clock import S_TO_NS
from aionode.gateway.server.connection import (
    GOODBYE_SEC,
    Connection,
    is_encrypted,
    logger,
    response,
)
from aionode.gateway.server.outgoing import Outgoing
from aionode.gateway.session.encoding.frames import Fragmented
from aionode.gateway.session.refusals import Refusal
from aionode.gateway.session.robot import Bucket

if TYPE_CHECKING:
    from aionode.gateway.server.connection import Shared
    from aionode.gateway.session.delivery.outbox import Frame as Outgone

__all__ = ["WebSocketConnection"]

PING_SEC: Final = 20.0
"""Interval between pings, within which a client has to answer, in seconds."""

ANSWERED: Final = "aionode.answered"
"""The type of an ASGI message for the answer to a ping, which the application does not see."""

MAX_ASKED: Final = 16
"""Maximum number of pings that wait for their answers."""

PINGS_PER_SEC: Final = 200.0
"""Pings and pongs per second that the gateway reads from a client: it has to answer each ping."""

MAX_PARTS: Final = 10_000
"""Number of parts that a WebSocket message may have; clients send large ones in parts of 16 kB."""

ENDED_SEC: Final = 0.02
"""Pause for each frame that a client sends after the end of its WebSocket, in seconds."""

quiet = logging.getLogger("aionode.gateway.websockets")
quiet.setLevel(logging.WARNING)  # on lower levels it logs headers, which contain tokens


class WebSocketConnection(Connection):
    """A WebSocket that reports how long its client has been silent, and when it answers a ping.

    Args:
        shared: What it shares with the other connections.
        http: The HTTP connection of its request, which answers that request.

    Attributes:
        note: Counts and logs what is refused of the client; see `Session.note`.
    """

    def __init__(self, shared: Shared, http: h11.Connection) -> None:
        super().__init__(shared)
        self._http = http
        limits = shared.policy().limits
        self._protocol = ServerProtocol(state=State.OPEN, max_size=limits.frame_bytes, logger=quiet)
        self._accept_headers: list[tuple[bytes, bytes]] = []
        self._queue: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self._is_open = False
        self._is_answered = False  # the request, with either an end or a beginning
        self._has_closed = False
        self._parts: list[bytes] = []
        self._is_text = False
        # By the payloads of pings.
        self._asked: Recent[bytes, Callable[[], None] | None] = Recent(MAX_ASKED)
        self._awaits_pong = False
        self._timer: asyncio.TimerHandle | None = None
        rate_hz = limits.frames_per_sec
        self._conts = Bucket(rate_hz, self._now_ns)
        self._pings = Bucket(min(PINGS_PER_SEC, rate_hz), self._now_ns)
        self.note: Callable[[Refusal, str, str], object] = ignore

    def _now_ns(self) -> int:
        return round(self._loop.time() * S_TO_NS)

    def begin(self, transport: asyncio.Transport, scope: dict[str, Any], rest: bytes) -> None:
        """Ask the application whether the client may connect.

        Args:
            transport: The transport.
            scope: The ASGI scope of the request.
            rest: The bytes that arrived after the request.
        """
        self.use(transport)
        self._portions.add(rest)
        self._outgoing = Outgoing(transport, self.writable)
        self._outgoing.on_abort = partial(
            self._note_end, "it does not read the answers to its pings"
        )
        headers = Headers(
            (name.decode("latin-1"), value.decode("latin-1")) for name, value in scope["headers"]
        )
        answer = self._protocol.accept(Request(scope["raw_path"].decode("ascii"), headers))
        self._accept_headers = encoded(answer.headers.raw_items())
        if answer.status_code != HTTPStatus.SWITCHING_PROTOCOLS:
            self._answer(answer.status_code, self._accept_headers, bytes(answer.body or b""))
            return
        scope["state"]["aionode_connection"] = self
        offered = headers.get_all("Sec-WebSocket-Protocol")
        scope |= {
            "type": "websocket",
            "scheme": "wss" if is_encrypted(transport) else "ws",
            "subprotocols": [name.strip() for line in offered for name in line.split(",")],
            "extensions": {"websocket.http.response": {}},
        }
        self._queue.put_nowait({"type": "websocket.connect"})
        self._shared.start(self._run(scope))

    async def _run(self, scope: dict[str, Any]) -> None:
        """Serve the client; afterwards it has a moment to read the close frame."""
        try:
            await self._shared.app(scope, self._receive, self._send)
        except Exception as error:  # noqa: BLE001  # of any kind, and the log says why
            # the client has left
            if not (isinstance(error, OSError) and self.transport.is_closing()):
                logger.exception("gateway: a WebSocket failed")
        finally:
            if not self._is_answered:
                self._answer(500, [], b"Internal Server Error")
            elif not self._has_closed:
                self._outgoing.close()
                self._part_soon()

    # The answer to the request

    def _answer(self, status: int, headers: list[tuple[bytes, bytes]], body: bytes) -> None:
        """Refuse the upgrade."""
        self._begin_answer(status, headers)
        self._end_answer(body)

    def _begin_answer(self, status: int, headers: Iterable[tuple[bytes, bytes]]) -> None:
        self._is_answered = True
        kept = [each for each in headers if each[0] not in {b"connection", b"date"}]
        self._write_http(response(status, [*kept, (b"connection", b"close")]))

    def _end_answer(self, body: bytes, *, more_body: bool = False) -> None:
        self._write_http(h11.Data(data=body))
        if not more_body:
            self._write_http(h11.EndOfMessage())
            self._has_closed = True
            self._disconnect(CloseCode.ABNORMAL_CLOSURE)
            self.transport.close()

    def _write_http(self, event: h11.Event) -> None:
        if not self.transport.is_closing():
            self.transport.write(self._http.send(event) or b"")

    def _accept(self, message: Any) -> None:
        headers = [*self._accept_headers, *message.get("headers", ())]
        if message.get("subprotocol"):
            headers.append((b"sec-websocket-protocol", message["subprotocol"].encode("latin-1")))
        self._is_answered = True
        self._write_http(
            h11.InformationalResponse(
                status_code=101, headers=headers, reason=b"Switching Protocols"
            )
        )
        self._is_open = True
        self._portions.go_on()
        self._timer = self._loop.call_later(PING_SEC, self._keep_alive)

    # ASGI

    async def _receive(self) -> dict[str, Any]:
        """Return the next message.

        The answer to a ping is queued in order with messages: those before it were sent earlier.
        """
        while True:
            message = await self._queue.get()
            if self._queue.empty():
                self._portions.go_on()
            if message["type"] != ANSWERED:
                return message
            message["answered"]()

    async def _send(self, message: Any) -> None:
        """Send a message of the application, once the client has read the earlier ones.

        Raises:
            OSError: the client has left.
        """
        kind = message["type"]
        if kind == "websocket.send":
            text = message.get("text")
            await self._send_frame(message["bytes"] if text is None else text)
            return
        await self.writable.wait()
        if self.transport.is_closing():
            raise ConnectionResetError("the client has left")
        if kind == "websocket.accept":
            self._accept(message)
        elif kind == "websocket.http.response.start":
            self._begin_answer(message["status"], message.get("headers", ()))
        elif kind == "websocket.http.response.body":
            more_body = message.get("more_body", False)
            self._end_answer(message.get("body", b""), more_body=more_body)
        elif self._is_answered:
            self._close(message.get("code", 1000), message.get("reason") or "")
        else:
            self._answer(403, [], b"")

    async def _send_frame(self, frame: Outgone) -> None:
        while not self.writable.is_set():
            await self.writable.wait()
        if not self._may_send():
            raise ConnectionResetError("the client has left")
        self._outgoing.send(self._shared.framing.parts(frame))

    def _may_send(self) -> bool:
        return self._is_open and not (self._has_closed or self.transport.is_closing())

    def send_now(self, frame: Outgone) -> bool:
        """Send a frame if the client has read enough of earlier ones; return whether it did."""
        if not (self.writable.is_set() and self._may_send()) or isinstance(frame, Fragmented):
            return False
        self._outgoing.send(self._shared.framing.parts(frame))
        return True

    def pause_writing(self) -> None:
        """Pause sending until the client has read what was sent."""
        self._outgoing.pause()

    def resume_writing(self) -> None:
        """Resume sending."""
        self._outgoing.resume()

    # Frames

    def is_ready(self) -> bool:
        """Return whether the application has consumed everything that was read."""
        return self._is_open and (self._queue.empty() or self._has_closed)

    def take(self, data: bytes) -> None:
        """Process a part of the received data."""
        self._protocol.receive_data(data)
        for event in self._protocol.events_received():
            if isinstance(event, Frame):
                self._take_frame(event)
        self._write_protocol()

    def _write_protocol(self) -> None:
        """Send what the protocol has to send, and end if it is done."""
        written = self._protocol.data_to_send()
        data = b"".join(written)
        if data:
            self._outgoing.write(data)
        if SEND_EOF in written:
            self._finish()

    def _take_frame(self, frame: Frame) -> None:
        if frame.opcode is Opcode.PING:  # the protocol answers it
            self._count(self._pings)
        elif frame.opcode is Opcode.PONG:
            self._count(self._pings)
            self._take_pong(bytes(frame.data))
        elif frame.opcode is not Opcode.CLOSE:
            self._take_part(frame)

    def _take_part(self, frame: Frame) -> None:
        """Take a part of a message; there could be any number of parts without any bytes."""
        if frame.opcode is Opcode.CONT:
            self._count(self._conts)
        else:
            self._is_text = frame.opcode is Opcode.TEXT
        if len(self._parts) >= MAX_PARTS:
            self._note_end(f"a message has more than {MAX_PARTS} parts")
            self.abort()
            return
        self._parts.append(bytes(frame.data))
        if frame.fin:
            parts, self._parts = self._parts, []
            self.take_message(parts[0] if len(parts) == 1 else b"".join(parts))

    def take_message(self, data: bytes) -> None:
        """Pass a message to the application; after a close frame, only a few per second."""
        if self._has_closed:
            self._portions.owed_sec += ENDED_SEC
            return
        message: dict[str, Any] = {"type": "websocket.receive"}
        if self._is_text:
            try:
                message["text"] = data.decode()
            except UnicodeDecodeError:
                self._protocol.fail(CloseCode.INVALID_DATA, "text that is not UTF-8")
                self._write_protocol()
                return
        else:
            message["bytes"] = data
        self._queue.put_nowait(message)

    def _count(self, bucket: Bucket) -> None:
        if bucket.wait_sec():
            self._portions.owed_sec += 1.0 / bucket.rate_hz

    def has_unread(self) -> bool:
        """Return whether received data waits here: if so, the client is not silent, but held up."""
        return bool(self._portions) or not self._queue.empty()

    # Pings

    def ping(self, answered: Callable[[], None] | None = None) -> None:
        """Ping the client, and call `answered` with the pong: data after it is newer than the ping.

        A pong cannot be forged in advance, since the payload of a ping is random. A client that
        gets several pings at once may answer only the last one, so its pong counts for the earlier
        ones as well.
        """
        if not self._may_send():
            return
        payload = secrets.token_bytes(8)
        self._asked.put(payload, answered)
        self._protocol.send_ping(payload)
        self._write_protocol()

    def _take_pong(self, payload: bytes) -> None:
        if payload not in self._asked:
            return
        self._awaits_pong = False
        answered = self._asked[payload]
        while payload in self._asked:
            del self._asked[next(iter(self._asked))]
        if answered is not None:
            self._queue.put_nowait({"type": ANSWERED, "answered": answered})

    def _keep_alive(self) -> None:
        """Ping the client; close the connection if it has not answered since the last time.

        Such a client would not read a close frame either.
        """
        if self._has_closed:
            return
        if self._awaits_pong:
            self._note_end(f"it has not answered a ping for {PING_SEC:g} s")
            self.abort()
            return
        self._awaits_pong = True
        self.ping()
        self._timer = self._loop.call_later(PING_SEC, self._keep_alive)

    # The end

    def _close(self, code: int, reason: str) -> None:
        """Send a close frame, and wait for the client's, which may be queued behind other data."""
        if self._has_closed:
            return
        self._has_closed = True
        self._disconnect(code, reason)
        if self._protocol.state is State.OPEN:
            self._protocol.send_close(code, reason)
            self._write_protocol()
        self._portions.go_on()
        self._part_soon()

    def _part_soon(self) -> None:
        self._loop.call_later(GOODBYE_SEC, self.abort)

    def _finish(self) -> None:
        """End after the client's close frame, or after invalid data."""
        if not self._has_closed:
            self._has_closed = True
            self._protocol.receive_eof()
            end = self._protocol.close_exc
            if end.sent is not None and end.sent.code == CloseCode.MESSAGE_TOO_BIG and not end.rcvd:
                limit = f"at most {self._shared.policy().limits.frame_bytes} bytes are allowed"
                text = f"{limit} by frame_bytes; the connection has ended"
                self.note(Refusal.TOO_LARGE, "frame", text)
            self._disconnect(*said(end))
            self._part_soon()
        self._outgoing.close()

    def _disconnect(self, code: int, reason: str = "") -> None:
        message = {"type": "websocket.disconnect", "code": code, "reason": reason}
        self._queue.put_nowait(message)

    def _note_end(self, reason: str) -> None:
        self.note(Refusal.DISCONNECTED, "connection", reason)

    def end(self) -> None:
        """Close the WebSocket when the server ends."""
        if not self._is_answered:
            self._answer(503, [], b"the gateway ends")
        else:
            self._close(CloseCode.SERVICE_RESTART, "")
            self._outgoing.close()

    def abort(self) -> None:
        """Close the connection without a message, which nobody would read."""
        self._outgoing.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """Notify the application."""
        if self._timer is not None:
            self._timer.cancel()
        super().connection_lost(exc)
        self._has_closed = True
        self._disconnect(CloseCode.NO_STATUS_RCVD if self._is_open else CloseCode.ABNORMAL_CLOSURE)


def ignore(*_: object) -> None:
    """Do nothing."""


def said(end: ConnectionClosed) -> tuple[int, str]:
    """Return the code and reason of the close frame of either side."""
    close = end.rcvd or end.sent
    return (close.code, close.reason) if close else (CloseCode.ABNORMAL_CLOSURE, "")


def encoded(headers: Iterable[tuple[str, str]]) -> list[tuple[bytes, bytes]]:
    """Return headers encoded for HTTP."""
    return [(name.lower().encode("latin-1"), value.encode("latin-1")) for name, value in headers]
