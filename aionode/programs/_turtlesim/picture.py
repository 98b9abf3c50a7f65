"""The window of turtlesim as pixels: the lines that turtles have drawn, and the turtles."""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = ["METER", "SIZE", "Pen", "Picture", "png"]

SIZE: Final = 500
"""Width and height of the window, in pixels."""

METER: Final = 45.0
"""The number of pixels in a unit: the height of a turtle."""

SHELLS: Final = (
    (0x4E, 0x9A, 0x06), (0xC4, 0x7D, 0x2A), (0x8F, 0x59, 0x02), (0xCC, 0x44, 0x44),
    (0x75, 0x50, 0x7B), (0x2E, 0x8B, 0x8B), (0xD1, 0x6B, 0x9A), (0x9C, 0x9A, 0x2F),
)  # fmt: skip
"""The colors of shells, one for each turtle."""

SKIN: Final = (0xA8, 0xD0, 0x8D)

LIMBS: Final = ((16.0, 0.0, 6.0), (9.0, 12.0, 4.5), (9.0, -12.0, 4.5), (-10.0, 11.0, 4.0),
                (-10.0, -11.0, 4.0), (-16.5, 0.0, 2.0))  # fmt: skip
"""Head, legs and tail of a turtle that faces along x: centers and radii."""

REACH: Final = 24
"""Half the side of the square around a turtle, in pixels."""


@dataclass(frozen=True)
class Pen:
    """The pen of a turtle.

    Attributes:
        color: Red, green and blue.
        width: The width of its line, in pixels.
    """

    color: tuple[int, int, int] = (0xB3, 0xB8, 0xFF)
    width: int = 3


class Picture:
    """The window of turtlesim. Places are in pixels, from its upper left corner."""

    def __init__(self) -> None:
        self.lines: npt.NDArray[np.uint8] = np.empty((SIZE, SIZE, 3), np.uint8)
        self.is_drawn: npt.NDArray[np.bool_] = np.empty((SIZE, SIZE), np.bool_)
        self.clear()

    def clear(self) -> None:
        """Remove all lines."""
        self.lines[:] = 255
        self.is_drawn[:] = False

    def color_at(self, x: float, y: float) -> tuple[int, int, int]:
        """Return the color of a line; white where there is none."""
        red, green, blue = self.lines[round(y), round(x)].tolist()
        return red, green, blue

    def draw(self, pen: Pen, x1: float, y1: float, x2: float, y2: float) -> None:
        """Draw a line."""
        half = max(pen.width, 1) / 2
        columns = within(min(x1, x2) - half, max(x1, x2) + half)
        rows = within(min(y1, y2) - half, max(y1, y2) + half)
        x = np.arange(columns.start, columns.stop)[np.newaxis, :]
        y = np.arange(rows.start, rows.stop)[:, np.newaxis]
        dx, dy = x2 - x1, y2 - y1
        length = math.hypot(dx, dy)
        if length:
            along = np.clip(((x - x1) * (dx / length) + (y - y1) * (dy / length)) / length, 0, 1)
        else:
            along = np.zeros((1, 1))
        touched = np.hypot(x - (x1 + along * dx), y - (y1 + along * dy)) <= half
        self.lines[rows, columns][touched] = pen.color
        self.is_drawn[rows, columns] |= touched

    def painted(
        self, background: tuple[int, int, int], turtles: Iterable[tuple[float, float, float, int]]
    ) -> npt.NDArray[np.uint8]:
        """Return the picture with turtles on it.

        Args:
            background: The color of the empty window.
            turtles: The place of each, its direction in radians, and the number of its shell.
        """
        pixels = np.empty_like(self.lines)
        pixels[:] = background
        drawn = np.flatnonzero(self.is_drawn)
        pixels.reshape(-1, 3)[drawn] = self.lines.reshape(-1, 3)[drawn]
        for x, y, direction, shell in turtles:
            columns, rows = within(x - REACH, x + REACH), within(y - REACH, y + REACH)
            right = np.arange(columns.start, columns.stop)[np.newaxis, :] - x
            up = y - np.arange(rows.start, rows.stop)[:, np.newaxis]
            ahead = right * math.cos(direction) + up * math.sin(direction)
            aside = up * math.cos(direction) - right * math.sin(direction)
            part = pixels[rows, columns]
            for center, side, radius in LIMBS:
                part[np.hypot(ahead - center, aside - side) <= radius] = SKIN
            body = np.hypot(ahead / 14.0, aside / 11.0)
            color = np.array(SHELLS[shell % len(SHELLS)])
            part[body <= 1.0] = color // 2
            part[body <= 0.85] = color
        return pixels


def within(least: float, greatest: float) -> slice:
    """Return the pixels between two places that are in the window."""
    first = math.floor(min(max(least, 0.0), SIZE))
    return slice(first, max(first, math.ceil(min(max(greatest + 1, 0.0), SIZE))))


def png(pixels: npt.NDArray[np.uint8]) -> bytes:
    """Return red, green and blue pixels as a PNG file."""
    height, width = pixels.shape[:2]
    # each line begins with the number of a filter
    rows = np.zeros((height, 1 + 3 * width), np.uint8)
    rows[:, 1:] = pixels.reshape(height, -1)
    parts = (
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)),
        (b"IDAT", zlib.compress(rows.data, 1)),
        (b"IEND", b""),
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in parts
    )
