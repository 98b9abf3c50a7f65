"""What one process can make another one keep has bounds, and what failed once is tried again."""

from __future__ import annotations

import asyncio
import os
import socket
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any

import pytest

from aionode._concurrency import checkpoint
from aionode.context import Context
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.transport.ipc import (
    _connection as connection,
)
from aionode.transport.ipc import (
    _manager as manager,
)
from aionode.transport.ipc import _protocol as protocol
from aionode.transport.ipc import (
    _send_queue as send_queue,
)
from aionode.transport.ipc._listener import Listener
from aionode.transport.ipc._protocol import Kind
from tests.support.links import Counting, folder, link_of, manager_of, two_nodes, writer_of
from tests.support.peers import DOMAIN_ID, quiet_node

__all__ = ["folder"]  # a fixture


async def dialled(folder: Path, context: Context) -> socket.socket:
    """Return a socket to a context, without a word said."""
    sock = socket.socket(socket.AF_UNIX)
    sock.setblocking(False)
    await asyncio.get_running_loop().sock_connect(sock, str(folder / f"{context.participant}.sock"))
    return sock


def greeting(participant: int) -> bytes:
    """Return the first frame of a process."""
    return protocol.pack(Kind.HELLO, protocol.VERSION, DOMAIN_ID, participant.to_bytes(16, "big"))


async def until_closed(sock: socket.socket) -> None:
    """Read until the other end is closed."""
    loop = asyncio.get_running_loop()
    try:
        while await loop.sock_recv(sock, 1 << 16):
            pass
    except ConnectionResetError:
        pass


# Before the greeting


async def test_who_does_not_say_who_he_is_is_hung_up_on(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A descriptor is kept for a few seconds, not for ever."""
    monkeypatch.setattr(manager, "HELLO_S", 0.05)
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        with closing(await dialled(folder, node.context)) as sock:
            await until_closed(sock)
        assert not manager_of(node)._opening


async def test_of_many_silent_sockets_the_oldest_are_closed(folder: Path) -> None:
    """Two hundred of them leave descriptors for everything else."""
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        with ExitStack() as stack:
            socks = []
            for _ in range(manager.MAX_OPENING + 20):
                socks.append(stack.enter_context(closing(await dialled(folder, node.context))))
                await checkpoint()  # or the backlog is full
            for sock in socks[:20]:
                await until_closed(sock)
            assert len(manager_of(node)._opening) == manager.MAX_OPENING


async def test_a_frame_cannot_begin_in_place_of_the_greeting(folder: Path) -> None:
    """What is unknown may make nobody hold its megabytes."""
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        with closing(await dialled(folder, node.context)) as sock:
            head = protocol.HEADER.pack(1 << 26, Kind.HELLO, 0, protocol.MARK, 1, 1, bytes(16))
            await asyncio.get_running_loop().sock_sendall(sock, head + bytes(1000))
            await until_closed(sock)


# After it


async def test_frames_without_an_end_take_so_much_memory_and_no_more(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of all links together; the largest ends, and the others go on."""
    monkeypatch.setattr(manager, "MAX_HELD", 10 << 20)
    loop = asyncio.get_running_loop()
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        with ExitStack() as stack:
            socks = []
            for number, megabytes in enumerate((4, 2, 3, 2), start=1):
                sock = stack.enter_context(closing(await dialled(folder, node.context)))
                socks.append(sock)
                head = protocol.HEADER.pack(1 << 26, Kind.DATA, 0, protocol.MARK, 1, 1, bytes(16))
                rest = bytes(megabytes << 20)
                await loop.sock_sendall(sock, greeting(number) + head + rest)
            await until_closed(socks[0])
            assert len(manager_of(node).links) == 3


async def test_a_reader_that_takes_no_answers_is_hung_up_on(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever asks on and on and reads nothing would fill the server's memory."""
    monkeypatch.setattr(connection, "URGENT_BYTES", 1 << 16)
    loop = asyncio.get_running_loop()
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        with closing(await dialled(folder, node.context)) as sock:
            await loop.sock_sendall(sock, greeting(1))
            question = protocol.pack(Kind.REQUEST, 1, 1, bytes(16), bytes(16))
            while True:
                try:
                    await loop.sock_sendall(sock, question * 100)
                except (BrokenPipeError, ConnectionResetError):
                    break


async def test_a_reader_that_confirms_nothing_is_not_kept_everything_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It said that it would."""
    monkeypatch.setattr(send_queue, "MAX_UNCONFIRMED", 200)
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        (remote_publisher,) = next(
            iter(manager_of(nodes.b).readers.values())
        ).remote_publishers.values()
        remote_publisher._confirms = False
        await numbers.go(1000)
        (route,) = writer_of(numbers.publisher)._send_queues.values()
        assert len(route._unconfirmed) == 200


async def test_a_process_that_keeps_memory_gets_the_rest_through_the_stream(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A frozen one would have hundreds of large messages waiting for it."""
    monkeypatch.setattr(connection, "LENT_PIECES", 3)
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        publisher = nodes.a.create_publisher(Image, "images", 10)
        subscription = nodes.b.create_subscription(Image, "images", None, 10)
        while writer_of(publisher).linked == 0:
            await numbers.go()
        kept: list[Any] = []
        for number in range(8):
            publisher.publish(Image(height=1, width=600_000, data=bytes([number]) * 600_000))
            kept.append(await subscription.receive())
        assert [bytes(one.data[-1:])[0] for one in kept] == list(range(8))
        assert len(link_of(nodes.a)._lent) == 3


async def test_a_publisher_that_goes_gives_its_memory_back() -> None:
    """What its readers had not confirmed was kept for ever."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        publisher = nodes.a.create_publisher(Image, "images", 10)
        nodes.b.create_subscription(Image, "images", None, 10)
        while writer_of(publisher).linked == 0:
            await numbers.go()
        publisher.publish(Image(height=1, width=600_000, data=bytes(600_000)))
        publisher.destroy()  # before any confirmation can have come
        assert manager_of(nodes.a)._ending
        while manager_of(nodes.a)._ending:
            await checkpoint()


# Dialling


async def test_a_context_that_could_not_be_dialled_is_dialled_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A full backlog, or a descriptor too few, passes."""
    failures = 3
    dial = Listener.dial

    def failing(self: Listener, participant: str) -> socket.socket | None:
        nonlocal failures
        failures -= 1
        return dial(self, participant) if failures < 0 else None

    monkeypatch.setattr(Listener, "dial", failing)
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        assert failures < 0


async def test_a_context_that_did_not_answer_is_dialled_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It was frozen when it was dialled, and refused when it came back."""
    monkeypatch.setattr(manager, "MAX_OPENING", 0)
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.publisher.wait_for_subscribers()
        for _ in range(20):
            await numbers.go()
        assert manager_of(nodes.a).links == []
        monkeypatch.setattr(manager, "MAX_OPENING", 64)
        await numbers.until_linked()


# The folder


def test_a_socket_that_was_never_finished_is_removed(tmp_path: Path) -> None:
    """Its process was killed between two steps; one that is being made is left alone."""
    old, new = tmp_path / "old.new", tmp_path / "new.new"
    for path in (old, new):
        path.touch()
    os.utime(old, (1, 1))
    Listener(tmp_path, "1a").close()
    assert [path.name for path in tmp_path.iterdir()] == ["new.new"]
