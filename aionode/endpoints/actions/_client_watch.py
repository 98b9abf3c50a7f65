"""Detects at the server that a goal's client is lost: killed, frozen, blocked or cut off."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from aionode.clock import Duration
from aionode.engine.rules.goal import alive_id, left_id
from aionode.graph import EndpointKind
from aionode.qos import as_profile

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import Alarm, TimeBase
    from aionode.graph import EndpointInfo, Graph
    from aionode.qos import QoSProfile

__all__ = ["SIGNS_IN_TIME", "ClientWatch", "announcing"]

SIGNS_IN_TIME = 3
"""Signs of life that a client sends per loss timeout: two may be late."""

STALLS_IN_TIME = 6
"""A check late by at least this fraction of the timeout shows that the server stood still."""


def announcing(profile: QoSProfile | int, lost_ns: int) -> QoSProfile:
    """Return the profile of the result service, which asks clients to send signs of life.

    Its lifespan is the loss timeout, after which a response is of no use to the client.
    """
    chosen = as_profile(profile)
    return chosen.replace(lifespan=Duration(nanoseconds=lost_ns)) if lost_ns else chosen


@dataclass(slots=True)
class WatchedGoal:
    """What the server knows of the client of one goal.

    Attributes:
        gid: The gid of its client of the goal service.
        client: The full name of its node; empty if unknown.
        candidates: The gids of the clients that may have sent the goal, if the middleware does not
            say which one did.
        found_by_ns: Steady time until which the client may still be discovered, after its goal.
        heard_ns: Steady time of its last sign of life; None if it never sent one.
        gone_ns: Steady time from which it counts as lost because it is not in the graph; None while
            it is.
    """

    gid: bytes
    client: str = ""
    candidates: set[bytes] = field(default_factory=set)
    found_by_ns: int = 0
    heard_ns: int | None = None
    gone_ns: int | None = None


class ClientWatch:
    """Watches the clients of one server's goals, until the goals end or are being cancelled.

    A client that sends signs of life is lost when it has been silent for the timeout. One that
    never sent any, such as rclpy's, is lost when it leaves the graph.

    When the server itself stood still, silence says nothing about its clients. So it checks them
    three times per timeout. If a check is late, signs that arrived meanwhile are processed first,
    and the timeout starts again; but not repeatedly for short delays, or a server that is always a
    little late would never lose a client.

    Args:
        service: Full name of the goal service.
        graph: The graph.
        time_base: Provides the steady clock.
        lost_ns: The silence after which a client is lost; 0 for never.
        on_lost: Called with the ids of goals, and a text that names their client and why it is
            lost.
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
        self._unwatch: Callable[[], None] | None = None
        if lost_ns:
            self._unwatch = graph.watch(EndpointKind.CLIENT, service, self._note_client)

    def stop(self) -> None:
        """Stop watching."""
        if self._unwatch is not None:
            self._unwatch()
        self._goals.clear()
        self._set_alarm()

    # Goals

    def add(self, goal_id: bytes, gid: bytes) -> None:
        """Watch the client of a goal that the server is about to decide on."""
        if not self._lost_ns:
            return
        goal = WatchedGoal(gid, found_by_ns=self._time_base.steady_ns() + self._lost_ns)
        for client in self._graph.endpoints(EndpointKind.CLIENT, name=self._service):
            if client.gid == gid:
                goal.client = client.node.fully_qualified_name
            elif is_anonymous(client):
                goal.candidates.add(client.gid)
        if goal.client:
            goal.candidates.clear()
        elif not goal.candidates and any(gid):
            # It is discovered a little after its goal arrives, or left while the goal was queued.
            goal.gone_ns = goal.found_by_ns
        self._goals[goal_id] = goal
        if self._alarm is None:
            self._set_alarm()

    def remove(self, goal_id: bytes) -> None:
        """Stop watching a goal: it has ended, or its client has left it on purpose."""
        if self._goals.pop(goal_id, None) is not None and not self._goals:
            self._set_alarm()

    def take(self, asked_id: bytes) -> None:
        """Take a sign of life: a request for the result of a goal that does not exist."""
        goal = self._goals.get(alive_id(asked_id))
        if goal is not None:
            goal.heard_ns = self._time_base.steady_ns()
        self.remove(left_id(asked_id))

    # Clients

    def _note_client(self, client: EndpointInfo, present: bool) -> None:
        now_ns = self._time_base.steady_ns()
        for goal in self._goals.values():
            if goal.gid == client.gid:
                goal.client = client.node.fully_qualified_name
                goal.gone_ns = None if present else now_ns
            elif client.gid in goal.candidates and not present:
                goal.candidates.discard(client.gid)
                goal.gone_ns = None if goal.candidates else now_ns
            elif present and is_anonymous(client) and now_ns < goal.found_by_ns and not goal.client:
                goal.candidates.add(client.gid)
                goal.gone_ns = None
        if self._goals and not present:
            # Later, as an endpoint whose gid changes leaves and returns at once.
            asyncio.get_running_loop().call_soon(self._look)

    def _set_alarm(self) -> None:
        """Schedule the next check; nothing wakes a server without goals."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None
        if not self._goals:
            return
        now_ns = self._time_base.steady_ns()
        self._due_ns = now_ns + self._lost_ns // SIGNS_IN_TIME
        for goal in self._goals.values():
            lost_ns = self._lost_at_ns(goal)
            if lost_ns is not None:
                self._due_ns = max(now_ns, min(self._due_ns, lost_ns))
        self._alarm = self._time_base.call_at(self._due_ns, self._ring)

    def _ring(self) -> None:
        # Signs that have arrived may not be read yet, which takes some iterations of the loop.
        loop = asyncio.get_running_loop()
        loop.call_soon(loop.call_soon, self._look)

    def _look(self) -> None:
        """Find lost clients."""
        if not self._goals:
            return
        now_ns = self._time_base.steady_ns()
        late_ns = now_ns - self._due_ns
        is_rested = now_ns - self._awake_ns >= SIGNS_IN_TIME * self._lost_ns
        if late_ns >= self._lost_ns or (is_rested and late_ns > self._lost_ns // STALLS_IN_TIME):
            self._awake_ns = now_ns
        lost: dict[str, list[bytes]] = {}
        for goal_id, goal in list(self._goals.items()):
            lost_ns = self._lost_at_ns(goal)
            if lost_ns is not None and now_ns >= lost_ns:
                del self._goals[goal_id]
                client = goal.client or f"with gid {goal.gid.hex()}"
                why = f"no sign of it for {self._lost_ns / 1e9:g} s"
                if goal.heard_ns is None:
                    why = "it is not in the graph"
                lost.setdefault(f"its client {client} is lost: {why}", []).append(goal_id)
        self._set_alarm()
        for text, goal_ids in lost.items():
            self._on_lost(goal_ids, text)

    def _lost_at_ns(self, goal: WatchedGoal) -> int | None:
        """Return when the client of `goal` will be lost if nothing changes; None if never."""
        if goal.heard_ns is not None:
            return max(goal.heard_ns, self._awake_ns) + self._lost_ns
        if goal.gone_ns is not None:
            return max(goal.gone_ns, self._awake_ns + self._lost_ns)
        return None


def is_anonymous(client: EndpointInfo) -> bool:
    """Return whether a client's gid in the graph differs from the one in its requests."""
    return client.node.over_rcl or client.node.bridged
