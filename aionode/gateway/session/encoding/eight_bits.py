"""Images as screens show them: eight bits of grey, or of red, green and blue."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from aionode import image

if TYPE_CHECKING:
    import numpy.typing as npt

    from aionode.interfaces.sensor_msgs.msg import Image

__all__ = ["eight_bits"]

YUYV: Final = {"yuv422_yuy2", "yuyv"}
"""Encodings in which the brightness comes first; in ``yuv422`` and ``uyvy`` it comes second."""


def eight_bits(message: Image) -> Image:
    """Return an image as mono8, rgb8 or rgba8; a mono8 or rgb8 image is returned unchanged.

    Grey of other types, such as depth, is scaled from its smallest to its largest value; NaN and
    infinities become dark. 16-bit colours lose their lower bits. Unnamed channels are in OpenCV's
    order: blue, green, red. Each square of four pixels of a Bayer pattern gets one colour.

    Raises:
        MessageError: its data is too short for its size, or its encoding is unknown (a ValueError).
        ValueError: its channels are not colours.
    """
    encoding = message.encoding
    if encoding in {"mono8", "rgb8", "rgba8"}:
        return message
    pixels = image.to_numpy(message)
    if match := re.fullmatch(r"bayer_([rgb]{4})(?:8|16)", encoding):
        return image.from_numpy(from_bayer(grey(pixels), match[1]), "rgb8")
    if encoding.startswith(("yuv", "uyvy", "yuyv")):
        return image.from_numpy(from_yuv(pixels, first=encoding in YUYV), "rgb8")
    if pixels.ndim == 2:
        return image.from_numpy(grey(pixels), "mono8")
    if pixels.shape[2] not in {3, 4}:
        raise ValueError(f"{encoding}: {pixels.shape[2]} channels cannot be shown; use 1, 3 or 4")
    colors = pixels >> 8 if encoding.endswith("16") else grey(pixels)
    order = [0, 1, 2] if encoding.startswith("rgb") else [2, 1, 0]
    order += [3] if pixels.shape[2] == 4 else []
    name = "rgba8" if len(order) == 4 else "rgb8"
    return image.from_numpy(np.ascontiguousarray(colors[:, :, order], np.uint8), name)


def grey(pixels: npt.NDArray[Any]) -> npt.NDArray[np.uint8]:
    """Return numbers of any type as eight bits: unchanged, or scaled by their range."""
    if pixels.dtype == np.uint8:
        return pixels
    numbers = pixels.astype(np.float64)
    finite = np.isfinite(numbers)
    if not finite.any():
        return np.zeros(pixels.shape, np.uint8)
    low, high = numbers[finite].min(), numbers[finite].max()
    # The range of two large numbers may overflow.
    scaled = (numbers / 2 - low / 2) / (high / 2 - low / 2) * 255 if high > low else finite * 255.0
    return np.where(finite, np.round(scaled), 0.0).astype(np.uint8)


def from_bayer(pixels: npt.NDArray[np.uint8], pattern: str) -> npt.NDArray[np.uint8]:
    """Return the colours of a Bayer pattern, such as ``rggb``; each square of four has one."""
    height, width = pixels.shape
    even = np.pad(pixels, ((0, height % 2), (0, width % 2)), "edge").astype(np.uint16)
    places = [even[0::2, 0::2], even[0::2, 1::2], even[1::2, 0::2], even[1::2, 1::2]]
    channels = []
    for color in "rgb":
        found = [place for place, name in zip(places, pattern, strict=True) if name == color]
        channels.append(sum(found[1:], found[0]) // len(found))
    squares = np.stack(channels, axis=2).astype(np.uint8)
    return squares.repeat(2, axis=0).repeat(2, axis=1)[:height, :width]


def from_yuv(pixels: npt.NDArray[np.uint8], *, first: bool) -> npt.NDArray[np.uint8]:
    """Return the colours of pixels whose chroma is shared by pairs (BT.601).

    Args:
        pixels: Two bytes for each: brightness, and alternately the blue and the red difference.
        first: Whether the brightness is the first of them.
    """
    width = pixels.shape[1]
    bright = pixels[:, :, 0 if first else 1].astype(np.float32)
    shared = pixels[:, :, 1 if first else 0].astype(np.float32) - 128
    blue, red = (
        shared[:, start::2].repeat(2, axis=1)[:, :width] if width > 1 else np.zeros_like(bright)
        for start in (0, 1)
    )
    if width % 2:  # the last pixel has no partner, so it takes the red of the one before
        red = np.pad(red, ((0, 0), (0, width - red.shape[1])), "edge")
    colors = [bright + 1.402 * red, bright - 0.344 * blue - 0.714 * red, bright + 1.772 * blue]
    return np.clip(np.round(np.stack(colors, axis=2)), 0, 255).astype(np.uint8)
