"""HTTP: the graph, topics, services, actions and parameters of the robot for curl and programs.

Each request is a session of its own, which ends with its connection: a program that closes the
stream of a goal cancels the goal. Only the lease of a command outlives its request, by its time to
live: to keep the topic, the next command has to arrive within that time, over the same connection
or with the same client name (``?client=``).
"""

from __future__ import annotations

from collections.abc import AsyncGenerator, Awaitable, Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import msgspec
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from aionode._version import __version__
from aionode.errors import AionodeError, RefusedError
from aionode.fastapi import until_disconnected
from aionode.gateway.http.answers import (
    ALIVE,
    CLIENT_GONE,
    EVENTS,
    HEADERS,
    MAX_SEC,
    Asked,
    Stream,
    body_of,
    error_of,
    error_response,
    event,
    json_response,
    until_ended,
)
from aionode.gateway.http.metrics import MEDIA_TYPE, gateway_metrics, node_metrics, prometheus
from aionode.gateway.http.offers import offers
from aionode.gateway.http.openapi import openapi
from aionode.gateway.http.parameters import set_parameter, show_parameters
from aionode.gateway.http.topics import answer_topic
from aionode.gateway.policy.identity import Identity
from aionode.gateway.session.assets import read_asset
from aionode.gateway.session.encoding.values import json_of

if TYPE_CHECKING:
    from starlette.routing import BaseRoute
    from starlette.types import Receive, Scope, Send
    from starlette.websockets import WebSocket

    from aionode.gateway._clients import Clients
    from aionode.gateway.session.delivery.subscribed import Subscribed
    from aionode.gateway.session.session import Session

__all__ = ["answer_http_error", "answer_other_websocket", "routes"]

MAX_CLIENT_NAME: Final = 100
"""The longest name of a client, in characters."""

NAMELESS: Final = (
    "a program that opens a connection for each command identifies itself by ?client=NAME"
)
"""Added when a request without a client name is refused because another client commands the
topic."""

EXPECTED: Final = {404, 503, 504}
"""The codes of errors that are not refusals: unknown names, the end of the gateway, and no message
in time."""

Handler = Callable[[Asked], Awaitable[Response]]


def routes(clients: Clients) -> list[BaseRoute]:
    """Return the routes of HTTP, for a Starlette application."""
    api = HttpApi(clients)
    table: list[tuple[str, str, Handler]] = [
        ("GET", "/topics", list_topics),
        ("GET", "/services", list_services),
        ("GET", "/actions", list_actions),
        ("GET", "/nodes", list_nodes),
        ("GET", "/nodes/{name:path}", show_node),
        ("GET", "/topics/{name:path}", answer_topic),
        ("POST", "/topics/{name:path}", publish),
        ("POST", "/services/{name:path}", call),
        ("POST", "/actions/{name:path}", send_goal),
        ("GET", "/parameters/{name:path}", show_parameters),
        ("PUT", "/parameters/{name:path}", set_parameter),
        ("GET", "/assets/{name:path}", send_asset),
        ("GET", "/openapi.json", api.openapi),
        ("GET", "/metrics", api.metrics),
    ]
    return [
        *(
            Route(path, Endpoint(clients, handler), methods=[method])
            for method, path, handler in table
        ),
        Route("/healthz", api.healthz, methods=["GET"]),
    ]


