"""``dummy_sensors dummy_laser``: a round wall that comes and goes."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

import aionode
from aionode import Node
from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["DummyLaser", "main"]

BEAMS: Final = 1081
STEP: Final = math.radians(0.25)


class DummyLaser(Node):
    """Publishes `scan` thirty times a second."""

    def __init__(self) -> None:
        super().__init__("dummy_laser")
        self.publisher = self.create_publisher(LaserScan, "scan", 10)
        self.count = 0.0
        logger = self.get_logger()
        logger.info(f"angle inc:\t{STEP:f}")
        logger.info(f"scan size:\t{BEAMS}")
        logger.info(f"scan time increment: \t{0:f}")
        create_wall_timer(self, 1.0 / 30.0, self.publish)

    def publish(self) -> None:
        """Publish a scan."""
        self.count += 0.1
        start = -math.radians(135.0)
        msg = LaserScan(
            angle_min=start,
            angle_max=start + (BEAMS - 1) * STEP,
            angle_increment=STEP,
            scan_time=0.04,
            range_max=10.0,
            ranges=np.full(BEAMS, abs(math.sin(self.count)), np.float32),
        )
        msg.header.frame_id = "single_rrbot_hokuyo_link"
        msg.header.stamp = self.get_clock().now().to_msg()
        self.publisher.publish(msg)


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(DummyLaser)
