"""Transform point clouds, with numpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from aionode.interfaces.std_msgs.msg import Header
from aionode.point_cloud2 import create_cloud, read_points

if TYPE_CHECKING:
    from aionode.interfaces.geometry_msgs.msg import TransformStamped
    from aionode.interfaces.sensor_msgs.msg import PointCloud2

__all__ = ["transformed_cloud"]

AXES = ("x", "y", "z")


def transformed_cloud(cloud: PointCloud2, by: TransformStamped) -> PointCloud2:
    """Transform the points of a cloud; as in tf2, its stamp is kept.

    Raises:
        ValueError: the cloud lacks x, y or z.
    """
    missing = set(AXES) - {field.name for field in cloud.fields}
    if missing:
        raise ValueError(
            f"PointCloud2: it has no field {', '.join(sorted(missing))}; a cloud needs x, y and z "
            "to be transformed"
        )
    points = read_points(cloud).copy()
    xyz = np.stack([points[axis].astype(np.float64) for axis in AXES])
    rotation, moved = by.transform.rotation, by.transform.translation
    turned = matrix(rotation.x, rotation.y, rotation.z, rotation.w) @ xyz.reshape(3, -1)
    for axis, row, offset in zip(AXES, turned, (moved.x, moved.y, moved.z), strict=True):
        points[axis] = (row + offset).reshape(points.shape)
    header = Header(stamp=cloud.header.stamp, frame_id=by.header.frame_id)
    result = create_cloud(header, cloud.fields, points)
    result.height, result.width = cloud.height, cloud.width
    result.row_step = result.point_step * cloud.width
    result.is_dense = cloud.is_dense
    return result


def matrix(i: float, j: float, k: float, w: float) -> Any:
    """Return the rotation matrix of a unit quaternion."""
    return np.array(
        [
            [1 - 2 * (j * j + k * k), 2 * (i * j - k * w), 2 * (i * k + j * w)],
            [2 * (i * j + k * w), 1 - 2 * (i * i + k * k), 2 * (j * k - i * w)],
            [2 * (i * k - j * w), 2 * (j * k + i * w), 1 - 2 * (i * i + j * j)],
        ]
    )
