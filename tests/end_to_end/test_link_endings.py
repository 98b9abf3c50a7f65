"""The last messages of a process that ends reach the processes that it is linked to."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from aionode.engine.context import Context
from aionode.engine.transport.link._subscription import Route
from aionode.interfaces.std_msgs.msg import Int32
from tests.support.links import folder, freeze, manager_of
from tests.support.peers import KEEP_ALL, quiet_node

__all__ = ["folder"]  # a fixture
from tests.support import fork_server

pytestmark = pytest.mark.one_loop  # tests/engine/transport/link reads ended links on both loops

ENDER = Path(__file__).with_name("link_ender.py")


@contextmanager
def publishing_process(count: int, end: str) -> Iterator[subprocess.Popen[str]]:
    """Run the process that publishes `count` numbers on request."""
    root = Path(__file__).parents[2]
    environ = {**os.environ, "PYTHONPATH": str(root)}
    pipes: dict[str, Any] = {
        "stdin": subprocess.PIPE,
        "stdout": subprocess.DEVNULL,
        "stderr": subprocess.PIPE,
    }
    command = [str(ENDER), str(count), end]
    with fork_server.start(command, cwd=root, env=environ, **pipes) as process:
        try:
            yield process
        finally:
            process.send_signal(signal.SIGCONT)
            process.kill()


async def until_linked(node: Any, subscription: Any) -> None:
    """Receive until the numbers come over the link."""
    while not any(
        remote_publisher.route is Route.LINK
        for reader in manager_of(node).readers.values()
        for remote_publisher in reader.remote_publishers.values()
    ):
        await subscription.receive()


async def numbers_until(last: int, subscription: Any) -> list[int]:
    """Return the arriving numbers up to the last one."""
    got: list[int] = []
    while last not in got[-1:]:
        number = (await subscription.receive()).data
        if number >= 0:
            got.append(number)
    return got


def tell(process: subprocess.Popen[str]) -> None:
    """Tell it to publish and end."""
    assert process.stdin is not None
    process.stdin.close()


async def test_what_a_process_sent_before_it_died_is_read_to_the_end() -> None:
    """Its socket accepts no more confirmations, but unread data must still be read."""
    async with asyncio.timeout(30), Context(link=True) as context, quiet_node("n", context) as node:
        subscription = node.create_subscription(Int32, "numbers", None, 1000)
        with publishing_process(401, "exit") as process:
            await until_linked(node, subscription)
            tell(process)
            process.wait(10)  # and the loop reads nothing meanwhile
            assert await numbers_until(400, subscription) == list(range(401))


@pytest.mark.parametrize("profile", [KEEP_ALL, 10_000], ids=["keep_all", "keep_last"])
async def test_what_waits_when_a_process_ends_still_reaches_a_slow_reader(profile: Any) -> None:
    """It is more than the window and the socket hold, and the process ends soon after."""
    async with asyncio.timeout(30), Context(link=True) as context, quiet_node("n", context) as node:
        subscription = node.create_subscription(Int32, "numbers", None, profile)
        with publishing_process(5000, "leave") as process:
            await until_linked(node, subscription)
            tell(process)
            got = await numbers_until(4999, subscription)
            assert got == list(range(5000))
            assert await asyncio.to_thread(process.wait, 10) == 0
        assert subscription.stats.lost == 0


@pytest.mark.slow
async def test_a_frozen_reader_holds_a_process_up_for_a_second_and_is_told_of() -> None:
    """It still ends, and logs how many messages of which topic were given up."""
    async with asyncio.timeout(30), Context(link=True) as context, quiet_node("n", context) as node:
        subscription = node.create_subscription(Int32, "numbers", None, KEEP_ALL)
        with publishing_process(9000, "leave") as process:
            await until_linked(node, subscription)
            (link,) = (manager_of(node).linked(p) for p in manager_of(node).links)
            assert link is not None
            freeze(link)
            tell(process)
            assert await asyncio.to_thread(process.wait, 10) == 0
            assert process.stderr is not None
            said = process.stderr.read()
        assert "/numbers: dropped the last" in said
        assert "has read nothing for 1 s" in said
        assert len(said.splitlines()) == 1
