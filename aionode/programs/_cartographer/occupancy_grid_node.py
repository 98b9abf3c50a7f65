"""``cartographer_ros cartographer_occupancy_grid_node``: submaps of Cartographer as one map."""

from __future__ import annotations

import asyncio
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

import aionode
from aionode import DurabilityPolicy, Node, QoSProfile
from aionode.arguments import remove_ros_args
from aionode.errors import (
    CommandError,
    RequestTimeoutError,
    ServiceError,
    ServiceUnavailableError,
    brief,
    escaped,
)
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.cartographer_ros_msgs.msg import StatusCode, SubmapEntry, SubmapList
from aionode.interfaces.cartographer_ros_msgs.srv import SubmapQuery
from aionode.interfaces.geometry_msgs.msg import Point, Pose, Quaternion
from aionode.interfaces.nav_msgs.msg import MapMetaData, OccupancyGrid
from aionode.interfaces.std_msgs.msg import Header
from aionode.programs._cartographer.canvas import Base, Canvas
from aionode.programs._cartographer.submaps import (
    Array,
    Submap,
    Texture,
    placement_of,
    texture_of,
)
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["Flags", "OccupancyGridNode", "flags_of", "main"]

MAX_SUBMAPS: Final = 10_000
MAX_CELLS: Final = 1 << 27
"""The most cells of all submaps together, in 400 MB."""

TELL_SEC: Final = 10.0
"""How often a lasting problem is logged."""

NUMBERS: Final = (0.001, 100_000)
"""The least and the largest number of a flag."""

YES: Final = ("1", "t", "true", "y", "yes")
NO: Final = ("0", "f", "false", "n", "no")
"""The values of a switch, as in gflags."""

IGNORED: Final = "occupancy_grid_topic"
"""A flag that the original accepts, but ignores in ROS 2."""


@dataclass
class Flags:
    """The options of the command line, with the names of the original."""

    resolution: float = 0.05
    publish_period_sec: float = 1.0
    include_frozen_submaps: bool = True
    include_unfrozen_submaps: bool = True


def flags_of(words: Sequence[str]) -> tuple[Flags, list[str]]:
    """Return the flags of a command line, written as in gflags, and those that have no effect.

    Raises:
        CommandError: A flag has no value, or an invalid one.
    """
    flags = Flags()
    ignored = []
    rest = iter(words)
    for word in rest:
        if word == "--":
            break
        if not word.startswith("-") or word == "-":
            continue
        name, is_given, value = word.removeprefix("-").removeprefix("-").partition("=")
        negated = name.removeprefix("no")
        if name.startswith("no") and isinstance(getattr(flags, negated, None), bool):
            setattr(flags, negated, False)
        elif isinstance(getattr(flags, name, None), bool):
            setattr(flags, name, switch_of(name, value) if is_given else True)
        elif name == IGNORED or isinstance(getattr(flags, name, None), float):
            text = value if is_given else next(rest, None)
            if text is None:
                raise CommandError(f"-{name} has no value; use -{name} VALUE")
            if name == IGNORED:
                ignored.append(name)
            else:
                setattr(flags, name, number_of(name, text))
        else:
            ignored.append(name)
    if not flags.include_frozen_submaps and not flags.include_unfrozen_submaps:
        raise CommandError("Ignoring both frozen and unfrozen submaps makes no sense.")
    return flags, ignored


def switch_of(name: str, text: str) -> bool:
    """Return the value of a switch.

    Raises:
        CommandError: The text is neither true nor false.
    """
    if text.lower() not in YES + NO:
        raise CommandError(f"-{name} is {text!r}; use true or false")
    return text.lower() in YES


def number_of(name: str, text: str) -> float:
    """Return a number of metres or seconds.

    Raises:
        CommandError: The text is not a number, or out of range.
    """
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    low, high = NUMBERS
    if not low <= number <= high:
        raise CommandError(f"-{name} is {text!r}; use a number from {low} to {high}")
    return number


