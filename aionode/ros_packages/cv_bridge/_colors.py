"""Converts images between encodings; `cv2` is imported only where numpy would differ from it."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt

from aionode.image import COLORS
from cv_bridge._encodings import (
    bit_depth,
    channels_of,
    colour_of,
    dtype_of,
)

__all__ = ["cvtColor2", "cvtColorForDisplay", "with_depth"]

Pixels = npt.NDArray[Any]

CODES: Final = {"yuv422": "YUV2{}_UYVY", "yuv422_yuy2": "YUV2{}_YUY2"}
"""OpenCV's names for conversions from YUV."""

BAYER: Final = {"rggb": "BG", "bggr": "RG", "gbrg": "GR", "grbg": "GB"}
"""OpenCV's names for Bayer patterns, which are based on the second row and column."""


def cvtColor2(image: Pixels, encoding_in: str, encoding_out: str) -> Pixels:
    """Return an image in another encoding, converting the depth of its values if it differs.

    Args:
        image: The pixels.
        encoding_in: Their encoding.
        encoding_out: The encoding to which they are converted; the same if it is empty.

    Raises:
        RuntimeError: There is no such conversion, or an encoding is unknown.
        ModuleNotFoundError: The conversion needs `cv2`, which is not installed.
    """
    if encoding_out in {"", encoding_in}:
        return image.copy()
    source, wanted = colour_of(encoding_in), colour_of(encoding_out)
    same_channels = channels_of(encoding_in) == channels_of(encoding_out)
    if not source and wanted:
        raise RuntimeError(
            f"[{encoding_in}] is not a color format. but [{encoding_out}] is. "
            "The conversion does not make sense"
        )
    if not source and not same_channels:
        raise RuntimeError(
            f"[{encoding_in}] and [{encoding_out}] do not have the same number of channel"
        )
    if not wanted and not same_channels:
        raise RuntimeError(
            f"[{encoding_in}] is a color format but [{encoding_out}] is not so they must have "
            "the same OpenCV type, CV_8UC3, CV16UC1 ...."
        )
    if wanted and source != wanted:
        if not is_possible(source, wanted):
            raise RuntimeError(f"Unsupported conversion from [{encoding_in}] to [{encoding_out}]")
        image = with_colour(image, source, wanted)
    elif wanted and source not in {*COLORS, "yuv422"}:
        raise RuntimeError(f"Unsupported conversion from [{encoding_in}] to [{encoding_out}]")
    return with_depth(image, encoding_in, encoding_out)


def is_possible(source: str, wanted: str) -> bool:
    """Return whether there is a conversion between two kinds of colours."""
    if source.startswith("bayer_"):
        return wanted in {"mono", "rgb", "bgr"}
    return wanted in COLORS


def with_colour(image: Pixels, source: str, wanted: str) -> Pixels:
    """Return an image with converted colours, and unchanged depth."""
    if source == "mono":
        colours = np.stack([image] * 3, axis=-1)
        return with_alpha(colours) if wanted.endswith("a") else colours
    if source in COLORS and wanted != "mono":
        order = [source.index(letter) for letter in wanted if letter in source]
        moved = np.ascontiguousarray(image[..., order])
        return moved if len(order) == len(wanted) else with_alpha(moved)
    import cv2

    name = "GRAY" if wanted == "mono" else wanted.upper()
    if source.startswith("bayer_"):
        code = f"Bayer{BAYER[source.removeprefix('bayer_')]}2{name}"
    else:
        code = CODES.get(source, f"{source.upper()}2{{}}").format(name)
    converted: Pixels = cv2.cvtColor(image, getattr(cv2, f"COLOR_{code}"))
    return converted


def with_alpha(colours: Pixels) -> Pixels:
    """Return an image with a fourth channel, at its maximum."""
    highest = np.full((*colours.shape[:2], 1), np.iinfo(colours.dtype).max, colours.dtype)
    return np.concatenate([colours, highest], axis=-1)


