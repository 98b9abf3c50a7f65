"""A process in which aionode stands in for ROS."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import pytest

import aionode.rclpy
from aionode.rclpy._finder import FINDER, EmptyLoader, InterfaceLoader, KindLoader


@pytest.fixture
def installed() -> Iterator[None]:
    """A process in which aionode stands in for ROS; message packages are forgotten afterwards."""
    aionode.rclpy.install()
    yield
    assert FINDER in sys.meta_path
    for name, module in list(sys.modules.items()):
        if isinstance(
            getattr(module, "__loader__", None), EmptyLoader | KindLoader | InterfaceLoader
        ):
            del sys.modules[name]
