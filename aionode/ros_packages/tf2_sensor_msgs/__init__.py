"""The package that programs import as `tf2_sensor_msgs`: point clouds in another frame."""

from __future__ import annotations

from rclpy._reexports import add_names
from tf2_sensor_msgs.tf2_sensor_msgs import (
    do_transform_cloud,
    from_msg_msg,
    to_msg_msg,
    transform_points,
)

__all__ = ["do_transform_cloud", "from_msg_msg", "to_msg_msg", "transform_points"]

add_names(__name__)
