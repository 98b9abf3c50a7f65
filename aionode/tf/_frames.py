"""A frame in a buffer: its history, or the single pose of a static frame."""

from __future__ import annotations

from bisect import bisect_right
from typing import TYPE_CHECKING

from aionode.tf._arithmetic import interpolated

if TYPE_CHECKING:
    from aionode.tf._arithmetic import Edge, Pose

__all__ = ["MAX_SAMPLES", "DynamicFrame", "Frame", "Room", "StaticFrame", "Tree"]

MAX_SAMPLES = 1_000_000
"""Maximum poses that a buffer stores for all frames together, some 340 MB."""

MAX_EQUAL = 100
"""How many poses with the same stamp are searched for an exact duplicate."""

COMPACT = 64
"""Maximum expired poses at the start of a history before they are removed together."""


class Room:
    """The number of poses that the frames of one buffer may still store."""

    __slots__ = ("left",)

    def __init__(self, left: int = MAX_SAMPLES) -> None:
        self.left = left


class DynamicFrame:
    """The history of a frame whose transform changes, sorted by stamp.

    Equal stamps are kept in order of arrival; exact duplicates are not stored.

    Args:
        max_ns: How much older than the newest pose a pose may be, in nanoseconds.
        room: Shared by the frames of a buffer. When it is used up, histories stop growing: each new
            pose replaces the oldest one.
    """

    __slots__ = ("first", "max_ns", "parents", "poses", "reparented", "room", "stamps")

    is_static = False

    def __init__(self, max_ns: int, room: Room) -> None:
        self.max_ns = max_ns
        self.room = room
        self.stamps: list[int] = []
        self.parents: list[str] = []
        self.poses: list[Pose] = []
        # The index of the oldest valid pose, as removing each from the front of the list would move
        # all others every time.
        self.first = 0
        self.reparented = False  # whether the history has, or had, more than one parent

    def __len__(self) -> int:
        return len(self.stamps) - self.first

    def insert(self, stamp_ns: int, parent: str, pose: Pose) -> bool:
        """Add a pose; return False if it is older than the history."""
        stamps = self.stamps
        if not stamps:
            self._put(0, stamp_ns, parent, pose)
            return True
        if parent != self.parents[-1]:
            self.reparented = True
        newest = stamps[-1]
        if stamps[self.first] < newest - self.max_ns:
            self._forget(newest - self.max_ns)
        if stamp_ns > newest:
            self._put(len(stamps), stamp_ns, parent, pose)
        elif stamp_ns < newest - self.max_ns:
            return False
        else:
            index = bisect_right(stamps, stamp_ns, self.first)
            if not self._has(index, stamp_ns, parent, pose):
                self._put(index, stamp_ns, parent, pose)
        return True

    def _put(self, index: int, stamp_ns: int, parent: str, pose: Pose) -> None:
        self.stamps.insert(index, stamp_ns)
        self.parents.insert(index, parent)
        self.poses.insert(index, pose)
        if self.room.left > 0:
            self.room.left -= 1
        elif len(self) > 1:
            self.first += 1
            self._compact()

    def _has(self, index: int, stamp_ns: int, parent: str, pose: Pose) -> bool:
        """Return whether this exact pose is among those of its stamp, which end before `index`."""
        for before in range(index - 1, max(self.first, index - MAX_EQUAL) - 1, -1):
            if self.stamps[before] != stamp_ns:
                return False
            if self.poses[before] == pose and self.parents[before] == parent:
                return True
        return False

    def _forget(self, before_ns: int) -> None:
        """Drop the poses older than a stamp."""
        kept = bisect_right(self.stamps, before_ns - 1, self.first)
        self.room.left += kept - self.first
        self.first = kept
        self._compact()

    def _compact(self) -> None:
        if self.first > COMPACT and self.first * 2 > len(self.stamps):
            del self.stamps[: self.first], self.parents[: self.first], self.poses[: self.first]
            self.first = 0

    def pose_at(self, time_ns: int) -> Pose | None:
        """Return the pose at a time, for histories with one parent; None as in `find`."""
        stamps = self.stamps
        index = bisect_right(stamps, time_ns, self.first)
        if self.first < index < len(stamps):
            stamp = stamps[index - 1]
            if stamp != time_ns:
                ratio = (time_ns - stamp) / (stamps[index] - stamp)
                return interpolated(self.poses[index - 1], self.poses[index], ratio)
        nearest = self.find(time_ns)
        return None if nearest is None else nearest[1][0]

    def find(self, time_ns: int) -> tuple[str, Edge] | None:
        """Return the parent and the pose at a time; None if outside the history.

        Args:
            time_ns: 0 means the newest.
        """
        stamps = self.stamps
        last = len(stamps) - 1
        if last < 0:
            return None
        newest = stamps[last]
        if time_ns in (newest, 0):
            return self.parents[last], (self.poses[last], None, 0.0)
        first = self.first
        if time_ns > newest or time_ns < stamps[first]:
            return None
        # Of equal stamps tf2 uses the last one, but for the oldest stamp the first one.
        index = first if time_ns == stamps[first] else bisect_right(stamps, time_ns, first) - 1
        stamp = stamps[index]
        parents, poses = self.parents, self.poses
        parent = parents[index]
        if stamp == time_ns or parents[index + 1] != parent:
            return parent, (poses[index], None, 0.0)
        ratio = (time_ns - stamp) / (stamps[index + 1] - stamp)
        return parent, (poses[index], poses[index + 1], ratio)

    @property
    def newest_ns(self) -> int:
        """The newest stamp; 0 if there is none."""
        return self.stamps[-1] if self.stamps else 0

    @property
    def oldest_ns(self) -> int:
        """The oldest stamp; 0 if there is none."""
        return self.stamps[self.first] if self.stamps else 0

    def latest(self) -> tuple[int, str] | None:
        """Return the newest stamp and its parent; None if there is none."""
        return (self.stamps[-1], self.parents[-1]) if self.stamps else None

    def clear(self) -> None:
        """Drop all poses."""
        self.room.left += len(self)
        self.stamps.clear()
        self.parents.clear()
        self.poses.clear()
        self.first = 0
        self.reparented = False


