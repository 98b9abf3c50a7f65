"""Pictures of the graph as text, as SVG, and for Graphviz and Mermaid."""

from __future__ import annotations

import itertools
import math
from collections import defaultdict
from html import escape
from typing import TYPE_CHECKING, Final, TypeAlias

from aionode.errors import escaped

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from aionode.observe._picture import Edge, Picture, Vertex

__all__ = ["to_dot", "to_mermaid", "to_svg", "to_text"]

MARKS: Final = {"": " ", "new": "+", "gone": "-"}

VERBS: Final = {
    ("node", "topic"): "publishes",
    ("topic", "node"): "subscribes to",
    ("node", "service"): "calls",
    ("service", "node"): "serves",
    ("node", "action"): "sends goals to",
    ("action", "node"): "executes",
}


def rate_of(edge: Edge) -> str:
    """Return the rate of an edge as text; empty if unknown."""
    return "" if edge.hz is None else f"{edge.hz:.3g} Hz"


def to_text(picture: Picture) -> str:
    """Return a picture as lines: each node with its endpoints."""
    types = {(vertex.kind, vertex.name): ", ".join(vertex.types) for vertex in picture.vertices}
    edges: dict[Key, list[Edge]] = defaultdict(list)
    for edge in picture.edges:
        for end in {edge.source, edge.target}:
            edges[end].append(edge)
    lines = []
    for vertex in picture.vertices:
        if vertex.kind != "node":
            continue
        me = (vertex.kind, vertex.name)
        lines.append(f"{MARKS[vertex.change]} {vertex.name}")
        for edge in edges[me]:
            other = edge.target if edge.source == me else edge.source
            verb = VERBS[edge.source[0], edge.target[0]]
            rate = f"  {rate_of(edge)}" if edge.hz is not None else ""
            why = f"  DOES NOT MATCH: {edge.mismatch}" if edge.mismatch else ""
            lines.append(f"{MARKS[edge.change]}   {verb} {other[1]} [{types[other]}]{rate}{why}")
    return "\n".join(escaped(line, one_line=True) for line in lines)


def ids_of(picture: Picture) -> dict[tuple[str, str], str]:
    """Return a short name for each vertex."""
    return {(each.kind, each.name): f"v{n}" for n, each in enumerate(picture.vertices)}


def to_dot(picture: Picture) -> str:
    """Return a picture in the language of Graphviz."""
    ids = ids_of(picture)
    lines = ["digraph robot {", "  rankdir=LR;", '  node [fontname="sans-serif"];']
    for vertex in picture.vertices:
        shape = "ellipse" if vertex.kind == "node" else "box"
        color = COLORS[vertex.change or vertex.kind]
        label = quoted(vertex.name)
        lines.append(
            f'  {ids[vertex.kind, vertex.name]} [label={label}, shape={shape}, color="{color}"];'
        )
    for edge in picture.edges:
        color = RED if edge.mismatch else COLORS[edge.change or "edge"]
        label = quoted(" ".join(filter(None, (rate_of(edge), edge.mismatch))))
        lines.append(
            f'  {ids[edge.source]} -> {ids[edge.target]} [color="{color}", fontcolor="{color}", '
            f"label={label}];"
        )
    return "\n".join([*lines, "}"])


def quoted(text: str) -> str:
    """Return a text between quotes, as Graphviz reads it."""
    return '"' + escaped(text, one_line=True).replace("\\", "\\\\").replace('"', '\\"') + '"'


def to_mermaid(picture: Picture) -> str:
    """Return a picture in the language of Mermaid."""
    ids = ids_of(picture)
    lines = ["flowchart LR"]
    for vertex in picture.vertices:
        opening, closing = ("([", "])") if vertex.kind == "node" else ("[", "]")
        label = escape(escaped(vertex.name, one_line=True), quote=True).replace("&", "#")
        lines.append(f'  {ids[vertex.kind, vertex.name]}{opening}"{label}"{closing}')
    red = []
    for number, edge in enumerate(picture.edges):
        words = " ".join(filter(None, (rate_of(edge), edge.mismatch)))
        label = escape(escaped(words, one_line=True), quote=True).replace("&", "#")
        arrow = f'-->|"{label}"|' if label else "-->"
        lines.append(f"  {ids[edge.source]} {arrow} {ids[edge.target]}")
        red += [number] if edge.mismatch else []
    if red:
        lines.append(f"  linkStyle {','.join(map(str, red))} stroke:{RED},color:{RED}")
    return "\n".join(lines)


