"""What the sessions of a gateway share: the node, the policy, and the endpoints in use."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, Any, Final

from aionode.clock import S_TO_NS, SteadyClock
from aionode.errors import InterfaceNotFoundError
from aionode.gateway._command import Commands
from aionode.gateway._feed import Feeds
from aionode.gateway._sharing import Shared

if TYPE_CHECKING:
    from aionode.gateway._audit import Audit
    from aionode.gateway._identity import Identity
    from aionode.gateway._policy import Policy, Rule, Verb
    from aionode.node import Node

__all__ = ["Ask", "Rates", "Robot"]

Ask = Callable[["Identity", "Verb", str, Any], Awaitable[bool]]
"""Asks a person whether a client may do something: called with the client, what it wants to do,
with which name, and what it sends. Returns whether the person says yes."""

MOST_TYPES: Final = 1000
MOST_RATES: Final = 10_000
KINDS: Final = frozenset({"msg", "srv", "action"})


class Robot:
    """What a gateway's sessions touch of the robot.

    Args:
        node: The node of the gateway.
        policy: Who may do what.
        audit: The audit log.
        tasks: Run the leases, and encode large messages.
        ask: Asks a person; None if there is nobody to ask.

    Attributes:
        turn: Held by who encodes a large message: one at a time.
    """

    def __init__(
        self,
        node: Node,
        policy: Policy,
        audit: Audit,
        tasks: asyncio.TaskGroup,
        ask: Ask | None = None,
    ) -> None:
        self.node = node
        self.policy = policy
        self.audit = audit
        self.tasks = tasks
        self.turn = asyncio.Lock()
        self.ask = ask
        self.time_base = node.context.time_base
        self.clock = SteadyClock(time_base=self.time_base)
        self.feeds = Feeds(node)
        self.shared = Shared(self.time_base)
        self.commands = Commands(tasks)
        self.rates = Rates(self.time_base.steady_ns)
        self._types: dict[tuple[str, frozenset[str]], Any] = {}

    async def find_type(self, name: str, kind: str) -> Any:
        """Return the class of a type, once made for all.

        Args:
            name: Its name: ``std_msgs/msg/String``, or ``std_msgs/String``.
            kind: ``msg``, ``srv`` or ``action``.

        Raises:
            InterfaceNotFoundError: neither this program nor a node that uses it describes it.
        """
        parts = name.split("/")
        full = "/".join((parts[0], kind, parts[1])) if len(parts) == 2 else name
        if len(parts) not in {2, 3} or f"/{kind}/" not in full:
            raise InterfaceNotFoundError(name[:200], problem=f"this is no name of a type of {kind}")
        endpoints = self.node.graph.endpoints()
        hashes = frozenset(e.type_hash for e in endpoints if e.type_name.startswith(full))
        key = (full, hashes)
        if key not in self._types:
            found = await self.node.find_type(full)
            if len(self._types) >= MOST_TYPES:
                self._types.clear()
            self._types.setdefault(key, found)
        return self._types[key]

    def close(self) -> None:
        """Destroy the endpoints that are shared."""
        self.shared.close()


class Rates:
    """How often clients have done what a rule limits: a bucket for each client, rule and name.

    Args:
        now_ns: The steady clock, in nanoseconds.
    """

    def __init__(self, now_ns: Callable[[], int]) -> None:
        self._now_ns = now_ns
        self._buckets: dict[tuple[str, int, str], Bucket] = {}

    def allows(self, identity: Identity, rule: Rule, name: str) -> bool:
        """Count one more, and return whether it is within the rate."""
        if rule.rate_hz == math.inf:
            return True
        key = (identity.name, id(rule), name)
        bucket = self._buckets.get(key)
        if bucket is None:
            if len(self._buckets) >= MOST_RATES:
                del self._buckets[next(iter(self._buckets))]  # the oldest, not those of others
            bucket = self._buckets[key] = Bucket(rule.rate_hz, self._now_ns)
        return bucket.wait_sec() <= 0.0


class Bucket:
    """A token bucket: so many a second, and a second's worth at once, but at least one."""

    def __init__(self, rate_hz: float, now_ns: Callable[[], int]) -> None:
        self._rate_hz = rate_hz
        self._now_ns = now_ns
        self._room = self._tokens = max(1.0, rate_hz)
        self._at_ns = now_ns()

    def wait_sec(self) -> float:
        """Take one, and return 0; without one, return after how many seconds there is one."""
        now_ns = self._now_ns()
        passed = (now_ns - self._at_ns) / S_TO_NS
        self._tokens = min(self._room, self._tokens + passed * self._rate_hz)
        self._at_ns = now_ns
        if self._tokens >= 1.0:
            self._tokens -= 1.0
            return 0.0
        return (1.0 - self._tokens) / self._rate_hz
