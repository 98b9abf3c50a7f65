"""The packets of points that a YDLIDAR sends while it scans."""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["Kind", "Packet", "Packets", "Points"]

HEADER: Final = b"\xaa\x55"
HEADER_SIZE: Final = 10
MAX_POINTS: Final = 80
"""The most points of a packet; a larger number is not the start of one."""

ERRORS: Final = 2
"""Consecutive wrong checksums after which points are assumed to be larger or smaller."""

SAMPLES: Final = {
    0: np.dtype([("distance", "<u2")]),
    8: np.dtype([("intensity", "u1"), ("distance", "<u2")]),
    10: np.dtype([("intensity", "u1"), ("distance", "<u2")]),
    16: np.dtype([("intensity", "<u2"), ("distance", "<u2")]),
}
"""The form of a point, by the bits of its intensity."""


class Kind(NamedTuple):
    """How distances are measured.

    Attributes:
        units: How many units of a distance are a metre.
        beside_mm: How far the detector is off the axis, which makes near points appear rotated.
        span_mm: The distance at which they do not; 0 for none.
    """

    units: float
    beside_mm: float = 0.0
    span_mm: float = 0.0


class Points(NamedTuple):
    """Points in the order in which they were measured.

    Attributes:
        angles: Clockwise, in radians, from 0 to 2π.
        ranges: In metres; 0 where nothing was measured.
        intensities: Zeros if the lidar sends none.
    """

    angles: npt.NDArray[np.float64]
    ranges: npt.NDArray[np.float64]
    intensities: npt.NDArray[np.float64]


class Packet(NamedTuple):
    """Points next to each other.

    Attributes:
        is_start: Whether a revolution starts with it.
        first: The angle of the first point, in degrees.
        last: The angle of the last point, in degrees.
        samples: Distances, and intensities if there are any.
        bits: The bits of an intensity.
    """

    is_start: bool
    first: float
    last: float
    samples: npt.NDArray[Any]
    bits: int

    def points(self, kind: Kind) -> Points:
        """Return the points, for a kind of lidar."""
        count = len(self.samples)
        span = (self.last - self.first) % 360.0
        angles = np.radians(self.first + span * np.arange(count) / max(count - 1, 1))
        distances = self.samples["distance"]
        intensities = np.zeros(count)
        if self.bits:
            intensities += self.samples["intensity"]
        if self.bits == 10:
            intensities += (distances & 3).astype(np.float64) * 256
        if self.bits in {8, 10}:
            distances = distances & ~np.uint16(3)
        ranges = distances / kind.units
        if kind.beside_mm:
            millimetres = np.where(ranges, ranges * 1e3, math.inf)
            part = 1 / kind.span_mm if kind.span_mm else 0.0
            turned = np.arctan(kind.beside_mm * (1 / millimetres - part))
            angles = angles + np.where(ranges, turned, 0.0)
        return Points(angles % math.tau, ranges, intensities)


class Packets:
    """Finds the packets in a stream of bytes.

    Args:
        bits: The bits of an intensity; adjusted if the checksums show that it is another number.
    """

    def __init__(self, bits: int) -> None:
        self.bits = bits
        given = bits if SAMPLES[bits].itemsize == 3 else 8
        self.next_bits = {16: given, given: 0, 0: 16}
        self.errors = 0
        self.buffer = bytearray()

    def feed(self, data: bytes) -> list[Packet]:
        """Return the packets that are complete with these bytes; others are skipped."""
        buffer = self.buffer
        buffer += data
        found = []
        done = 0
        start = buffer.find(HEADER)
        while 0 <= start <= len(buffer) - HEADER_SIZE:
            end = start + self.size(start)
            if end > len(buffer):
                break
            packet = self.packet(start, end) if end > start else None
            if packet is not None:
                found.append(packet)
            done = start + len(HEADER) if packet is None else end
            start = buffer.find(HEADER, done)
        del buffer[: start if start >= 0 else max(len(buffer) - 1, done)]
        return found

    def size(self, start: int) -> int:
        """Return the size of the packet that starts there; 0 if none does."""
        head = self.buffer[start : start + HEADER_SIZE]
        count, has_angles = head[3], head[4] & head[6] & 1
        if not has_angles or not 0 < count <= MAX_POINTS:
            return 0
        return HEADER_SIZE + count * SAMPLES[self.bits].itemsize

    def packet(self, start: int, end: int) -> Packet | None:
        """Return the packet between two places; None if its checksum is wrong."""
        data = bytes(self.buffer[start:end])
        head = np.frombuffer(data, "<u2", HEADER_SIZE // 2)
        samples = np.frombuffer(data, SAMPLES[self.bits], offset=HEADER_SIZE)
        words = [head, *(samples[name].astype("<u2") for name in samples.dtype.names or ())]
        if np.bitwise_xor.reduce(np.concatenate(words)):
            self.errors += 1
            if self.errors >= ERRORS:
                self.bits, self.errors = self.next_bits[self.bits], 0
            return None
        self.errors = 0
        first, last = ((int(angle) >> 1) / 64 for angle in head[2:4])
        return Packet(bool(data[2] & 1), first, last, samples, self.bits)
