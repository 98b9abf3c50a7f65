"""Notice managed nodes that go away and come back."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Literal

from aionode.graph import EndpointKind
from aionode.interfaces.lifecycle_msgs.msg import TransitionEvent

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from aionode.graph import EndpointInfo
    from aionode.node import Node

__all__ = ["LEVELS", "ManagedNodeEvent", "NodeWatch"]

LEVELS = ("unconfigured", "inactive", "active")
"""The states to which a manager brings nodes, in ascending order."""


@dataclass(frozen=True, slots=True)
class ManagedNodeEvent:
    """A change of a managed node that a `LifecycleManager` watches.

    Attributes:
        node_name: Its full name.
        kind: ``"lost"``: the node has gone or cannot be reached. ``"returned"``: it is back.
            ``"restored"``: it is in its earlier state again. ``"failed"``: restoring it failed.
        state: Label of its state, as far as known.
        state_before: Label of the state that it had before it was lost.
        error: The reason for ``"failed"``.
    """

    node_name: str
    kind: Literal["lost", "returned", "restored", "failed"]
    state: str
    state_before: str
    error: Exception | None = None

    def __str__(self) -> str:
        """Return one line."""
        if self.kind == "lost":
            return f"{self.node_name} has gone, or cannot be reached; it was {self.state_before}"
        if self.kind == "returned":
            return f"{self.node_name} is back and {self.state}; it was {self.state_before}"
        if self.kind == "restored":
            return f"{self.node_name} is {self.state} again"
        return f"{self.node_name} could not be made {self.state_before} again: {self.error}"


class NodeWatch:
    """Watches the services of managed nodes, and the states that they publish.

    A new node may appear before its killed predecessor of the same name is known to be gone; it is
    recognized by its service, which is a different one.

    Args:
        node: The node that watches.
        services: The ``change_state`` service of each managed node, by the name of the node.
        states: The last known state of each; updated as nodes publish it.
        tell: Called with each event that is noticed here.
    """

    def __init__(
        self,
        node: Node,
        services: Mapping[str, str],
        states: dict[str, str],
        tell: Callable[[ManagedNodeEvent], None],
    ) -> None:
        self._states = states
        self._tell = tell
        self._servers: dict[str, set[EndpointInfo]] = {name: set() for name in services}
        self._states_before: dict[str, str] = {}  # of nodes that were lost or replaced
        self._lost: set[str] = set()
        self._returned: set[str] = set()
        self._begun = False
        self._closed = False
        self._changed = asyncio.Event()
        self._unwatch = [
            node.graph.watch(EndpointKind.SERVER, service, partial(self._note, name))
            for name, service in services.items()
        ]
        self._subscriptions = [
            node.create_subscription(
                TransitionEvent, f"{name}/transition_event", partial(self._note_state, name)
            )
            for name in services
        ]
        self._begun = True

    def _note(self, name: str, server: EndpointInfo, present: bool) -> None:
        servers = self._servers[name]
        if present:
            servers.add(server)
        else:
            servers.discard(server)
        if not self._begun:
            return
        before = self._states_before.setdefault(name, self._states.get(name, "unknown"))
        if present:
            self._returned.add(name)
            self._changed.set()
        elif not servers:
            self._lost.add(name)
            self._tell(ManagedNodeEvent(name, "lost", before, before))

    def _note_state(self, name: str, event: TransitionEvent) -> None:
        state = event.goal_state.label
        if state in (*LEVELS, "finalized"):
            self._states[name] = state

    async def next_return(self) -> str | None:
        """Wait for a node that is back, the first in order; None once this is closed."""
        while not self._closed:
            for name in self._servers:
                if name in self._returned:
                    self._returned.discard(name)
                    return name
            self._changed.clear()
            await self._changed.wait()
        return None

    def state_before(self, name: str) -> str:
        """Return the state that a node had before it was lost or replaced."""
        return self._states_before.get(name, "unknown")

    def was_lost(self, name: str) -> bool:
        """Return whether the node was gone before it came back."""
        return name in self._lost

    def settle(self, name: str) -> None:
        """Accept a node's current state as the one that it should have."""
        self._states_before.pop(name, None)
        self._lost.discard(name)

    def close(self) -> None:
        """Stop watching."""
        self._closed = True
        self._changed.set()
        for unwatch in self._unwatch:
            unwatch()
        for subscription in self._subscriptions:
            subscription.destroy()
