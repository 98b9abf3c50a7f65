"""A linked process that is killed or frozen in mid-stream takes nobody with it."""

from __future__ import annotations

import asyncio
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path
from typing import Any

import pytest

from aionode.context import Context
from aionode.interfaces.std_msgs.msg import Int32
from aionode.transport.link.publishers import LinkWriter
from aionode.transport.link.transport import LinkTransport
from tests.peers import isolated_environment, quiet_node

MEMBER = Path(__file__).with_name("link_member.py")


@pytest.fixture(autouse=True)
def isolated(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The processes of a test hear each other only, and meet in a folder of their own."""
    root = tempfile.mkdtemp(prefix="aio")
    monkeypatch.setenv("XDG_RUNTIME_DIR", root)
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    yield
    shutil.rmtree(root)


@contextmanager
def other_process() -> Iterator[subprocess.Popen[bytes]]:
    """Run the echoing process meanwhile."""
    root = Path(__file__).parents[2]
    with subprocess.Popen(
        [sys.executable, MEMBER], stdin=subprocess.PIPE, cwd=root, env=os.environ.copy()
    ) as process:
        try:
            yield process
        finally:
            process.send_signal(signal.SIGCONT)
            process.kill()


class Pings:
    """Numbers that the other process sends back."""

    def __init__(self, node: Any) -> None:
        self.node = node
        self.there = node.create_publisher(Int32, "there", 1000)
        self.back = node.create_subscription(Int32, "back", None, 1000)
        self.next = 0

    @property
    def links(self) -> list[str]:
        """Who is linked."""
        transport = self.node.context.transports[1]
        assert isinstance(transport, LinkTransport)
        return transport.hub.links

    @property
    def writer(self) -> LinkWriter:
        """The publisher's end of both ways."""
        writer = self.there._writers[1]
        assert isinstance(writer, LinkWriter)
        return writer

    async def go(self) -> None:
        """Send the next number to and fro."""
        self.there.publish(Int32(data=self.next))
        assert (await self.back.receive()).data == self.next
        self.next += 1

    async def until_linked(self) -> None:
        """Go on until the link is used."""
        await self.there.wait_for_subscribers()
        while self.back.get_publisher_count() == 0:
            await self.node.graph.changed()
        while self.writer.linked == 0:
            await self.go()


@asynccontextmanager
async def pings() -> AsyncIterator[Pings]:
    """A node that may be linked."""
    async with (
        asyncio.timeout(40),
        Context(link=True) as context,
        quiet_node("ping", context) as node,
    ):
        yield Pings(node)


async def test_a_killed_process_ends_its_link_and_the_next_gets_one() -> None:
    """In the middle of a stream, with what was on its way."""
    async with pings() as ping:
        for _ in range(2):
            with other_process() as process:
                await ping.until_linked()
                for _ in range(50):
                    await ping.go()
                for _ in range(200):
                    ping.there.publish(Int32(data=-1))
                process.kill()
                while ping.links:
                    ping.there.publish(Int32(data=-1))
                    await asyncio.to_thread(lambda: None)
            while ping.there.get_subscription_count():
                await ping.node.graph.changed()
            while ping.back._inbox:
                await ping.back.receive()


async def test_a_frozen_process_costs_nothing_but_its_messages() -> None:
    """The publisher drops the oldest, never waits, and goes on when it goes on."""
    async with pings() as ping:
        with other_process() as process:
            await ping.until_linked()
            process.send_signal(signal.SIGSTOP)
            for _ in range(20_000):
                ping.there.publish(Int32(data=-1))
            assert ping.writer.dropped > 0
            process.send_signal(signal.SIGCONT)
            ping.there.publish(Int32(data=-2))
            while (await ping.back.receive()).data != -2:
                pass
            while ping.back._inbox:
                await ping.back.receive()
            await ping.go()
