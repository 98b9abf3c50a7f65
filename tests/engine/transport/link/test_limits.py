"""Limits on what another process can make this one store, and retries after failures."""

from __future__ import annotations

import asyncio
import os
import socket
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.engine.context import Context
from aionode.engine.transport.link import (
    _connection,
)
from aionode.engine.transport.link import (
    _connection as connection,
)
from aionode.engine.transport.link import (
    _manager as manager,
)
from aionode.engine.transport.link import _protocol as protocol
from aionode.engine.transport.link import (
    _send_queue as send_queue,
)
from aionode.engine.transport.link._listener import Advertisement, Listener, socket_folder
from aionode.engine.transport.link._protocol import Kind
from aionode.engine.transport.link._publisher import LinkWriter
from aionode.errors import TransportError
from aionode.interfaces.sensor_msgs.msg import Image
from tests.support.links import (
    Counting,
    fd_of,
    folder,
    freeze,
    link_of,
    manager_of,
    read,
    thaw,
    two_nodes,
    writer_of,
)
from tests.support.peers import DOMAIN_ID, quiet_node
from tests.support.waiting import until

__all__ = ["folder"]  # a fixture


async def dialled(folder: Path, context: Context) -> socket.socket:
    """Return a socket to a context that has not sent a Hello."""
    sock = socket.socket(socket.AF_UNIX)
    sock.setblocking(False)
    await asyncio.get_running_loop().sock_connect(sock, str(folder / f"{context.participant}.sock"))
    return sock


def hello(participant: int) -> bytes:
    """Return the first frame of a process."""
    gid, secret = participant.to_bytes(16, "big"), bytes(protocol.SECRET_SIZE)
    return protocol.pack(Kind.HELLO, protocol.VERSION, DOMAIN_ID, gid, secret)


async def until_closed(sock: socket.socket) -> None:
    """Read until the other end is closed."""
    loop = asyncio.get_running_loop()
    try:
        while await loop.sock_recv(sock, 1 << 16):
            pass
    except ConnectionResetError:
        pass


# Before the Hello


