"""The signs of life by which an action client tells servers that it is alive."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from aionode.endpoints.actions._client_watch import SIGNS_IN_TIME
from aionode.endpoints.actions.common import uuid_message
from aionode.engine.rules.goal import alive_id, left_id
from aionode.graph import EndpointKind
from aionode.qos import is_unlimited

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable

    from aionode.clock import Alarm, TimeBase
    from aionode.endpoints.client import Client, Exchange
    from aionode.graph import Graph

__all__ = ["LifeSigns"]

RETRY_NS = 20_000_000
"""How soon a sign is sent again if it could not be delivered."""


class LifeSigns:
    """Sends signs of life for the goals of one client, as long as its event loop runs.

    They are sent from an alarm of the loop, so that a blocked loop is noticed as well. Only servers
    that announced that they want signs get them.

    Args:
        get_result: The client of the result service.
        graph: The graph.
        time_base: Provides the steady clock.
    """

    def __init__(self, get_result: Client[Any, Any], graph: Graph, time_base: TimeBase) -> None:
        self._get_result = get_result
        self._graph = graph
        self._time_base = time_base
        self._goals: dict[bytes, Exchange | None] = {}  # goal id to last sign
        self._interval_ns = 0
        # The graph's `changes` when the interval was computed that servers want, and that interval.
        self._asked_at = -1
        self._limit_ns = 0
        self._alarm: Alarm | None = None
        self._farewells: set[asyncio.Future[Any]] = set()

    @property
    def is_leaving(self) -> bool:
        """Whether servers still have to answer the messages of `leave`."""
        return bool(self._farewells)

    def add(self, goal_id: bytes) -> None:
        """Send signs for an accepted goal from now on, if a server wants them."""
        announced_ns = self._announced_ns()
        if announced_ns and goal_id not in self._goals:
            self._goals[goal_id] = None
            self._sign(goal_id)
            if self._alarm is None:
                self._interval_ns = announced_ns
                self._set_alarm(announced_ns)

    def remove(self, goal_id: bytes) -> None:
        """Stop sending signs for a goal."""
        sign = self._goals.pop(goal_id, None)
        if sign is not None:
            sign.cancel()
        if not self._goals and self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def stop(self) -> None:
        """Stop sending signs."""
        for goal_id in list(self._goals):
            self.remove(goal_id)

    def leave(self, on_answered: Callable[[], None]) -> list[asyncio.Future[Any]]:
        """Stop sending signs, and tell the servers that this is not a loss, so the goals go on.

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

    def _announced_ns(self) -> int:
        """Return the interval between signs that the servers want, in nanoseconds; 0 for none."""
        if self._asked_at != self._graph.changes:  # asked for each goal
            self._asked_at = self._graph.changes
            servers = self._graph.endpoints(EndpointKind.SERVER, name=self._get_result.srv_name)
            lifespans = [server.qos.lifespan for server in servers]
            limits_ns = [each.nanoseconds for each in lifespans if not is_unlimited(each)]
            self._limit_ns = min(limits_ns) // SIGNS_IN_TIME if limits_ns else 0
        return self._limit_ns

    def _beat(self) -> None:
        """Send a sign for each goal, and schedule the next ones."""
        for goal_id in self._goals:
            self._sign(goal_id)
        # A server that has left the graph may come back, with its goals.
        self._interval_ns = self._announced_ns() or self._interval_ns
        self._set_alarm(self._interval_ns)

    def _set_alarm(self, after_ns: int) -> None:
        if self._alarm is not None:
            self._alarm.cancel()
        due_ns = self._time_base.steady_ns() + after_ns
        self._alarm = self._time_base.call_at(due_ns, self._beat)

    def _sign(self, goal_id: bytes) -> None:
        last = self._goals[goal_id]
        if last is not None:
            last.cancel()
        sign = self._goals[goal_id] = self._send(alive_id(goal_id))
        if sign is not None:
            sign.answer.add_done_callback(partial(self._note_answer, goal_id))

    def _note_answer(self, goal_id: bytes, answer: asyncio.Future[Any]) -> None:
        # The first sign matters most: without any, the server takes the client for a ROS one.
        if not answer.cancelled() and answer.exception() is not None and goal_id in self._goals:
            self._set_alarm(RETRY_NS)

    def _send(self, asked_id: bytes) -> Exchange | None:
        """Ask for the result of a goal that does not exist; do nothing without a server."""
        client = self._get_result
        if client.destroyed or not client.service_is_ready():
            return None
        sent = client._begin(client.srv_type.Request(goal_id=uuid_message(asked_id)))
        # Retrieve the exception, so that asyncio does not report it.
        sent.answer.add_done_callback(lambda done: done.cancelled() or done.exception())
        return sent
