"""A transcript of tool calls drives the rover, like a model that looks for the ball."""

from __future__ import annotations

import asyncio
import base64
import io
import math
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path
from typing import Any, NamedTuple

import mcp
import numpy as np
from PIL import Image

from aionode.examples import rover as rover_package
from aionode.examples.rover.description import Description
from aionode.examples.rover.driver import Driver
from aionode.examples.rover.simulator import Simulator
from aionode.gateway import Assistant, Policy
from aionode.node import Node
from aionode.testing import local_context
from tests.support.waiting import until

POLICY = Policy.load(Path(rover_package.__path__[0]) / "policy.toml")


class Scene(NamedTuple):
    """The rover, and a client of its assistant."""

    simulator: Simulator
    client: Any

    async def call(self, tool: str, /, **arguments: Any) -> Any:
        """Return what a tool has answered."""
        answered = await self.client.call_tool(tool, arguments)
        assert not answered.is_error, answered.content
        return answered


@asynccontextmanager
async def rover_scene(era: str) -> AsyncIterator[Scene]:
    """Yield the rover in real time, without a network."""
    async with AsyncExitStack() as stack:
        context = await stack.enter_async_context(local_context())
        simulator = await stack.enter_async_context(Simulator(context=context))
        await stack.enter_async_context(Driver(context=context))
        await stack.enter_async_context(Description(context=context))
        node = await stack.enter_async_context(Node("mcp", context=context))
        assistant = await stack.enter_async_context(Assistant(node, POLICY))
        mode: Any = era
        client = await stack.enter_async_context(mcp.Client(assistant.server, mode=mode))
        yield Scene(simulator, client)


def ball_in(picture: Any) -> float | None:
    """Return where the ball is in an image, from -1 at the left to 1; None if it is not visible."""
    image = Image.open(io.BytesIO(base64.b64decode(picture.data))).convert("RGB")
    pixels = np.asarray(image).astype(int)
    orange = (pixels[..., 0] > 150) & (pixels[..., 0] - pixels[..., 2] > 90)
    columns = np.flatnonzero(orange.any(axis=0))
    return float(columns.mean() / pixels.shape[1] * 2 - 1) if columns.size > 2 else None


async def test_a_transcript_of_calls_drives_the_rover(era: str) -> None:
    """Look, find the ball, drive there, be interrupted, stop."""
    async with rover_scene(era) as scene:
        # Look around until the ball is in sight, and ahead.
        seen = None
        for _ in range(20):
            picture = (await scene.call("look")).content[0]
            seen = ball_in(picture)
            if seen is not None and abs(seen) < 0.4:
                break
            turn = 0.8 if seen is None else -0.5 * seen
            await scene.call(
                "move", topic="/cmd_vel", message={"angular": {"z": turn}}, seconds=0.4
            )
        assert seen is not None

        # Drive towards it.
        where = (
            await scene.call("transform", target="odom", source="base_link")
        ).structured_content
        place, yaw = where["value"]["transform"]["translation"], where["yaw"]["value"]
        goal = {"x": place["x"] + math.cos(yaw), "y": place["y"] + math.sin(yaw)}
        before = scene.simulator.world.rover[:2]
        async with asyncio.TaskGroup() as tasks:
            driving = tasks.create_task(scene.client.call_tool("do_drive_to", goal))
            await until(lambda: math.dist(scene.simulator.world.rover[:2], before) > 0.1)

            # Somebody interrupts.
            stopped = (await scene.call("stop")).structured_content
        await until(lambda: scene.simulator.speed == 0.0)

        assert stopped["ended"] == ["/drive_to (visitor)"]
        assert driving.result().structured_content["outcome"].endswith("by stop of visitor")
        assert driving.result().structured_content["status"] == "canceled"
        rested = scene.simulator.world.rover
        watched = (await scene.call("watch", topic="/odom", seconds=0.3)).structured_content
        assert watched["fields"]["twist.twist.linear.x"]["max"] == 0.0
        assert scene.simulator.world.rover == rested


async def test_a_goal_out_of_reach_says_why(era: str) -> None:
    """The reason given by the robot, on which the model can act."""
    async with rover_scene(era) as scene:
        rejected = await scene.client.call_tool("do_drive_to", {"x": 100.0, "y": 0.0})

    assert rejected.is_error
    assert rejected.structured_content["code"] == "failed"
    assert "rejected" in rejected.content[0].text
