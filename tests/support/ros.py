"""Whether tests over an installed ROS 2 can run, and its processes."""

from __future__ import annotations

import functools
import importlib.util
import os

__all__ = ["ros_domain", "ros_missing"]


@functools.cache
def ros_missing() -> str:
    """Return why tests with an installed ROS 2 cannot run here; empty if they can."""
    for package in ("rclpy", "std_msgs", "test_msgs"):
        if importlib.util.find_spec(package) is None:
            return (
                f"{package} is not installed: pip install 'aionode[ros]' (Linux x86-64), or source "
                "a ROS 2; see CONTRIBUTING.md"
            )
    return ""


def ros_domain() -> int:
    """Return a domain of this process alone, below 102, from where on ports are ephemeral."""
    return 1 + os.getpid() % 100
