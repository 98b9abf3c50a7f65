"""Run rclpy programs on aionode: `install`, and ``python -m aionode.rclpy PROGRAM.py``.

After `install`, `rclpy`, `launch`, `tf2_ros`, message packages and other Python packages of ROS can
be imported under their own names. Their sources are in ``aionode/ros_packages``.
"""

from __future__ import annotations

import sys
from importlib.abc import MetaPathFinder
from typing import NoReturn

from aionode.rclpy._finder import install

__all__ = ["install"]


def __getattr__(name: str) -> NoReturn:
    """Raise an error that says where rclpy's names are."""
    raise AttributeError(remedy(name), name=name)


class MisplacedNames(MetaPathFinder):
    """Raises that error for ``from aionode.rclpy.node import Node``, which finds no module."""

    def find_spec(self, fullname: str, _path: object, _target: object = None) -> None:
        """Raise ModuleNotFoundError for a name that may be one of rclpy's."""
        package, _, name = fullname.rpartition(".")
        if package == __name__ and not name.startswith("_") and name not in globals():
            # Not `fullname`: `from aionode.rclpy import init` replaces such an error by its own.
            raise ModuleNotFoundError(remedy(name), name="rclpy")


def remedy(name: str) -> str:
    """Return the text of the error."""
    return (
        f"aionode.rclpy has no {name!r}: call aionode.rclpy.install(), then import rclpy's names "
        "from rclpy"
    )


sys.meta_path.append(MisplacedNames())  # the last one: it is asked for what no other has found