# SVG, by a layered layout

RED: Final = "#c62828"

COLORS: Final = {
    "node": "#1565c0",
    "topic": "#555555",
    "service": "#6a1b9a",
    "action": "#00695c",
    "edge": "#888888",
    "new": "#2e7d32",
    "gone": "#c77700",
}

CHARACTER: Final = 7.3
"""Width of a character of the font, in pixels."""

HEIGHT: Final = 26.0
GAP: Final = 14.0
BETWEEN: Final = 90.0
MARGIN: Final = 20.0

SWEEPS: Final = 8
"""Number of times that the vertices of each layer are sorted by their neighbours."""

Key: TypeAlias = tuple[str, str]


def to_svg(picture: Picture) -> str:
    """Return a picture as SVG, with layers from left to right."""
    layers, chains = layered(picture)
    places = placed(layers)
    right = max((x + width for x, _, width in places.values()), default=0.0) + MARGIN
    below = max((y + HEIGHT for _, y, _ in places.values()), default=0.0) + MARGIN
    reasons = list(dict.fromkeys(edge.mismatch for edge in picture.edges if edge.mismatch))
    height = below + 18 * len(reasons) + (MARGIN if reasons else 0)
    right = max([right, *(CHARACTER * (len(reason) + 6) + 2 * MARGIN for reason in reasons)])
    size = f'width="{right:.0f}" height="{height:.0f}" viewBox="0 0 {right:.0f} {height:.0f}"'
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="monospace" font-size="12">',
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    for edge, chain in zip(picture.edges, chains, strict=True):
        lines += edge_svg(edge, [places[key] for key in chain], reasons)
    for vertex in picture.vertices:
        lines += vertex_svg(vertex, *places[vertex.kind, vertex.name])
    for number, reason in enumerate(reasons, 1):
        lines.append(
            f'<text x="{MARGIN:.0f}" y="{below + 18 * number:.0f}" fill="{RED}">'
            f"({number}) {escape(escaped(reason, one_line=True))}</text>"
        )
    return "\n".join([*lines, "</svg>"])


def edge_svg(
    edge: Edge, places: list[tuple[float, float, float]], reasons: list[str]
) -> Iterator[str]:
    """Yield an edge as a smooth line with an arrow and its label."""
    color = RED if edge.mismatch else COLORS[edge.change or "edge"]
    ends = [(x, x + width, y + HEIGHT / 2) for x, y, width in places]
    if ends[-1][0] < ends[0][0]:  # backwards: out of the left side, and in at the right one
        ends = [(right, left, y) for left, right, y in ends]
    points = [(ends[0][1], ends[0][2])]
    for entry, leaving, y in ends[1:-1]:
        points += [(entry, y), (leaving, y)]
    points.append((ends[-1][0], ends[-1][2]))
    way = f"M{points[0][0]:.1f},{points[0][1]:.1f}"
    for (x1, y1), (x2, y2) in itertools.pairwise(points):
        middle = (x1 + x2) / 2
        way += f" C{middle:.1f},{y1:.1f} {middle:.1f},{y2:.1f} {x2:.1f},{y2:.1f}"
    dashes = ' stroke-dasharray="5 4"' if edge.mismatch or edge.change == "gone" else ""
    yield f'<path d="{way}" fill="none" stroke="{color}" stroke-width="1.4"{dashes}/>'
    (x, y), toward = points[-1], points[-2][0]
    tip = 7.0 if toward < x else -7.0
    yield f'<path d="M{x:.1f},{y:.1f} l{-tip:.1f},-4 v8 z" fill="{color}"/>'
    words = [rate_of(edge)] if edge.hz is not None else []
    words += [f"({reasons.index(edge.mismatch) + 1})"] if edge.mismatch else []
    if words:
        near = (points[0][0] + points[1][0]) / 2, (points[0][1] + points[1][1]) / 2
        yield (
            f'<text x="{near[0]:.1f}" y="{near[1] - 4:.1f}" fill="{color}" font-size="10" '
            f'text-anchor="middle">{escape(" ".join(words))}</text>'
        )


