"""A process in which aionode stands in for ROS."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import pytest

import aionode.rclpy
from aionode.rclpy import _finder


@pytest.fixture
def installed() -> Iterator[None]:
    """A process in which aionode stands in for ROS, and afterwards does not."""
    before = dict(sys.modules)
    aionode.rclpy.install()
    yield
    sys.meta_path.remove(_finder.FINDER)
    for name in set(sys.modules) - set(before):
        if not name.startswith("aionode"):
            del sys.modules[name]
