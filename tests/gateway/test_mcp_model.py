"""A model drives the rover through the program in which it runs, which starts `aionode mcp`.

An environment variable names the program, since most machines have none::

    AIONODE_MODEL_CLIENT='claude -p {prompt} --mcp-config {config} --allowedTools "mcp__robot__*"'

It is run once, with the settings and a task. In its place, a script does the same here.
"""

from __future__ import annotations

import asyncio
import json
import math
import os
import shlex
import sys
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Final

import pytest

from aionode.engine.context import Context
from aionode.examples import rover as rover_package
from aionode.examples.rover.description import Description
from aionode.examples.rover.driver import Driver
from aionode.examples.rover.simulator import Simulator
from tests.support.peers import DOMAIN_ID, isolated_environment
from tests.support.waiting import until

PROMPT: Final = (
    "You control a small robot by the tools of the MCP server `robot`. Find the orange ball with "
    "its camera, and drive towards it until it is less than a metre away. Then call `stop`."
)

SCRIPT: Final = f"{shlex.quote(sys.executable)} -m tests.support.scripted_model {{config}}"

MODEL: Final = os.environ.get("AIONODE_MODEL_CLIENT", "")


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.one_loop
@pytest.mark.timeout(600)
@pytest.mark.parametrize(
    "command",
    [
        pytest.param(SCRIPT, id="script"),
        pytest.param(
            MODEL,
            id="model",
            marks=pytest.mark.skipif(not MODEL, reason="AIONODE_MODEL_CLIENT names no program"),
        ),
    ],
)
async def test_a_model_drives_to_the_ball(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It looks, moves, and leaves the rover at a standstill near the ball."""
    environment = isolated_environment()
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    async with AsyncExitStack() as stack:
        context = await stack.enter_async_context(Context(domain_id=DOMAIN_ID))
        simulator = await stack.enter_async_context(Simulator(context=context))
        for part in (Driver, Description):
            await stack.enter_async_context(part(context=context))

        await run_client(command, settings(tmp_path, environment))
        await until(lambda: simulator.speed == 0.0)
        world = simulator.world
        distance = math.dist(world.rover[:2], world.ball)
        driven = math.dist(world.rover[:2], (-2.0, -1.0))

    assert driven > 0.1
    assert distance < 1.0


def settings(folder: Path, environment: dict[str, str]) -> Path:
    """Write the settings of a client that starts `aionode mcp`, and return their file."""
    policy = str(Path(rover_package.__path__[0]) / "policy.toml")
    words = ["-m", "aionode", "mcp", "--policy", policy, "--domain", str(DOMAIN_ID)]
    robot = {"command": sys.executable, "args": words, "env": environment}
    path = folder / "mcp.json"
    path.write_text(json.dumps({"mcpServers": {"robot": robot}}), encoding="utf-8")
    return path


async def run_client(command: str, config: Path) -> None:
    """Run the program of a model until it ends."""
    words = [word.format(config=config, prompt=PROMPT) for word in shlex.split(command)]
    program = await asyncio.create_subprocess_exec(*words)
    try:
        assert await program.wait() == 0
    finally:
        if program.returncode is None:
            program.kill()
            await program.wait()
