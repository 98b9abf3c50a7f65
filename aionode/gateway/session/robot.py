"""The robot, as shared by the sessions of a gateway: node, policy, and endpoints in use."""

from __future__ import annotations

import asyncio
import math
import re
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, Any, Final

from aionode._process.recent import Recent
from aionode.clock import S_TO_NS, SteadyClock
from aionode.errors import InterfaceNotFoundError
from aionode.gateway.session.command import Commands
from aionode.gateway.session.encoding.client_json import type_text
from aionode.gateway.session.feed import Feeds
from aionode.gateway.session.goal_owners import GoalOwners
from aionode.gateway.session.refusals import Refusals
from aionode.gateway.session.sharing import Shared
from aionode.gateway.session.standstill import Standstills
from aionode.message import ActionType, Message, ServiceType

if TYPE_CHECKING:
    from aionode.gateway.policy.identity import Identity
    from aionode.gateway.policy.policy import Policy, Rule, Verb
    from aionode.gateway.session.audit import Audit
    from aionode.node import Node

__all__ = ["Ask", "Rates", "Robot"]

Ask = Callable[["Identity", "Verb", str, Any], Awaitable[bool]]
"""Asks a person whether a client may do something: called with the client, the verb, the name, and
the message. Returns whether the person approves."""

BASES: Final = {"msg": Message, "srv": ServiceType, "action": ActionType}
MAX_TYPES: Final = 1000
MAX_RATES: Final = 10_000

MAX_TYPE_NAME: Final = 255
"""The longest name of a type, in characters: for an unknown name, similar ones are searched."""


class Robot:
    """The robot, as shared by the sessions of a gateway.

    Args:
        node: The node of the gateway.
        policy: Who may do what.
        audit: The audit log.
        tasks: Run the leases, and encode large messages.
        ask: Asks a person for approval; None if there is nobody to ask.

    Attributes:
        turn: A lock held while encoding a large message, or querying the graph.
        making: A lock held while a large message is created in a thread from a client's data.
        owners: Knows the owners of goals, and creates the action clients that send them.
        standstills: Notices that the event loop was stalled.
        refusals: Counts and logs what is refused, dropped or late.
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
        self.making = asyncio.Lock()
        self.ask = ask
        self.time_base = node.context.time_base
        self.clock = SteadyClock(time_base=self.time_base)
        self.feeds = Feeds(node)
        self.shared = Shared(self.time_base)
        self.commands = Commands(tasks)
        self.owners = GoalOwners(node, audit)
        self.standstills = Standstills(self.time_base)
        self.refusals = Refusals(node)
        self.rates = Rates(self.time_base.steady_ns)
        self._types: dict[tuple[str, frozenset[str]], Any] = {}
        self._types_now: dict[str, Any] = {}  # by name, until the graph changes
        self._changes = -1

    async def find_type(self, name: str, kind: str) -> Any:
        """Return the class of a type, created once for all clients.

        Args:
            name: Its name: ``std_msgs/msg/String``, or ``std_msgs/String``.
            kind: ``msg``, ``srv`` or ``action``.

        Raises:
            InterfaceNotFoundError: neither this program nor a node that uses it describes it.
        """
        full = type_text(name, kind)
        misfit = InterfaceNotFoundError(
            name[:200], problem=f"this is not the name of a type of {kind}"
        )
        # Actions consist of services and messages, and services of messages.
        of = rf"\w+/({kind}/\w+|(srv|action)/\w+_\w+)"
        if len(full) > MAX_TYPE_NAME or not re.fullmatch(of, full, re.ASCII):
            raise misfit
        graph = self.node.graph
        if self._changes != graph.changes:
            self._changes, self._types_now = graph.changes, {}
        now = self._types_now
        if full not in now:
            now[full] = await self._find_type(full)
        if not issubclass(now[full], BASES[kind]):
            raise misfit
        return now[full]

    async def _find_type(self, full: str) -> Any:
        """Return the class of a type by its full name, created once for all nodes that use it.

        Raises:
            InterfaceNotFoundError: see `find_type`.
        """
        endpoints = self.node.graph.endpoints()
        whole = full.partition("_")[0] if "/msg/" not in full else full
        hashes = frozenset(e.type_hash for e in endpoints if e.type_name.startswith(whole))
        key = (full, hashes)
        if key not in self._types:
            message_type = await self.node.find_type(full)
            if len(self._types) >= MAX_TYPES:
                self._types.clear()
            self._types.setdefault(key, message_type)
        return self._types[key]

    def close(self) -> None:
        """Destroy the shared endpoints."""
        self.standstills.stop()
        self.shared.close()


class Rates:
    """The rates of uses limited by rules: a bucket for each client, rule and name.

    Args:
        now_ns: The steady clock, in nanoseconds.
    """

    def __init__(self, now_ns: Callable[[], int]) -> None:
        self._now_ns = now_ns
        # Keeping the rule alive ensures that no other rule gets the same id.
        self._buckets: Recent[tuple[str, int, str], tuple[Rule, Bucket]] = Recent(MAX_RATES)

    def allows(self, identity: Identity, rule: Rule, name: str) -> bool:
        """Count one more, and return whether it is within the rate."""
        if rule.rate_hz == math.inf:
            return True
        key = (identity.name, id(rule), name)
        if key not in self._buckets:
            self._buckets.put(key, (rule, Bucket(rule.rate_hz, self._now_ns)))
        return self._buckets[key][1].wait_sec() <= 0.0


class Bucket:
    """A token bucket: a rate per second, with a burst of one second's worth, but at least one."""

    def __init__(self, rate_hz: float, now_ns: Callable[[], int]) -> None:
        self.rate_hz = rate_hz
        self._now_ns = now_ns
        self._room = self._tokens = max(1.0, rate_hz)
        self._at_ns = now_ns()

    def wait_sec(self) -> float:
        """Take a token and return 0; if there is none, return how long to wait, in seconds."""
        now_ns = self._now_ns()
        passed = (now_ns - self._at_ns) / S_TO_NS
        self._tokens = min(self._room, self._tokens + passed * self.rate_hz)
        self._at_ns = now_ns
        if self._tokens >= 1.0:
            self._tokens -= 1.0
            return 0.0
        return (1.0 - self._tokens) / self.rate_hz
