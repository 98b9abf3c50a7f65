"""Sends the recorded requests of services and actions, as their clients did."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, Final

from aionode.bag._selection import kind_of
from aionode.engine.rules.service_events import REQUEST_RECEIVED, REQUEST_SENT
from aionode.errors import AionodeError, InterfaceNotFoundError
from aionode.interfaces import get_interface

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from aionode.action import ActionClient
    from aionode.bag.files.record import Record, TopicInfo
    from aionode.endpoints.client import Client
    from aionode.node import Node

__all__ = ["SOURCES", "RequestSender"]

SOURCES: Final = {
    "service_introspection": REQUEST_RECEIVED,
    "client_introspection": REQUEST_SENT,
}
"""The events to take requests from: the server's, or the client's."""

MAX_PENDING: Final = 1000
"""Maximum number of unanswered requests; further ones are skipped with a warning."""

SEND_GOAL: Final = "send_goal/_service_event"
CANCEL_GOAL: Final = "cancel_goal/_service_event"
ANSWER_S: Final = 5.0
"""How long to wait for answers at the end of a recording, in seconds."""

Key = tuple[str, str, str]


class RequestSender:
    """Sends recorded requests.

    Args:
        node: The node of the player.
        kinds: What to send: ``service``, ``action``.
        source: Which events to use; see `SOURCES`.
        remap: New names by recorded name.
        warn: Called with a description of what could not be sent.

    Raises:
        ValueError: the source is unknown.
    """

    def __init__(
        self,
        node: Node,
        kinds: Collection[str],
        source: str,
        remap: Mapping[str, str],
        warn: Callable[[str], None],
    ) -> None:
        self._node = node
        self._kinds = kinds
        self._event_type = SOURCES[source]
        self._remap = remap
        self._warn = warn
        self._clients: dict[Key, Client[Any, Any]] = {}
        self._actions: dict[str, ActionClient[Any, Any, Any]] = {}
        self._goals: dict[bytes, asyncio.Future[Any]] = {}
        self._pending: set[asyncio.Future[Any]] = set()
        self._told: set[str] = set()

    def takes(self, topic: TopicInfo) -> bool:
        """Return whether a topic is sent as requests instead of being published."""
        kind, name = kind_of(topic.name)
        if kind not in self._kinds:
            return False
        name = self._remap.get(name, name)
        try:
            if kind == "service":
                srv_type = get_interface(topic.type.removesuffix("_Event"))
                self._clients[topic.key] = self._node.create_client(srv_type, name)
            elif topic.name.endswith(SEND_GOAL):
                action_type = get_interface(topic.type.removesuffix("_SendGoal_Event"))
                self._actions[kind_of(topic.name)[1]] = self._node.create_action_client(
                    action_type, name
                )
        except InterfaceNotFoundError as error:
            self._warn(f"{name}: its requests are not sent: {error}")
        return True

    def send(self, record: Record) -> None:
        """Send the request in a record, if it contains one."""
        client = self._clients.get(record.info.key)
        is_goal = record.topic.endswith((SEND_GOAL, CANCEL_GOAL))
        if client is None and not is_goal:
            return
        event = record.message
        if event.info.event_type != self._event_type or not event.request:
            return
        if client is not None:
            self._call(client, event.request[0])
        elif record.topic.endswith(SEND_GOAL):
            self._send_goal(kind_of(record.topic)[1], event.request[0])
        else:
            self._cancel(bytes(event.request[0].goal_info.goal_id.uuid))

    def _call(self, client: Client[Any, Any], request: Any) -> None:
        name = client.service_name
        if self._has_room(name) and self._is_there(name, client.service_is_ready()):
            self._follow(name, client.call_async(request))

    def _send_goal(self, name: str, request: Any) -> None:
        client = self._actions.get(name)
        if client is None or not self._has_room(name):
            return
        if self._is_there(name, client.server_is_ready()):
            sent = client.send_goal_async(request.goal)
            self._goals[bytes(request.goal_id.uuid)] = sent
            self._follow(name, sent)

    def _cancel(self, goal_id: bytes) -> None:
        """Cancel a goal that was sent earlier, once it is accepted."""
        sent = self._goals.get(goal_id)
        if sent is None:
            return

        def accepted(answer: asyncio.Future[Any]) -> None:
            if not answer.cancelled() and answer.exception() is None:
                self._follow("cancel", answer.result().cancel_goal_async())

        sent.add_done_callback(accepted)

    def _has_room(self, name: str) -> bool:
        if len(self._pending) < MAX_PENDING:
            return True
        self._tell(f"{name}: requests are skipped, as {MAX_PENDING} are still unanswered")
        return False

    def _is_there(self, name: str, ready: bool) -> bool:
        if not ready:
            self._tell(f"{name}: a request is not sent, as it has no server")
        return ready

    def _tell(self, text: str) -> None:
        """Log a warning once."""
        if text not in self._told:
            self._told.add(text)
            self._warn(text)

    def _follow(self, name: str, answer: asyncio.Future[Any]) -> None:
        """Keep track of an answer until it arrives, and report it if it is an error."""
        self._pending.add(answer)

        def ended(_: object) -> None:
            self._pending.discard(answer)
            if not answer.cancelled() and isinstance(answer.exception(), AionodeError):
                self._tell(f"{name}: {answer.exception()}")

        answer.add_done_callback(ended)

    async def drain(self) -> None:
        """Wait for outstanding answers, for a few seconds at most."""
        if self._pending:
            await asyncio.wait(self._pending, timeout=ANSWER_S)
