"""The rover that learns to drive to the ball; the test moves the time."""

from __future__ import annotations

import asyncio
import math
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import numpy as np
import pytest

from aionode import Node
from aionode.examples.rover.learn import CONTRACT, demonstrate, drive, fitted
from aionode.examples.rover.simulator import Simulator
from aionode.learn import Contract, Episodes, export

if TYPE_CHECKING:
    from collections.abc import Coroutine

    from aionode import Context
    from aionode.testing import ManualClock

T = TypeVar("T")

pytestmark = pytest.mark.slow


async def passing(clock: ManualClock, work: Coroutine[object, object, T]) -> T:
    """Return what `work` returns, while up to a minute passes."""
    async with asyncio.TaskGroup() as tasks:
        working = tasks.create_task(work)
        for _ in range(1_200):
            if working.done():
                break
            await clock.advance(0.05)
        working.cancel()
    return working.result()


async def test_the_rover_learns_to_drive_to_the_ball(
    aionode_context: Context, manual_clock: ManualClock, tmp_path: Path
) -> None:
    """From headings that it was not shown, after ten demonstrations by a script."""
    async with (
        Simulator(context=aionode_context) as simulator,
        Node("learner", context=aionode_context) as node,
    ):
        async with Episodes(
            tmp_path / "demonstrations", Contract.load(CONTRACT), context=aionode_context
        ) as episodes:
            for seed in range(10):
                await passing(manual_clock, demonstrate(node, episodes, seed))
        export(tmp_path / "ball", [episodes.folder])
        weights = fitted(tmp_path / "ball")

        for heading in (2.5, -1.3):
            world = simulator.world
            world.reset()
            world.rover = world.rover._replace(heading=heading)
            stats = await passing(manual_clock, drive(node, weights))

            x, y = np.array(world.ball) - world.rover[:2]
            assert math.hypot(x, y) < 0.7
            assert abs(math.atan2(y, x) - world.rover.heading) < 0.2
            assert stats.underruns == 0
            await manual_clock.advance(0.5)
            assert (simulator.speed, simulator.turn) == (0.0, 0.0)
