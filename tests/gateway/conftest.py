"""A robot without a network, and clients of its gateway without sockets."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from typing import TYPE_CHECKING

import pytest

from aionode.gateway.session.robot import Robot
from aionode.node import Node
from aionode.testing import settle
from tests.support.gateway_bench import Bench, bench_of_gateway
from tests.support.rosbridge import RosbridgeClient, robot_of, rosbridge_client

if TYPE_CHECKING:
    from tests.support.mcp_bench import Bench as AssistedBench

Make = Callable[..., Node]


@pytest.fixture
async def node(node_factory: Make) -> Node:
    """Return a running node of the robot."""
    node = node_factory("robot_node")
    await settle()
    return node


@pytest.fixture
async def robot(node: Node, node_factory: Make) -> AsyncIterator[Robot]:
    """Yield the state shared by the sessions of a gateway."""
    gateway = node_factory("aionode_gateway")
    await settle()
    async with robot_of(gateway) as robot:
        yield robot


@pytest.fixture
async def client(robot: Robot) -> AsyncIterator[RosbridgeClient]:
    """Yield a client that has requested errors."""
    async with rosbridge_client(robot) as client:
        client.send("set_level", level="error")
        yield client


@pytest.fixture
async def bench() -> AsyncIterator[Bench]:
    """Yield a gateway without a server that allows everything, with time set by the test."""
    async with bench_of_gateway() as bench:
        yield bench


@pytest.fixture(params=["in process", "http"])
async def assisted(request: pytest.FixtureRequest) -> AsyncIterator[AssistedBench]:
    """Yield a robot with an assistant, whose clients are in this process or use HTTP."""
    from tests.support.mcp_bench import bench_of  # takes a second, which other tests need not

    async with bench_of(over_http=request.param == "http") as bench:
        yield bench


@pytest.fixture(params=["auto", "legacy"], ids=["2026-07-28", "2025-11-25"])
def era(request: pytest.FixtureRequest) -> str:
    """Return how MCP clients connect: by the newest revision, or by an older one."""
    return str(request.param)
