"""The functions for geometry_msgs, registered for `Buffer.transform` when this is imported."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import (
    Point,
    PointStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3Stamped,
)

from aionode.interfaces.geometry_msgs import msg as geometry
from aionode.tf import do_transform
from rosidl_generator_py import from_aionode, message_class, to_aionode
from tf2_ros.buffer_interface import ConvertRegistration, TransformRegistration

__all__ = [
    "Point",
    "PointStamped",
    "Pose",
    "PoseStamped",
    "PoseWithCovarianceStamped",
    "TransformStamped",
    "Vector3Stamped",
    "do_transform_point",
    "do_transform_polygon_stamped",
    "do_transform_pose",
    "do_transform_pose_stamped",
    "do_transform_pose_with_covariance_stamped",
    "do_transform_vector3",
    "do_transform_wrench_stamped",
    "from_msg_msg",
    "to_msg_msg",
    "transform_covariance",
]

STAMPED = (
    "AccelStamped",
    "AccelWithCovarianceStamped",
    "InertiaStamped",
    "PointStamped",
    "PolygonInstanceStamped",
    "PolygonStamped",
    "PoseStamped",
    "PoseWithCovarianceStamped",
    "QuaternionStamped",
    "TransformStamped",
    "TwistStamped",
    "TwistWithCovarianceStamped",
    "Vector3Stamped",
    "VelocityStamped",
    "WrenchStamped",
)


def to_msg_msg(msg: Any) -> Any:
    """Return a message unchanged."""
    return msg


def from_msg_msg(msg: Any) -> Any:
    """Return a message unchanged."""
    return msg


def transformed(stamped: Any, transform: Any) -> Any:
    """Return a stamped message, expressed in the target frame of a transform."""
    by: Any = to_aionode(transform)
    return from_aionode(do_transform(to_aionode(stamped), by))


do_transform_point = do_transform_vector3 = transformed
do_transform_pose_stamped = do_transform_pose_with_covariance_stamped = transformed
do_transform_polygon_stamped = do_transform_wrench_stamped = transformed


def do_transform_pose(pose: Any, transform: Any) -> Any:
    """Return a pose without a header, translated and rotated."""
    inner: Any = to_aionode(pose)
    by: Any = to_aionode(transform)
    return from_aionode(do_transform(geometry.PoseStamped(pose=inner), by).pose)


def transform_covariance(cov_in: Any, transform: Any) -> Any:
    """Return a covariance of 36 numbers, rotated."""
    stamped = geometry.PoseWithCovarianceStamped()
    stamped.pose.covariance = list(cov_in)
    by: Any = to_aionode(transform)
    return from_aionode(do_transform(stamped, by)).pose.covariance


for name in STAMPED:
    kind = message_class(f"geometry_msgs/msg/{name}")
    TransformRegistration().add(kind, transformed)
    ConvertRegistration().add_to_msg(kind, to_msg_msg)
    ConvertRegistration().add_from_msg(kind, from_msg_msg)
