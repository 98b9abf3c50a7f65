"""The encodings of images: their OpenCV types, and the meaning of their channels."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import MessageError
from aionode.image import OPENCV_TYPES as DEPTHS
from aionode.image import encoding_of

if TYPE_CHECKING:
    import numpy as np

__all__ = [
    "DEPTHS",
    "bit_depth",
    "channels_of",
    "colour_of",
    "cv_type",
    "getCvType",
    "type_name",
]

COLOURS: Final = re.compile(r"(mono|rgba?|bgra?|bayer_(?:rggb|bggr|gbrg|grbg))(8|16)")
YUV: Final = ("yuv422", "yuv422_yuy2")
NOT_OF_CV_BRIDGE: Final = ("uyvy", "yuyv")


def pixel_of(encoding: str) -> tuple[np.dtype[Any], int]:
    """Return the type of a channel, and the number of channels.

    Raises:
        RuntimeError: The encoding is unknown.
    """
    try:
        if encoding not in NOT_OF_CV_BRIDGE:
            return encoding_of(encoding)
    except MessageError:  # cv_bridge has its own text
        pass
    raise RuntimeError(f"Unrecognized image encoding [{encoding}]")


def cv_type(depth: int, channels: int) -> int:
    """Return OpenCV's number for a type."""
    return depth + ((channels - 1) << 3)


def type_name(dtype_name: str, channels: int) -> str:
    """Return OpenCV's name for channels of a numpy type, such as 8UC3.

    Raises:
        KeyError: OpenCV has no such type.
    """
    name = next((name for name, dtype in DEPTHS.items() if dtype == dtype_name), None)
    if name is None:
        raise KeyError(dtype_name)
    return f"{name}C{channels}"


def getCvType(encoding: str) -> int:  # cv_bridge's name
    """Return OpenCV's number for the type of an encoding.

    Raises:
        RuntimeError: The encoding is unknown.
    """
    dtype, channels = pixel_of(encoding)
    return cv_type(list(DEPTHS.values()).index(dtype.name), channels)


def channels_of(encoding: str) -> int:
    """Return the number of channels.

    Raises:
        RuntimeError: The encoding is unknown.
    """
    return pixel_of(encoding)[1]


def bit_depth(encoding: str) -> int:
    """Return the number of bits of a channel.

    Raises:
        RuntimeError: The encoding is unknown.
    """
    return pixel_of(encoding)[0].itemsize * 8


def dtype_of(encoding: str) -> str:
    """Return numpy's name for the type of a channel.

    Raises:
        RuntimeError: The encoding is unknown.
    """
    return pixel_of(encoding)[0].name


def colour_of(encoding: str) -> str:
    """Return the meaning of the channels, such as ``bgr`` or ``bayer_rggb``; empty without one."""
    match = COLOURS.fullmatch(encoding)
    if match is not None:
        return match[1]
    return encoding if encoding in YUV else ""
