"""Zenoh's sockets are found among a process's descriptors, and no other one is touched."""

from __future__ import annotations

import asyncio
import os
import select
import socket
import sys
import threading
from contextlib import ExitStack, closing, contextmanager
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest
import zenoh  # noqa: TID251  # makes real connections

from aionode.engine.context import Context
from aionode.engine.transport.zenoh._defects import closing as closing_defect
from aionode.engine.transport.zenoh._defects import lingering
from aionode.engine.transport.zenoh.connections import sockets as _sockets
from aionode.engine.transport.zenoh.connections.sockets import (
    Pair,
    cut_participants,
    descriptors,
    duplicates,
    find,
    is_open,
    pair_of,
    polled_by_zenoh,
)
from aionode.engine.transport.zenoh.session.session import open_router
from tests.support.guest import locks
from tests.support.peers import free_ports, two_contexts, zenoh_config
from tests.support.waiting import until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="only Linux lists the sockets of a process"
)


def session_of(context: Context) -> Any:
    """Return the Zenoh session of an open context."""
    transport: Any = context.transports[1]
    return transport.session_state.session


def pairs_of(session: zenoh.Session) -> set[Pair]:
    """Return the addresses of the connections of a session."""
    return {pair for link in session.info.links() if (pair := pair_of(link))}


@contextmanager
def listening(host: str) -> Iterator[tuple[zenoh.Session, int]]:
    """A session that listens, and its port."""
    (port,) = free_ports(1)
    listens = {"listen/endpoints": [f"tcp/{host}:{port}"], "scouting/multicast/enabled": False}
    with closing(zenoh.open(zenoh_config({"mode": "router", **listens}))) as session:
        yield session, port


@contextmanager
def dialling(host: str, port: int) -> Iterator[zenoh.Session]:
    """A session that is connected with one that listens."""
    dials = {"connect/endpoints": [f"tcp/{host}:{port}"], "scouting/multicast/enabled": False}
    with closing(zenoh.open(zenoh_config({"mode": "client", **dials}))) as session:
        yield session


@contextmanager
def log_connection() -> Iterator[socket.socket]:
    """A connection of the program that only sends, with the same options as Zenoh's."""
    with (
        socket.create_server(("127.0.0.1", 0)) as listener,
        socket.create_connection(listener.getsockname()) as one,
    ):
        one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, closing_defect.ZENOH_LINGER)
        one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        one.sendall(bytes(34))  # as many as Zenoh sends before it waits for an answer
        yield one


def is_whole(one: socket.socket) -> bool:
    """Return whether a connection accepts data, and still has its options."""
    one.sendall(b"more")
    linger = one.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8)
    info = one.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, 8)
    return info[0] == closing_defect.ESTABLISHED and linger == closing_defect.ZENOH_LINGER


