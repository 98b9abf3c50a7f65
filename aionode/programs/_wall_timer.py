"""Timers that also run while simulated time stands still, as rclcpp's `create_wall_timer`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from aionode import Clock, ClockType, Node, Timer

__all__ = ["create_wall_timer", "wall_clock"]


def wall_clock(node: Node) -> Clock:
    """Return the machine's monotonic clock, whatever time the node follows."""
    return Clock(ClockType.STEADY_TIME, time_base=node.context.time_base)


def create_wall_timer(
    node: Node, period_sec: float, callback: Callable[[], Any], *, autostart: bool = True
) -> Timer:
    """Create a timer that does not follow simulated time.

    Programs search for topics and devices, repeat commands and update what they show in real time:
    a simulator that has not started, is paused or is slow must not stop them.
    """
    return node.create_timer(period_sec, callback, wall_clock(node), autostart)
