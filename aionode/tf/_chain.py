"""The names of the frames between two frames, as returned by tf2."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.tf._walk import walk

if TYPE_CHECKING:
    from aionode.tf._frames import Tree

__all__ = ["chain"]


def chain(frames: Tree, target: tuple[str, int], source: tuple[str, int], fixed: str) -> list[str]:
    """Return the frames between a source and a target, via a fixed frame.

    tf2 omits some of the frames where both branches meet, and so does this.

    Args:
        frames: The frames by name.
        target: The target frame and its time, in nanoseconds.
        source: The source frame and its time, in nanoseconds.
        fixed: The frame that is fixed between the two times.

    Raises:
        TransformException: there is no such chain.
    """
    way = chain_at(frames, fixed, *source)
    if source[1] == target[1]:
        return way
    to_target = chain_at(frames, target[0], fixed, target[1])
    n, m = common_end(way, to_target)
    if n:
        del way[n - 1 :]
    if m < len(to_target):
        way += to_target[: m + 1]
    return way


def chain_at(frames: Tree, target: str, source: str, time_ns: int) -> list[str]:
    """Return the frames between two frames at one time."""
    if target == source:
        return []
    way = walk(frames, target, source, time_ns)
    if way.failure is not None:
        raise way.failure.exception()
    up = to_top(frames, source, way.time_ns, stop=target)
    if up[-1] == target:
        return up
    down = to_top(frames, target, way.time_ns, stop=source)
    if down[-1] == source:
        return down
    if down[-1] == up[-1]:
        down.pop()
    n, m = common_end(up, down)
    if n:
        del up[n - 1 :]
    if m < len(down):
        up += reversed(down[: m + 1])
    return up


def to_top(frames: Tree, frame: str, time_ns: int, *, stop: str) -> list[str]:
    """Return a frame and its ancestors at a time, up to the root or to `stop`."""
    chain = [frame]
    while frame != stop:
        history = frames.get(frame)
        above = None if history is None else history.find(time_ns)
        if above is None:
            break
        frame = above[0]
        chain.append(frame)
    return chain


def common_end(first: list[str], second: list[str]) -> tuple[int, int]:
    """Return the indices at which two lists, compared from the end, first differ."""
    n, m = len(first), len(second)
    while n > 0 and m > 0:
        n -= 1
        m -= 1
        if first[n] != second[m]:
            break
    return n, m
