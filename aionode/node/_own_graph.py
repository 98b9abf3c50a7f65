"""Graph queries of one node, with names resolved as in that node."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode import names
from aionode.engine.graph_queries import NamesAndTypes, names_and_types_of
from aionode.graph import SERVICE_KINDS, EndpointKind

if TYPE_CHECKING:
    from collections.abc import Iterable

    from aionode.endpoints.core.node_core import NodeCore

__all__ = ["OwnGraph"]


class OwnGraph:
    """Answers queries from the graph of a node's context, in the caller's thread."""

    def __init__(self, core: NodeCore) -> None:
        self._core = core
        self._graph = core.context.graph
        self.nodes = self._graph.nodes

    def names_and_types(self, kinds: Iterable[EndpointKind]) -> NamesAndTypes:
        """Return the names of all endpoints of these kinds, with their types."""
        return self._graph.names_and_types(*kinds)

    def names_and_types_of(
        self, kind: EndpointKind, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        """Return the names of a node's endpoints of a kind, with their types."""
        full_name = names.fully_qualified_name(node_namespace, node_name)
        return names_and_types_of(self._graph, kind, full_name)

    def count(self, kind: EndpointKind, name: str) -> int:
        """Count the endpoints of a kind with this name."""
        return self._graph.count(kind, self._core.resolve(name, is_service=kind in SERVICE_KINDS))