class Endpoint:
    """One route: opens a session for the request, and answers errors in JSON."""

    def __init__(self, clients: Clients, handler: Handler) -> None:
        self._clients = clients
        self._handler = handler

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request, which ends with its connection."""
        request = Request(scope, receive)
        has_session = False
        try:
            body = await body_of(request, self._clients.policy.limits.handshake_sec)
            async with (
                self._clients.session_of(scope, "http") as session,
                until_disconnected(request),
            ):
                has_session = True
                session.owner = caller_of(request, session)
                self._clients.robot.standstills.look()
                session.arrivals.note_arrival(scope["state"]["aionode_connection"].silent_sec())
                session.on_policy = partial(end_with, session)
                async with until_ended(session):
                    if request.method != "POST":  # about the graph, or the nodes in it
                        await session.graph.turn()
                    answer = await self._handler(Asked(session, request, body))
                await answer(scope, receive, send)
        except (AionodeError, HTTPException, TimeoutError) as error:
            if isinstance(error, HTTPException) and error.status_code == CLIENT_GONE:
                return  # there is nobody to answer
            if has_session:
                if not isinstance(error, HTTPException) or error.status_code not in EXPECTED:
                    session.rights.note_failure(error, f"{scope['method']} {scope['path']}")
            elif isinstance(error, RefusedError):
                self._clients.note_refusal(scope["aionode.credentials"], error)
            await error_response(error)(scope, receive, send)


def end_with(session: Session, ended: list[Subscribed]) -> None:
    """End a session whose request was for a topic that the policy no longer allows."""
    if ended:
        session.ended.set()


class Caller(msgspec.Struct, frozen=True):
    """The holder of topics commanded by requests, since the session of each ends with its request.

    Two programs may share an identity, so that alone does not make them the same holder.

    Attributes:
        identity: The client that has sent the requests.
        client: The name that it gives itself; empty without one.
        connection: The connection of its requests, if it has no such name.
    """

    identity: Identity
    client: str
    connection: object

    @property
    def way(self) -> str:
        """How it is connected, for `Owner`."""
        return f"http as client {self.client!r}" if self.client else "another connection of http"

    def doubt(self) -> None:
        """Do nothing: the next request has to prove the caller's identity anyway."""


def caller_of(request: Request, session: Session) -> Caller:
    """Return the holder of the topics that a request commands.

    A proxy may send the requests of several programs over one connection, so each request forwarded
    by a known proxy is a caller of its own, unless it has a client name.

    Raises:
        HTTPException: the name is too long (400).
    """
    client = request.query_params.get("client", "")
    if len(client) > MAX_CLIENT_NAME:
        raise HTTPException(
            400, f"client: {len(client)} characters, at most {MAX_CLIENT_NAME} are allowed"
        )
    connection: object = None
    if not client:
        connection = request.scope["state"].get("aionode_connection")
        credentials = session.credentials
        if credentials is not None and credentials.is_forwarded:
            connection = object()
    return Caller(session.identity, client, connection)


async def answer_http_error(request: Request, error: Exception) -> Response:
    """Answer a path or method that does not exist, for a Starlette application."""
    if isinstance(error, HTTPException) and error.status_code == 404:
        error = HTTPException(404, no_path(request.url.path))
    return error_response(error)


async def answer_other_websocket(websocket: WebSocket) -> None:
    """Refuse a WebSocket at a path that serves none."""
    error = HTTPException(404, f"{no_path(websocket.url.path)} A WebSocket connects to / or /ws.")
    await websocket.send_denial_response(error_response(error))


def no_path(path: str) -> str:
    """Return the text for a client that requests a path that does not exist."""
    return (
        f"{path[:200]}: the gateway has no such path. /openapi.json lists its paths; a "
        "proxy has to remove its own prefix, as nginx does if proxy_pass ends with a slash."
    )


class HttpApi:
    """The routes that need more than the session of their request.

    Args:
        clients: The clients, whose counts it shows.
    """

    def __init__(self, clients: Clients) -> None:
        self._clients = clients

    async def openapi(self, asked: Asked) -> Response:
        """Return a document of all requests that the caller may send; ``?all=1`` omits nothing."""
        user_only = asked.request.query_params.get("all", "0") in {"0", "false", ""}
        offered = await offers(asked.session, user_only=user_only)
        title = f"aionode gateway {self._clients.node.get_fully_qualified_name()}"
        return json_response(openapi(title, __version__, offered))

    async def metrics(self, asked: Asked) -> Response:
        """Return the counts of nodes and of the gateway, for Prometheus."""
        nodes = self._clients.node.context.report().nodes

        def sees(name: str, type_name: str) -> bool:
            return asked.session.graph.sees(name, type_name)

        families = [*gateway_metrics(self._clients.stats, sees), *node_metrics(nodes, sees)]
        return Response(prometheus(families), headers=HEADERS, media_type=MEDIA_TYPE)

    async def healthz(self, _request: Request) -> Response:
        """Return whether the gateway's node runs; anyone may ask, as it reveals nothing else."""
        ok = self._clients.node.is_running
        return json_response({"ok": ok}, 200 if ok else 503)


