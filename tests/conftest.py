"""What every test of the project runs under: debug mode, and both event loops where it matters."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest
import uvloop

from aionode.node import Node

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable

    from aionode.context import Context


class DebugPolicy(asyncio.DefaultEventLoopPolicy):
    """asyncio's own loop, in debug mode: it reports forgotten coroutines and foreign threads."""

    def new_event_loop(self) -> asyncio.AbstractEventLoop:
        loop = super().new_event_loop()
        loop.set_debug(True)
        loop.slow_callback_duration = 60.0  # measuring is the business of benchmarks
        return loop


@pytest.fixture(
    params=[
        pytest.param(DebugPolicy(), id="asyncio"),
        pytest.param(uvloop.EventLoopPolicy(), id="uvloop"),
    ]
)
def event_loop_policy(request: pytest.FixtureRequest) -> asyncio.AbstractEventLoopPolicy:
    """Run each async test on asyncio and on uvloop."""
    policy: asyncio.AbstractEventLoopPolicy = request.param
    return policy


@pytest.fixture
async def node(node_factory: Callable[..., Node]) -> AsyncIterator[Node]:
    """A running node in a context without network."""
    yield node_factory("node")


@pytest.fixture
async def context(aionode_context: Context) -> Context:
    """An open context without network."""
    return aionode_context
