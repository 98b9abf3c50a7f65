"""The web server of the gateway: uvicorn in the running loop, as a guest of the process."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import ssl
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Final

import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.utils import ClientDisconnected
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from aionode.gateway._outgoing import Framing, Outgoing

if TYPE_CHECKING:
    from aionode.gateway._policy import Policy

__all__ = ["HttpConnection", "Server", "WebSocketConnection", "server_config"]

PING_SEC: Final = 20.0
DATE_SEC: Final = 1.0
CLOSING_SEC: Final = 1.0
SPARE: Final = 16
"""How many more connections there may be than clients: those for pages, and those that are told
that there are too many."""


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
        """Listen, and tell who waits for it."""
        await super().startup(sockets)
        self.has_started.set()

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


class HttpConnection(H11Protocol):
    """A connection that has to say within some seconds what it wants.

    The application finds in the state of the scope who the client is by its TLS certificate.
    """

    _handshake: asyncio.TimerHandle | None = None
    _is_upgraded = False

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin the time within which a request has to arrive."""
        super().connection_made(transport)
        self.access_log = False  # it would have the paths of requests, and belongs to the program
        limits = self.config.policy().limits  # type: ignore[attr-defined]  # a ServerConfig
        if len(self.connections) > limits.clients + SPARE:
            transport.abort()
            return
        state = {"aionode_certificate": common_name(transport), "aionode_connection": self}
        self.app_state = {**self.app_state, **state}
        self._handshake = self.loop.call_later(limits.handshake_sec, self._give_up)

    def _give_up(self) -> None:
        scope: object = self.scope  # None until the head of a request has arrived
        cycle: Any = self.cycle  # None until the first request
        is_answered = cycle is not None and cycle.response_complete
        if not self._is_upgraded and (scope is None or is_answered):
            self.transport.abort()

    def on_response_complete(self) -> None:
        """Begin the time within which the next request has to arrive whole."""
        super().on_response_complete()
        if self._handshake is not None:
            self._handshake.cancel()
        if not self.transport.is_closing():
            limits = self.config.policy().limits  # type: ignore[attr-defined]  # a ServerConfig
            self._handshake = self.loop.call_later(limits.handshake_sec, self._give_up)

    def handle_websocket_upgrade(self, event: Any) -> None:
        """Let a WebSocket have all the time."""
        self._is_upgraded = True
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

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the time limit."""
        if self._handshake is not None:
            self._handshake.cancel()
        super().connection_lost(exc)
        self.config.has_lost_one.set()  # type: ignore[attr-defined]  # a ServerConfig


class WebSocketConnection(WebSocketsSansIOProtocol):
    """A WebSocket that says how long its client is silent, and whether it answers now."""

    _heard_s: float = 0.0
    _pings: int = 0
    _on_pong: tuple[bytes, Callable[[], None]] | None = None

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.conn.debug = False  # it would write the tokens of addresses and headers into the log

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Have frames leave as the client reads them."""
        super().connection_made(transport)
        self._framing = self.config.framing  # type: ignore[attr-defined]  # a ServerConfig
        self.transport = self._outgoing = Outgoing(transport, self.writable)

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
        """Note the time."""
        self._heard_s = self.loop.time()
        super().data_received(data)

    async def send(self, message: Any) -> None:
        """Send what the application does; a client that it has refused is no fault of it.

        uvicorn would write an error into the log for each of them.
        """
        if message["type"] == "websocket.send":
            text = message.get("text")
            await self._send_frame(message["bytes"] if text is None else text)
            return
        await super().send(message)
        if message["type"] == "websocket.http.response.body":
            self.handshake_complete = True

    async def _send_frame(self, frame: bytes | str) -> None:
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

    def send_now(self, frame: bytes | str) -> bool:
        """Send a frame, if its client has read enough of the earlier ones; return whether."""
        if not (self.writable.is_set() and self._is_open()):
            return False
        if type(frame) is not bytes and type(frame) is not str:  # a frame in parts
            return False
        self._outgoing.send(self._framing.parts(frame))
        return True

    def silent_sec(self) -> float:
        """Return how long nothing has arrived, in seconds."""
        return self.loop.time() - self._heard_s

    def ping(self, answered: Callable[[], None] | None = None) -> None:
        """Ask the client for a sign, and call `answered` with it: what comes then is no older."""
        self._pings += 1
        payload = b"aionode%d" % self._pings
        if answered is not None:  # a mere sign of life takes no answer from who waits for one
            self._on_pong = (payload, answered)
        if not (self.close_sent or self.transport.is_closing()):
            self.conn.send_ping(payload)
            self.transport.write(b"".join(self.conn.data_to_send()))

    def abort(self) -> None:
        """Close the connection without a word, which nobody would read."""
        self.transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """Tell the server, which may wait for its last connection to end."""
        super().connection_lost(exc)
        self.config.has_lost_one.set()  # type: ignore[attr-defined]  # a ServerConfig

    def handle_pong(self, event: Any) -> None:
        """Take the answer to a ping."""
        if self._on_pong is not None and bytes(event.data) == self._on_pong[0]:
            answered, self._on_pong = self._on_pong[1], None
            answered()
        else:
            super().handle_pong(event)


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
