"""What ties an entity to its node: its entry in the graph, and the node's way of calling back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.endpoints.dispatch import CallbackContext, Dispatch

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable

    from aionode.endpoints.dispatch import OnError
    from aionode.endpoints.stats import CallbackStats
    from aionode.graph import EndpointInfo, EndpointKind, Graph
    from aionode.logging import RcutilsLogger

__all__ = ["Channel"]


class Channel:
    """One endpoint in the graph.

    Attributes:
        endpoint: The endpoint.
        logger: The logger of its node.
    """

    def __init__(
        self, endpoint: EndpointInfo, graph: Graph, logger: RcutilsLogger, budget_ns: int
    ) -> None:
        self.endpoint = endpoint
        self.logger = logger
        self._graph = graph
        self._budget_ns = budget_ns
        self._waits: set[asyncio.Future[None]] = set()

    def open(self) -> None:
        """Enter the endpoint into the graph. Called when its transports know it."""
        self._graph.add_endpoint(self.endpoint)

    def close(self) -> None:
        """Take the endpoint out of the graph, and cancel every `until`."""
        self._graph.remove_endpoint(self.endpoint)
        for wait in list(self._waits):
            wait.cancel(f"{self.endpoint.kind.value} of {self.endpoint.name}: destroyed")

    def count_matched(self, kind: EndpointKind) -> int:
        """Return how many endpoints of the opposite `kind` this one reaches."""
        return sum(
            self.endpoint.matches(other)
            for other in self._graph.endpoints(kind, name=self.endpoint.name)
        )

    async def until(self, condition: Callable[[], bool]) -> None:
        """Wait until `condition()` is true; it is asked again when the graph changes.

        Raises:
            CancelledError: the endpoint was closed meanwhile.
        """
        while not condition():
            wait = self._graph.changed()
            self._waits.add(wait)
            wait.add_done_callback(self._waits.discard)
            await wait

    def dispatch(
        self,
        callback: Callable[..., Any],
        entity: Any,
        stats: CallbackStats,
        *,
        on_error: OnError,
        offload: bool,
    ) -> Dispatch:
        """Return what runs the callback of `entity`.

        Raises:
            TypeError: `callback` or `on_error` is of a wrong kind.
            ValueError: `on_error` is an unknown word, or a coroutine function is to be offloaded.
        """
        name = getattr(callback, "__qualname__", repr(callback))
        context = CallbackContext(
            node=self.endpoint.node.fully_qualified_name,
            subject=f"{entity.subject} (callback {name})",
            entity=entity,
        )
        return Dispatch(
            callback,
            context,
            stats,
            on_error=on_error,
            offload=offload,
            budget_ns=self._budget_ns,
            logger=self.logger,
        )
