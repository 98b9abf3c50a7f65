"""Point clouds as numpy arrays, as in `aionode.point_cloud2`, for rosidl messages."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from aionode import point_cloud2
from rosidl_generator_py import from_aionode, to_aionode

__all__ = [
    "create_cloud",
    "create_cloud_xyz32",
    "dtype_from_fields",
    "read_points",
    "read_points_list",
    "read_points_numpy",
]


def read_points(
    cloud: Any,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Any] | None = None,
    reshape_organized_cloud: bool = False,
) -> npt.NDArray[Any]:
    """Return the points as a structured array, sharing the bytes of the message where possible.

    See `aionode.point_cloud2.read_points` for arguments and errors.
    """
    return point_cloud2.read_points(
        own(cloud), field_names, skip_nans, uvs, reshape_organized_cloud
    )


def read_points_numpy(
    cloud: Any,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Any] | None = None,
    reshape_organized_cloud: bool = False,
) -> npt.NDArray[Any]:
    """Return points whose fields all have one type as a plain array; see `read_points`."""
    return point_cloud2.read_points_numpy(
        own(cloud), field_names, skip_nans, uvs, reshape_organized_cloud
    )


def read_points_list(
    cloud: Any,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[Any] | None = None,
) -> list[Any]:
    """Return the points as a list of named tuples; see `read_points`."""
    return point_cloud2.read_points_list(own(cloud), field_names, skip_nans, uvs)


def dtype_from_fields(fields: Iterable[Any], point_step: int | None = None) -> np.dtype[Any]:
    """Return numpy's type for one point."""
    return point_cloud2.dtype_from_fields(map(own, fields), point_step)


def create_cloud(header: Any, fields: Iterable[Any], points: Any, step: int | None = None) -> Any:
    """Return a cloud of points; see `aionode.point_cloud2.create_cloud`."""
    cloud = point_cloud2.create_cloud(own(header), map(own, fields), points, step)
    return from_aionode(cloud)


def create_cloud_xyz32(header: Any, points: Any, step: int | None = None) -> Any:
    """Return a cloud of points with x, y and z as float32."""
    return from_aionode(point_cloud2.create_cloud_xyz32(own(header), points, step))


def own(message: Any) -> Any:
    """Return a message as an aionode message; its bytes are not copied."""
    return to_aionode(message)
