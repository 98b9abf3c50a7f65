"""Two nodes in two contexts that can be linked, and numbers sent between them."""

from __future__ import annotations

import asyncio
import shutil
import tempfile
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from aionode.engine.context import Context
from aionode.engine.transport.link import _manager as manager
from aionode.engine.transport.link._connection import Connection
from aionode.engine.transport.link._publisher import LinkWriter
from aionode.engine.transport.link._transport import LinkTransport
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node
from tests.support.arrivals import writers_of
from tests.support.peers import isolated_environment, quiet_node

__all__ = [
    "Counting",
    "Two",
    "calls_of",
    "fd_of",
    "folder",
    "freeze",
    "link_of",
    "manager_of",
    "read",
    "thaw",
    "transport_of",
    "two_nodes",
    "writer_of",
]

PERIOD_S = 0.001
"""The time between two numbers while a test waits for something else."""


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Give a test its own folder for sockets, with a short enough path.

    Its contexts reach each other, but nothing else on the machine.
    """
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    root = Path(tempfile.mkdtemp(prefix="aio"))
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(root))
    monkeypatch.setattr(manager, "AGAIN_S", 0.01)
    yield root / "aionode"
    shutil.rmtree(root)


class Two(NamedTuple):
    """Two nodes in two contexts."""

    a: Node
    b: Node


def transport_of(node: Node) -> LinkTransport:
    """Return the transport under test."""
    transport = node.context.transports[1]
    assert isinstance(transport, LinkTransport)
    return transport


def manager_of(node: Node) -> manager.LinkManager:
    """Return the links of a node's context."""
    return transport_of(node).manager


def calls_of(node: Node) -> dict[tuple[bytes, int], Any]:
    """Return the pending calls of a node's context over links, by client and number."""
    return {
        (gid, number): call
        for gid, requester in manager_of(node).requesters.items()
        for number, call in requester.calls.items()
    }


def link_of(node: Node) -> Connection:
    """Return the only link of a node's context."""
    (participant,) = manager_of(node).links
    connection = manager_of(node).linked(participant)
    assert connection is not None
    return connection


def fd_of(link: Connection) -> int:
    """Return the descriptor of a link's socket."""
    return link._fd


def freeze(link: Connection) -> None:
    """Stop a link from reading, as if its process were frozen."""
    asyncio.get_running_loop().remove_reader(fd_of(link))


def read(link: Connection) -> bool:
    """Have a link read once from its socket; return whether there was any data."""
    return link._on_readable()


def thaw(link: Connection) -> None:
    """Let a link read again."""
    asyncio.get_running_loop().add_reader(fd_of(link), read, link)


def writer_of(publisher: Any) -> LinkWriter:
    """Return the publisher's end of both routes."""
    writer = writers_of(publisher)[1]
    assert isinstance(writer, LinkWriter)
    return writer


@asynccontextmanager
async def two_nodes(*, links: tuple[bool, bool] = (True, True)) -> AsyncIterator[Two]:
    """Two nodes that may be linked, or not."""
    async with (
        asyncio.timeout(30),
        Context(link=links[0]) as first,
        Context(link=links[1]) as second,
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        yield Two(a, b)


class Counting:
    """A publisher of rising numbers and a subscription that expects them."""

    def __init__(self, nodes: Two, profile: Any = 1000, topic: str = "n") -> None:
        self.publisher = nodes.a.create_publisher(Int32, topic, profile)
        self.subscription = nodes.b.create_subscription(Int32, topic, None, profile)
        self.next = 0

    def publish(self, count: int = 1) -> None:
        """Publish the next numbers."""
        for _ in range(count):
            self.publisher.publish(Int32(data=self.next))
            self.next += 1

    async def go(self, count: int = 1) -> None:
        """Publish and receive `count` numbers; expect the next ones without a gap."""
        first = self.next
        self.publish(count)
        assert [(await self.subscription.receive()).data for _ in range(count)] == list(
            range(first, self.next)
        )

    async def go_until(self, condition: Callable[[], Any]) -> None:
        """Continue until a condition holds; a publisher at full speed would only delay it."""
        while not condition():
            await self.go()
            await asyncio.sleep(PERIOD_S)  # noqa: TID251  # a clock's alarm has a file

    async def until_linked(self, linked: int = 1) -> None:
        """Publish and receive until `linked` readers use the link only."""
        await self.publisher.wait_for_subscribers()
        await self.go_until(lambda: writer_of(self.publisher).linked == linked)