def with_depth(image: Pixels, encoding_in: str, encoding_out: str) -> Pixels:
    """Return an image with values of another type; 8 and 16 bits are scaled to each other."""
    dtype = np.dtype(dtype_of(encoding_out))
    depths = bit_depth(encoding_in), bit_depth(encoding_out)
    factor = {(8, 16): 65535 / 255, (16, 8): 255 / 65535}.get(depths, 1.0)
    if factor == 1.0 and image.dtype == dtype:
        return image
    return saturated(image * np.float64(factor), dtype)


def saturated(values: Pixels, dtype: np.dtype[Any]) -> Pixels:
    """Return values in another type: integers are rounded, and clamped to its range."""
    if dtype.kind == "f":
        return values.astype(dtype)
    limits = np.iinfo(dtype)
    whole = np.nan_to_num(np.rint(values), nan=limits.min)
    near: Pixels = np.clip(whole, limits.min, limits.max).astype(dtype)
    return near


def cvtColorForDisplay(  # cv_bridge's name
    source: Pixels,
    encoding_in: str,
    encoding_out: str,
    do_dynamic_scaling: bool = False,
    min_image_value: float = 0.0,
    max_image_value: float = 0.0,
    colormap: int = -1,
) -> Pixels:
    """Return an image of 8 bits for a screen.

    Args:
        source: The pixels.
        encoding_in: Their encoding; in 32SC1 each value is a label with its own colour, 0 black.
        encoding_out: A colour or grey of 8 bits; bgr8 if it is empty.
        do_dynamic_scaling: Scale the lowest value to 0, and the highest to 255.
        min_image_value: Scale this value to 0 …
        max_image_value: … and this one to 255, unless both are equal.
        colormap: OpenCV's number of a map of colours for scaled values; needs `cv2`.

    Raises:
        RuntimeError: There is no such conversion, or an encoding is unknown.
        ModuleNotFoundError: The conversion needs `cv2`, which is not installed.
    """
    wanted = encoding_out or "bgr8"
    if colour_of(wanted) not in COLORS or bit_depth(wanted) != 8:
        raise RuntimeError(
            "cv_bridge.cvtColorForDisplay() does not have an output encoding "
            "that is color or mono, and has is bit in depth"
        )
    if wanted == "bgr8" and encoding_in == "32SC1":
        return coloured_labels(source)
    if do_dynamic_scaling:
        finite = source[~np.isinf(source)]
        min_image_value, max_image_value = float(np.nanmin(finite)), float(np.nanmax(finite))
        if min_image_value == max_image_value:
            return np.full((*source.shape[:2], 3), 128, np.uint8)
    if min_image_value != max_image_value:
        if channels_of(encoding_in) != 1:
            raise RuntimeError(
                "cv_bridge.cvtColorForDisplay() scaling for images "
                "with more than one channel is unsupported"
            )
        factor = 255.0 / (max_image_value - min_image_value)
        scaled = saturated((source - np.float64(min_image_value)) * factor, np.dtype(np.uint8))
        if colormap == -1:
            return cvtColor2(scaled, "mono8", wanted)
        import cv2

        mapped = cv2.applyColorMap(scaled, colormap)
        mapped[np.isnan(source)] = 0
        return cvtColor2(mapped, "bgr8", wanted)
    guessed = {"8UC1": "mono8", "16UC1": "mono16", "8UC3": "bgr8", "8UC4": "bgra8"}
    return cvtColor2(source, guessed.get(encoding_in, encoding_in), wanted)


def coloured_labels(labels: Pixels) -> Pixels:
    """Return an image with one colour per label: neighbours differ, 0 is black."""
    # The bits of a label are distributed over the three colours, the lowest to the highest bit of a
    # colour.
    number = labels.astype(np.int64)
    colours = np.zeros((*labels.shape, 3), np.uint8)
    for bit in range(24):
        shifted = ((number >> bit) & 1) << (7 - bit // 3)
        colours[..., 2 - bit % 3] |= shifted.astype(np.uint8)
    colours[(number != 0) & (number % 8 == 7)] |= 0x7F
    return colours
