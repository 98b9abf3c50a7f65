"""A process without ROS: message packages and `rclpy` cannot be imported."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from aionode.interfaces import shipped_packages
from aionode.rclpy._finder import FINDER, SUPPLIED

__all__ = ["without_ros"]


@contextmanager
def without_ros() -> Iterator[None]:
    """Undo `aionode.rclpy.install` for a while: other tests of this process may have called it."""
    finders, modules = list(sys.meta_path), dict(sys.modules)
    sys.meta_path[:] = [finder for finder in finders if finder is not FINDER]
    forget()
    try:
        yield
    finally:
        sys.meta_path[:] = finders
        forget()  # a part that stayed would not be in its package
        sys.modules.update(modules)


def forget() -> None:
    """Remove the modules of ROS's packages from this process."""
    for name in list(sys.modules):
        if name.partition(".")[0] in SUPPLIED | shipped_packages():
            del sys.modules[name]