async def test_a_client_without_a_hello_is_disconnected(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its descriptor is kept for a few seconds, not forever."""
    monkeypatch.setattr(manager, "HELLO_S", 0.05)
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        with closing(await dialled(folder, node.context)) as sock:
            await until_closed(sock)


async def test_of_many_silent_sockets_the_oldest_are_closed(folder: Path) -> None:
    """Two hundred of them leave enough descriptors for everything else."""
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        with ExitStack() as stack:
            socks = []
            for _ in range(manager.MAX_OPENING + 20):
                socks.append(stack.enter_context(closing(await dialled(folder, node.context))))
                await checkpoint()  # # otherwise the backlog is full
            for sock in socks[:20]:
                await until_closed(sock)
            for sock in socks[20:]:
                assert sock.recv(1 << 16)  # # a Hello, then neither more data nor an end
                with pytest.raises(BlockingIOError):
                    sock.recv(1)


async def test_a_context_that_was_dialled_may_take_as_long_as_it_likes(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """When 100 start at once, many are busy; giving up meant that they were dialled much later."""
    monkeypatch.setattr(manager, "HELLO_S", 0.0)
    monkeypatch.setattr(manager, "MAX_OPENING", 0)
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        links = manager_of(node)
        with ExitStack() as stack:
            listening = []
            for number in range(70):
                busy = stack.enter_context(closing(socket.socket(socket.AF_UNIX)))
                busy.bind(str(folder / f"{number}.sock"))
                busy.listen()
                listening.append(busy)
                links._dial(str(number))
            accepted = stack.enter_context(closing(await dialled(folder, node.context)))
            await until_closed(accepted)

            for busy in listening:
                sock = stack.enter_context(closing(busy.accept()[0]))
                assert sock.recv(1 << 16)
                with pytest.raises(BlockingIOError):  # # the connection was not given up
                    sock.recv(1, socket.MSG_DONTWAIT)


def test_the_sockets_of_contexts_that_live_are_not_dialled_at_the_start(folder: Path) -> None:
    """When 100 start at once, each would otherwise be dialled by all others."""
    socket_folder(os.environ)
    living = Listener(folder, "a1")
    try:
        Listener(folder, "b2").close()

        assert living.accept() is None
    finally:
        living.close()


async def test_a_long_frame_in_place_of_the_hello_is_refused(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An unknown client must not make a process hold megabytes for the duration of a Hello."""
    monkeypatch.setattr(manager, "HELLO_S", 3600.0)
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        with closing(await dialled(folder, node.context)) as sock:
            head = protocol.HEADER.pack(1 << 26, Kind.HELLO, 0, protocol.MARK, 1, 1, bytes(16))
            await asyncio.get_running_loop().sock_sendall(sock, head + bytes(1000))
            await until_closed(sock)


# After it


async def test_the_memory_for_incomplete_frames_is_bounded(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The limit covers all links together; the largest is closed, and the others continue."""
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
                await loop.sock_sendall(sock, hello(number) + head + rest)
            await until_closed(socks[0])
            assert len(manager_of(node).links) == 3


async def test_a_client_that_reads_no_responses_is_disconnected(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A client that sends requests and reads nothing would fill the server's memory."""
    monkeypatch.setattr(connection, "URGENT_BYTES", 1 << 16)
    loop = asyncio.get_running_loop()
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        with closing(await dialled(folder, node.context)) as sock:
            await loop.sock_sendall(sock, hello(1))
            request = protocol.pack(Kind.REQUEST, 1, 1, bytes(16), bytes(16))
            while True:
                try:
                    await loop.sock_sendall(sock, request * 100)
                except (BrokenPipeError, ConnectionResetError):
                    break


async def test_what_is_kept_for_a_reader_that_confirms_nothing_is_bounded(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It has announced confirmations, but sends none."""
    monkeypatch.setattr(send_queue, "MAX_UNCONFIRMED", 200)
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        monkeypatch.setattr(LinkWriter, "credit", lambda *_: None)
        await numbers.go(1000)
        frames = writer_of(numbers.publisher).broken(link_of(nodes.a))
        assert len(list(frames)) == 200


async def test_a_process_that_keeps_memory_gets_the_rest_through_the_stream(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Otherwise hundreds of large messages would be waiting for a frozen process."""
    monkeypatch.setattr(connection, "LENT_PIECES", 3)
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        publisher = nodes.a.create_publisher(Image, "images", 10)
        subscription = nodes.b.create_subscription(Image, "images", None, 10)
        await numbers.go_until(lambda: writer_of(publisher).linked)
        kept: list[Any] = []
        for number in range(8):
            publisher.publish(Image(height=1, width=600_000, data=bytes([number]) * 600_000))
            kept.append(await subscription.receive())
        assert [bytes(one.data[-1:])[0] for one in kept] == list(range(8))
        assert len(link_of(nodes.a).lent) == 3


async def test_a_publisher_that_goes_gives_its_memory_back() -> None:
    """Payloads that its readers had not confirmed used to be kept forever."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        publisher = nodes.a.create_publisher(Image, "images", 10)
        nodes.b.create_subscription(Image, "images", None, 10)
        await numbers.go_until(lambda: writer_of(publisher).linked)
        publisher.publish(Image(height=1, width=600_000, data=bytes(600_000)))
        publisher.destroy()  # # before any confirmation can have arrived
        assert manager_of(nodes.a)._ending
        while manager_of(nodes.a)._ending:
            await checkpoint()


# Dialling


async def test_a_context_that_could_not_be_dialled_is_dialled_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A full backlog or a lack of descriptors is temporary."""
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
    """It was frozen when it was dialled, and was refused when it resumed."""
    monkeypatch.setattr(manager, "MAX_OPENING", 0)
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.publisher.wait_for_subscribers()
        for _ in range(20):
            await numbers.go()
        assert manager_of(nodes.a).links == []
        monkeypatch.setattr(manager, "MAX_OPENING", 64)
        await numbers.until_linked()


async def test_a_context_whose_advertisement_flaps_is_dialled_once(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Tokens come and go at startup; the second socket used to be refused with a warning."""
    attempts: list[str] = []
    dial = Listener.dial

    async with two_nodes() as nodes:
        managers = [manager_of(node) for node in nodes]

        def flapping(self: Listener, participant: str) -> socket.socket | None:
            attempts.append(participant)
            (dialling,) = (one for one in managers if one.participant != participant)
            own = Advertisement.own(participant)

            def flap() -> None:  # # before either Hello has arrived
                dialling.on_advertisement(own, False)
                dialling.on_advertisement(own, True)

            asyncio.get_running_loop().call_soon(flap)
            return dial(self, participant)

        monkeypatch.setattr(Listener, "dial", flapping)
        await Counting(nodes).until_linked()

    assert len(attempts) == 1
    assert "second link" not in caplog.text


async def test_a_context_that_dials_again_replaces_a_link_whose_end_is_unread(
    folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Its new socket may become readable before the end of the old one is noticed."""
    loop = asyncio.get_running_loop()
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        with closing(await dialled(folder, node.context)) as first:
            await loop.sock_sendall(first, hello(1))
            await until(lambda: manager_of(node).links)
            old = link_of(node)
            freeze(old)
        with closing(await dialled(folder, node.context)) as second:
            await loop.sock_sendall(second, hello(1))
            await until(lambda: manager_of(node).linked("1") not in (None, old))
        assert old.closed
    assert "second link" not in caplog.text


# Closing


async def test_each_part_of_a_large_frame_that_the_socket_takes_is_progress() -> None:
    """Otherwise a slow reader of a large message would be given up when the context closes."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        link, other = link_of(nodes.a), link_of(nodes.b)
        freeze(other)
        assert link.write(protocol.pack(Kind.DATA, 1, 1, bytes(16), bytes(8 << 20)))
        for _ in range(3):
            progress = link.progress()
            assert not link.idle
            while not progress.done():
                read(other)
                await checkpoint()
        assert not link.idle
        thaw(other)


async def test_what_the_socket_took_a_part_of_counts_among_what_is_given_up(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """The reader gets neither its last message nor those meant for the same batch."""
    monkeypatch.setattr(_connection, "STALLED_S", 0.01)
    async with two_nodes() as nodes:
        numbers = Counting(nodes, 20_000)
        await numbers.until_linked()
        link, other = link_of(nodes.a), link_of(nodes.b)
        loop = asyncio.get_running_loop()
        freeze(other)
        numbers.publish(20_000)
        assert not link.idle

        await _connection.flush(link)

        (warning,) = [each for each in caplog.records if "dropped the last" in each.message]
        assert isinstance(warning.args, tuple)
        loop.remove_writer(fd_of(link))  # # nothing more is sent, as after the end of a process
        while read(other):
            pass
        numbers.subscription.destroy()
        got = [msg.data async for msg in numbers.subscription]
        assert got[-1] == numbers.next - int(str(warning.args[1])) - 1
        loop.add_writer(fd_of(link), link.send_rest)
        thaw(other)


# The folder


@pytest.mark.parametrize("size", [69, 70])
def test_a_folder_is_refused_whose_path_leaves_no_room_for_the_name_of_a_socket(
    size: int, folder: Path
) -> None:
    """A longer id would not fit in the socket's name, even if this context's id does."""
    runtime = folder.parent / ("x" * (size - len(str(folder)) - 1))
    runtime.mkdir()
    environ = {"XDG_RUNTIME_DIR": str(runtime)}
    longest = runtime / "aionode" / ("f" * 32 + ".sock")
    if size == 69:
        assert socket_folder(environ).is_dir()
        with socket.socket(socket.AF_UNIX) as sock:
            sock.bind(str(longest))
        return
    with pytest.raises(TransportError, match="set XDG_RUNTIME_DIR to a shorter path"):
        socket_folder(environ)


async def test_a_folder_with_a_long_path_is_reported_and_everything_goes_over_zenoh(
    folder: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Without the report, nothing would explain why there are no links."""
    runtime = folder.parent / ("x" * 100)
    runtime.mkdir()
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(runtime))
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.publisher.wait_for_subscribers()
        await numbers.go(20)
    assert "too long for the path of a Unix socket" in caplog.text


def test_a_socket_that_was_never_finished_is_removed(tmp_path: Path) -> None:
    """Its process was killed between two steps; one being created is left alone."""
    old, new = tmp_path / "old.new", tmp_path / "new.new"
    for path in (old, new):
        path.touch()
    os.utime(old, (1, 1))
    Listener(tmp_path, "1a").close()
    assert [path.name for path in tmp_path.iterdir()] == ["new.new"]
