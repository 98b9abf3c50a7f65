"""The graph for drawing: nodes, what they share, and mismatches."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import msgspec

from aionode.graph import EndpointKind, is_infrastructure
from aionode.names import is_hidden

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from aionode.graph import EndpointInfo, Graph

__all__ = ["Edge", "Picture", "Vertex", "difference", "picture_of"]

Kind: TypeAlias = Literal["node", "topic", "service", "action"]

Change: TypeAlias = Literal["", "new", "gone"]

SEND_GOAL = "/_action/send_goal"


class Vertex(msgspec.Struct, frozen=True):
    """A node, or a topic, service or action.

    Attributes:
        kind: What it is.
        name: Its full name.
        types: The names of its types; empty for a node.
        change: Whether it is new or gone compared with an earlier picture.
    """

    kind: Kind
    name: str
    types: tuple[str, ...] = ()
    change: Change = ""


class Edge(msgspec.Struct, frozen=True):
    """A node publishes to, subscribes to, calls or serves something.

    Attributes:
        source: Where messages, requests or goals come from: kind and name.
        target: Where they go.
        mismatch: Why they do not arrive; empty if they do.
        hz: Their rate per second; None if it was not measured.
        change: Whether it is new or gone compared with an earlier picture.
    """

    source: tuple[Kind, str]
    target: tuple[Kind, str]
    mismatch: str = ""
    hz: float | None = None
    change: Change = ""


class Picture(msgspec.Struct, frozen=True):
    """A graph at one time, which can be drawn, saved and compared.

    Attributes:
        vertices: Nodes, topics, services and actions, sorted.
        edges: What connects them, sorted.
    """

    vertices: tuple[Vertex, ...]
    edges: tuple[Edge, ...]


def picture_of(
    graph: Graph,
    *,
    names: Collection[str] = (),
    everything: bool = False,
    hz: Mapping[tuple[str, str, str], float] | None = None,
) -> Picture:
    """Return the picture of a graph.

    Args:
        graph: The graph.
        names: Only these nodes, topics, services and actions, and their neighbours; a name that
            ends in a slash stands for everything below it. By default all.
        everything: Whether infrastructure and hidden nodes are drawn as well.
        hz: Measured rates by node, kind of endpoint and name.
    """
    edges: dict[tuple[object, object], Edge] = {}
    types: dict[tuple[Kind, str], set[str]] = {}
    nodes = {node.fully_qualified_name for node in graph.nodes()}
    vertices: set[tuple[Kind, str]] = {
        ("node", name) for name in nodes if everything or not is_hidden(name)
    }
    for endpoint in graph.endpoints():
        node = endpoint.node.fully_qualified_name
        found = None if is_hidden(node) and not everything else shared(endpoint, everything)
        if found is None:
            continue
        kind, name, type_name = found
        types.setdefault((kind, name), set()).add(type_name)
        ends: tuple[tuple[Kind, str], tuple[Kind, str]] = (("node", node), (kind, name))
        if endpoint.kind in (EndpointKind.SUBSCRIPTION, EndpointKind.SERVER):
            ends = ends[1], ends[0]
        rate = None if hz is None else hz.get((node, endpoint.kind.value, name))
        reason = edges[ends].mismatch if ends in edges else ""
        edges[ends] = Edge(*ends, reason or mismatch_of(graph, endpoint), rate)
    chosen = chosen_of({*vertices, *types}, edges.values(), names)
    kept = [edge for edge in edges.values() if {edge.source, edge.target} <= chosen]
    return Picture(
        tuple(
            Vertex(kind, name, tuple(sorted(types.get((kind, name), ()))))
            for kind, name in sorted(chosen)
        ),
        tuple(sorted(kept, key=lambda edge: (edge.source, edge.target))),
    )


def shared(endpoint: EndpointInfo, everything: bool) -> tuple[Kind, str, str] | None:
    """Return the topic, service or action of an endpoint, with its type; None if it is left out."""
    is_topic = endpoint.kind in (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
    if endpoint.name.endswith(SEND_GOAL):
        name = endpoint.name.removesuffix(SEND_GOAL)
        if everything or not is_hidden(name):
            return "action", name, endpoint.type_name.removesuffix("_SendGoal")
    if is_infrastructure(endpoint) and not everything:
        return None
    return "topic" if is_topic else "service", endpoint.name, endpoint.type_name


def mismatch_of(graph: Graph, endpoint: EndpointInfo) -> str:
    """Return why an endpoint does not communicate with one of the others; empty if it does."""
    if endpoint.kind in (EndpointKind.PUBLISHER, EndpointKind.SERVER):
        return ""
    reasons = (endpoint.mismatch(other) for other in graph.opposites(endpoint))
    return next((reason for reason in reasons if reason is not None), "")


def chosen_of(
    vertices: set[tuple[Kind, str]], edges: Collection[Edge], names: Collection[str]
) -> set[tuple[Kind, str]]:
    """Return the named vertices and those connected with them."""
    if not names:
        return vertices
    wanted = {f"/{name.lstrip('/')}" for name in names}
    below = tuple(name for name in wanted if name.endswith("/"))
    chosen = {vertex for vertex in vertices if vertex[1] in wanted or vertex[1].startswith(below)}
    near = {
        vertex
        for edge in edges
        if edge.source in chosen or edge.target in chosen
        for vertex in (edge.source, edge.target)
    }
    return chosen | near


def difference(before: Picture, after: Picture) -> Picture:
    """Return both pictures as one, in which new and vanished parts are marked."""
    old = {(vertex.kind, vertex.name): vertex for vertex in before.vertices}
    new = {(vertex.kind, vertex.name): vertex for vertex in after.vertices}
    old_edges = {(edge.source, edge.target): edge for edge in before.edges}
    new_edges = {(edge.source, edge.target): edge for edge in after.edges}
    vertices = [
        msgspec.structs.replace(vertex, change="" if key in old else "new")
        for key, vertex in new.items()
    ] + [
        msgspec.structs.replace(vertex, change="gone")
        for key, vertex in old.items()
        if key not in new
    ]
    edges = [
        msgspec.structs.replace(edge, change="" if key in old_edges else "new")
        for key, edge in new_edges.items()
    ] + [
        msgspec.structs.replace(edge, change="gone")
        for key, edge in old_edges.items()
        if key not in new_edges
    ]
    return Picture(
        tuple(sorted(vertices, key=lambda vertex: (vertex.kind, vertex.name))),
        tuple(sorted(edges, key=lambda edge: (edge.source, edge.target))),
    )
