"""The web server of the gateway: uvicorn in the running loop, as a guest of the process."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import secrets
import socket
import ssl
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import uvicorn
from uvicorn.protocols.http.flow_control import FlowControl
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.utils import ClientDisconnected
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.exceptions import InvalidState
from websockets.frames import CloseCode

from aionode._process.socket_queue import queued_bytes
from aionode.clock import S_TO_NS
from aionode.gateway.server.outgoing import Framing, Outgoing
from aionode.gateway.server.portions import Portions
from aionode.gateway.session.encoding.frames import Fragmented
from aionode.gateway.session.refusals import Refusal
from aionode.gateway.session.robot import Bucket

if TYPE_CHECKING:
    from aionode.gateway.policy.policy import Limits, Policy
    from aionode.gateway.session.outbox import Frame

__all__ = ["HttpConnection", "Server", "WebSocketConnection", "server_config"]

PING_SEC: Final = 20.0
DATE_SEC: Final = 1.0
CLOSING_SEC: Final = 1.0

GOODBYE_SEC: Final = 5.0
"""Longest time for a client to read the end of a WebSocket, in seconds."""

ANSWERED: Final = "aionode.answered"
"""The type of a message of ASGI for the answer to a ping, which the application does not see."""

MOST_ASKED: Final = 16
"""Pings that may wait for their answers at once."""

PINGS_PER_SEC: Final = 200.0
"""Pings and pongs that the gateway reads of a client in a second: it has to answer each ping."""

MOST_PARTS: Final = 10_000
"""Parts that a message of a WebSocket may have; clients send large ones in parts of 16 kB."""

ENDED_SEC: Final = 0.02
"""Pause for each frame that a client sends after the end of its WebSocket, in seconds."""

SPARE: Final = 16
"""Connections beyond the number of clients: those for pages, and those that are told that there are
too many."""


class Server(uvicorn.Server):
    """A server that leaves signals to the program, says when it has started, and ends at once.

    uvicorn's own looks ten times a second whether it shall end, and then whether it may.
    """

    config: ServerConfig

    def __init__(self, config: ServerConfig) -> None:
        super().__init__(config)
        self.has_started = asyncio.Event()
        self._has_to_end = asyncio.Event()

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Leave the handlers of signals alone."""
        yield

    async def startup(self, sockets: Any = None) -> None:
        """Listen, and tell the tasks that wait for it.

        uvicorn would give a client a minute for the handshake of TLS, before it counts as one.
        """
        await super().startup([])
        limits: dict[str, Any] = {}
        if self.config.ssl is not None:
            limits["ssl_handshake_timeout"] = self.config.policy().limits.handshake_sec
            limits["ssl_shutdown_timeout"] = GOODBYE_SEC
        for listener in sockets or ():
            server = await asyncio.get_running_loop().create_server(
                self._connection, sock=listener, ssl=self.config.ssl, **limits
            )
            self.servers.append(server)
        self.has_started.set()

    def _connection(self) -> HttpConnection:
        return HttpConnection(self.config, self.server_state, self.lifespan.state)

    def stop(self) -> None:
        """Have `serve` disconnect the clients and return."""
        self.should_exit = True
        self._has_to_end.set()

    async def main_loop(self) -> None:
        """Serve until `stop` is called, and bring the date of the headers up to date meanwhile."""
        while not await self.on_tick(0):
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(DATE_SEC):
                    await self._has_to_end.wait()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Disconnect the clients; after `CLOSING_SEC`, cancel the requests that still run."""
        for listener in (*self.servers, *(sockets or ())):
            listener.close()
        for connection in list(self.server_state.connections):
            connection.shutdown()
        try:
            async with asyncio.timeout(CLOSING_SEC):
                await self._end_of_connections()
        except TimeoutError:
            for request in self.server_state.tasks:
                request.cancel()

    async def _end_of_connections(self) -> None:
        while self.server_state.connections:
            self.config.has_lost_one.clear()
            await self.config.has_lost_one.wait()
        if self.server_state.tasks:
            await asyncio.wait(self.server_state.tasks)
        for server in self.servers:
            await server.wait_closed()


class ServerLog:
    """The log of uvicorn, without the mistakes of clients: these may make them at any rate.

    Its errors are faults of the application, but for a text that is no UTF-8.
    """

    def __init__(self, logger: logging.Logger) -> None:
        self._logger = logger

    def __getattr__(self, name: str) -> Any:
        """Return another member of the log."""
        return getattr(self._logger, name)

    def warning(self, *_: object) -> None:
        """Say nothing of a request that is malformed."""

    def exception(self, text: str) -> None:
        """Write an error with its traceback."""
        if not text.startswith("Invalid UTF-8"):
            self._logger.error(text, exc_info=True)  # noqa: LOG014  # called by a handler


class Flow(FlowControl):
    """The flow of a connection, which begins again with what waits."""

    def __init__(self, transport: asyncio.Transport, portions: Portions) -> None:
        super().__init__(transport)
        self._portions = portions

    def resume_reading(self) -> None:
        """Take further bytes of the client."""
        super().resume_reading()
        self._portions.go_on()


class HttpConnection(H11Protocol):
    """A connection that has to say within some seconds what it wants, and to read the answer.

    The application finds in the state of the scope who the client is by its TLS certificate.

    Attributes:
        made_s: When it was made, by the clock of the loop.
        has_session: Whether a session uses it, as the application says.
    """

    _timer: asyncio.TimerHandle | None = None
    _unread_bytes: int | None = None
    made_s: float = 0.0
    has_session = False
    _heard_s: float = 0.0
    _is_upgraded = False
    config: ServerConfig

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin the time within which a request has to arrive."""
        super().connection_made(transport)
        self.access_log = False  # it would have the paths of requests, and belongs to the program
        self.logger = ServerLog(self.logger)  # type: ignore[assignment]  # does what is called of it
        self._portions = Portions(
            transport, super().data_received, lambda: not self.flow.read_paused
        )
        self.flow = Flow(transport, self._portions)
        self.made_s = self.loop.time()
        if len(self.connections) > self._limits.clients + SPARE and not self._make_room():
            transport.abort()
            return
        state = {"aionode_certificate": common_name(transport), "aionode_connection": self}
        self.app_state = {**self.app_state, **state}
        self._begin_time()

    @property
    def _limits(self) -> Limits:
        return self.config.policy().limits

    def _make_room(self) -> bool:
        """Close the oldest connection without a session, and return whether there was one.

        A client says at once what it wants, and those who only keep connections, or read none of
        what is public, must not keep it out.
        """
        without: list[HttpConnection | WebSocketConnection] = [
            other
            for other in self.connections
            if isinstance(other, HttpConnection | WebSocketConnection)
            and other is not self
            and not other.has_session
        ]
        oldest = min(without, key=lambda other: other.made_s, default=None)
        if oldest is not None:
            oldest.transport.abort()
            self.connections.discard(oldest)  # its end is told in the next turn only
        return oldest is not None

    @property
    def is_waiting(self) -> bool:
        """Whether the gateway waits for a request, or for the rest of one."""
        cycle: Any = self.cycle  # None until the head of a request has arrived
        return cycle is None or cycle.response_complete or cycle.more_body

    def data_received(self, data: bytes) -> None:
        """Note the time, and take what was received, some of it at a time."""
        self._heard_s = self.loop.time()
        self._portions.add(data)

    def silent_sec(self) -> float:
        """Return how long nothing has arrived, in seconds."""
        return self.loop.time() - self._heard_s

    def _begin_time(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        self._timer = self.loop.call_later(self._limits.handshake_sec, self._look)

    def _look(self) -> None:
        """Close the connection if its client has not sent its request, or reads nothing."""
        if self._is_upgraded:
            return
        left = unread_bytes(self.transport)
        cycle: Any = self.cycle
        if left:
            is_idle = self._unread_bytes is not None and left >= self._unread_bytes
        else:  # the application itself limits the time for the body
            is_idle = cycle is None or cycle.response_complete
        self._unread_bytes = left or None
        if is_idle:
            self.transport.abort()
        else:
            self._begin_time()

    def resume_writing(self) -> None:
        """Note that the client reads."""
        self._unread_bytes = None
        super().resume_writing()

    def on_response_complete(self) -> None:
        """Begin the time within which the next request has to arrive whole."""
        super().on_response_complete()
        if not self.transport.is_closing():
            self._begin_time()

    def handle_websocket_upgrade(self, event: Any) -> None:
        """Let a WebSocket have all the time, and frames as large as the policy says now."""
        self._is_upgraded = True
        self._portions.close()
        self.config.ws_max_size = self._limits.frame_bytes
        super().handle_websocket_upgrade(event)

    def lose_after(self, seconds: float) -> None:
        """Have a client whose host acknowledges nothing for some seconds count as disconnected.

        TCP by itself waits for a quarter of an hour. Only Linux is told, and only the host answers:
        a program that is frozen is not noticed.
        """
        connected = self.transport.get_extra_info("socket")
        if connected is not None and hasattr(socket, "TCP_USER_TIMEOUT"):
            connected.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_KEEPIDLE, 1)
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_KEEPINTVL, 1)
            timeout_ms = round(seconds * 1000)
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, timeout_ms)

    def shutdown(self) -> None:
        """End, without a request that is not there yet."""
        super().shutdown()
        if self.is_waiting:
            self.transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the time limit, and what waits."""
        if self._timer is not None:
            self._timer.cancel()
        self._portions.close()
        super().connection_lost(exc)
        self.config.has_lost_one.set()


class WebSocketConnection(WebSocketsSansIOProtocol):
    """A WebSocket that says how long its client is silent, and whether it answers now.

    Attributes:
        made_s: When it was made, by the clock of the loop.
        has_session: Whether a session uses it, as the application says.
        note: Counts and logs what is refused of the client; see `Session.note`.
    """

    has_session = False
    _heard_s: float = 0.0
    config: ServerConfig

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.made_s = self.loop.time()
        self.note: Callable[[Refusal, str, str], object] = ignore
        self.conn.debug = False  # it would write the tokens of addresses and headers into the log
        self.logger = ServerLog(self.logger)  # type: ignore[assignment]  # does what is called of it
        self._asked: dict[bytes, Callable[[], None]] = {}  # by the payloads of pings
        rate_hz = self.config.policy().limits.frames_per_sec
        self._parts = Bucket(rate_hz, self._now_ns)
        self._pings = Bucket(min(PINGS_PER_SEC, rate_hz), self._now_ns)

    def _now_ns(self) -> int:
        return round(self.loop.time() * S_TO_NS)

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Have frames leave as the client reads them, and arrive as the application does."""
        super().connection_made(transport)
        self._framing = self.config.framing
        self.transport = self._outgoing = Outgoing(transport, self.writable)
        self._outgoing.on_abort = partial(
            self._note_end, "it does not read the answers to its pings"
        )
        self._portions = Portions(transport, super().data_received, self._is_ready)

    def _is_ready(self) -> bool:
        return self.queue.empty() or self.close_sent

    def shutdown(self) -> None:
        """Close the WebSocket, also one whose client closes it at this moment."""
        try:
            super().shutdown()
        except InvalidState:  # the close was received, and what waits for the client is not sent
            self.transport.close()

    def pause_writing(self) -> None:
        """Send nothing until the client has read what was sent."""
        self._outgoing.pause()

    def resume_writing(self) -> None:
        """Send again."""
        self._outgoing.resume()

    def handle_connect(self, event: Any) -> None:
        """Have the application find this connection."""
        self.app_state = {**self.app_state, "aionode_connection": self}
        super().handle_connect(event)

    def data_received(self, data: bytes) -> None:
        """Note the time, and take what was received, some of it at a time."""
        self._heard_s = self.loop.time()
        self._portions.add(data)

    async def receive(self) -> Any:
        """Return the next frame.

        The answer to a ping has its place among the frames: those before it were sent earlier.
        """
        while True:
            message: Any = await self.queue.get()
            if self.queue.empty():
                self.read_paused = False
                self._portions.go_on()
            if message["type"] != ANSWERED:
                return message
            message["answered"]()

    async def send(self, message: Any) -> None:
        """Send a message of the application; a client that it has refused is no fault of it.

        uvicorn would write an error into the log for each of them.
        """
        if message["type"] == "websocket.send":
            text = message.get("text")
            await self._send_frame(message["bytes"] if text is None else text)
            return
        await super().send(message)
        if message["type"] == "websocket.http.response.body":
            self.handshake_complete = True
        elif message["type"] == "websocket.close":
            self._portions.go_on()  # the client's answer may be behind what waits

    async def _send_frame(self, frame: Frame) -> None:
        """Send a frame when the client has read the earlier ones.

        Raises:
            ClientDisconnected: it has left.
        """
        while not self.writable.is_set():
            await self.writable.wait()
        if not self._is_open():
            raise ClientDisconnected
        self._outgoing.send(self._framing.parts(frame))

    def _is_open(self) -> bool:
        return self.handshake_complete and not (self.close_sent or self.transport.is_closing())

    def send_now(self, frame: Frame) -> bool:
        """Send a frame, if its client has read enough of the earlier ones; return whether."""
        if not (self.writable.is_set() and self._is_open()):
            return False
        if isinstance(frame, Fragmented):
            return False
        self._outgoing.send(self._framing.parts(frame))
        return True

    def silent_sec(self) -> float:
        """Return how long nothing has arrived, in seconds."""
        return self.loop.time() - self._heard_s

    def has_unread(self) -> bool:
        """Return whether something of the client waits here: it is not silent, but has to wait."""
        return bool(self._portions) or not self.queue.empty()

    def ping(self, answered: Callable[[], None] | None = None) -> None:
        """Ask the client for a sign, and call `answered` with it: what comes then is no older.

        Nobody can answer before: what a ping carries is random. A client that gets several pings
        at once may answer the last one only, so its answer counts for the earlier ones as well.
        """
        payload = secrets.token_bytes(8)
        if answered is not None:
            if len(self._asked) >= MOST_ASKED:
                del self._asked[next(iter(self._asked))]
            self._asked[payload] = answered
        if not (self.close_sent or self.transport.is_closing()):
            self.conn.send_ping(payload)
            self.transport.write(b"".join(self.conn.data_to_send()))

    def abort(self) -> None:
        """Close the connection without a word, which nobody would read."""
        self.transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """Tell the server, which may wait for its last connection to end."""
        self._portions.close()
        self.connections.add(self)  # where it made room, and uvicorn needs it once more
        super().connection_lost(exc)
        self.config.has_lost_one.set()

    def _note_end(self, reason: str) -> None:
        self.note(Refusal.DISCONNECTED, "connection", reason)

    def handle_parser_exception(self) -> None:
        """Close the connection of a client whose frame is too large, or none of WebSocket."""
        closed = self.conn.close_sent
        if closed is not None and closed.code == CloseCode.MESSAGE_TOO_BIG:
            limit = f"at most {self.config.ws_max_size} bytes fit, as frame_bytes says"
            self.note(Refusal.TOO_LARGE, "frame", f"{limit}; the connection has ended")
        super().handle_parser_exception()

    def keepalive_timeout(self) -> None:
        """Close the connection of a client that answers nothing, and reads no goodbye either."""
        self._note_end(f"it has answered no ping for {PING_SEC:g} s")
        super().keepalive_timeout()
        self.transport.abort()

    async def run_asgi(self) -> None:
        """Serve the client; it has a moment to read the goodbye."""
        await super().run_asgi()
        if not self.disconnected:
            self.loop.call_later(GOODBYE_SEC, self.transport.abort)

    # Frames that reach no application: they are read no faster than others

    def handle_ping(self) -> None:
        """Answer a ping."""
        self._count(self._pings)
        super().handle_ping()

    def handle_pong(self, event: Any) -> None:
        """Take the answer to a ping."""
        self._count(self._pings)
        answered = self._asked.get(bytes(event.data))
        if answered is None:
            super().handle_pong(event)
        else:
            while bytes(event.data) in self._asked:
                del self._asked[next(iter(self._asked))]
            message: Any = {"type": ANSWERED, "answered": answered}
            self.queue.put_nowait(message)

    def send_receive_event_to_app(self) -> None:
        """Hand a message to the application; after the goodbye, a few a second are read at most."""
        if self.close_sent:
            self._portions.owed_sec += ENDED_SEC
        super().send_receive_event_to_app()

    def handle_cont(self, event: Any) -> None:
        """Take a part of a message; without any bytes in them, there could be any number."""
        self._count(self._parts)
        if len(self.frames) >= MOST_PARTS:
            self._note_end(f"a message has more than {MOST_PARTS} parts")
            self.transport.abort()
        else:
            super().handle_cont(event)

    def _count(self, bucket: Bucket) -> None:
        if bucket.wait_sec():
            self._portions.owed_sec += 1.0 / bucket.rate_hz


