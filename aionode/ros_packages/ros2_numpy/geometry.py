"""Vectors, quaternions and transforms as arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from ros2_numpy.registry import converts_from_numpy, converts_to_numpy
from rosidl_generator_py import message_class
from tf_transformations import quaternion_from_matrix, quaternion_matrix

__all__ = [
    "numpy_to_point",
    "numpy_to_pose",
    "numpy_to_quat",
    "numpy_to_transform",
    "numpy_to_vector3",
    "point_to_numpy",
    "pose_to_numpy",
    "quat_to_numpy",
    "transform_to_numpy",
    "vector3_to_numpy",
]

Array = npt.NDArray[Any]

Point = message_class("geometry_msgs/msg/Point")
Pose = message_class("geometry_msgs/msg/Pose")
Quaternion = message_class("geometry_msgs/msg/Quaternion")
Transform = message_class("geometry_msgs/msg/Transform")
Vector3 = message_class("geometry_msgs/msg/Vector3")


def of_each(array: Array, rank: int, make: Callable[[Array], Any]) -> Any:
    """Return the message for an array, or the messages for each of the arrays in it.

    Args:
        array: Its last `rank` dimensions are those of one message.
        rank: The number of these dimensions.
        make: Creates a message.
    """
    shape = array.shape[:-rank]
    if not shape:
        return make(array)
    messages = np.empty(shape, dtype=object)
    for index in np.ndindex(shape):
        messages[index] = make(array[index])
    return messages


def xyz(cls: type[Any]) -> Callable[[Array], Any]:
    """Return a function that creates a message with x, y and z from an array."""
    return lambda array: cls(**dict(zip("xyz", map(float, array), strict=True)))


@converts_to_numpy(Vector3)
def vector3_to_numpy(msg: Any, hom: bool = False) -> Array:
    """Return x, y and z, followed by 0 if `hom` requests homogeneous coordinates."""
    return np.array([msg.x, msg.y, msg.z, *[0.0] * hom])


@converts_from_numpy(Vector3)
def numpy_to_vector3(arr: Array) -> Any:
    """Return a vector, or an array of them, from three coordinates, or four with 0 as the last.

    Raises:
        AssertionError: The fourth coordinate is not 0.
    """
    if arr.shape[-1] == 4:
        if not np.all(arr[..., -1] == 0):
            raise AssertionError("the fourth coordinate of a vector is not 0")
        arr = arr[..., :-1]
    return of_each(arr, 1, xyz(Vector3))


@converts_to_numpy(Point)
def point_to_numpy(msg: Any, hom: bool = False) -> Array:
    """Return x, y and z, followed by 1 if `hom` requests homogeneous coordinates."""
    return np.array([msg.x, msg.y, msg.z, *[1.0] * hom])


@converts_from_numpy(Point)
def numpy_to_point(arr: Array) -> Any:
    """Return a point, or an array of them, from three coordinates, or four homogeneous ones."""
    if arr.shape[-1] == 4:
        arr = arr[..., :-1] / arr[..., -1:]
    return of_each(arr, 1, xyz(Point))


@converts_to_numpy(Quaternion)
def quat_to_numpy(msg: Any) -> Array:
    """Return x, y, z and w."""
    return np.array([msg.x, msg.y, msg.z, msg.w])


@converts_from_numpy(Quaternion)
def numpy_to_quat(arr: Array) -> Any:
    """Return a quaternion, or an array of them, from x, y, z and w.

    Raises:
        AssertionError: There are not four of them.
    """
    check_shape(arr, (4,))
    return of_each(
        arr, 1, lambda numbers: Quaternion(**dict(zip("xyzw", map(float, numbers), strict=True)))
    )


def of_matrices(arr: Array, make: Callable[[Array, Any], Any]) -> Any:
    """Return the results of `make` for the position and quaternion of each 4x4 matrix.

    Raises:
        AssertionError: The matrices are not 4x4.
        ValueError: A matrix has no inverse.
    """
    check_shape(arr, (4, 4))
    return of_each(
        arr,
        2,
        lambda matrix: make(matrix[:3, 3], numpy_to_quat(np.array(quaternion_from_matrix(matrix)))),
    )


@converts_to_numpy(Transform)
def transform_to_numpy(msg: Any) -> Array:
    """Return the 4x4 matrix of a transform."""
    return matrix_of(point_to_numpy(msg.translation), msg.rotation)


@converts_from_numpy(Transform)
def numpy_to_transform(arr: Array) -> Any:
    """Return a transform, or an array of them, from 4x4 matrices.

    Raises:
        AssertionError: The matrices are not 4x4.
        ValueError: A matrix has no inverse.
    """
    return of_matrices(
        arr,
        lambda position, rotation: Transform(translation=xyz(Vector3)(position), rotation=rotation),
    )


@converts_to_numpy(Pose)
def pose_to_numpy(msg: Any) -> Array:
    """Return the 4x4 matrix of a pose."""
    return matrix_of(point_to_numpy(msg.position), msg.orientation)


@converts_from_numpy(Pose)
def numpy_to_pose(arr: Array) -> Any:
    """Return a pose, or an array of them, from 4x4 matrices.

    Raises:
        AssertionError: The matrices are not 4x4.
        ValueError: A matrix has no inverse.
    """
    return of_matrices(
        arr,
        lambda position, rotation: Pose(position=xyz(Point)(position), orientation=rotation),
    )


def matrix_of(translation: Array, rotation: Any) -> Array:
    """Return the 4x4 matrix of a rotation followed by a translation."""
    matrix = quaternion_matrix(quat_to_numpy(rotation))
    matrix[:3, 3] = translation
    return matrix


def check_shape(array: Array, shape: tuple[int, ...]) -> None:
    """Raise AssertionError unless the last dimensions of an array have this shape."""
    if array.shape[-len(shape) :] != shape:
        raise AssertionError(f"the array has the shape {array.shape}; it has to end in {shape}")
