"""The gateway: one port for everything, and a session for each client."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Coroutine, Sequence
from contextlib import AsyncExitStack
from typing import TYPE_CHECKING, Any, Final, Self

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.routing import WebSocketRoute

from aionode._process.concurrency import to_the_end
from aionode.errors import ConfigurationError, RefusedError
from aionode.gateway._clients import Clients, GatewayStats
from aionode.gateway.foxglove import websocket as _foxglove
from aionode.gateway.http import routes as _http
from aionode.gateway.page import files as _page_files
from aionode.gateway.policy.identity import parsed_address
from aionode.gateway.policy.policy import Policy
from aionode.gateway.rosbridge import websocket as _rosbridge
from aionode.gateway.rosbridge.client_list import ClientList
from aionode.gateway.server.door import Door
from aionode.gateway.server.exchange import TRY_AGAIN_LATER, close
from aionode.gateway.server.server import Server
from aionode.gateway.session.refusals import Refusal
from aionode.gateway.session.robot import Bucket, Robot

if TYPE_CHECKING:
    from types import TracebackType

    from starlette.routing import BaseRoute
    from starlette.websockets import WebSocket

    from aionode.bag import Player
    from aionode.gateway.mcp import McpOverHttp
    from aionode.gateway.session.robot import Ask
    from aionode.gateway.session.session import Session
    from aionode.node import Node

__all__ = ["Gateway"]

REFUSALS_PER_SEC: Final = 50.0
"""Frames per second that are read from a client whose frames are refused."""


class Gateway:
    """Serves a robot to browsers, programs and apps: ``async with Gateway(node) as gateway:``.

    Args:
        node: The node by which the gateway takes part in the graph. The node has to run.
        policy: Who may do what; by default `Policy.default`, by which programs of this host read
            everything, and nobody writes.
        host: The address on which the gateway listens.
        port: The port on which the gateway listens; 0 for a free port.
        ask: A coroutine function that asks a person, where a rule of the policy has ``ask``. The
            gateway calls it with the identity of the client, the verb, the name and the message,
            and it returns whether the person says yes. Without `ask`, such requests are refused.
        player: The player of a bag. Foxglove's timeline controls it, as far as the policy allows
            calls of the services of the player's node.
        mcp: Whether clients of MCP, such as those of language models, are served at ``/mcp``; it
            needs the extra ``mcp``.
        about: With `mcp`, a description of this robot for models.
        bags: With `mcp`, a folder of recordings of which models get summaries; empty for none.

    Raises:
        ConfigurationError: other machines can connect to `host`, and the policy knows no client by
            a token or certificate (a ValueError).

    Attributes:
        node: The node.
        clients: The clients, the policy that holds for them, and the robot as they share it.
        host: The address on which the gateway listens.
        port: The port on which the gateway listens.
    """

    def __init__(
        self,
        node: Node,
        policy: Policy | None = None,
        *,
        host: str = "127.0.0.1",
        port: int = 9090,
        ask: Ask | None = None,
        player: Player | None = None,
        mcp: bool = False,
        about: str = "",
        bags: str = "",
    ) -> None:
        self.node = node
        self.clients = Clients(node, Policy.default() if policy is None else policy, ask)
        self._player = player
        self._mcp: McpOverHttp | None = None
        if mcp:
            from aionode.gateway.mcp import McpOverHttp  # takes a second, and few want it

            self._mcp = McpOverHttp(self.clients, about, bags)
        self.host = host
        self.port = port
        if not is_loopback(host) and not self.clients.policy.knows_secrets:
            raise ConfigurationError(
                "gateway's host",
                host,
                "other machines can connect there, and the policy knows no client by a token or "
                "certificate; add [[who]] with a token, or listen on 127.0.0.1",
            )

    @property
    def stats(self) -> GatewayStats:
        """Counts of the gateway's work."""
        return self.clients.stats

    # Lifetime

    async def __aenter__(self) -> Self:
        """Start listening.

        Raises:
            OSError: the address is not available, for example because another program uses it.
            RuntimeError: the node is not running.
        """
        self.clients.check_node()
        listener = bound(self.host, self.port)
        self.port = listener.getsockname()[1]
        async with AsyncExitStack() as stack:
            stack.callback(listener.close)
            tasks = await self.clients.open(stack)
            self._client_list = ClientList(self.node)
            stack.callback(self._client_list.close)
            app = Door(self._application(), self.clients)
            self._server = server = Server(app, lambda: self.clients.policy)
            serving = tasks.create_task(server.serve(listener))
            stack.push_async_callback(self._stop, server, serving)
            if self._mcp is not None:
                tasks.create_task(self._mcp.run())
                stack.callback(self._mcp.stop)
                await self._mcp.started()
            await server.has_started.wait()
            self._stack = stack.pop_all()
        self.node.get_logger().info(f"gateway: listening on {self.host}:{self.port}")
        if not self.clients.policy.who:
            self.node.get_logger().warning(
                "gateway: the policy has no [[who]], so nobody can connect; add clients with a "
                "token, or programs of this host with loopback = true"
            )
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Disconnect the clients: the stops of their leases are sent, and their goals cancelled."""
        if isinstance(error, Exception):
            kind = error = traceback = None  # the task group would wrap the program's error
        await to_the_end(self._stack.__aexit__(kind, error, traceback))

    def tell(self, text: str) -> None:
        """Tell MCP clients that listen about an event, such as ``the battery is low``.

        They read it from the resource ``robot://events``, together with the warnings of the robot's
        log.

        Raises:
            RuntimeError: the gateway serves no clients of MCP.
        """
        if self._mcp is None:
            raise RuntimeError("gateway: it has no assistants to tell; create it with mcp=True")
        self._mcp.mcp.events.tell(text)

    async def _stop(self, server: Server, serving: asyncio.Task[None]) -> None:
        self.clients.end()
        server.stop()
        await serving
        # The commands of requests whose session has already ended:
        await self.clients.robot.commands.close()

    # Routes

    def _application(self) -> Starlette:
        routes: list[BaseRoute] = [
            WebSocketRoute("/", self._websocket),
            WebSocketRoute("/ws", self._websocket),
            *_http.routes(self.clients),
            *_page_files.routes(),
            *(self._mcp.routes() if self._mcp is not None else ()),
            WebSocketRoute("/{path:path}", _http.answer_other_websocket),
        ]
        return Starlette(routes=routes, exception_handlers={HTTPException: _http.answer_http_error})

    async def _websocket(self, websocket: WebSocket) -> None:
        """Serve a WebSocket with the protocol that its client requests."""
        kind, chosen = protocol_of(websocket.scope["subprotocols"])
        async with self.clients.session_of(websocket.scope, kind) as session:
            connection = websocket.scope["state"]["aionode_connection"]
            session.arrivals.connection = connection
            connection.note = session.rights.note
            session.outbox.direct = connection.send_now
            rate_hz, robot = self.clients.policy.limits.frames_per_sec, self.clients.robot
            websocket._receive = paced(websocket._receive, rate_hz, robot, session)
            if kind == "foxglove" and chosen is not None:
                serving = _foxglove.serve(websocket, session, chosen, self._player)
                await until(session.ended, serving, self._watch(session))
            else:
                with self._client_list.listing(session.identity.address):
                    serving = _rosbridge.serve(websocket, session, chosen)
                    await until(session.ended, serving, self._watch(session))
        if session.end_reason:
            await close(websocket, TRY_AGAIN_LATER, session.end_reason)

    async def _watch(self, session: Session) -> None:
        """End the session of a client that has gone silent while it has goals or commands.

        Also end the session of a client that does not read its answers; it would not read a goodbye
        either.
        """
        robot = self.clients.robot
        while True:
            limit = self.clients.policy.limits.client_lost_sec
            await robot.clock.sleep(limit / 3)
            connection = session.arrivals.connection
            if connection is None:
                continue
            is_lost = session.outbox.overflowed  # already logged
            if session.has_goals or (session.arrivals.is_doubtful and session.publishes):
                session.arrivals.ask_for_sign()
                # After a standstill of its own, the gateway first handles what arrived during it.
                silent_sec = min(connection.silent_sec(), robot.standstills.since_sec())
                if not is_lost and silent_sec > limit and not connection.has_unread():
                    is_lost = True
                    reason = f"it was silent for {limit:g} s while it had goals or commands"
                    session.rights.note(Refusal.DISCONNECTED, "connection", reason)
            if is_lost:
                session.ended.set()
                connection.abort()


def protocol_of(offered: Sequence[str]) -> tuple[str, str | None]:
    """Return the protocol that a WebSocket requests, and the subprotocol to answer with.

    Args:
        offered: The subprotocols that its client offers, without the token. Clients of rosbridge
            offer none; a browser expects one of those that it offers.

    Raises:
        RefusedError: none of them is known; its code is ``unsupported``.
    """
    for name in offered:
        if name in _foxglove.SUBPROTOCOLS:
            return "foxglove", name
        if name.startswith("rosbridge"):
            return "rosbridge", name
    if offered:
        fitting = ", ".join(_foxglove.SUBPROTOCOLS)
        raise RefusedError(
            f"subprotocol {offered[0][:80]!r}",
            f"unknown subprotocol; use {fitting}, or none for rosbridge",
            "unsupported",
        )
    return "rosbridge", None


def paced(receive: Any, rate_hz: float, robot: Robot, session: Session) -> Any:
    """Return a `receive` for WebSockets that limits the rate of frames.

    A client that sends faster is not read meanwhile, so it has to wait. A client whose frames are
    refused waits longer: futile requests must cost the robot almost nothing. Frames that had to
    wait are older than they seem when they are read, so a client that had to wait is doubted. A
    driver that is refused because another one drives does not wait; otherwise its old commands
    would be read later.
    """
    clock = robot.clock
    bucket = Bucket(rate_hz, robot.time_base.steady_ns)
    refusals = Bucket(REFUSALS_PER_SEC, robot.time_base.steady_ns)
    seen = session.rights.refused - session.rights.refused_cheaply

    async def wait_for(waited_for: Bucket, what: str) -> None:
        has_waited = False
        while wait_sec := waited_for.wait_sec():
            has_waited = True
            await clock.sleep(wait_sec)
        if has_waited:
            session.doubt()
            reason = (
                f"it sends more than {waited_for.rate_hz:g} a second, so it is read more slowly"
            )
            session.rights.note(Refusal.LATE, what, reason)

    async def receive_paced() -> Any:
        nonlocal seen
        while seen < session.rights.refused - session.rights.refused_cheaply:
            await wait_for(refusals, "refused frames")
            seen += 1
        message = await receive()
        if message["type"] == "websocket.receive":
            session.arrivals.note_frame()
            await wait_for(bucket, "frames")
        return message

    return receive_paced


async def until(
    event: asyncio.Event, work: Coroutine[Any, Any, None], *others: Coroutine[Any, Any, None]
) -> None:
    """Run work until it ends or an event cancels it; raise its exception unchanged.

    Args:
        event: Cancels the work.
        work: The coroutine to run.
        others: Coroutines that run beside it, until it ends.
    """
    error: Exception | None = None

    async def run() -> None:
        nonlocal error
        try:
            await work
        except Exception as raised:  # noqa: BLE001  # raised below, without a group around it
            error = raised

    async with asyncio.TaskGroup() as tasks:
        running = tasks.create_task(run())
        waiting = tasks.create_task(event.wait())
        beside = [tasks.create_task(other) for other in others]
        await asyncio.wait([running, waiting], return_when=asyncio.FIRST_COMPLETED)
        for task in (running, waiting, *beside):
            task.cancel()
    if error is not None:
        raise error


def is_loopback(host: str) -> bool:
    """Return whether only this host can connect to an address."""
    address = parsed_address(host)
    return host == "localhost" or (address is not None and address.is_loopback)


def bound(host: str, port: int) -> socket.socket:
    """Return a socket bound to an address.

    Raises:
        OSError: the address cannot be bound.
    """
    family, kind, protocol, _, address = socket.getaddrinfo(
        host or None, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
    )[0]
    # asyncio sets TCP_NODELAY only if the socket's protocol is TCP: without it a small frame may
    # wait for 40 ms until the client has acknowledged the previous one.
    listener = socket.socket(family, kind, protocol)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
    except OSError:
        listener.close()
        raise
    listener.setblocking(False)
    return listener
