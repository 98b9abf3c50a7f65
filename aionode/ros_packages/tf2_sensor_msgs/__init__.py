"""Programs import this as `tf2_sensor_msgs`: point clouds in another frame."""

from __future__ import annotations

from sensor_msgs.msg import PointCloud2

from tf2_sensor_msgs.tf2_sensor_msgs import (
    do_transform_cloud,
    from_msg_msg,
    to_msg_msg,
    transform_points,
)

__all__ = [
    "PointCloud2",
    "do_transform_cloud",
    "from_msg_msg",
    "to_msg_msg",
    "transform_points",
]
