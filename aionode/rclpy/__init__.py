"""Programs of rclpy on aionode: `install`, and ``python -m aionode.rclpy PROGRAM.py``.

After `install`, `rclpy`, `launch`, `tf2_ros`, message packages and others of ROS's Python packages
are imported under their own names. Those in Python lie in the folder ``aionode/ros_packages``.
"""

from __future__ import annotations

from typing import NoReturn

from aionode.rclpy._finder import install

__all__ = ["install"]


def __getattr__(name: str) -> NoReturn:
    """Say where the names of rclpy are."""
    problem = (
        f"aionode.rclpy has no {name!r}: call aionode.rclpy.install(), then import rclpy's names "
        "from rclpy"
    )
    raise AttributeError(problem, name=name)
