"""What ties an entity to its node: its entry in the graph, and how the node runs callbacks."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from collections.abc import Set as AbstractSet

    from aionode.endpoints._core.callback_runner import Callbacks
    from aionode.endpoints._core.loop_affinity import LoopAffinity
    from aionode.graph import EndpointInfo, EndpointKind, Graph

__all__ = ["GraphEntry"]


class GraphEntry:
    """One endpoint in the graph.

    Attributes:
        endpoint: The endpoint.
        callbacks: How its node runs callbacks.
        affinity: The event loop that its node runs in.
    """

    def __init__(
        self, endpoint: EndpointInfo, graph: Graph, callbacks: Callbacks, affinity: LoopAffinity
    ) -> None:
        self.endpoint = endpoint
        self.callbacks = callbacks
        self.affinity = affinity
        self._graph = graph
        # What `until` waits for: changes of the graph, each until it is done.
        self._waits: set[asyncio.Future[None]] = set()
        self._closed = False
        self._unwatch: list[Callable[[], None]] = []
        self._unreported: AbstractSet[str] = frozenset()

    def leave_unreported(self, aspects: AbstractSet[str]) -> None:
        """Have no warning logged for these mismatches, as a `Mismatch` calls them."""
        self._unreported = aspects

    def watch(self, watcher: Callable[[EndpointInfo, bool], None]) -> None:
        """Call `watcher` with each opposite endpoint of its name, and whether it is present.

        Until the entry is closed; what is known already comes at once.
        """
        if not self._closed:
            opposite = self.endpoint.kind.opposite
            self._unwatch.append(self._graph.watch(opposite, self.endpoint.name, watcher))

    def open(self) -> None:
        """Add the endpoint to the graph. Called once it is announced to the transports."""
        if self._unreported:
            self._graph.unreported[self.endpoint] = self._unreported
        self._graph.add_endpoint(self.endpoint)

    def close(self) -> None:
        """Remove the endpoint from the graph, and cancel every `until`."""
        self._closed = True
        for wait in list(self._waits):  # first, since the change below wakes them
            wait.cancel(f"{self.endpoint.kind.value} of {self.endpoint.name}: destroyed")
        for unwatch in self._unwatch:
            unwatch()
        self._unwatch.clear()
        self._graph.remove_endpoint(self.endpoint)

    def matched(self) -> list[EndpointInfo]:
        """Return the endpoints of the opposite kind that this one reaches; none when closed."""
        if self._closed:
            return []
        opposite = self.endpoint.kind.opposite
        return [
            other
            for other in self._graph.endpoints(opposite, name=self.endpoint.name)
            if self.endpoint.matches(other)
        ]

    def count_matched(self, kind: EndpointKind) -> int:
        """Return how many endpoints of the opposite `kind` this one reaches."""
        return sum(
            self.endpoint.matches(other)
            for other in self._graph.endpoints(kind, name=self.endpoint.name)
        )

    async def until(self, condition: Callable[[], bool]) -> None:
        """Wait until `condition()` is true; it is checked again when endpoints of its name change.

        Raises:
            CancelledError: the endpoint was closed during the wait.
        """
        while not condition():
            if self._closed:
                # A change in the same iteration of the loop had ended the wait before `close`.
                raise asyncio.CancelledError(f"{self.endpoint.name}: destroyed")
            wait = self._graph.changed(self.endpoint.name)
            self._waits.add(wait)
            wait.add_done_callback(self._waits.discard)
            await wait
