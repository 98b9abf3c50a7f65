"""What every test of the project runs under: debug mode, and both event loops."""

from __future__ import annotations

import asyncio
import functools
import inspect
from typing import TYPE_CHECKING, Any

import pytest
import uvloop
from hypothesis import settings

from aionode.node import Node

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Generator

    from aionode.context import Context

# For `make fuzz`. Tests that set a number of examples of their own take it as a part of this one.
settings.register_profile("fuzz", max_examples=2000, deadline=None)


def debugging_loop() -> asyncio.AbstractEventLoop:
    """Return asyncio's own loop, which reports forgotten coroutines and foreign threads."""
    loop = asyncio.new_event_loop()
    loop.set_debug(True)
    loop.slow_callback_duration = 60.0  # measuring is the business of benchmarks
    return loop


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let no async test wait for ever: uvloop swallows what pytest-timeout's signal raises."""
    for item in items:
        if isinstance(item, pytest.Function) and inspect.iscoroutinefunction(item.obj):
            marker = item.get_closest_marker("timeout")
            item.obj = bounded(item.obj, marker.args[0] if marker and marker.args else 60.0)


def bounded(test: Callable[..., Awaitable[None]], limit_s: float) -> Callable[..., Awaitable[None]]:
    """Return `test` with a time limit a little below that of pytest-timeout."""

    @functools.wraps(test)
    async def run(*args: Any, **fixtures: Any) -> None:
        async with asyncio.timeout(limit_s * 0.9):
            await test(*args, **fixtures)

    return run


def pytest_asyncio_loop_factories(
    config: pytest.Config, item: pytest.Item
) -> dict[str, Callable[[], asyncio.AbstractEventLoop]]:
    """Run each async test on asyncio and on uvloop."""
    return {"asyncio": debugging_loop, "uvloop": uvloop.new_event_loop}


@pytest.fixture
async def node(node_factory: Callable[..., Node]) -> Node:
    """A running node in a context without network."""
    return node_factory("node")


@pytest.fixture
async def context(aionode_context: Context) -> Context:
    """An open context without network."""
    return aionode_context


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Escape lone surrogates in captured output: pytest-xdist cannot send them."""
    report = yield
    report.sections = [
        (title, text.encode(errors="backslashreplace").decode()) for title, text in report.sections
    ]
    return report
