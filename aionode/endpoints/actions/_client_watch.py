"""Noticing at the server that the client of a goal is lost: killed, frozen, blocked or cut off."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from aionode.endpoints.actions.goal import LIVELINESS_ID, alive_id, left_id
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import TimeBase
    from aionode.clock._time_base import Alarm
    from aionode.graph import EndpointInfo, Graph

__all__ = ["SIGN_UNIT_NS", "ClientWatch"]

SIGNS_IN_TIME = 3
"""How often a client gives a sign within the time after which it is lost: two may be late."""

SIGN_UNIT_NS = 10_000_000
LONGEST_SIGN_UNITS = 127
"""Clients are told the time between two signs in these units, in the int8 of a status."""

STALLS_IN_TIME = 6
"""A look that is late by this part of that time, or more, shows that the server stood still."""


@dataclass(slots=True)
class WatchedGoal:
    """What is known of the client of one goal.

    Attributes:
        gid: The gid of its client of the service that takes goals.
        client: The full name of its node; empty if it is not known.
        candidates: The gids of the clients of which one has sent the goal, where the middleware
            does not tell which.
        heard_ns: The steady time of its last sign; None if it has given none.
        is_gone: Whether it is no longer in the graph.
    """

    gid: bytes
    client: str = ""
    candidates: set[bytes] = field(default_factory=set)
    heard_ns: int | None = None
    is_gone: bool = False


class ClientWatch:
    """Watches the clients of the goals of one server, as long as these have not ended.

    A client that has given a sign is lost when it has been silent for a certain time. One that has
    never given any, such as rclpy's, is lost when it leaves the graph.

    The silence of a server that stood still says nothing of its clients. So it looks at them three
    times within that time. If a look is late, what has arrived meanwhile is taken first, and the
    time begins anew; for a short delay not again and again, or a server that is always a little
    late would lose nobody.

    Args:
        service: Full name of the service that takes goals.
        graph: The graph.
        time_base: Whose steady clock counts.
        lost_ns: After how long a silence a client is lost.
        on_lost: Called with ids of goals, and who their client was and why it is lost.
    """

    def __init__(
        self,
        service: str,
        graph: Graph,
        time_base: TimeBase,
        lost_ns: int,
        on_lost: Callable[[list[bytes], str], None],
    ) -> None:
        self._service = service
        self._graph = graph
        self._time_base = time_base
        self._lost_ns = lost_ns
        self._on_lost = on_lost
        self._goals: dict[bytes, WatchedGoal] = {}
        self._alarm: Alarm | None = None
        self._due_ns = 0
        self._awake_ns = time_base.steady_ns() - SIGNS_IN_TIME * lost_ns
        units = lost_ns // SIGNS_IN_TIME // SIGN_UNIT_NS
        self._sign_units = max(1, min(units, LONGEST_SIGN_UNITS))
        self._unwatch = graph.watch(EndpointKind.CLIENT, service, self._note_client)

    def stop(self) -> None:
        """Watch nothing more."""
        self._unwatch()
        self._goals.clear()
        self._set_alarm()

    # Goals

    def add(self, goal_id: bytes, gid: bytes) -> None:
        """Watch the client of a goal, from which the request to execute it has come."""
        goal = WatchedGoal(gid)
        for client in self._graph.endpoints(EndpointKind.CLIENT, name=self._service):
            if client.gid == gid:
                goal.client = client.node.fully_qualified_name
            elif client.node.over_rcl:
                goal.candidates.add(client.gid)
        if goal.client:
            goal.candidates.clear()
        self._goals[goal_id] = goal
        if self._alarm is None:
            self._set_alarm()

    def remove(self, goal_id: bytes) -> None:
        """Watch a goal no longer: it has ended, or its client has left it on purpose."""
        if self._goals.pop(goal_id, None) is not None and not self._goals:
            self._set_alarm()

    def take(self, asked_id: bytes) -> int:
        """Take what a client says by asking for the result of a goal that does not exist.

        Returns:
            What the status of the answer is to be.
        """
        if asked_id == LIVELINESS_ID:
            return self._sign_units
        goal = self._goals.get(alive_id(asked_id))
        if goal is not None:
            goal.heard_ns = self._time_base.steady_ns()
        self.remove(left_id(asked_id))
        return 0

    # Clients

    def _note_client(self, client: EndpointInfo, present: bool) -> None:
        for goal in self._goals.values():
            if goal.gid == client.gid:
                goal.client = client.node.fully_qualified_name
                goal.is_gone = not present
            elif client.gid in goal.candidates and not present:
                goal.candidates.discard(client.gid)
                goal.is_gone = not goal.candidates
        if self._goals and not present:
            # Later, as an endpoint whose gid changes goes and returns at once.
            asyncio.get_running_loop().call_soon(self._look)

    def _set_alarm(self) -> None:
        """Set when to look next; nothing wakes a server without goals."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None
        if not self._goals:
            return
        now_ns = self._time_base.steady_ns()
        self._due_ns = now_ns + self._lost_ns // SIGNS_IN_TIME
        for goal in self._goals.values():
            if goal.heard_ns is not None:
                lost_ns = max(goal.heard_ns, self._awake_ns) + self._lost_ns
                self._due_ns = max(now_ns, min(self._due_ns, lost_ns))
        self._alarm = self._time_base.call_at(self._due_ns, self._ring)

    def _ring(self) -> None:
        # Signs that have arrived may still wait to be read, which takes some turns of the loop.
        loop = asyncio.get_running_loop()
        loop.call_soon(loop.call_soon, self._look)

    def _look(self) -> None:
        """Find the clients that are lost."""
        if not self._goals:
            return
        now_ns = self._time_base.steady_ns()
        late_ns = now_ns - self._due_ns
        is_rested = now_ns - self._awake_ns >= SIGNS_IN_TIME * self._lost_ns
        if late_ns >= self._lost_ns or (is_rested and late_ns > self._lost_ns // STALLS_IN_TIME):
            self._awake_ns = now_ns
        lost: dict[str, list[bytes]] = {}
        for goal_id, goal in list(self._goals.items()):
            why = self._why_lost(goal, now_ns)
            if why:
                del self._goals[goal_id]
                client = goal.client or f"with gid {goal.gid.hex()}"
                lost.setdefault(f"its client {client} is lost: {why}", []).append(goal_id)
        self._set_alarm()
        for text, goal_ids in lost.items():
            self._on_lost(goal_ids, text)

    def _why_lost(self, goal: WatchedGoal, now_ns: int) -> str:
        """Return why the client of `goal` is lost; empty if it is not."""
        since_ns = self._awake_ns
        if goal.heard_ns is not None:
            since_ns = max(since_ns, goal.heard_ns)
        elif not goal.is_gone:
            return ""
        if now_ns - since_ns < self._lost_ns:
            return ""
        if goal.heard_ns is None:
            return "it has left the graph"
        return f"no sign of it for {self._lost_ns / 1e9:g} s"
