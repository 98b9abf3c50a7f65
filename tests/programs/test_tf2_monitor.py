"""The program that prints how late transforms come."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.programs._tf2.monitor import Monitor
from aionode.testing import ManualClock, settle
from aionode.tf import TransformBroadcaster
from tests.programs.conftest import Start
from tests.support.transforms import transform


@pytest.fixture
async def robot(node_factory: Callable[..., Any], manual_clock: ManualClock) -> Callable[..., Any]:
    """A robot that publishes transforms half a second late, twice a second."""
    node: Node = node_factory("robot")
    broadcaster = TransformBroadcaster(node)

    async def move(seconds: float) -> None:
        for _ in range(round(seconds * 2)):
            now = node.get_clock().now().nanoseconds / 1e9
            broadcaster.sendTransform(transform("odom", "base", now - 0.5, (1.0, 0.0, 0.0)))
            broadcaster.sendTransform(transform("base", "arm", now - 0.25, (1.0, 0.0, 0.0)))
            await settle()
            await manual_clock.advance(0.5)

    return move


async def test_the_delays_of_all_frames_are_printed(start: Start, robot: Any) -> None:
    """Every ten seconds, in the words of the original."""
    texts: list[str] = []
    start(Monitor, None, texts.append)
    await robot(12.0)

    assert texts[0] == "Gathering data on all frames for 10 seconds...\n"
    lines = texts[1].splitlines()
    assert lines[3] == "RESULTS: for all Frames"
    author = "published by <no authority available>"
    assert f"Frame: arm, {author}, Average Delay: 0.25, Max Delay: 0.25" in lines
    assert f"Frame: base, {author}, Average Delay: 0.5, Max Delay: 0.5" in lines
    assert lines[-1].endswith("Hz, Average Delay: 0.375 Max Delay: 0.5")


async def test_between_two_frames_their_chain_counts(
    start: Start, robot: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    """It waits until there is one."""
    texts: list[str] = []
    start(Monitor, ("odom", "base"), texts.append)
    await robot(0.0)
    await robot(12.0)

    assert texts[0] == "Gathering data on odom -> base for 10 seconds...\n"
    assert "RESULTS: for odom to base\nChain is: " in texts[1]
    assert "Net delay     avg = " in texts[1]
    assert "Frame: arm" not in texts[1]
