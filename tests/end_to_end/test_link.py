"""A linked process that is killed or frozen in mid-stream does not stop the other one."""

from __future__ import annotations

import asyncio
import os
import shutil
import signal
import socket
import subprocess
import tempfile
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from aionode._process.concurrency import checkpoint
from aionode.engine.context import Context
from aionode.engine.transport.link._connection import Connection
from aionode.engine.transport.link._protocol import FrameParser
from aionode.engine.transport.link._publisher import LinkWriter
from aionode.engine.transport.link._subscription import Route
from aionode.engine.transport.link._transport import LinkTransport
from aionode.interfaces.std_msgs.msg import Int32, UInt8MultiArray
from aionode.node import Node
from tests.end_to_end.link_member import STREAMED_BYTES
from tests.support import fork_server
from tests.support.arrivals import reader_of, writers_of
from tests.support.links import fd_of, freeze, thaw
from tests.support.peers import isolated_environment, quiet_node
from tests.support.spies import returns_of
from tests.support.waiting import until

MEMBER = Path(__file__).with_name("link_member.py")


@pytest.fixture(autouse=True)
def isolated(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The processes of a test see only each other, and have their own folder for sockets."""
    root = tempfile.mkdtemp(prefix="aio")
    monkeypatch.setenv("XDG_RUNTIME_DIR", root)
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    yield
    shutil.rmtree(root)


@contextmanager
def other_process(*arguments: str) -> Iterator[subprocess.Popen[str]]:
    """Run the echoing process meanwhile."""
    with fork_server.start(
        [str(MEMBER), *arguments],
        env=os.environ,
        cwd=Path(__file__).parents[2],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=2,  # shown if the test fails
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
        """The linked contexts."""
        transport = self.node.context.transports[1]
        assert isinstance(transport, LinkTransport)
        return transport.manager.links

    @property
    def writer(self) -> LinkWriter:
        """The publisher's end of both routes."""
        writer = writers_of(self.there)[1]
        assert isinstance(writer, LinkWriter)
        return writer

    async def go(self) -> None:
        """Send the next number there and back."""
        self.there.publish(Int32(data=self.next))
        assert (await self.back.receive()).data == self.next
        self.next += 1

    async def until_linked(self) -> None:
        """Send numbers until the link is used."""
        await self.there.wait_for_subscribers()
        while self.back.get_publisher_count() == 0:
            await self.node.graph.changed()
        while self.writer.linked == 0:
            await self.go()


@asynccontextmanager
async def linked_node() -> AsyncIterator[Node]:
    """A node that may be linked."""
    async with asyncio.timeout(40), Context(link=True) as context, quiet_node("n", context) as node:
        yield node


async def test_a_killed_process_ends_its_link_and_the_next_gets_one() -> None:
    """In the middle of a stream, with messages in transit."""
    async with linked_node() as node:
        ping = Pings(node)
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
            while reader_of(ping.back):
                await ping.back.receive()


async def test_a_frozen_process_costs_nothing_but_its_messages() -> None:
    """The publisher never waits, drops the oldest, and continues with the process."""
    async with linked_node() as node:
        ping = Pings(node)
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
            while reader_of(ping.back):
                await ping.back.receive()
            await ping.go()


class Stream:
    """Large arrays from the other process, over a link whose reading can be stopped."""

    def __init__(self, node: Any) -> None:
        self.node = node
        self.subscription = node.create_subscription(UInt8MultiArray, "stream", None, 10)

    @property
    def link(self) -> Connection:
        """The only link."""
        manager = self.node.context.transports[1].manager
        (participant,) = manager.links
        return cast(Connection, manager.linked(participant))

    async def next(self) -> int:
        """Return the number that fills the whole next array."""
        data = np.frombuffer((await self.subscription.receive()).data, np.uint8)
        assert len(data) == STREAMED_BYTES
        assert data.min() == data.max()
        return int(data[0])

    async def until_linked(self) -> None:
        """Continue until the arrays come over the link."""
        while not any(
            remote_publisher.route is Route.LINK
            for reader in self.node.context.transports[1].manager.readers.values()
            for remote_publisher in reader.remote_publishers.values()
        ):
            await self.next()

    async def freeze_in_mid_frame(self, process: subprocess.Popen[str]) -> None:
        """Stop reading, and freeze the sender while it waits to send the rest of a frame."""
        while self.link.held:  # the link has read a part of a frame
            await self.next()
        freeze(self.link)
        while True:
            stop(process)
            if in_mid_frame(self.link):
                return
            process.send_signal(signal.SIGCONT)
            await checkpoint()

    def on_writable(self) -> None:
        """Read again."""
        thaw(self.link)


def stop(process: subprocess.Popen[str]) -> None:
    """Freeze a process, and wait until it is frozen."""
    process.send_signal(signal.SIGSTOP)
    os.waitpid(process.pid, os.WUNTRACED)


def in_mid_frame(link: Connection) -> bool:
    """Return whether the data in the socket ends within a frame."""
    parser = FrameParser()
    assert not link.held  # so the socket begins with a frame
    with socket.socket(fileno=os.dup(fd_of(link))) as peeking:
        try:
            parser.feed(peeking.recv(1 << 20, socket.MSG_PEEK))
        except BlockingIOError:  # nothing waits
            return False
    return parser.held > 0


async def test_a_sender_that_is_killed_in_mid_frame_ends_its_stream_and_the_next_is_heard(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An incomplete message is dropped; complete ones are delivered."""
    async with linked_node() as node:
        stream = Stream(node)
        closed = returns_of(monkeypatch, stream.node.context.transports[1].manager, "on_closed")
        for _ in range(2):
            with other_process("stream") as process:
                await stream.until_linked()
                await stream.freeze_in_mid_frame(process)
                process.kill()
                process.wait()
                link = stream.link
                stream.on_writable()
                while not link.closed:  # others that dial may be closed, too
                    await closed.get()
                while reader_of(stream.subscription):
                    await stream.next()
            while stream.subscription.get_publisher_count():
                await stream.node.graph.changed()


async def test_a_sender_that_is_frozen_in_mid_frame_goes_on_where_it_was(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its link stays, and the rest of the frame arrives with the next one."""
    async with linked_node() as node:
        stream = Stream(node)
        with other_process("stream") as process:
            await stream.until_linked()
            await stream.freeze_in_mid_frame(process)
            stream.on_writable()
            await until(lambda: stream.link.held)
            process.send_signal(signal.SIGCONT)
            for _ in range(20):
                await stream.next()
            assert not stream.link.closed
