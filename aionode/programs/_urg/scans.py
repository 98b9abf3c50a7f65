"""The measurements of a Hokuyo as messages."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from aionode import Node
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.sensor_msgs.msg import LaserEcho, LaserScan, MultiEchoLaserScan
from aionode.programs._urg.scip import Limits

__all__ = ["Echoes", "Window"]

Values = npt.NDArray[np.int64]
"""Distances in millimetres, and intensities if there are any, by step, or by step and echo."""


class Window(NamedTuple):
    """What a lidar is set to measure.

    Attributes:
        limits: What the lidar can measure.
        first: The first step.
        last: The last one.
        cluster: How many steps make a point.
        latency_sec: What is added to the time of scans, in seconds.
        frame_id: The frame of the lidar.
    """

    limits: Limits
    first: int
    last: int
    cluster: int
    latency_sec: float
    frame_id: str

    @property
    def size(self) -> int:
        """The most points of a scan."""
        return self.last - self.first + 1

    @property
    def turn_sec(self) -> float:
        """The time from the back, where a revolution begins, to the first step."""
        part = (self.limits.angle(self.first) + math.pi) / math.tau
        return part * self.limits.period_sec

    def command(self, skip: int, *, has_echoes: bool, is_intense: bool) -> str:
        """Return the command for endless scans."""
        kind = ("N" if has_echoes else "M") + ("E" if is_intense else "D")
        return f"{kind}{self.first:04d}{self.last:04d}{self.cluster:02d}{skip:01d}00"

    def filled(self, kind: Callable[..., Any], stamp: Time) -> Any:
        """Return a message without ranges."""
        limits = self.limits
        message = kind(
            angle_min=limits.angle(self.first),
            angle_max=limits.angle(self.last),
            angle_increment=self.cluster * math.tau / limits.ares,
            time_increment=self.cluster * limits.period_sec / limits.ares,
            scan_time=limits.period_sec,
            range_min=limits.dmin / 1e3,
            range_max=limits.dmax / 1e3,
        )
        message.header.stamp, message.header.frame_id = stamp, self.frame_id
        return message

    def scan(self, stamp: Time, values: Values) -> LaserScan:
        """Return a scan with one echo of each step."""
        scan: LaserScan = self.filled(LaserScan, stamp)
        is_there = values[0] > 0
        scan.ranges = np.where(is_there, values[0] / 1e3, math.nan).astype(np.float32)
        if len(values) > 1:
            scan.intensities = np.where(is_there, values[1], 0).astype(np.float32)
        return scan

    def echoes(self, stamp: Time, values: Values) -> MultiEchoLaserScan:
        """Return a scan with all echoes of each step."""
        message: MultiEchoLaserScan = self.filled(MultiEchoLaserScan, stamp)
        counts = counted(values)
        ranges = (values[0] / 1e3).astype(np.float32)
        message.ranges = [
            LaserEcho(echoes=row[:count]) for row, count in zip(ranges, counts, strict=True)
        ]
        if len(values) > 1:
            intensities = values[1].astype(np.float32)
            message.intensities = [
                LaserEcho(echoes=row[:count])
                for row, count in zip(intensities, counts, strict=True)
            ]
        return message


def counted(values: Values) -> Values:
    """Return the number of echoes of each step: those before the first zero."""
    return np.asarray(np.cumprod(values[0] > 0, axis=1).sum(axis=1))


def first(values: Values) -> Values:
    """Return the first echo of each step."""
    return values[..., 0]


def last(values: Values) -> Values:
    """Return the last echo of each step."""
    return picked(values, np.maximum(counted(values) - 1, 0))


def most_intense(values: Values) -> Values:
    """Return the echo of each step with the greatest intensity."""
    is_there = np.arange(values.shape[2]) < counted(values)[:, None]
    return picked(values, np.argmax(np.where(is_there, values[-1], -1), axis=1))


def picked(values: Values, at: Values) -> Values:
    """Return one echo of each step."""
    return values[:, np.arange(values.shape[1]), at]


PICKS: Final[dict[str, Callable[[Values], Values]]] = {
    "first": first,
    "last": last,
    "most_intense": most_intense,
}


class Echoes:
    """Publishes all echoes on `echoes`, and one of each step on `first`, `last`, `most_intense`.

    Args:
        node: The node whose topics these are.
    """

    def __init__(self, node: Node) -> None:
        self.all = node.create_publisher(MultiEchoLaserScan, "echoes", 20)
        self.picks = [
            (node.create_publisher(LaserScan, name, 20), pick) for name, pick in PICKS.items()
        ]

    def publish(self, window: Window, stamp: Time, values: Values) -> None:
        """Publish a scan on the topics that have subscriptions."""
        if self.all.get_subscription_count():
            self.all.publish(window.echoes(stamp, values))
        for publisher, pick in self.picks:
            if publisher.get_subscription_count() and (pick is not most_intense or len(values) > 1):
                publisher.publish(window.scan(stamp, pick(values)))