class StaticFrame:
    """The single pose of a static frame; a new one replaces it."""

    __slots__ = ("parent", "pose")

    is_static = True
    reparented = False
    newest_ns = 0
    oldest_ns = 0

    def __init__(self, parent: str, pose: Pose) -> None:
        self.parent = parent
        self.pose = pose

    def __len__(self) -> int:
        return 1

    def insert(self, stamp_ns: int, parent: str, pose: Pose) -> bool:  # noqa: ARG002  # as `DynamicFrame`
        """Replace the pose."""
        self.parent, self.pose = parent, pose
        return True

    def pose_at(self, time_ns: int) -> Pose:  # noqa: ARG002  # it is the same at any time
        """Return the pose."""
        return self.pose

    def find(self, time_ns: int) -> tuple[str, Edge]:  # noqa: ARG002  # it is the same at any time
        """Return the parent and the pose."""
        return self.parent, (self.pose, None, 0.0)

    def latest(self) -> tuple[int, str]:
        """Return 0, as the pose is valid at any time, and the parent."""
        return 0, self.parent

    def clear(self) -> None:
        """Keep the pose, as tf2 does."""


Frame = DynamicFrame | StaticFrame


class Tree(dict[str, Frame]):
    """The frames that have had a transform, by name.

    Attributes:
        names: All frames ever mentioned, even as parents, in order of first mention.
    """

    def __init__(self) -> None:
        super().__init__()
        self.names: dict[str, None] = {}

    def in_order(self) -> dict[str, Frame]:
        """Return the frames in the order of `names`, as listed by tf2."""
        return {name: self[name] for name in self.names if name in self}