@pytest.mark.parametrize("told", [True, False], ids=["told", "listed"])
@pytest.mark.parametrize(
    ("listens", "dialled"),
    [("127.0.0.1", "127.0.0.1"), ("[::1]", "[::1]"), ("[::]", "127.0.0.1"), ("[::]", "[::1]")],
)
def test_the_socket_of_each_end_is_found_by_the_addresses_of_its_link(
    listens: str, dialled: str, told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Over IPv4, IPv6, and IPv4 to a socket that listens for both, as that of a ROS router.

    The system is asked for each connection, or lists all to those that must not ask.
    """
    monkeypatch.setattr(_sockets, "CONNECTIONS" if told else "SOCK_DIAG", () if told else -1)
    with listening(listens) as (one, port), dialling(dialled, port) as other:
        for session, end in ((one, socket.socket.getsockname), (other, socket.socket.getpeername)):
            (descriptor,) = find(pairs_of(session)).values()
            ends = [end(duplicate)[1] for _, duplicate in duplicates([descriptor])]
            assert ends == [port]


@pytest.mark.parametrize("told", [True, False], ids=["told", "listed"])
async def test_a_closed_connection_is_not_taken_for_the_socket_that_listens(
    told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The system returns the listening socket in its place, which would have been cut."""
    monkeypatch.setattr(_sockets, "CONNECTIONS" if told else "SOCK_DIAG", () if told else -1)
    with listening("127.0.0.1") as (one, port):
        with dialling("127.0.0.1", port):
            pairs = pairs_of(one)
            (descriptor,) = find(pairs).values()
        await until(lambda: not is_open(descriptor))

        assert find(pairs) == {}


def test_connections_of_two_sessions_to_one_address_are_told_apart() -> None:
    """By the peer's address alone, each session took the socket of the other for its own."""
    with (
        listening("127.0.0.1") as (_, port),
        dialling("127.0.0.1", port) as one,
        dialling("127.0.0.1", port) as other,
    ):
        (first,), (second,) = find(pairs_of(one)).values(), find(pairs_of(other)).values()

    assert first != second


def test_a_connection_of_the_program_to_the_same_address_is_left_alone() -> None:
    """A program may ask the router's port whether it answers."""
    with (
        listening("127.0.0.1") as (_, port),
        socket.create_connection(("127.0.0.1", port)) as asking,
        dialling("127.0.0.1", port) as session,
    ):
        found = find(pairs_of(session)).values()

        assert asking.fileno() not in {number for number, _ in found}


def test_a_link_without_a_tcp_connection_has_no_socket_here() -> None:
    """The addresses of a UDP link may be those of a TCP connection of the program."""
    one, other = "127.0.0.1:7447", "127.0.0.1:7448"
    for source, target in (
        (f"udp/{one}", f"udp/{other}"),
        (f"quic/{one}", f"quic/{other}"),
        ("unixsock-stream//tmp/x", "unixsock-stream//tmp/y"),
        (f"tcp/{one}", "tcp/robot.local:7448"),
        ("tcp/127.0.0.1", "nonsense"),
    ):
        link: Any = SimpleNamespace(src=source, dst=target)
        assert pair_of(link) is None


def test_a_connection_is_searched_for_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The search takes milliseconds in a process with a thousand descriptors."""
    with listening("127.0.0.1") as (_, port), dialling("127.0.0.1", port) as session:
        pairs = pairs_of(session)
        first = find(pairs)
        monkeypatch.setattr(_sockets, "CONNECTIONS", ())
        monkeypatch.setattr(_sockets, "SOCK_DIAG", -1)

        assert find(pairs) == first
        assert set(_sockets.known) >= pairs


def test_a_new_connection_is_found_without_reading_all_descriptors(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With a thousand of them, a start beside thirty peers took 0.65 s in place of 0.2."""
    read: list[int | str] = []
    target_of = _sockets.target_of

    def note(name: int | str) -> str:
        read.append(name)
        return target_of(name)

    with ExitStack() as stack, listening("127.0.0.1") as (_, port):
        for _ in range(400):
            stack.callback(os.close, os.open(os.devnull, os.O_RDONLY))
        with dialling("127.0.0.1", port) as session:
            pairs = pairs_of(session)
            monkeypatch.setattr(_sockets, "target_of", note)

            assert find(pairs).keys() == pairs

    assert len(read) < 200


def test_what_was_found_is_forgotten_when_its_connection_is_closed() -> None:
    """The next socket may have the same number."""
    with listening("127.0.0.1") as (_, port):
        with dialling("127.0.0.1", port) as session:
            pairs = pairs_of(session)
            find(pairs)
        assert find(pairs) == {}
        with dialling("127.0.0.1", port) as session:
            find(pairs_of(session))

    assert pairs.isdisjoint(_sockets.known)


def test_searching_opens_one_descriptor_at_a_time() -> None:
    """Processes of ten contexts ran out of 20000: each search found the duplicates of others."""
    with listening("127.0.0.1") as (one, port), dialling("127.0.0.1", port) as other:
        sockets = find(pairs_of(one) | pairs_of(other))
        assert len(sockets) == 2
        before = len(list(descriptors()))
        counts = [len(list(descriptors())) for _ in duplicates(sockets.values())]

    assert counts == [before + 1] * 2


async def test_locks_of_the_program_outlast_all_that_is_done_with_sockets(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Closing a duplicate of a file drops the record locks that the process has on it.

    Another process wrote inside an exclusive transaction of SQLite.
    """
    monkeypatch.setattr(lingering, "SETTLE_S", 0.0)
    with locks(tmp_path):
        async with two_contexts() as (first, second):
            session, other = session_of(first), str(session_of(second).zid())
            await until(lambda: not any(lingers(session)))  # by SocketOptions
            assert await asyncio.to_thread(_sockets.send_progress, session, other)
            assert await asyncio.to_thread(_sockets.arrived_bytes, session)
            await asyncio.to_thread(closing_defect.unanswered)
            before = pairs_of(session)
            await asyncio.to_thread(cut_participants, session, {other})
            await until(lambda: pairs_of(session).isdisjoint(before))


def lingers(session: zenoh.Session) -> list[bool]:
    """Return whether closing each connection of a session waits for its peer."""
    return [
        any(one.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 4))
        for _, one in duplicates(find(pairs_of(session)).values())
    ]


def test_a_file_that_gets_the_number_of_a_closed_socket_keeps_its_locks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even within the microsecond between the search and the duplication."""
    monkeypatch.setattr(_sockets, "is_open", lambda _: True)
    with locks(tmp_path):
        names = [str(tmp_path / name) for name in ("record", "log.sqlite")]
        files = {number: target for number, target in descriptors() if target in names}
        assert sorted(files.values()) == sorted(names)

        assert list(duplicates((number, 1) for number in files)) == []


@pytest.mark.parametrize("kind", ["plain", "asyncio", "edge-triggered"])
async def test_a_connection_of_the_program_is_not_taken_for_one_of_zenoh(kind: str) -> None:
    """Ending a node reset the log connection of its program: SO_LINGER, and nothing received."""
    with log_connection() as one, select.epoll() as poll:
        if kind == "asyncio":
            asyncio.get_running_loop().add_reader(one, lambda: None)
        elif kind == "edge-triggered":
            poll.register(one, select.EPOLLIN | select.EPOLLOUT | select.EPOLLET)
        async with two_contexts():
            unanswered = await asyncio.to_thread(closing_defect.unanswered)
            assert one.fileno() not in {number for number, _ in unanswered}
        asyncio.get_running_loop().remove_reader(one)

        assert is_whole(one)


async def test_a_connection_of_the_program_outlasts_a_close_beside_a_silent_peer() -> None:
    """Only Zenoh's own connection is cut, though both look the same to their peers."""
    with log_connection() as one, socket.create_server(("127.0.0.1", 0)) as silent:
        dial = {"connect/endpoints": [f"tcp/127.0.0.1:{silent.getsockname()[1]}"]}
        async with Context(config=dial), asyncio.timeout(20):
            while not (unanswered := await asyncio.to_thread(closing_defect.unanswered)):
                await asyncio.to_thread(threading.Event().wait, 0.01)

        assert len(unanswered) == 1
        assert is_whole(one)


async def test_sockets_of_zenoh_are_known_by_how_its_runtime_waits_for_them() -> None:
    """The system names no owner of a descriptor within a process."""
    router = await open_router([f"tcp/127.0.0.1:{os.environ['AIONODE_ROUTER_PORT']}"])
    with closing(router):
        async with two_contexts() as both:
            own = {each for one in both for each in find(pairs_of(session_of(one))).values()}
            assert own
            assert own <= polled_by_zenoh()


def test_locks_that_do_not_hold_are_noticed(tmp_path: Path) -> None:
    """Otherwise the tests above would show nothing."""
    guest = locks(tmp_path)
    guest.__enter__()
    for number, target in list(descriptors()):
        if target in {str(tmp_path / "record"), str(tmp_path / "log.sqlite")}:
            os.close(os.dup(number))

    with pytest.raises(AssertionError, match="the record lock\nthe transaction"):
        guest.__exit__(None, None, None)
