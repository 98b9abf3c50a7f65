"""One end of a link, tested against a plain socket."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Iterator
from typing import Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.engine.transport.link._connection import Connection
from aionode.engine.transport.link._protocol import Gone
from aionode.engine.transport.link._shared_memory import BufferPool


class Owner:
    """Records what happens on a connection."""

    def __init__(self) -> None:
        self.noted: list[Any] = []

    def on_call(self, *_: object) -> None:
        """Ignore requests and replies: there are none here."""

    def on_control(self, _: Connection, control: object) -> None:
        """Record a control frame."""
        self.noted.append(control)

    def on_held(self, _: Connection) -> None:
        """Ignore incomplete frames: there are none here."""

    def on_closed(self, _: Connection) -> None:
        """Record the end."""
        self.noted.append("closed")


@pytest.fixture
def pair() -> Iterator[tuple[socket.socket, socket.socket]]:
    """Return the two ends of a socket."""
    ours, theirs = socket.socketpair()
    with ours, theirs:
        ours.setblocking(False)
        yield ours, theirs


async def test_what_the_other_end_sent_before_it_closed_is_read_although_a_send_fails_first(
    pair: tuple[socket.socket, socket.socket],
) -> None:
    """A process that exits right after its last messages reads no confirmations."""
    ours, theirs = pair
    owner = Owner()
    connection = Connection(asyncio.get_running_loop(), ours, BufferPool(), owner)
    connection.accept_hello("1")
    last_words = [Gone(number.to_bytes(16, "big")) for number in range(3000)]  # of several reads
    theirs.sendall(b"".join(each.pack() for each in last_words))
    theirs.close()

    connection.send(Gone(bytes(16)))
    while not connection.closed:
        await checkpoint()

    assert owner.noted == [*last_words, "closed"]
