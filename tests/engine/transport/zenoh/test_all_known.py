"""Waiting for the tokens of connected peers."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
from collections.abc import AsyncIterator
from itertools import count
from types import SimpleNamespace
from typing import Any

import pytest

from aionode.engine.transport.zenoh import _transport
from aionode.engine.transport.zenoh._transport import ZenohTransport
from aionode.engine.transport.zenoh.connections import stopped_peers
from tests.support.fork_server import start
from tests.support.peers import quiet_node

STOPPED = """
import asyncio
from tests.support.peers import quiet_node

async def main():
    async with quiet_node("stopped"):
        print("there", flush=True)
        await asyncio.Event().wait()

asyncio.run(main())
"""

QUIET_S = 0.02
ENOUGH = 20
"""How many looks at what arrives take longer than `QUIET_S`."""


@pytest.fixture
async def transport(monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[ZenohTransport]:
    """An open transport, whose peers have not answered yet."""
    monkeypatch.setattr(_transport, "ASK_AGAIN_S", 0.002)
    async with quiet_node("asking") as node:
        opened: Any = node.context.transports[1]
        opened._answered = asyncio.get_running_loop().create_future()
        opened._watcher.newest_ns = 0  # as on a machine so busy that the first look comes late
        yield opened


@pytest.mark.parametrize(
    ("received", "unread"), [(1000, 0), (0, 1000)], ids=["something is read", "nothing is read"]
)
async def test_it_is_waited_while_something_arrives(
    transport: ZenohTransport, monkeypatch: pytest.MonkeyPatch, received: int, unread: int
) -> None:
    """On a busy machine, Zenoh reads thousands of tokens for seconds before it reports one."""
    loop = asyncio.get_running_loop()
    numbers = count(1)  # what has arrived before the first look counts

    def arrived(_: object) -> dict[str, tuple[int, int]]:
        number = next(numbers)
        if number == ENOUGH and transport._answered is not None:
            loop.call_soon_threadsafe(transport._answered.set_result, True)
        return {"peer": (received * number, unread)}

    monkeypatch.setattr(_transport, "arrived_bytes", arrived)

    assert await transport.all_known(QUIET_S)


async def test_signs_of_life_are_not_waited_for(
    transport: ZenohTransport, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All other peers keep sending them while one is frozen."""
    numbers = count()
    monkeypatch.setattr(_transport, "arrived_bytes", lambda _: {"peer": (4 * next(numbers), 4)})

    assert not await transport.all_known(QUIET_S)


async def test_an_answer_that_zenoh_has_given_up_is_incomplete(transport: ZenohTransport) -> None:
    """It ends as well, with an error among the replies."""

    def get(_: str, handler: Any, **__: object) -> None:
        handler.callback(SimpleNamespace(ok=None))
        handler.drop()

    session: Any = SimpleNamespace(liveliness=lambda: SimpleNamespace(get=get))
    transport._ask(session)

    assert not await transport.all_known(QUIET_S)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux lists sessions")
async def test_a_stopped_process_is_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not for its connection, and not for the nodes that others still know; others do answer."""
    monkeypatch.setattr(_transport, "NAMED_NS", 60 * 10**9)
    monkeypatch.setattr(stopped_peers, "LOOKS", 60)  # nobody gives it up meanwhile
    streams: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    program = ["-c", STOPPED]
    with start(program, env=os.environ, stdout=subprocess.PIPE, **streams) as process:
        assert process.stdout is not None
        await asyncio.to_thread(process.stdout.readline)
        try:
            async with asyncio.timeout(20), quiet_node("other") as other:
                await other.wait_for_node("/stopped")
                process.send_signal(signal.SIGSTOP)
                async with quiet_node("asking") as node:
                    known = await node.context.transports[1].all_known(60.0)
                    nodes = node.get_node_names()
        finally:
            process.kill()

    assert not known
    assert "other" in nodes
