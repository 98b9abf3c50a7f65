"""The path between two frames through the tree, or the reason why there is none."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.errors import (
    BackwardExtrapolationException,
    ConnectivityException,
    ForwardExtrapolationException,
    LookupException,
    NoDataForExtrapolationException,
    TransformException,
)
from aionode.tf._arithmetic import Pose, chained, composed, inverted
from aionode.tf.frame_listing import frames_as_string, seconds_text

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.tf._arithmetic import Edge
    from aionode.tf._frames import Tree

__all__ = ["MAX_DEPTH", "Failure", "Walk", "latest_common_ns", "walk"]

MAX_DEPTH = 1000
"""Maximum edges of a path; beyond that, tf2 assumes a loop."""


class Failure:
    """Why there is no transform.

    Attributes:
        error: The class of the exception.
        frame: The frame that has no data for the time; empty if the tree is at fault.
    """

    __slots__ = ("_text", "error", "frame")

    def __init__(
        self, error: type[TransformException], text: Callable[[], str], frame: str = ""
    ) -> None:
        self.error = error
        self.frame = frame
        # A waiter only asks whether there is a transform, so the text is created lazily.
        self._text = text

    @property
    def text(self) -> str:
        """The message, as in tf2."""
        return self._text()

    def exception(self) -> TransformException:
        """Return the exception."""
        return self.error(self.text)


class Walk:
    """The path from a source frame up to a common ancestor, and from a target frame up to it.

    Attributes:
        time_ns: The time of the transforms; the latest common time, if requested.
        up: The edges from the source, the innermost first.
        down: The edges from the target.
        visited: The frames on which the outcome depends.
        failure: Why there is no path; None if there is one.
    """

    __slots__ = ("down", "failure", "time_ns", "up", "visited")

    def __init__(self, time_ns: int) -> None:
        self.time_ns = time_ns
        self.up: list[Edge] = []
        self.down: list[Edge] = []
        self.visited: list[str] = []
        self.failure: Failure | None = None

    def pose(self) -> Pose:
        """Return the pose of the source in the target, with a quaternion of any length."""
        source = chained(self.up)
        if not self.down:
            return source
        return composed(inverted(chained(self.down)), source)


def walk(frames: Tree, target: str, source: str, time_ns: int) -> Walk:
    """Return the path from `source` to `target` at a time; 0 means the latest common time.

    The order of the steps is tf2's, since it decides which error is reported: first from the source
    to the root, or as far as there is data, then from the target until both meet. An error names an
    edge of the path and none above it, unlike tf2 before its pull request 896.
    """
    way = Walk(time_ns)
    if target == source:
        return way
    if time_ns == 0:
        latest = latest_common_ns(frames, target, source)
        if isinstance(latest, Failure):
            way.failure = latest
            way.visited = [*ancestors(frames, source), *ancestors(frames, target)]
            return way
        way.time_ns = latest
    counts = walk_up(frames, way, target, source)
    if counts is not None and way.failure is None:
        walk_down(frames, way, target, source, counts)
    return way


def walk_up(frames: Tree, way: Walk, target: str, source: str) -> dict[str, int] | None:
    """Walk from the source to the root, or as far as there is data.

    Returns:
        For each reached frame, the number of edges to it; None if the target is reached.
    """
    counts: dict[str, int] = {}
    frame = source
    while True:
        counts[frame] = len(way.up)
        way.visited.append(frame)
        history = frames.get(frame)
        nearest = None if history is None else history.find(way.time_ns)
        if nearest is None:
            return counts
        if frame == target:
            return None
        frame, edge = nearest
        way.up.append(edge)
        if len(way.up) > MAX_DEPTH:
            way.failure = loop(frames)
            return counts


def walk_down(frames: Tree, way: Walk, target: str, source: str, counts: dict[str, int]) -> None:
    """Walk from the target to a frame reached from the source."""
    last = way.visited[-1]  # the root, or a frame without data with the target perhaps above it
    frame = target
    while frame not in counts:
        way.visited.append(frame)
        history = frames.get(frame)
        if history is None:
            way.failure = (
                extrapolation(frames, last, way.time_ns, target, source)
                if last in frames
                else unconnected(target, source)
            )
            return
        nearest = history.find(way.time_ns)
        if nearest is None:
            # If the source's path ends below this frame, this edge is above the meeting point.
            missing = last if frame in ancestors(frames, last) else frame
            way.failure = extrapolation(frames, missing, way.time_ns, target, source)
            return
        frame, edge = nearest
        way.down.append(edge)
        if len(way.down) > MAX_DEPTH:
            way.failure = loop(frames)
            return
    del way.up[counts[frame] :]


def latest_common_ns(frames: Tree, target: str, source: str) -> int | Failure:
    """Return the newest time for which all dynamic frames between two frames have data.

    It is 0 if all of them are static.
    """
    stamps: list[int] = []
    above: dict[str, int] = {}  # for each ancestor of the source, the number of edges to it
    frame = source
    while (history := frames.get(frame)) is not None and (latest := history.latest()) is not None:
        stamp, frame = latest
        stamps.append(stamp)
        above.setdefault(frame, len(stamps))
        if frame == target:
            return lowest(stamps)
        if len(stamps) > MAX_DEPTH:
            return loop(frames)
    of_target: list[int] = []
    frame = target
    while (history := frames.get(frame)) is not None and (latest := history.latest()) is not None:
        stamp, frame = latest
        of_target.append(stamp)
        if frame in above:
            return lowest(of_target + stamps[: above[frame]])
        if frame == source:
            return lowest(of_target)
        if len(of_target) > MAX_DEPTH:
            return loop(frames)
    return unconnected(target, source)


def lowest(stamps: list[int]) -> int:
    """Return the lowest non-zero stamp; 0 belongs to static frames."""
    return min((stamp for stamp in stamps if stamp), default=0)


def ancestors(frames: Tree, frame: str) -> list[str]:
    """Return a frame and its current ancestors, up to one without a parent."""
    chain = [frame]
    while (history := frames.get(frame)) is not None and (latest := history.latest()) is not None:
        frame = latest[1]
        chain.append(frame)
        if len(chain) > MAX_DEPTH:
            break
    return chain


def loop(frames: Tree) -> Failure:
    """Return the failure for a tree with a loop."""
    return Failure(
        LookupException,
        lambda: f"The tf tree is invalid because it contains a loop.\n{frames_as_string(frames)}\n",
    )


def unconnected(target: str, source: str) -> Failure:
    """Return the failure for two frames in different trees."""
    return Failure(
        ConnectivityException,
        lambda: (
            f"Could not find a connection between '{target}' and '{source}' because they are "
            "not part of the same tree.Tf has two or more unconnected trees."
        ),
    )


def extrapolation(frames: Tree, missing: str, time_ns: int, target: str, source: str) -> Failure:
    """Return the failure for a frame without data for a time."""
    frame = frames[missing]
    wanted = seconds_text(time_ns)
    oldest_ns, newest_ns = frame.oldest_ns, frame.newest_ns
    error: type[TransformException]
    if len(frame) < 2:
        error = NoDataForExtrapolationException
        text = f"at time {wanted}, but only time {seconds_text(newest_ns)} is in the buffer"
    elif time_ns > newest_ns:
        error = ForwardExtrapolationException
        text = (
            f"into the future.  Requested time {wanted} but the latest data is at time "
            f"{seconds_text(newest_ns)}"
        )
    else:
        error = BackwardExtrapolationException
        text = (
            f"into the past.  Requested time {wanted} but the earliest data is at time "
            f"{seconds_text(oldest_ns)}"
        )
    whole = (
        f"Lookup would require extrapolation {text}, when looking up transform from frame "
        f"[{source}] to frame [{target}]"
    )
    return Failure(error, lambda: whole, missing)
