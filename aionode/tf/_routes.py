"""Paths through the tree that are valid at any time, so that most lookups need no walk."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.tf._arithmetic import IDENTITY, Pose, composed, inverted
from aionode.tf._walk import MAX_DEPTH, lowest

if TYPE_CHECKING:
    from aionode.tf._frames import Frame, Tree

__all__ = ["Route", "Routes"]

MAX_ROUTES = 1_000
"""Maximum routes cached by a buffer."""


class Route:
    """The frames between two frames; they and their ancestors only ever had one parent."""

    __slots__ = ("down", "names", "up")

    def __init__(self, up: list[Frame], down: list[Frame], names: list[str]) -> None:
        self.up = up
        self.down = down
        self.names = names

    def latest_ns(self) -> int:
        """Return the newest time for which all dynamic frames have data; 0 if none is dynamic."""
        return lowest([frame.newest_ns for frame in (*self.up, *self.down)])

    def pose(self, time_ns: int) -> Pose | None:
        """Return the pose of the source in the target; None if a frame has no data for the time."""
        source = pose_over(self.up, time_ns)
        if not self.down or source is None:
            return source
        target = pose_over(self.down, time_ns)
        return None if target is None else composed(inverted(target), source)


def pose_over(frames: list[Frame], time_ns: int) -> Pose | None:
    """Compose the poses of a series of frames; None if one has no data for the time."""
    total = None
    for frame in frames:
        pose = frame.pose_at(time_ns)
        if pose is None:
            return None
        total = pose if total is None else composed(pose, total)
    return total or IDENTITY


class Routes:
    """The routes of a buffer, cached until the tree changes.

    Args:
        frames: The frames of the buffer.
    """

    def __init__(self, frames: Tree) -> None:
        self._frames = frames
        self._known: dict[tuple[str, str], Route | None] = {}

    def forget(self) -> None:
        """Drop all routes, as a frame is new, of another kind, or has another parent."""
        self._known.clear()

    def find(self, target: str, source: str) -> Route | None:
        """Return the route between two frames; None if it takes a walk."""
        key = target, source
        known = self._known.get(key)
        if known is not None or key in self._known:
            return known
        if len(self._known) >= MAX_ROUTES:
            self._known.clear()
        route = self._known[key] = self._search(target, source)
        return route

    def _search(self, target: str, source: str) -> Route | None:
        if target == source:
            return None  # its stamp is the frame's own
        above_source = self._above(source)
        above_target = self._above(target)
        common = next((name for name in above_source if name in above_target), None)
        if common is None:
            return None
        up = above_source[: above_source.index(common)]
        down = above_target[: above_target.index(common)]
        frames = self._frames
        # Also above the common ancestor, where at another time the walk may have met the target.
        if any(frames[name].reparented for name in (*above_source, *down) if name in frames):
            return None
        return Route([frames[name] for name in up], [frames[name] for name in down], [*up, *down])

    def _above(self, frame: str) -> list[str]:
        """Return a frame and its ancestors; empty if they form a loop."""
        chain = [frame]
        while (history := self._frames.get(frame)) is not None:
            latest = history.latest()
            if latest is None:
                break
            frame = latest[1]
            chain.append(frame)
            if len(chain) > MAX_DEPTH:
                return []
        return chain
