"""Point clouds as structured arrays."""

from __future__ import annotations

from array import array
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from aionode.point_cloud2 import fields_from_dtype
from rclpy._arrays import array_over
from ros2_numpy.registry import converts_from_numpy, converts_to_numpy
from rosidl_generator_py import from_aionode, message_class

__all__ = [
    "DUMMY_FIELD_PREFIX",
    "array_to_pointcloud2",
    "dtype_to_fields",
    "fields_to_dtype",
    "get_xyz_points",
    "merge_rgb_fields",
    "nptype_to_pftype",
    "pftype_sizes",
    "pftype_to_nptype",
    "pointcloud2_to_array",
    "pointcloud2_to_xyz_array",
    "split_rgb_field",
    "type_mappings",
]

Array = npt.NDArray[Any]

PointCloud2 = message_class("sensor_msgs/msg/PointCloud2")
PointField = message_class("sensor_msgs/msg/PointField")

DUMMY_FIELD_PREFIX = "__"
"""Prefix of the names of fields for padding bytes between those of a cloud."""

type_mappings = [
    (getattr(PointField, name.upper()), np.dtype(name))
    for name in ("int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64")
]
pftype_to_nptype = dict(type_mappings)
nptype_to_pftype = {dtype: number for number, dtype in type_mappings}
pftype_sizes = {number: dtype.itemsize for number, dtype in type_mappings}


@converts_to_numpy(PointField, plural=True)
def fields_to_dtype(fields: Sequence[Any], point_step: int) -> list[Any]:
    """Return the type of a point as a list of names and types; padding bytes have names, too.

    Args:
        fields: The fields of a cloud, in the order of their offsets.
        point_step: The size of a point in bytes.
    """
    listed: list[Any] = []
    end = 0
    for field in fields:
        listed += [(f"{DUMMY_FIELD_PREFIX}{at}", np.uint8) for at in range(end, field.offset)]
        dtype = pftype_to_nptype[field.datatype]
        listed.append((field.name, dtype if field.count == 1 else np.dtype((dtype, field.count))))
        end = max(end, field.offset) + dtype.itemsize * field.count
    listed += [(f"{DUMMY_FIELD_PREFIX}{at}", np.uint8) for at in range(end, point_step)]
    return listed


def fields_of(dtype: np.dtype[Any]) -> Mapping[str, Any]:
    """Return type and offset of each field of a structured type."""
    return dtype.fields or {}


@converts_from_numpy(PointField, plural=True)
def dtype_to_fields(dtype: np.dtype[Any]) -> list[Any]:
    """Return the fields of a cloud whose points have a structured type.

    Raises:
        TypeError: It is not structured, or contains a type that no field can have.
    """
    return [from_aionode(field) for field in fields_from_dtype(dtype)]


@converts_to_numpy(PointCloud2)
def pointcloud2_to_array(cloud_msg: Any, squeeze: bool = True) -> Array:
    """Return the points as a structured array that shares the message's bytes.

    Args:
        cloud_msg: The cloud.
        squeeze: Remove the dimension of rows if there is only one row.

    Raises:
        TypeError: The message has less data than its size needs.
    """
    listed = fields_to_dtype(cloud_msg.fields, cloud_msg.point_step)
    points = array_over(
        cloud_msg.data,
        (cloud_msg.height, cloud_msg.width),
        np.dtype(listed).newbyteorder(">" if cloud_msg.is_bigendian else "<"),
        (cloud_msg.row_step, cloud_msg.point_step),
    )
    named = points[[name for name, _ in listed if not name.startswith(DUMMY_FIELD_PREFIX)]]
    return named[0] if squeeze and cloud_msg.height == 1 else named


@converts_from_numpy(PointCloud2)
def array_to_pointcloud2(cloud_arr: Array, stamp: Any = None, frame_id: str | None = None) -> Any:
    """Return a cloud from a structured array with one or two dimensions.

    Args:
        cloud_arr: The points.
        stamp: The stamp of the header.
        frame_id: The frame of the header.
    """
    points = np.atleast_2d(cloud_arr)
    points = points.astype(points.dtype.newbyteorder("<"), copy=False)
    cloud = PointCloud2(fields=dtype_to_fields(points.dtype))
    if stamp is not None:
        cloud.header.stamp = stamp
    if frame_id is not None:
        cloud.header.frame_id = frame_id
    cloud.height, cloud.width = points.shape
    cloud.point_step = points.dtype.itemsize
    cloud.row_step = cloud.point_step * cloud.width
    cloud.is_dense = all(bool(np.isfinite(points[name]).all()) for name in points.dtype.names or ())
    cloud.data = array("B", points.tobytes())
    return cloud


def merge_rgb_fields(cloud_arr: Array) -> Array:
    """Combine the fields r, g and b into one field rgb, three bytes in a float32."""
    r, g, b = (cloud_arr[name].astype(np.uint32) for name in "rgb")
    merged = (r << 16 | g << 8 | b).view(np.float32)
    return with_fields(cloud_arr, without={"r", "g", "b"}, added={"rgb": merged})


def split_rgb_field(cloud_arr: Array) -> Array:
    """Split the field rgb into three fields r, g and b."""
    rgb = cloud_arr["rgb"].copy().view(np.uint32)
    parts = {
        name: (rgb >> shift & 255).astype(np.uint8)
        for name, shift in zip("rgb", (16, 8, 0), strict=True)
    }
    return with_fields(cloud_arr, without={"rgb"}, added=parts)


def with_fields(points: Array, *, without: set[str], added: dict[str, Array]) -> Array:
    """Return a new array without some fields, and with others at the end."""
    kept = [name for name in points.dtype.names or () if name not in without]
    dtype = [(name, fields_of(points.dtype)[name][0]) for name in kept]
    changed = np.zeros(
        points.shape, [*dtype, *((name, part.dtype) for name, part in added.items())]
    )
    for name in kept:
        changed[name] = points[name]
    for name, part in added.items():
        changed[name] = part
    return changed


def get_xyz_points(
    cloud_array: Array, remove_nans: bool = True, dtype: npt.DTypeLike = np.float64
) -> Array:
    """Return x, y and z of the points as a plain array, one row for each point.

    Args:
        cloud_array: The points.
        remove_nans: Omit points with a coordinate that is not finite.
        dtype: The type of the coordinates.
    """
    points = np.stack([cloud_array[name] for name in "xyz"], axis=-1).astype(dtype)
    return points[np.isfinite(points).all(axis=-1)] if remove_nans else points


def pointcloud2_to_xyz_array(cloud_msg: Any, remove_nans: bool = True) -> Array:
    """Return x, y and z of the points of a cloud; see `get_xyz_points`."""
    return get_xyz_points(pointcloud2_to_array(cloud_msg), remove_nans=remove_nans)
