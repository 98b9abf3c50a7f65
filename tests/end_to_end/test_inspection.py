"""Tools that look at a running node do not disturb it."""

from __future__ import annotations

import asyncio

import pytest

from aionode.engine.context import Context
from aionode.node import Node
from aionode.parameter import Parameter
from aionode.parameter_client import AsyncParameterClient
from tests.end_to_end.process import Process

MEMBER = "tests/end_to_end/inspected_member.py"


@pytest.mark.parametrize(
    "program",
    [(MEMBER,), ("-m", "aionode", "run", MEMBER, "rclpy")],
    ids=["aionode", "rclpy"],
)
async def test_a_node_without_arrays_serves_its_parameters_without_numpy(
    program: tuple[str, ...],
) -> None:
    """Importing it stopped a moving robot's loop for 90 ms when a parameter was read or set."""
    with Process(*program, fresh=True) as process:
        await asyncio.to_thread(process.expect, "ready")
        async with Node("inspector", context=Context()) as node:
            client = AsyncParameterClient(node, "/inspected")
            assert await client.wait_for_services(timeout_sec=20)

            await client.list_parameters()
            await client.describe_parameters(["speed"])
            assert (await client.get_parameters(["speed"]))[0].value == 1.0
            await client.set_parameters([Parameter("speed", value=2.0)])
            await client.set_parameters_atomically([Parameter("end", value=True)])

            await asyncio.to_thread(process.expect, "numpy False")
