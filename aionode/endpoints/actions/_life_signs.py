"""The signs by which an action client tells servers that it is alive."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from aionode.endpoints.actions._client_watch import SIGN_UNIT_NS
from aionode.endpoints.actions._common import uuid_message
from aionode.endpoints.actions.goal import LIVELINESS_ID, alive_id, left_id
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable

    from aionode.clock import TimeBase
    from aionode.clock._time_base import Alarm
    from aionode.endpoints.client import Client, Exchange
    from aionode.graph import Graph

__all__ = ["LifeSigns"]

FIRST_INTERVAL_NS = 100_000_000
"""The time between two signs until the server has told how often it wants them."""


class LifeSigns:
    """Gives signs for the goals of one client, as long as its event loop runs.

    They are sent by an alarm of the loop, so that a blocked loop shows as well. Servers that want
    none are asked once, and cost nothing more.

    Args:
        get_result: The client of the service that gives results.
        graph: The graph.
        time_base: Whose steady clock counts.
    """

    def __init__(self, get_result: Client[Any, Any], graph: Graph, time_base: TimeBase) -> None:
        self._get_result = get_result
        self._graph = graph
        self._time_base = time_base
        self._goals: dict[bytes, Exchange | None] = {}  # with the last sign of each
        self._question: Exchange | None = None
        # The servers that have said how often they want signs, and their answer; 0 means never.
        self._answered_by: frozenset[bytes] = frozenset()
        self._interval_ns = FIRST_INTERVAL_NS
        self._alarm: Alarm | None = None
        self._farewells: set[asyncio.Future[Any]] = set()

    @property
    def is_leaving(self) -> bool:
        """Whether servers have not answered yet to what `leave` told them."""
        return bool(self._farewells)

    def add(self, goal_id: bytes) -> None:
        """Give signs for a goal that was accepted, beginning now."""
        if self._is_answered() and self._interval_ns == 0:
            return
        self._goals[goal_id] = None
        if self._alarm is None:
            self._beat()
        else:
            self._sign(goal_id)

    def remove(self, goal_id: bytes) -> None:
        """Give no more signs for a goal."""
        sign = self._goals.pop(goal_id, None)
        if sign is not None:
            sign.cancel()
        if not self._goals:
            self.stop()

    def stop(self) -> None:
        """Give no more signs."""
        for sign in (*self._goals.values(), self._question):
            if sign is not None:
                sign.cancel()
        self._goals.clear()
        self._question = None
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def leave(self, on_answered: Callable[[], None]) -> list[asyncio.Future[Any]]:
        """Give no more signs, and tell the servers that this is no loss: the goals go on.

        Args:
            on_answered: Called after each answer.

        Returns:
            The answers.
        """
        goal_ids = list(self._goals)
        self.stop()

        def answered(answer: asyncio.Future[Any]) -> None:
            self._farewells.discard(answer)
            on_answered()

        for goal_id in goal_ids:
            farewell = self._send(left_id(goal_id))
            if farewell is not None:
                self._farewells.add(farewell.answer)
                farewell.answer.add_done_callback(answered)
        return list(self._farewells)

    # Signs

    def _beat(self) -> None:
        """Give a sign for each goal, and set when to do so next."""
        if not self._is_answered():
            self._ask()
        for goal_id in self._goals:
            self._sign(goal_id)
        self._set_alarm()

    def _set_alarm(self) -> None:
        if self._alarm is not None:
            self._alarm.cancel()
        interval_ns = self._interval_ns or FIRST_INTERVAL_NS
        self._alarm = self._time_base.call_at(self._time_base.steady_ns() + interval_ns, self._beat)

    def _sign(self, goal_id: bytes) -> None:
        last = self._goals[goal_id]
        if last is not None:
            last.cancel()
        self._goals[goal_id] = self._send(alive_id(goal_id))

    def _send(self, asked_id: bytes) -> Exchange | None:
        """Ask for the result of a goal that does not exist; nothing without a server."""
        client = self._get_result
        if client.destroyed or not client.service_is_ready():
            return None
        sent = client._begin(client.srv_type.Request(goal_id=uuid_message(asked_id)))
        # Retrieves the exception, so that asyncio does not report it.
        sent.answer.add_done_callback(lambda done: done.cancelled() or done.exception())
        return sent

    # How often

    def _servers(self) -> frozenset[bytes]:
        servers = self._graph.endpoints(EndpointKind.SERVER, name=self._get_result.srv_name)
        return frozenset(server.gid for server in servers)

    def _is_answered(self) -> bool:
        """Return whether the servers that are there now have said how often they want signs."""
        return bool(self._answered_by) and self._answered_by == self._servers()

    def _ask(self) -> None:
        if self._question is not None:
            self._question.cancel()
        self._interval_ns = FIRST_INTERVAL_NS
        self._question = self._send(LIVELINESS_ID)
        if self._question is not None:
            self._question.answer.add_done_callback(partial(self._take, self._servers()))

    def _take(self, servers: frozenset[bytes], answer: asyncio.Future[Any]) -> None:
        if answer.cancelled() or answer.exception() is not None:
            return  # the next beat asks again
        self._answered_by = servers
        self._interval_ns = max(0, answer.result().status) * SIGN_UNIT_NS
        if self._interval_ns == 0:
            self.stop()
        elif self._alarm is not None:
            self._set_alarm()
