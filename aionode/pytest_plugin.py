"""Fixtures for tests of nodes; pytest finds them as soon as aionode is installed.

Two of them are async, and need pytest-asyncio, in either of its modes, or the plugin of anyio,
which runs tests marked with ``@pytest.mark.anyio``. pytest starts without either.
"""

from __future__ import annotations

import asyncio
from types import FunctionType, ModuleType
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable

    from aionode.context import Context
    from aionode.node import Node
    from aionode.testing import ManualClock

__all__ = ["aionode_context", "manual_clock", "node_factory", "pytest_configure"]


@pytest.fixture
def manual_clock() -> ManualClock:
    """A clock that stands still until the test advances it; `aionode_context` follows it."""
    from aionode.testing import ManualClock  # imported by tests that use it only

    return ManualClock()


@pytest.fixture
def aionode_context(request: pytest.FixtureRequest) -> Context:
    """An open context without network; its time is `manual_clock` if the test uses that fixture.

    During the test it is the default context, so nodes created without one join it too.
    """
    context: Context = async_fixture(request, "context")
    return context


@pytest.fixture
def node_factory(request: pytest.FixtureRequest) -> Callable[..., Node]:
    """Create nodes in `aionode_context` that run until the test ends.

    ``node_factory("talker")`` creates a plain node and takes the arguments of `Node`;
    ``node_factory(Talker)`` creates one of your own class, with the arguments that follow. A
    callback that failed makes the test fail at its end.
    """
    make: Callable[..., Node] = async_fixture(request, "factory")
    return make


# The async fixtures exist once for each plugin that can run them; the test determines which runs.


def pytest_configure(config: pytest.Config) -> None:
    """Register the async fixtures with the plugins that can run them."""
    makers: dict[str, Callable[..., Any]] = {"anyio": pytest.fixture}
    if config.pluginmanager.hasplugin("asyncio"):
        import pytest_asyncio

        makers["asyncio"] = pytest_asyncio.fixture
    fixtures = ModuleType("aionode_async_fixtures")
    for plugin, fixture in makers.items():
        for what, function in (("context", open_context), ("factory", open_factory)):
            name = f"aionode_{plugin}_{what}"
            # A copy: pytest-asyncio marks the function itself.
            own = FunctionType(function.__code__, function.__globals__, function.__name__)
            setattr(fixtures, name, fixture(name=name)(own))
    config.pluginmanager.register(fixtures, "aionode-async-fixtures")


def async_fixture(request: pytest.FixtureRequest, name: str) -> Any:
    """Return the value of an async fixture, from the plugin that runs the test."""
    if "anyio_backend" in request.fixturenames:
        return request.getfixturevalue(f"aionode_anyio_{name}")
    if request.config.pluginmanager.hasplugin("asyncio"):
        return request.getfixturevalue(f"aionode_asyncio_{name}")
    raise pytest.UsageError(
        f"{request.fixturename}: no plugin runs async fixtures; pip install pytest-asyncio, or "
        "mark the test with @pytest.mark.anyio"
    )


async def open_context(request: pytest.FixtureRequest) -> AsyncIterator[Context]:
    """Implement `aionode_context`."""
    from aionode.context import Context  # as above
    from aionode.testing import local_context

    clock = (
        request.getfixturevalue("manual_clock") if "manual_clock" in request.fixturenames else None
    )
    async with local_context(clock=clock) as context:
        with Context.as_default(context):
            yield context


async def open_factory(aionode_context: Context) -> AsyncIterator[Callable[..., Node]]:
    """Implement `node_factory`."""
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
        # pytest may end a fixture in a different task, which a TaskGroup does not allow.
        runs.append(asyncio.get_running_loop().create_task(run(node)))
        return node

    yield make
    for node in nodes:
        node.destroy_node()
    outcomes = await asyncio.gather(*runs, return_exceptions=True)
    failures = [outcome for outcome in outcomes if isinstance(outcome, Exception)]
    if failures:
        raise ExceptionGroup("callbacks of nodes failed", failures)
