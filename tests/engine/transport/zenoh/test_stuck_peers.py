"""Zenoh's sockets while a peer does not read."""

from __future__ import annotations

import asyncio
import os
import socket
import struct
import sys
import threading
from contextlib import AsyncExitStack, suppress
from typing import TYPE_CHECKING, Any

import pytest
import zenoh  # noqa: TID251  # type of sessions

from aionode._process.concurrency import checkpoint
from aionode.engine.context import Context
from aionode.engine.transport.zenoh import _transport
from aionode.engine.transport.zenoh._defects import closing, lingering
from aionode.engine.transport.zenoh._defects.blocked_sends import UNREAD_MS
from aionode.engine.transport.zenoh._defects.closing import unanswered
from aionode.engine.transport.zenoh.connections import sockets as _sockets
from aionode.engine.transport.zenoh.connections.sockets import connections, duplicates
from aionode.engine.transport.zenoh.session import session as _session
from aionode.engine.transport.zenoh.session.session import close_session, open_router
from tests.support.living import living
from tests.support.peers import quiet_node, two_contexts
from tests.support.waiting import until, waited_s

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="only Linux lists the sockets of a process"
)


def session_of(context: Context) -> Any:
    """Return the Zenoh session of an open context."""
    transport: Any = context.transports[1]
    return transport.session_state.session


def options(session: zenoh.Session) -> list[tuple[bool, int]]:
    """Return whether closing each connection waits for its peer, and its time limit in ms."""
    return [
        (
            bool(struct.unpack("ii", one.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8))[0]),
            one.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT),
        )
        for _, one in duplicates(connections(session))
    ]


async def until_set(session: zenoh.Session, wanted: tuple[bool, int]) -> None:
    """Wait until all connections of a session have the wanted options."""
    async with asyncio.timeout(20):
        await until(lambda: set(options(session)) == {wanted})


async def test_no_connection_waits_for_its_peer_when_it_is_closed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Zenoh's one thread that connects stood still for ten seconds when a stuck peer was lost."""
    monkeypatch.setattr(lingering, "SETTLE_S", 0.0)
    async with two_contexts() as both:
        for context in both:
            await until_set(session_of(context), (False, UNREAD_MS))


