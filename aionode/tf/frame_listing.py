"""Listings of all frames of a buffer, with rates and times, in tf2's formats."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from aionode.tf._frames import Frame, Tree

__all__ = [
    "FRAMES_SERVICE",
    "frames_as_dot",
    "frames_as_string",
    "frames_as_yaml",
    "rate_of",
    "seconds_text",
    "to_seconds",
]

FRAMES_SERVICE = "tf2_frames"
"""The service that returns all frames as YAML."""

NO_AUTHORITY = "no recorded authority"

MIN_NS = 100_000
"""Shortest history for which tf2 computes a rate, in nanoseconds."""


def to_seconds(ns: int) -> float:
    """Convert nanoseconds to seconds, rounded like tf2."""
    fraction = (
        int(math.fmod(ns, 1e9)) if abs(ns) < 2**53 else abs(ns) % 10**9 * (1 if ns > 0 else -1)
    )
    return 1e-9 * fraction + (ns - fraction) // 10**9


def seconds_text(ns: int) -> str:
    """Format a time in seconds with six decimals."""
    return f"{to_seconds(ns):.6f}"


def rate_of(frame: Frame) -> float:
    """Return the rate of transforms per second over the history of a frame."""
    return len(frame) * 1e9 / max(frame.newest_ns - frame.oldest_ns, MIN_NS)


def frames_as_string(frames: Tree) -> str:
    """Return a line per frame, with its parent."""
    lines = []
    for name, frame in frames.in_order().items():
        latest = frame.latest()
        parent = "NO_PARENT" if latest is None else latest[1]
        lines.append(f"Frame {name} exists with parent {parent}.\n")
    return "".join(lines)


def frames_as_yaml(frames: Tree, authorities: Mapping[str, str], now_ns: int = 0) -> str:
    """Return parent, broadcaster, rate and times of each frame, as YAML.

    Args:
        frames: The frames by name.
        authorities: Their senders.
        now_ns: The current time, for the age of the newest transforms; 0 omits it.
    """
    if not frames.names:
        return "[]"
    parts = []
    for name, frame in frames.in_order().items():
        latest = frame.latest()
        if latest is None:
            continue
        newest, oldest = frame.newest_ns, frame.oldest_ns
        parts.append(
            f"{name}: \n"
            f"  parent: '{latest[1]}'\n"
            f"  broadcaster: '{authorities.get(name, NO_AUTHORITY)}'\n"
            f"  rate: {rate_of(frame):.3f}\n"
            f"  most_recent_transform: {seconds_text(newest)}\n"
            f"  oldest_transform: {seconds_text(oldest)}\n"
        )
        if now_ns:
            parts.append(f"  transform_delay: {to_seconds(now_ns - newest):.3f}\n")
        parts.append(f"  buffer_length: {to_seconds(newest - oldest):.3f}\n")
    return "".join(parts)


def frames_as_dot(frames: Tree, authorities: Mapping[str, str], now_ns: int = 0) -> str:
    """Return the tree in Graphviz's language.

    Args:
        frames: The frames by name.
        authorities: Their senders.
        now_ns: The current time, for the age of the newest transforms; 0 omits it.
    """
    parts = ["digraph G {\n"]
    if not frames.names:
        parts.append('"no tf data recieved"')  # spelled as in tf2
    for name, frame in frames.in_order().items():
        latest = frame.latest()
        if latest is None:
            continue
        newest = frame.newest_ns
        age = f"( {to_seconds(now_ns - newest):.3f} sec old)" if now_ns else ""
        parts.append(
            f'"{latest[1]}" -> "{name}"[label="'
            f"Broadcaster: {authorities.get(name, NO_AUTHORITY)}\\n"
            f"Average rate: {rate_of(frame):.3f} Hz\\n"
            f"Most recent transform: {seconds_text(newest)} {age}\\n"
            f'Buffer length: {to_seconds(newest - frame.oldest_ns):.3f} sec\\n"];\n'
        )
    legend = ' subgraph cluster_legend { style=bold; color=black; label ="view_frames Result";\n'
    recorded = (
        f'"Recorded at time: {seconds_text(now_ns)}"[ shape=plaintext ] ;\n ' if now_ns else ""
    )
    for name in frames.names:
        known = frames.get(name)
        if (known is None and now_ns) or (known is not None and known.latest() is None):
            parts.append(f'edge [style=invis];\n{legend}{recorded}}}->"{name}";\n')
    parts.append("}")
    return "".join(parts)
