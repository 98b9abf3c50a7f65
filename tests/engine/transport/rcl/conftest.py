"""Find the real rclpy of ROS, as other tests of this process may have installed aionode's."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.support.without_ros import without_ros


@pytest.fixture(autouse=True)
def of_ros(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Return the rclpy that is installed."""
    with without_ros():
        yield
        monkeypatch.undo()  # # later it would remove aionode's modules, which are back by then
