"""``dummy_map_server``: publishes a map in which an obstacle wanders."""

from __future__ import annotations

import numpy as np

import aionode
from aionode import DurabilityPolicy, Node, QoSProfile
from aionode.interfaces.geometry_msgs.msg import Point, Pose, Quaternion
from aionode.interfaces.nav_msgs.msg import MapMetaData, OccupancyGrid
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["DummyMapServer", "main"]

WIDTH = 100
RESOLUTION = 0.1


class DummyMapServer(Node):
    """Publishes `map` once a second: unknown, except for a cell between two free ones."""

    def __init__(self) -> None:
        super().__init__("dummy_map_server")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.publisher = self.create_publisher(OccupancyGrid, "map", latched)
        self.count = 0
        create_wall_timer(self, 1.0, self.publish)

    def publish(self) -> None:
        """Publish the map."""
        self.count += 1
        corner = -WIDTH * RESOLUTION / 2
        cells = np.full(WIDTH * WIDTH, -1, np.int8)
        cells[np.arange(self.count, self.count + 3) % cells.size] = (0, 100, 0)
        msg = OccupancyGrid(
            info=MapMetaData(
                resolution=RESOLUTION,
                width=WIDTH,
                height=WIDTH,
                origin=Pose(position=Point(x=corner, y=corner), orientation=Quaternion(w=1.0)),
            ),
            data=cells,
        )
        msg.header.frame_id = "world"
        msg.header.stamp = self.get_clock().now().to_msg()
        self.publisher.publish(msg)


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(DummyMapServer)
