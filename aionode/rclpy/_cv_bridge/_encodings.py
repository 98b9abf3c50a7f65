"""The encodings of images: what OpenCV's type is, and what the channels mean."""

from __future__ import annotations

import re
from typing import Final

__all__ = [
    "DEPTHS",
    "bit_depth",
    "channels_of",
    "colour_of",
    "cv_type",
    "getCvType",
    "type_name",
]

DEPTHS: Final = {
    "8U": "uint8",
    "8S": "int8",
    "16U": "uint16",
    "16S": "int16",
    "32S": "int32",
    "32F": "float32",
    "64F": "float64",
}
"""OpenCV's names for the types of a channel, in the order of their numbers, and numpy's."""

CHANNELS: Final = {"mono": 1, "rgb": 3, "bgr": 3, "rgba": 4, "bgra": 4}
COLOURS: Final = re.compile(r"(mono|rgba?|bgra?|bayer_(?:rggb|bggr|gbrg|grbg))(8|16)")
YUV: Final = ("yuv422", "yuv422_yuy2")
OPENCV: Final = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)(?:C([0-9]+))?")


def parts_of(encoding: str) -> tuple[str, int, str]:
    """Return the type of a channel, their number, and what they mean: empty if nothing.

    Raises:
        RuntimeError: The encoding is unknown.
    """
    if match := COLOURS.fullmatch(encoding):
        return f"{match[2]}U", CHANNELS.get(match[1], 1), match[1]
    if encoding in YUV:
        return "8U", 2, encoding
    if match := OPENCV.fullmatch(encoding):
        return match[1], int(match[2] or 1), ""
    raise RuntimeError(f"Unrecognized image encoding [{encoding}]")


def cv_type(depth: int, channels: int) -> int:
    """Return the number that OpenCV has for a type."""
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


def getCvType(encoding: str) -> int:  # noqa: N802  # cv_bridge's name
    """Return the number that OpenCV has for the type of an encoding.

    Raises:
        RuntimeError: The encoding is unknown.
    """
    depth, channels, _ = parts_of(encoding)
    return cv_type(list(DEPTHS).index(depth), channels)


def channels_of(encoding: str) -> int:
    """Return the number of channels.

    Raises:
        RuntimeError: The encoding is unknown.
    """
    return parts_of(encoding)[1]


def bit_depth(encoding: str) -> int:
    """Return the number of bits of a channel.

    Raises:
        RuntimeError: The encoding is unknown.
    """
    return int(parts_of(encoding)[0][:-1])


def dtype_of(encoding: str) -> str:
    """Return numpy's name for the type of a channel.

    Raises:
        RuntimeError: The encoding is unknown.
    """
    return DEPTHS[parts_of(encoding)[0]]


def colour_of(encoding: str) -> str:
    """Return what the channels mean, such as ``bgr`` or ``bayer_rggb``; empty if nothing."""
    match = COLOURS.fullmatch(encoding)
    if match is not None:
        return match[1]
    return encoding if encoding in YUV else ""
