"""What Zenoh's sockets do while a peer has stopped reading."""

from __future__ import annotations

import asyncio
import os
import socket
import struct
import sys
from contextlib import AsyncExitStack
from typing import Any

import pytest
import zenoh  # noqa: TID251  # plays another machine, without aionode

from aionode._concurrency import checkpoint
from aionode.context import Context
from aionode.transport._zenoh_config import look_settings
from aionode.transport.zenoh import _sockets
from aionode.transport.zenoh._session import close_session, open_router
from tests.support.peers import Collector, two_contexts, zenoh_config

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="only Linux lists the sockets of a process"
)


def lingers(context: Context) -> list[bool]:
    """Return for each connection of a context whether closing it waits for the peer."""
    transport: Any = context.transports[1]
    peers = {_sockets.address_of(link) for link in transport._state.session.info.links()}
    with _sockets.connections() as found:
        options = [
            one.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8)
            for peer, one in found
            if peer in peers
        ]
    return [bool(struct.unpack("ii", option)[0]) for option in options]


async def test_no_connection_waits_for_its_peer_when_it_is_closed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Zenoh's one thread that connects stood still for ten seconds when a stuck peer was lost."""
    monkeypatch.setattr(_sockets, "SETTLE_S", 0.0)
    async with two_contexts() as both:
        for context in both:
            async with asyncio.timeout(20):
                while not (found := lingers(context)) or any(found):
                    await checkpoint()


async def test_a_closed_context_looks_for_sockets_no_more() -> None:
    """A timer that is left would hold the closed session."""
    async with two_contexts() as both:
        transports: list[Any] = [context.transports[1] for context in both]
        switches = [transport._linger_switch for transport in transports]
        while not all(switch._timer for switch in switches):
            await checkpoint()

    assert all(switch._timer.cancelled() for switch in switches)
    assert [transport._linger_switch for transport in transports] == [None, None]


@pytest.mark.parametrize("who", ["we dial", "it dials"])
async def test_a_context_closes_at_once_while_a_connection_is_not_answered(who: str) -> None:
    """A program that is frozen accepts, and is accepted, as its system does that for it."""
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
            while not await asyncio.to_thread(_sockets.unanswered):
                await checkpoint()
        began_s = asyncio.get_running_loop().time()
        await closing.aclose()
        took_s = asyncio.get_running_loop().time() - began_s

    assert took_s < 0.7


async def test_only_connections_to_other_machines_are_looked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each look costs a router with 200 connections 4 ms, in which it answers no newcomer."""
    looked: list[str] = []
    monkeypatch.setattr(_sockets, "give_up_soon", looked.append)
    endpoint = f"tcp/127.0.0.1:{os.environ['AIONODE_ROUTER_PORT']}"
    router = await open_router([endpoint])
    try:
        look = await asyncio.to_thread(zenoh.open, zenoh_config(look_settings(endpoint)))
        look.close()
    finally:
        await close_session(router)

    assert not looked


real_give_up_soon = _sockets.give_up_soon


async def test_a_connection_to_another_machine_is_given_up_soon(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """When nothing arrives there: TCP would wait for minutes. Here loopback is another machine."""
    monkeypatch.setattr(_sockets, "is_near", lambda _: False)
    limited = Collector()

    def give_up_soon(peer: str) -> None:
        real_give_up_soon(peer)
        limited(peer)

    monkeypatch.setattr(_sockets, "give_up_soon", give_up_soon)
    endpoint = f"tcp/127.0.0.1:{os.environ['AIONODE_ROUTER_PORT']}"
    router = await open_router([endpoint])
    try:
        look = await asyncio.to_thread(zenoh.open, zenoh_config(look_settings(endpoint)))
        await limited.have(1)
        with _sockets.connections() as found:
            mine = {_sockets.address_of(link) for link in router.info.links()}
            limits = [
                one.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT)
                for peer, one in found
                if peer in mine
            ]
        look.close()
    finally:
        await close_session(router)

    assert limits == [_sockets.UNREACHABLE_MS]
