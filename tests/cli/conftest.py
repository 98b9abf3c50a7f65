"""A hidden node like that of the command line, in a context without network, and its output."""

from __future__ import annotations

import asyncio
import io
import json
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from typing import Any

import pytest

from aionode import Node
from aionode.cli._support.output import Output
from aionode.testing import settle

Running = Callable[[Coroutine[Any, Any, Any]], AbstractAsyncContextManager[asyncio.Task[Any]]]


class Screen:
    """The output of a command."""

    def __init__(self) -> None:
        self.stdout = io.StringIO()
        self.stderr = io.StringIO()
        self.output = Output(self.stdout, self.stderr)
        self.json_output = Output(self.stdout, self.stderr, json=True)

    @property
    def text(self) -> str:
        """All of stdout."""
        return self.stdout.getvalue()

    @property
    def errors(self) -> str:
        """All of stderr."""
        return self.stderr.getvalue()

    @property
    def records(self) -> list[Any]:
        """Each line of stdout as JSON."""
        return [json.loads(line) for line in self.text.splitlines()]


@pytest.fixture(autouse=True)
def quick_doctor(monkeypatch: pytest.MonkeyPatch) -> None:
    """The output of the command under test."""
    monkeypatch.setattr("aionode.cli._nouns.doctor.work.LOOKING_S", 0.1)


@pytest.fixture
def screen() -> Screen:
    """The buffer to which the command under test prints."""
    return Screen()


@pytest.fixture
async def tool(node_factory: Callable[..., Node]) -> Node:
    """Run a verb beside the test, and cancel it at the end of the block."""
    return node_factory("_aionode_cli_1", enable_rosout=False, start_parameter_services=False)


@pytest.fixture
def running() -> Running:
    """Run a verb beside the test, and cancel it at the end of the block."""

    @asynccontextmanager
    async def run(work: Coroutine[Any, Any, Any]) -> AsyncIterator[asyncio.Task[Any]]:
        async with asyncio.TaskGroup() as tasks:
            task = tasks.create_task(work)
            await settle()
            yield task
            task.cancel()

    return run
