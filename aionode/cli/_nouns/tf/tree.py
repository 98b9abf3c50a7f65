"""The tree of frames as text and as an image."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from aionode.tf.buffer_core import authorities_of, frames_of
from aionode.tf.frame_listing import rate_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from aionode.tf import BufferCore

__all__ = ["FrameEdge", "as_svg", "as_text", "edges_of"]

WIDTH, HEIGHT = 170, 92
"""The space for one frame in the image, in pixels."""

BOX = 30
"""The height of a frame's box, in pixels."""


@dataclass(frozen=True, slots=True)
class FrameEdge:
    """One transform of the tree.

    Attributes:
        child: The frame.
        parent: Its parent frame.
        static: Whether it never changes.
        broadcaster: The node that publishes it.
        rate_hz: Its rate; 0 for static transforms.
        age_sec: The age of the newest one; 0 for static transforms.
    """

    child: str
    parent: str
    static: bool
    broadcaster: str
    rate_hz: float
    age_sec: float

    def record(self) -> dict[str, Any]:
        """Return the transform as a record."""
        return asdict(self)

    def facts(self) -> str:
        """Return what is known about it, in a few words."""
        if self.static:
            return f"static, {self.broadcaster}"
        return f"{self.rate_hz:.1f} Hz, {self.age_sec:.3f} s old, {self.broadcaster}"


def edges_of(core: BufferCore, now_ns: int) -> list[FrameEdge]:
    """Return the transforms of a buffer, sorted by name.

    Args:
        core: The buffer.
        now_ns: The current time, from which ages are computed.
    """
    edges = []
    for name, frame in sorted(frames_of(core).items()):
        latest = frame.latest()
        if latest is None:
            continue
        static = frame.is_static
        edges.append(
            FrameEdge(
                child=name,
                parent=latest[1],
                static=static,
                broadcaster=authorities_of(core).get(name, ""),
                rate_hz=0.0 if static or len(frame) < 2 else rate_of(frame),
                age_sec=0.0 if static else (now_ns - latest[0]) / 1e9,
            )
        )
    return edges


def roots(edges: Sequence[FrameEdge]) -> list[str]:
    """Return the frames without a parent; for a loop, one of its frames."""
    children = {edge.child for edge in edges}
    heads = sorted({edge.parent for edge in edges} - children)
    reached = set(heads)
    for root in heads:
        reached.update(name for _, name, _ in walked(edges, root))
    for edge in edges:
        if edge.child not in reached:  # only loops are left
            heads.append(edge.child)
            reached.add(edge.child)
            reached.update(name for _, name, _ in walked(edges, edge.child))
    return heads


def walked(edges: Sequence[FrameEdge], root: str) -> Iterator[tuple[str, str, FrameEdge]]:
    """Yield what is below a frame, depth first: the line's prefix, the frame's name, its edge."""
    below: dict[str, list[FrameEdge]] = {}
    for edge in edges:
        below.setdefault(edge.parent, []).append(edge)
    seen = {root}
    stack: list[tuple[str, str, Iterator[FrameEdge]]] = [("", root, iter(below.get(root, [])))]
    while stack:
        prefix, name, rest = stack[-1]
        following = next(rest, None)
        if following is None:
            stack.pop()
        elif following.child not in seen:  # otherwise it is a loop
            child = following.child
            seen.add(child)
            is_last = following is below[name][-1]
            yield prefix + ("└── " if is_last else "├── "), child, following
            indent = prefix + ("    " if is_last else "│   ")
            stack.append((indent, child, iter(below.get(child, []))))


def as_text(edges: Sequence[FrameEdge]) -> str:
    """Return the tree as lines of text."""
    lines = []
    for root in roots(edges):
        lines.append(root)
        lines_of_tree = list(walked(edges, root))
        width = max((len(prefix) + len(name) for prefix, name, _ in lines_of_tree), default=0)
        lines += [
            f"{prefix + name:{width}}  {edge.facts()}" for prefix, name, edge in lines_of_tree
        ]
    return "\n".join(lines)


def as_svg(edges: Sequence[FrameEdge]) -> str:
    """Return the tree as an SVG image."""
    places = placed(edges)
    wide = max((x for x, _ in places.values()), default=0.0) + 1
    high = max((y for _, y in places.values()), default=0) + 1
    parts = [
        (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide * WIDTH:.0f}" '
            f'height="{high * HEIGHT:.0f}" font-family="sans-serif" font-size="12">'
        ),
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    parts += [
        line(places[edge.parent], places[edge.child], edge)
        for edge in edges
        if edge.parent in places and edge.child in places
    ]
    for name, (x, y) in places.items():
        left, top = x * WIDTH + 10, y * HEIGHT + 10
        middle = left + (WIDTH - 20) / 2
        parts.append(
            f'<rect x="{left:.0f}" y="{top}" width="{WIDTH - 20}" height="{BOX}" rx="6" '
            f'fill="#e8f0fe" stroke="#3367d6"/>'
            f'<text x="{middle:.0f}" y="{top + 19}" text-anchor="middle">{shown(name, 22)}</text>'
        )
    return "\n".join([*parts, "</svg>\n"])


def line(above: tuple[float, int], below: tuple[float, int], edge: FrameEdge) -> str:
    """Return the SVG line between two frames, labelled with what is known about the transform."""
    x1, y1 = above[0] * WIDTH + WIDTH / 2, above[1] * HEIGHT + 10 + BOX
    x2, y2 = below[0] * WIDTH + WIDTH / 2, below[1] * HEIGHT + 10
    dash = ' stroke-dasharray="4 3"' if edge.static else ""
    rate = "static" if edge.static else f"{edge.rate_hz:.1f} Hz"
    texts = (rate, edge.broadcaster)
    return f'<line x1="{x1:.0f}" y1="{y1}" x2="{x2:.0f}" y2="{y2}" stroke="#555"{dash}/>' + "".join(
        f'<text x="{x2 + 5:.0f}" y="{y2 - 22 + 13 * number}" font-size="10" fill="#555">'
        f"{shown(text, 24)}</text>"
        for number, text in enumerate(texts)
    )


def shown(name: str, limit: int) -> str:
    """Return a name as shown in the image."""
    return escape(name if len(name) <= limit else f"{name[: limit - 1]}…")


def placed(edges: Sequence[FrameEdge]) -> dict[str, tuple[float, int]]:
    """Return the position of each frame: column and row. Parents are above their children."""
    depths: dict[str, int] = {}
    order: list[str] = []
    for root in roots(edges):
        depths[root] = 0
        order.append(root)
        for _, name, edge in walked(edges, root):
            depths[name] = depths[edge.parent] + 1
            order.append(name)
    columns: dict[str, float] = {}
    leaves = 0
    for name in reversed(order):  # children come before their parents
        below = [columns[e.child] for e in edges if e.parent == name and e.child in columns]
        if below:
            columns[name] = sum(below) / len(below)
        else:
            columns[name] = float(leaves)
            leaves += 1
    last = max(columns.values(), default=0.0)
    return {name: (last - columns[name], depths[name]) for name in order}
