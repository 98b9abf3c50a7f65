"""Diagnose why a transform is missing, by listening to /tf."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.cli._nouns.doctor.diagnosis import Finding
from aionode.cli._nouns.tf.tree import edges_of, roots
from aionode.cli._support import lookup
from aionode.clock import Time
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from aionode.cli._nouns.tf.tree import FrameEdge
    from aionode.node import Node
    from aionode.tf import Buffer

__all__ = ["transform_findings"]

LISTEN_S = 1.5
"""Time to listen to /tf, in seconds."""

OLD_S = 5.0
"""Age from which a transform counts as no longer published, in seconds."""

AHEAD_S = 0.5
"""How far a stamp may be ahead of this machine's clock, in seconds."""


ZERO = Time()
"""Stands for the latest common time."""


async def transform_findings(node: Node, wanted: tuple[str, str] | None) -> list[Finding]:
    """Return findings about the transforms on the network.

    It listens only if there are publishers of /tf or /tf_static, or a transform is wanted.

    Args:
        node: The command's node.
        wanted: The target and source frame of a transform that is missing.
    """
    topics = {endpoint.name for endpoint in lookup.endpoints(node, EndpointKind.PUBLISHER)}
    if not topics & {"/tf", "/tf_static"} and wanted is None:
        return []
    from aionode.tf import Buffer as TfBuffer  # imported only where transforms are used

    buffer = TfBuffer(node)
    await node.get_clock().sleep(LISTEN_S)
    edges = edges_of(buffer, node.get_clock().now_ns())
    return [
        *missing(buffer, wanted),
        *unconnected(edges),
        # Stamps in simulated time cannot be compared with this machine's clock.
        *(() if "/clock" in topics else wrong_stamps(edges)),
        *two_broadcasters(buffer),
    ]


def missing(buffer: Buffer, wanted: tuple[str, str] | None) -> Iterator[Finding]:
    """Yield a finding if the wanted transform is missing, with tf2's reason."""
    if wanted is None:
        return
    target, source = wanted
    possible, reason = buffer.can_transform_core(target, source, ZERO)
    if possible:
        return
    known = buffer._getFrameStrings()
    remedy = "see `aionode tf tree`: a frame between them is not published, or has no parent"
    for name in wanted:
        if name not in known:
            close = lookup.close_to(name, known)
            remedy = f"no transform on /tf or /tf_static mentions '{name}'{close}"
    yield Finding("problem", f"transform from [{source}] to [{target}]", reason, remedy)


def unconnected(edges: Sequence[FrameEdge]) -> Iterator[Finding]:
    """Yield a finding if the frames form more than one tree."""
    trees = roots(edges)
    if len(trees) > 1:
        yield Finding(
            "hint",
            "/tf",
            f"the frames form {len(trees)} unconnected trees (roots: {', '.join(trees[:10])})",
            "publish the transform that connects them, for example with `aionode tf static`",
        )


def wrong_stamps(edges: Sequence[FrameEdge]) -> Iterator[Finding]:
    """Yield a finding for each frame whose newest transform is old, or in the future."""
    for edge in edges:
        if edge.static:
            continue
        if edge.age_sec > OLD_S:
            yield Finding(
                "hint",
                edge.child,
                f"its transform in {edge.parent} is {edge.age_sec:.1f} s old, from "
                f"{edge.broadcaster}",
                "check that the node still publishes, and that the clocks of both machines agree",
            )
        elif edge.age_sec < -AHEAD_S:
            yield Finding(
                "hint",
                edge.child,
                f"its transform in {edge.parent} is {-edge.age_sec:.1f} s ahead of this clock, "
                f"from {edge.broadcaster}",
                "synchronize the clocks of both machines, or set use_sim_time in both nodes",
            )


def two_broadcasters(buffer: Buffer) -> Iterator[Finding]:
    """Yield a finding for each frame that two nodes publish."""
    from aionode.tf.buffer_core import authorities_of, rivals_of  # as above

    for frame, rival in rivals_of(buffer).items():
        yield Finding(
            "hint",
            frame,
            f"{rival} and {authorities_of(buffer)[frame]} both publish its transform",
            "stop one of them, or rename its frame",
        )