# The graph


def named(types: Mapping[str, list[str]]) -> list[dict[str, Any]]:
    """Return names with their types, as ``aionode topic list --json`` prints them."""
    return [{"name": name, "types": of} for name, of in sorted(types.items())]


async def list_topics(asked: Asked) -> Response:
    """Return the topics that the caller sees."""
    return json_response(named(asked.session.graph.topics()))


async def list_services(asked: Asked) -> Response:
    """Return the services that the caller sees."""
    return json_response(named(asked.session.graph.services()))


async def list_actions(asked: Asked) -> Response:
    """Return the actions that the caller sees."""
    return json_response(named(asked.session.graph.actions()))


async def list_nodes(asked: Asked) -> Response:
    """Return the full names of the nodes that the caller sees."""
    return json_response(asked.session.graph.nodes())


async def show_node(asked: Asked) -> Response:
    """Return the publishers, subscriptions, services and clients of a node."""
    return json_response(asked.session.graph.node_details(asked.name))


# Messages, services and actions


async def publish(asked: Asked) -> Response:
    """Publish one message."""
    values = asked.json()
    type_name = asked.type_name
    try:
        await asked.session.publish(asked.name, values, type_name)
    except RefusedError as error:
        if error.code != "held" or "client" in asked.request.query_params:
            raise
        raise RefusedError(error.subject, f"{error.reason}; {NAMELESS}", error.code) from None
    return Response(status_code=204)


async def call(asked: Asked) -> Response:
    """Call a service and return its response. The call ends with the connection."""
    response = await asked.session.call(
        asked.name,
        asked.json(),
        type_name=asked.type_name,
        timeout_sec=asked.number(
            "timeout_sec", asked.session.wait_sec(None), asked.session.wait_sec(MAX_SEC)
        ),
    )
    return json_response(json_of(response))


async def send_goal(asked: Asked) -> Response:
    """Send a goal, and return its feedback and result as events, or only its result as JSON.

    The goal ends with the connection.
    """
    values, type_name = asked.json(), asked.type_name
    asked.lose_silent_client()
    if "application/json" in asked.accept:
        async with asked.session.goal(asked.name, values, type_name=type_name) as goal:
            return json_response(outcome_of(goal, await goal.result()))
    events = goal_events(asked.session, asked.name, values, type_name)
    accepted = await anext(events)  # a rejected goal is answered without a stream
    return Stream(asked.session, events, EVENTS, first=accepted, alive=ALIVE)


async def goal_events(
    session: Session, action: str, values: Any, type_name: str | None
) -> AsyncGenerator[bytes, None]:
    """Send a goal, and yield its events. Closing the generator cancels the goal."""
    async with session.goal(action, values, type_name=type_name) as goal:
        yield event("accepted", msgspec.json.encode({"goal_id": goal.text}))
        try:
            async for feedback in goal:
                yield event("feedback", json_of(feedback))
            result = await goal.result()
        except AionodeError as error:
            session.rights.note_failure(error, f"goal {action}")
            _, code, text = error_of(error)
            yield event("failure", msgspec.json.encode({"code": code, "error": text}))
        else:
            yield event("result", outcome_of(goal, result))


async def send_asset(asked: Asked) -> Response:
    """Return a file of a package, as bytes: no browser may take one for a page of the robot."""
    try:
        content = await read_asset(asked.session, asked.name)
    except FileNotFoundError as error:
        raise HTTPException(404, str(error)) from None
    return Response(content, headers=HEADERS, media_type="application/octet-stream")


def outcome_of(goal: Any, result: Any) -> bytes:
    """Return how a goal ended, as JSON."""
    return msgspec.json.encode(
        {
            "goal_id": goal.text,
            "status": result.status.name,
            "error": result.error_text,
            "result": msgspec.Raw(json_of(result.result)),
        }
    )
