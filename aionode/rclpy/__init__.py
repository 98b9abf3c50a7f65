"""Run rclpy programs on aionode: `install`, and ``python -m aionode.rclpy PROGRAM.py``.

After `install`, `rclpy`, `launch`, `tf2_ros`, message packages and other Python packages of ROS can
be imported under their own names. Their sources are in ``aionode/ros_packages``.
"""

from __future__ import annotations

from typing import NoReturn

from aionode.rclpy._finder import install

__all__ = ["install"]


def __getattr__(name: str) -> NoReturn:
    """Raise an error that says where rclpy's names are."""
    problem = (
        f"aionode.rclpy has no {name!r}: call aionode.rclpy.install(), then import rclpy's names "
        "from rclpy"
    )
    raise AttributeError(problem, name=name)
