"""Fixtures for tests of nodes; pytest finds them as soon as aionode is installed.

The fixtures are async and need pytest-asyncio.
"""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest
import pytest_asyncio

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable

    from aionode.context import Context
    from aionode.node import Node
    from aionode.testing import ManualClock

__all__ = ["aionode_context", "manual_clock", "node_factory"]


@pytest.fixture
def manual_clock() -> ManualClock:
    """A clock that stands still until the test moves it; `aionode_context` follows it."""
    from aionode.testing import ManualClock  # only tests that use it pay for it

    return ManualClock()


@pytest_asyncio.fixture
async def aionode_context(request: pytest.FixtureRequest) -> AsyncIterator[Context]:
    """An open context without network; its time is `manual_clock` if the test asks for that.

    During the test it is the default context, so that nodes made without one are in it too.
    """
    from aionode.context import Context  # as above
    from aionode.testing import local_context

    clock = (
        request.getfixturevalue("manual_clock") if "manual_clock" in request.fixturenames else None
    )
    async with local_context(clock=clock) as context:
        with Context.as_default(context):
            yield context


@pytest_asyncio.fixture
async def node_factory(aionode_context: Context) -> AsyncIterator[Callable[..., Node]]:
    """Make nodes in `aionode_context` that run until the test ends.

    ``node_factory("talker")`` makes a plain node and takes what `Node` takes;
    ``node_factory(Talker)`` makes one of your own, with the arguments that follow. A callback that
    failed makes the test fail at its end.
    """
    from aionode.node import Node  # as above

    nodes: list[Node] = []
    runs: list[asyncio.Task[None]] = []

    async def run(node: Node) -> None:
        if not node.destroyed and not node.is_running:
            await node.run()

    def make(kind: str | Callable[..., Node] = "node", /, *args: Any, **options: Any) -> Node:
        if isinstance(kind, str):
            node = Node(kind, *args, **{"context": aionode_context, **options})
        else:
            node = kind(*args, **options)
        nodes.append(node)
        # pytest may end a fixture in another task than it began in, which a TaskGroup forbids.
        runs.append(asyncio.get_running_loop().create_task(run(node)))
        return node

    yield make
    for node in nodes:
        node.destroy_node()
    outcomes = await asyncio.gather(*runs, return_exceptions=True)
    failures = [outcome for outcome in outcomes if isinstance(outcome, Exception)]
    if failures:
        raise ExceptionGroup("callbacks of nodes failed", failures)
