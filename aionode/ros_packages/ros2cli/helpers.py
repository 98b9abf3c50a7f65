"""Helpers of commands."""

from __future__ import annotations

import math
import os
import threading
from collections.abc import Callable
from typing import Any

from aionode.clock import S_TO_NS, MachineTime

__all__ = ["get_ros_domain_id", "wait_for"]


def get_ros_domain_id() -> int:
    """Return the domain that ROS_DOMAIN_ID sets."""
    return int(os.environ.get("ROS_DOMAIN_ID", "0"))


def wait_for(predicate: Callable[[], Any], timeout: float, period: float = 0.1) -> bool:
    """Block until a predicate is true, and return whether it is.

    Args:
        predicate: The predicate.
        timeout: Maximum time in seconds; negative to wait forever.
        period: The time between two checks, in seconds.
    """
    pause = threading.Event()
    limit_ns = math.inf if timeout < 0 else MachineTime.steady_ns() + timeout * S_TO_NS
    while not predicate():
        if MachineTime.steady_ns() > limit_ns:
            return bool(predicate())
        pause.wait(period)
    return True