class OccupancyGridNode(Node):
    """Publishes the submaps of `submap_list` as one map, which late subscriptions get too."""

    def __init__(self, flags: Flags, ignored: Sequence[str] = ()) -> None:
        super().__init__("cartographer_occupancy_grid_node")
        self.flags = flags
        self.submaps: dict[tuple[int, int], Submap] = {}
        self.painted: list[Submap] = []
        self.base: Base | None = None
        self.map = (np.empty((0, 0), np.int8), (0.0, 0.0))
        self.frame_id = ""
        self.stamp = Time()
        if ignored:
            self.get_logger().warning(f"these arguments have no effect: {', '.join(ignored)}")
        self.client = self.create_client(SubmapQuery, "submap_query")
        # The original keeps ten maps for late subscriptions, which only need the last one.
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.publisher = self.create_publisher(OccupancyGrid, "map", latched)
        # Only the latest list counts, and the original asks for the submaps of older ones first.
        self.create_subscription(SubmapList, "submap_list", self.on_submap_list, 1)
        create_wall_timer(self, flags.publish_period_sec, self.publish)

    async def on_submap_list(self, msg: SubmapList) -> None:
        """Move the submaps, and get those that are new or have changed."""
        if len(msg.submap) > MAX_SUBMAPS:
            self.warn(f"submap_list has {len(msg.submap)} submaps; at most {MAX_SUBMAPS} are used")
        found: dict[tuple[int, int], Submap] = {}
        cells = 0
        answers = True
        for entry in msg.submap[:MAX_SUBMAPS]:
            if not self.is_included(entry):
                continue
            key = (entry.trajectory_id, entry.submap_index)
            known = self.submaps.get(key)
            texture = known.texture if known else None
            try:
                placement = placement_of(entry.pose)
            except ValueError as error:
                self.warn(f"submap {key}: {error}")
                continue
            if answers and (texture is None or texture.version != entry.submap_version):
                try:
                    texture = await self.fetch(key)
                except (RequestTimeoutError, ServiceUnavailableError):
                    answers = False  # the next list asks again, rather than each submap of this one
                    self.warn("submap_query does not answer; it is a service of cartographer_node")
                except (ValueError, ServiceError) as error:
                    self.warn(f"submap {key}: {error}")
            if texture is None:
                continue
            cells += texture.cells.shape[0] * texture.cells.shape[1]
            if cells > MAX_CELLS:
                self.warn(f"submap {key} and later ones: all have more than {MAX_CELLS} cells")
                break
            found[key] = Submap(placement, texture)
        self.submaps = found
        self.frame_id = msg.header.frame_id
        self.stamp = msg.header.stamp

    def is_included(self, entry: SubmapEntry) -> bool:
        """Return whether a submap is part of the map."""
        if entry.is_frozen:
            return self.flags.include_frozen_submaps
        return self.flags.include_unfrozen_submaps

    async def fetch(self, key: tuple[int, int]) -> Texture:
        """Return a submap in its finest resolution, which is the first one by convention.

        Raises:
            ValueError: There is none.
            RequestTimeoutError: The service does not answer in time.
            ServiceError: The service failed, or went away.
        """
        trajectory, index = key
        request = SubmapQuery.Request(trajectory_id=trajectory, submap_index=index)
        answer = await self.client.call(request, self.flags.publish_period_sec)
        if answer.status.code != StatusCode.OK or not answer.textures:
            raise ValueError(
                f"submap_query has none: status {answer.status.code} {brief(answer.status.message)}"
            )
        return await asyncio.to_thread(texture_of, answer.textures[0], answer.submap_version)

    async def publish(self) -> None:
        """Publish the map; paint it anew if a submap has changed."""
        if not self.submaps or not self.frame_id:
            return
        submaps = [self.submaps[key] for key in sorted(self.submaps)]
        header = Header(stamp=self.stamp, frame_id=self.frame_id)
        if submaps != self.painted:
            try:
                self.map = await self.paint(submaps)
            except ValueError as error:
                self.warn(f"no map is published: {error}")
                return
            self.painted = submaps
        cells, (x, y) = self.map
        height, width = cells.shape
        info = MapMetaData(
            map_load_time=header.stamp,
            resolution=self.flags.resolution,
            width=width,
            height=height,
            origin=Pose(position=Point(x=x, y=y), orientation=Quaternion(w=1.0)),
        )
        self.publisher.publish(OccupancyGrid(header=header, info=info, data=cells.reshape(-1)))

    async def paint(self, submaps: list[Submap]) -> tuple[Array, tuple[float, float]]:
        """Return a map and its origin; threads do the work, and stop soon if the node ends.

        Raises:
            ValueError: It would be too large.
        """
        canvas = await asyncio.to_thread(Canvas, submaps, self.flags.resolution, self.base)
        strokes = canvas.strokes()
        while await asyncio.to_thread(next, strokes, False):
            pass
        self.base = canvas.base
        return await asyncio.to_thread(canvas.occupancy), canvas.origin

    def warn(self, text: str) -> None:
        """Warn, but not at every list."""
        self.get_logger().warning(escaped(text, one_line=True), throttle_duration_sec=TELL_SEC)


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(lambda: OccupancyGridNode(*flags_of(remove_ros_args(sys.argv)[1:])))