def vertex_svg(vertex: Vertex, x: float, y: float, width: float) -> Iterator[str]:
    """Yield a node as a rounded box, or a topic, service or action as a plain one."""
    color = COLORS[vertex.change or vertex.kind]
    radius = HEIGHT / 2 if vertex.kind == "node" else 2
    title = escape(escaped(", ".join((vertex.kind, *vertex.types)), one_line=True))
    yield (
        f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{HEIGHT:.0f}" '
        f'rx="{radius:.0f}" fill="{"#e3f2fd" if vertex.kind == "node" else "white"}" '
        f'stroke="{color}" stroke-width="1.4"><title>{title}</title></rect>'
    )
    yield (
        f'<text x="{x + width / 2:.1f}" y="{y + HEIGHT / 2 + 4:.1f}" fill="{color}" '
        f'text-anchor="middle">{escape(escaped(vertex.name, one_line=True))}</text>'
    )


def layered(picture: Picture) -> tuple[list[list[Key]], list[list[Key]]]:
    """Return the vertices in layers, with points for long edges, and the route of each edge."""
    keys: list[Key] = [(vertex.kind, vertex.name) for vertex in picture.vertices]
    layer = layers_of(keys, [(edge.source, edge.target) for edge in picture.edges])
    layers: list[list[Key]] = [[] for _ in range(max(layer.values(), default=-1) + 1)]
    for key in keys:
        layers[layer[key]].append(key)
    chains: list[list[Key]] = []
    for number, edge in enumerate(picture.edges):
        first, last = layer[edge.source], layer[edge.target]
        step = 1 if last >= first else -1
        between = [("", f"{number}.{at}") for at in range(first + step, last, step)]
        for at, point in zip(range(first + step, last, step), between, strict=True):
            layers[at].append(point)
        chains.append([edge.source, *between, edge.target])
    return ordered(layers, chains), chains


def layers_of(keys: list[Key], edges: list[tuple[Key, Key]]) -> dict[Key, int]:
    """Return the layer of each vertex: after all that lead to it, unless they form a cycle."""
    after: dict[Key, list[Key]] = defaultdict(list)
    leads_to: dict[Key, int] = defaultdict(int)
    for source, target in edges:
        after[source].append(target)
        leads_to[target] += 1
    layer = dict.fromkeys(keys, 0)
    left = dict.fromkeys(keys)
    while left:
        free = [key for key in left if leads_to[key] <= 0]
        # In a cycle, the vertex with the fewest edges to it goes first.
        taken = free or [min(left, key=lambda key: (leads_to[key], -len(after[key]), key))]
        for key in taken:
            del left[key]
            for target in after[key]:
                leads_to[target] -= 1
                if target in left:
                    layer[target] = max(layer[target], layer[key] + 1)
    return layer


def ordered(layers: list[list[Key]], chains: Iterable[list[Key]]) -> list[list[Key]]:
    """Return the layers, each sorted by the positions of its vertices' neighbours."""
    near: dict[Key, set[Key]] = defaultdict(set)
    for chain in chains:
        for one, other in itertools.pairwise(chain):
            near[one].add(other)
            near[other].add(one)
    for sweep in range(SWEEPS):
        numbers = range(len(layers)) if sweep % 2 == 0 else range(len(layers) - 1, -1, -1)
        for number in numbers:
            beside = layers[number - 1 if sweep % 2 == 0 else (number + 1) % len(layers)]
            position = {key: at for at, key in enumerate(beside)}
            old = {key: at for at, key in enumerate(layers[number])}

            def wish(
                key: Key, position: dict[Key, int] = position, old: dict[Key, int] = old
            ) -> float:
                places = [position[other] for other in near[key] if other in position]
                return sum(places) / len(places) if places else float(old[key])

            layers[number].sort(key=wish)
    return layers


def placed(layers: list[list[Key]]) -> dict[Key, tuple[float, float, float]]:
    """Return left, top and width of each vertex: layers side by side, each centred."""
    tallest = max((len(layer) for layer in layers), default=0)
    places: dict[Key, tuple[float, float, float]] = {}
    x = MARGIN
    for layer in layers:
        widths = [CHARACTER * len(name) + 20 if kind else 0.0 for kind, name in layer]
        widest = max(widths, default=0.0)
        room = tallest * (HEIGHT + GAP) / max(len(layer), 1)
        for number, (key, width) in enumerate(zip(layer, widths, strict=True)):
            y = MARGIN + room * (number + 0.5) - HEIGHT / 2
            places[key] = (x + (widest - width) / 2, y, width) if key[0] else (x, y, widest)
        x += math.ceil(widest) + BETWEEN
    return places
