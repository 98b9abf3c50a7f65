"""The functions for point clouds, registered for `Buffer.transform` when this is imported."""

from __future__ import annotations

from typing import Any

import numpy as np

from aionode.interfaces.geometry_msgs.msg import TransformStamped
from aionode.tf import do_transform, rotation_matrix
from rosidl_generator_py import from_aionode, message_class, to_aionode
from tf2_geometry_msgs.tf2_geometry_msgs import from_msg_msg, to_msg_msg
from tf2_ros.buffer_interface import ConvertRegistration, TransformRegistration

__all__ = ["do_transform_cloud", "from_msg_msg", "to_msg_msg", "transform_points"]


def transform_points(point_cloud: Any, transform: Any) -> Any:
    """Translate and rotate points, an array of three columns, by a Transform."""
    moved = transform.translation
    turned = point_cloud @ np.array(rotation_matrix(transform.rotation)).T
    return turned + np.array([moved.x, moved.y, moved.z])


def do_transform_cloud(cloud: Any, transform: Any) -> Any:
    """Translate and rotate a cloud by a Transform or TransformStamped."""
    own: Any = to_aionode(cloud)
    by: Any = to_aionode(transform)
    if not isinstance(by, TransformStamped):
        header = type(own.header)(frame_id=own.header.frame_id)
        by = TransformStamped(header=header, transform=by)
    return from_aionode(do_transform(own, by))


kind = message_class("sensor_msgs/msg/PointCloud2")
TransformRegistration().add(kind, do_transform_cloud)
ConvertRegistration().add_to_msg(kind, to_msg_msg)
ConvertRegistration().add_from_msg(kind, from_msg_msg)
