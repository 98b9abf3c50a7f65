"""The base of publishers, subscriptions, services and clients: their place in the graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from aionode.endpoints.core.entity import EndStage, Entity
from aionode.engine.membership import affinity_of
from aionode.engine.reports.limits import heavy_text

if TYPE_CHECKING:
    from collections.abc import Callable
    from collections.abc import Set as AbstractSet

    from aionode.endpoints.core.callback_runner import Callbacks
    from aionode.engine.context import Context
    from aionode.graph import EndpointInfo

__all__ = ["Endpoint", "EndpointSetup", "info_of", "report_heavy", "watch_opposite"]


class EndpointSetup(Struct, frozen=True):
    """What an endpoint uses of its node.

    Attributes:
        endpoint: The endpoint's entry in the graph.
        context: The node's context.
        callbacks: How the node runs callbacks.
    """

    endpoint: EndpointInfo
    context: Context
    callbacks: Callbacks


def report_heavy(setup: EndpointSetup, what: str) -> None:
    """Log that messages or requests were dropped or refused for taking too many bytes."""
    what = f"{what} (logged once; see stats.dropped)"
    limit = setup.context.network.queue_bytes
    setup.callbacks.logger.warning(heavy_text(setup.endpoint.name, limit, what))


class Endpoint(Entity):
    """An entity that others discover in the graph, and that is matched with its opposite kind.

    Args:
        subject: What it is, for errors and logs, such as ``publisher of /chatter``.
        setup: What it uses of its node.
        stage: When it is destroyed as its node ends.

    Attributes:
        qos_profile: Its profile.
    """

    def __init__(
        self, subject: str, setup: EndpointSetup, stage: EndStage = EndStage.CALLBACKS
    ) -> None:
        super().__init__(subject, stage)
        self._endpoint, self._graph = setup.endpoint, setup.context.graph
        self._callbacks, self._affinity = setup.callbacks, affinity_of(setup.context)
        self._causes = setup.context.causes
        self.qos_profile = self._endpoint.qos
        self._unwatch: list[Callable[[], None]] = []
        self._unreported: AbstractSet[str] = frozenset()

    def _leave_unreported(self, aspects: AbstractSet[str]) -> None:
        """Suppress warnings for these mismatches, which are aspects of `Mismatch`."""
        self._unreported = aspects

    def _watch(self, watcher: Callable[[EndpointInfo, bool], None]) -> None:
        """Call `watcher` with each opposite endpoint of its name and whether it is present.

        Lasts until the endpoint is destroyed; known endpoints are reported at once.
        """
        if not self.destroyed:
            opposite = self._endpoint.kind.opposite
            self._unwatch.append(self._graph.watch(opposite, self._endpoint.name, watcher))

    def _enter_graph(self) -> None:
        """Add the endpoint to the graph; called once it is announced to the transports."""
        if self._unreported:
            self._graph.unreported[self._endpoint] = self._unreported
        self._graph.add_endpoint(self._endpoint)

    def _leave_graph(self) -> None:
        """Remove the endpoint from the graph, which ends every `_until`; part of `_close`."""
        for unwatch in self._unwatch:
            unwatch()
        self._unwatch.clear()
        self._graph.remove_endpoint(self._endpoint)

    def _matched(self) -> list[EndpointInfo]:
        """Return the opposite endpoints that this one reaches; none when destroyed."""
        if self.destroyed:
            return []
        opposite = self._endpoint.kind.opposite
        return [
            other
            for other in self._graph.endpoints(opposite, name=self._endpoint.name)
            if self._endpoint.matches(other)
        ]

    def _count_matched(self) -> int:
        """Count the compatible opposite endpoints in the graph."""
        opposite = self._endpoint.kind.opposite
        return sum(
            self._endpoint.matches(other)
            for other in self._graph.endpoints(opposite, name=self._endpoint.name)
        )

    async def _until(self, condition: Callable[[], bool]) -> None:
        """Wait until `condition()` is true; it is checked again when endpoints of its name change.

        Raises:
            EntityDestroyedError: the endpoint was destroyed during the wait.
            CancelledError: as for EntityDestroyedError, in a task of the node.
        """
        while not condition():
            if self.destroyed:
                raise self._end_of_wait()
            await self._graph.changed(self._endpoint.name)


def info_of(endpoint: Endpoint) -> EndpointInfo:
    """Return the entry of an endpoint in the graph."""
    return endpoint._endpoint


def watch_opposite(endpoint: Endpoint, watcher: Callable[[EndpointInfo, bool], None]) -> None:
    """Call `watcher` with each opposite endpoint of its name and whether it is present.

    Lasts until the endpoint is destroyed; known endpoints are reported at once.
    """
    endpoint._watch(watcher)