@pytest.mark.parametrize(("near", "limit_ms"), [(True, 7_000), (False, 5_000)])
async def test_a_connection_whose_peer_reads_nothing_is_given_up_before_its_lease_ends(
    near: bool, limit_ms: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beside a thread that waited for it, Zenoh could not end it, and kept all others waiting."""
    monkeypatch.setattr(lingering, "SETTLE_S", 0.0)
    monkeypatch.setattr(lingering, "is_near", lambda _: near)
    async with two_contexts() as both:
        for context in both:
            await until_set(session_of(context), (False, limit_ms))


@pytest.mark.parametrize(
    ("few", "timers"), [(1000, 1), (0, 3)], ids=["few descriptors", "many descriptors"]
)
async def test_only_a_process_of_many_descriptors_starts_a_thread_for_one_connection(
    few: int, timers: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each start of a process cost every other one of its domain a thread, a millisecond.

    A context that opens starts one for all its connections.
    """
    monkeypatch.setattr(lingering, "FEW", few)
    monkeypatch.setattr(lingering, "SETTLE_S", 0.0)
    started: list[threading.Thread] = []
    start = threading.Thread.start

    def note(thread: threading.Thread) -> None:
        if isinstance(thread, threading.Timer):
            started.append(thread)
        start(thread)

    async with two_contexts() as both:
        for context in both:
            await until_set(session_of(context), (False, UNREAD_MS))
        # Only the two connections of the third one are missing.
        monkeypatch.setattr(lingering, "SETTLE_S", 0.5)
        monkeypatch.setattr(threading.Thread, "start", note)
        async with Context() as third:
            for context in (*both, third):
                await until_set(session_of(context), (False, UNREAD_MS))

    assert len(started) == timers


async def test_a_closed_context_looks_for_sockets_no_more() -> None:
    """A remaining timer would keep the closed session alive."""
    setters = living(lingering.SocketOptions)
    others = set(threading.enumerate())

    def timers() -> list[threading.Timer]:
        return [
            each
            for each in threading.enumerate()
            if isinstance(each, threading.Timer) and each not in others
        ]

    async with two_contexts():
        await until(lambda: len(timers()) >= 2)

    for timer in timers():
        timer.join(10)
    assert timers() == []
    assert living(lingering.SocketOptions) <= setters


async def test_no_connection_of_a_router_waits_for_its_peer_when_it_is_closed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A router stood still for all when one of its peers had stopped, and was lost."""
    monkeypatch.setattr(lingering, "SETTLE_S", 0.0)
    router = await open_router([f"tcp/127.0.0.1:{os.environ['AIONODE_ROUTER_PORT']}"])
    try:
        async with Context():
            await until_set(router, (False, UNREAD_MS))
    finally:
        await close_session(router)


async def test_what_arrives_is_seen_while_zenoh_reads_it() -> None:
    """A busy process takes seconds for that, and is not to take them for silence."""
    async with two_contexts() as (first, second):
        session = session_of(first)
        before = _sockets.arrived_bytes(session)
        assert before

        def more_has_come() -> bool:
            return any(
                received > before.get(peer, (0, 0))[0] + 100
                for peer, (received, _) in _sockets.arrived_bytes(session).items()
            )

        def all_is_read() -> bool:
            return not any(unread for _, unread in _sockets.arrived_bytes(session).values())

        async with quiet_node("second", second):
            await until(more_has_come)
            await until(all_is_read)


def descriptor_of(one: socket.socket) -> tuple[int, int]:
    """Return the numbers of a socket's descriptor and inode."""
    return one.fileno(), os.fstat(one.fileno()).st_ino


@pytest.fixture
def full(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[socket.socket, socket.socket]]:
    """Return both ends of the only connection, whose second end has not read what was sent."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        sender = socket.create_connection(server.getsockname())
        receiver, _ = server.accept()
    with sender, receiver:
        sender.setblocking(False)
        with suppress(BlockingIOError):
            while True:
                sender.send(bytes(1 << 16))
        found = {descriptor_of(sender): None}
        monkeypatch.setattr(closing, "connections", lambda _: found)
        monkeypatch.setattr(closing, "unanswered", set)
        yield sender, receiver


async def test_a_close_waits_for_a_peer_only_until_it_reads(
    full: tuple[socket.socket, socket.socket], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each command beside other processes took a tenth of a second more."""
    monkeypatch.setattr(closing, "STUCK_S", 30.0)
    sender, receiver = full
    session: Any = None

    def read() -> None:
        while closing.with_unsent_bytes([descriptor_of(sender)]):
            receiver.recv(1 << 16)

    async with asyncio.timeout(20):
        await asyncio.gather(asyncio.to_thread(closing.cut_stuck, session), asyncio.to_thread(read))

    sender.send(b"it is not cut")


async def test_a_close_cuts_the_connection_to_a_peer_that_does_not_read(
    full: tuple[socket.socket, socket.socket],
) -> None:
    """Zenoh would wait for it as long as for the end of its lease."""
    session: Any = None

    await asyncio.to_thread(closing.cut_stuck, session)

    with pytest.raises(BrokenPipeError):
        full[0].send(b"it is cut")


async def test_connections_that_were_just_made_do_not_linger_at_a_close(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What a command sends last is acknowledged up to 40 ms later, and closing waited for it."""
    monkeypatch.setattr(lingering, "SETTLE_S", 60.0)
    async with two_contexts() as both:
        session = session_of(both[0])
        assert {lingers for lingers, _ in options(session)} == {True}

        await asyncio.to_thread(closing.cut_stuck, session)

        assert {lingers for lingers, _ in options(session)} == {False}


def not_seen(_: zenoh.Session) -> None:
    """Find no connection to cut, as if it began only while the session is being closed."""


async def test_a_close_that_goes_on_in_a_thread_does_not_wait_for_a_frozen_peer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Python waits for that thread at exit."""
    monkeypatch.setattr(_transport, "cut_stuck", not_seen)
    monkeypatch.setattr(_session, "CLOSE_S", 0)
    before = set(threading.enumerate())
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        dial = {"connect/endpoints": [f"tcp/127.0.0.1:{silent.getsockname()[1]}"]}
        async with Context(config=dial), asyncio.timeout(20):
            while not await asyncio.to_thread(unanswered):
                await checkpoint()
        began_s, waited_before_s = asyncio.get_running_loop().time(), waited_s()
        async with asyncio.timeout(20):
            while closing := [
                thread
                for thread in {*threading.enumerate()} - before
                if thread.name == "aionode-zenoh"
            ]:
                for thread in closing:
                    with suppress(RuntimeError):  # one that has not started yet
                        await asyncio.to_thread(thread.join)

        took_s = asyncio.get_running_loop().time() - began_s
        assert took_s - (waited_s() - waited_before_s) < 2.5  # Zenoh would wait for 3 s


@pytest.mark.parametrize("begins", ["before", "meanwhile"])
@pytest.mark.parametrize("who", ["we dial", "it dials"])
async def test_a_context_closes_at_once_while_a_connection_is_not_answered(
    who: str, begins: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program that is frozen accepts, and is accepted, as its system does that for it."""
    monkeypatch.setattr(_session, "CLOSE_S", 20.0)  # so that the limit below is far away
    if begins == "meanwhile":
        monkeypatch.setattr(_transport, "cut_stuck", not_seen)
    async with AsyncExitStack() as stack:
        silent = stack.enter_context(socket.socket())
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        dial = {"connect/endpoints": [f"tcp/127.0.0.1:{silent.getsockname()[1]}"]}
        context = Context(config=dial if who == "we dial" else {})
        closing = await stack.enter_async_context(AsyncExitStack())
        await closing.enter_async_context(context)
        if who == "it dials":
            port = int(os.environ["AIONODE_MEETING_PORTS"].partition(",")[0])
            stack.enter_context(socket.create_connection(("127.0.0.1", port)))
        async with asyncio.timeout(20):
            while not await asyncio.to_thread(unanswered):
                await checkpoint()
        began_s, waited_before_s = asyncio.get_running_loop().time(), waited_s()
        await closing.aclose()
        took_s = asyncio.get_running_loop().time() - began_s - (waited_s() - waited_before_s)

    assert took_s < 2.5  # Zenoh would wait for 3 s
