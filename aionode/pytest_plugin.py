"""Fixtures for tests of nodes; pytest finds them once aionode is installed.

Two of them are async and need pytest-asyncio, in either mode, or anyio's plugin, which runs tests
marked with ``@pytest.mark.anyio``. Without either, pytest starts all the same.
"""

from __future__ import annotations

import asyncio
from shutil import rmtree
from types import FunctionType, ModuleType
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable
    from os import PathLike

    from aionode.bag import Outputs, Replay
    from aionode.engine.context import Context
    from aionode.node import Node
    from aionode.testing import ManualClock

__all__ = [
    "aionode_context",
    "golden_bag",
    "manual_clock",
    "node_factory",
    "pytest_addoption",
    "pytest_configure",
    "replay_bag",
]

UPDATE = "--update-golden-bags"


@pytest.fixture
def manual_clock() -> ManualClock:
    """A clock that only the test advances; `aionode_context` follows it."""
    from aionode.testing import ManualClock  # imported by tests that use it only

    return ManualClock()


@pytest.fixture
def aionode_context(request: pytest.FixtureRequest) -> Context:
    """An open context without network; it follows `manual_clock` if the test uses that fixture.

    During the test it is the default context, so nodes created without one join it too.
    """
    context: Context = async_fixture(request, "context")
    return context


@pytest.fixture
def node_factory(request: pytest.FixtureRequest) -> Callable[..., Node]:
    """Create nodes in `aionode_context` that run until the test ends.

    ``node_factory("talker")`` creates a plain node and takes the arguments of `Node`;
    ``node_factory(Talker)`` creates an instance of your class, with the arguments that follow. If a
    callback fails, the test fails at its end.
    """
    make: Callable[..., Node] = async_fixture(request, "factory")
    return make


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that rewrites the recordings of `golden_bag`."""
    parser.addoption(
        UPDATE,
        action="store_true",
        help="aionode: record what nodes publish, as the new expectation of golden_bag",
    )


@pytest.fixture
def replay_bag(request: pytest.FixtureRequest) -> Callable[..., Replay]:
    """A function that runs nodes on a recording, as `aionode.bag.replay` does.

    Use it as ``async with replay_bag("run") as run``, and inside it ``await run.play(record=[…])``.

    A relative path starts at the folder of the test file.
    """
    from aionode.bag import replay  # the extra `bag` may be missing

    def run(path: str | PathLike[str], *, seed: int = 0) -> Replay:
        return replay(request.path.parent / path, seed=seed)

    return run


@pytest.fixture
def golden_bag(request: pytest.FixtureRequest) -> Callable[..., None]:
    """A function that compares outputs with those recorded when the test was written.

    ``golden_bag(outputs)`` fails the test with the first differences from the recording with the
    test's name in the folder ``golden`` beside the test file. ``pytest --update-golden-bags``
    writes it. Options are those of `aionode.bag.compare`, and `name` for another recording.
    """
    from aionode.bag import compare  # as above

    def check(outputs: Outputs, *, name: str = request.node.name, **options: Any) -> None:
        path = request.path.parent / "golden" / name
        if request.config.getoption(UPDATE):
            rmtree(path, ignore_errors=True)
            outputs.save(path)
        elif not path.exists():
            pytest.fail(f"{path} does not exist; pytest {UPDATE} writes it", pytrace=False)
        elif differences := compare(outputs, path, **options):
            lines = "\n".join(map(str, differences))
            pytest.fail(f"the outputs differ from {path}:\n{lines}", pytrace=False)

    return check


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
    from aionode.engine.context import Context  # as above
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
