"""Processes with the rclpy of ROS, or none: other tests of this process may have aionode's."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.support.without_ros import without_ros


@pytest.fixture(autouse=True)
def of_ros(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The rclpy that is installed."""
    with without_ros():
        yield
        monkeypatch.undo()  # later it would take aionode's modules away, which are back by then
