"""Images as arrays."""

from __future__ import annotations

import sys
from array import array
from typing import Any

import numpy as np
import numpy.typing as npt

from aionode.image import COLORS, OPENCV_TYPES, encoding_of
from rclpy._arrays import array_over
from ros2_numpy.registry import converts_from_numpy, converts_to_numpy
from rosidl_generator_py import message_class

__all__ = ["image_to_numpy", "name_to_dtypes", "numpy_to_image"]

Image = message_class("sensor_msgs/msg/Image")

BAYER = ("bayer_rggb", "bayer_bggr", "bayer_gbrg", "bayer_grbg")
ENCODINGS = [
    *(f"{name}{bits}" for name in (*COLORS, *BAYER) for bits in (8, 16)),
    *(f"{name}C{count}" for name in OPENCV_TYPES for count in range(1, 5)),
]

name_to_dtypes: dict[str, tuple[type[Any], int]] = {
    name: (dtype.type, channels) for name in ENCODINGS for dtype, channels in [encoding_of(name)]
}
"""The type and number of the channels of each encoding."""


@converts_to_numpy(Image)
def image_to_numpy(msg: Any) -> npt.NDArray[Any]:
    """Return the pixels, sharing the message's bytes: rows, columns, and channels if several.

    Raises:
        TypeError: The encoding is unknown, or the data is too short.
    """
    dtype, channels = channels_of(msg.encoding)
    size = dtype.itemsize
    pixels = array_over(
        msg.data,
        (msg.height, msg.width, channels),
        dtype.newbyteorder(">" if msg.is_bigendian else "<"),
        (msg.step, size * channels, size),
    )
    return pixels[..., 0] if channels == 1 else pixels


@converts_from_numpy(Image)
def numpy_to_image(arr: npt.NDArray[Any], encoding: str) -> Any:
    """Return an image from rows, columns, and channels if there are several.

    Raises:
        TypeError: The encoding is unknown, or does not match the array.
    """
    dtype, channels = channels_of(encoding)
    if arr.ndim not in {2, 3}:
        raise TypeError(f"the array has {arr.ndim} dimensions; an image has two or three")
    given = 1 if arr.ndim == 2 else arr.shape[2]
    if given != channels:
        raise TypeError(f"the array has {given} channels; {encoding} has {channels}")
    if arr.dtype.type is not dtype.type:
        raise TypeError(f"the array has the type {arr.dtype}; {encoding} has {dtype}")
    whole = np.ascontiguousarray(arr)
    order = whole.dtype.byteorder
    image = Image(encoding=encoding, height=arr.shape[0], width=arr.shape[1])
    image.data = array("B", whole.tobytes())
    image.step = whole.strides[0]
    image.is_bigendian = int(order == ">" or (order == "=" and sys.byteorder == "big"))
    return image


def channels_of(encoding: str) -> tuple[np.dtype[Any], int]:
    """Return the type and number of the channels of an encoding."""
    if encoding not in name_to_dtypes:
        raise TypeError(
            f"the encoding {encoding!r} is unknown; use one such as rgb8, mono16 or 32FC1"
        )
    dtype, channels = name_to_dtypes[encoding]
    return np.dtype(dtype), channels