def ignore(*_: object) -> None:
    """Do nothing."""


def unread_bytes(transport: asyncio.Transport) -> int:
    """Return how much of what was sent is on its way: here, and in the buffers of the kernel.

    A socket tells that it has room only when a third of its buffer has left.
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


class ServerConfig(uvicorn.Config):
    """The configuration of a server.

    Attributes:
        policy: Returns the policy as it is now.
        has_lost_one: Set when a connection has ended.
        framing: Makes the frames of all its WebSockets.
    """

    policy: Callable[[], Policy]
    has_lost_one: asyncio.Event
    framing: Framing


def server_config(app: Any, current: Callable[[], Policy]) -> ServerConfig:
    """Return the configuration of the server."""
    policy = current()
    tls: dict[str, Any] = {}
    if policy.tls is not None:
        tls = {
            "ssl_certfile": policy.tls.certificate,
            "ssl_keyfile": policy.tls.key,
            "ssl_ca_certs": policy.tls.clients or None,
            "ssl_cert_reqs": ssl.CERT_OPTIONAL if policy.tls.clients else ssl.CERT_NONE,
        }
    config = ServerConfig(
        app,
        http=HttpConnection,
        ws=WebSocketConnection,
        ws_max_size=policy.limits.frame_bytes,
        ws_ping_interval=PING_SEC,
        ws_ping_timeout=PING_SEC,
        ws_per_message_deflate=False,  # it takes time and memory for each client
        lifespan="off",
        log_config=None,  # the program's logging stays as it is
        proxy_headers=False,  # a client may claim any address there
        server_header=False,
        **tls,
    )
    config.policy = current
    config.has_lost_one = asyncio.Event()
    config.framing = Framing()
    return config
