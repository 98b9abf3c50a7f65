"""Unannounced peers on the network, and retransmissions between contexts."""

from __future__ import annotations

import asyncio
import os
import threading
from collections.abc import AsyncIterator
from contextlib import ExitStack, asynccontextmanager
from typing import Any

import pytest
import zenoh  # noqa: TID251  # plays the other participants, without aionode

from aionode.engine.transport.network import network_from
from aionode.engine.transport.zenoh._transport import ZenohTransport
from aionode.engine.transport.zenoh.session.session import close_session, open_router
from aionode.graph import Graph
from tests.support.peers import (
    DOMAIN_ID,
    Collector,
    known,
    raw_session,
    ros_router,
    router_client,
)
from tests.support.waiting import until

PATIENCE_S = 20.0
"""How long a test waits for a connection to come or go."""


class Heard:
    """Lets a test wait until a context knows whether there are unannounced peers."""

    def __init__(self, transport: ZenohTransport) -> None:
        self.transport = transport
        self.peer_directory = peer_directory = transport.peer_directory
        self.told: list[bool] = []
        self._changed = asyncio.Event()
        peer_directory.on_unannounced_peers = self._on_unannounced_peers

    def _on_unannounced_peers(self, has_unannounced_peers: bool) -> None:
        assert has_unannounced_peers == self.peer_directory.has_unannounced_peers
        self.told.append(has_unannounced_peers)
        self._changed.set()

    async def until(self, has_unannounced_peers: bool) -> None:
        """Wait until there are unannounced peers, or none."""
        async with asyncio.timeout(PATIENCE_S):
            while self.peer_directory.has_unannounced_peers != has_unannounced_peers:
                self._changed.clear()
                await self._changed.wait()

    async def past(self) -> None:
        """Wait until there were unannounced peers and are none now; both may be over already."""
        async with asyncio.timeout(PATIENCE_S):
            while not self.told or self.peer_directory.has_unannounced_peers:
                self._changed.clear()
                await self._changed.wait()


@asynccontextmanager
async def context(
    participant: str, *, linked: bool = True, domain_id: int = DOMAIN_ID
) -> AsyncIterator[ZenohTransport]:
    """A transport that is open, and announces that it can be linked."""
    transport = ZenohTransport(participant, network_from(os.environ, domain_id=domain_id))
    if linked:
        transport.peer_directory.advertisement = f"{participant}/link/1/host/user"
    await transport.open(Graph())
    try:
        yield transport
    finally:
        await transport.close()


@pytest.fixture
async def heard() -> AsyncIterator[Heard]:
    """A context without any peers yet."""
    async with context("a1") as transport:
        yield Heard(transport)


@asynccontextmanager
async def router() -> AsyncIterator[zenoh.Session]:
    """A router of ROS."""
    session = await asyncio.to_thread(ros_router)
    try:
        yield session
    finally:
        await asyncio.to_thread(session.close)


def router_port() -> str:
    """Return the port of the router."""
    return os.environ["AIONODE_ROUTER_PORT"]


def meeting_port() -> str:
    """Return the port of the first context."""
    return os.environ["AIONODE_MEETING_PORTS"].split(",")[0]


def announce_node(session: zenoh.Session, domain_id: int) -> zenoh.LivelinessToken:
    """Announce a node as ROS does."""
    return session.liveliness().declare_token(
        f"@ros2_lv/{domain_id}/{session.zid()}/0/0/NN/%/%/theirs"
    )


async def until_nodes(transport: ZenohTransport, count: int) -> None:
    """Wait until `count` nodes of the domain are in the graph."""
    graph = transport.session_state.graph
    assert graph is not None
    await graph.until(lambda: len(graph.nodes()) == count)


def ignore(_: object) -> None:
    """Ignore a message."""


async def test_a_plain_session_is_an_unannounced_peer_while_it_is_connected(heard: Heard) -> None:
    """It may subscribe to anything unnoticed."""
    assert not heard.peer_directory.has_unannounced_peers

    with raw_session():
        await heard.until(True)
    await heard.until(False)

    assert heard.told == [True, False]


async def test_unannounced_peers_are_reported_with_the_connection(heard: Heard) -> None:
    """In a later turn of the loop, something may already be published."""
    seen: list[bool] = []
    there = asyncio.Event()

    connections = heard.transport.session_state.connections

    def on_change(_: object) -> None:
        if connections.kinds:
            seen.append(heard.peer_directory.has_unannounced_peers)
            there.set()

    connections.on_change.append(on_change)
    async with asyncio.timeout(PATIENCE_S):
        with raw_session():
            await there.wait()

    assert seen[0]


async def test_a_ros_node_of_another_domain_is_no_unannounced_peer(heard: Heard) -> None:
    """All of its subscriptions are announced, in its own domain."""
    with raw_session() as session:
        await heard.until(True)
        _token = announce_node(session, DOMAIN_ID + 1)
        await heard.until(False)


async def test_a_ros_context_stays_known_after_its_last_node(heard: Heard) -> None:
    """It will announce its next one, and what that subscribes to."""
    with raw_session() as session:
        await heard.until(True)
        token = announce_node(session, DOMAIN_ID)
        await heard.until(False)
        await until_nodes(heard.transport, 1)
        token.undeclare()
        await until_nodes(heard.transport, 0)
        with raw_session() as second:  # what came before it has been seen
            await heard.until(True)
            _token = announce_node(second, DOMAIN_ID)
            await heard.until(False)

    assert heard.told == [True, False, True, False]


@pytest.mark.parametrize("domain_id", [DOMAIN_ID, DOMAIN_ID + 1])
async def test_a_context_is_no_unannounced_peer(heard: Heard, domain_id: int) -> None:
    """This holds in any domain, and before it has a node."""
    connections = heard.transport.session_state.connections
    async with context("b2", domain_id=domain_id):
        await until(lambda: "b2" in connections.kinds)
        await heard.until(False)


async def test_a_router_is_an_unannounced_peer(heard: Heard) -> None:
    """The sessions behind it are not visible, even if all visible ones are known."""
    async with context("b2"):
        async with router():
            await heard.until(True)
        await heard.until(False)


async def test_our_own_router_answers_no_question_of_its_admin_space() -> None:
    """A query for its routing table can deadlock it."""
    session = await open_router([f"tcp/127.0.0.1:{router_port()}"])
    try:
        with router_client(router_port()) as asking:
            remote = zenoh.Locality.REMOTE  # a session answers for itself
            replies = await asyncio.to_thread(
                lambda: list(asking.get("@/**", timeout=1, allowed_destination=remote))
            )
    finally:
        await close_session(session)

    assert replies == []


async def test_a_client_of_one_context_is_an_unannounced_peer_to_all(heard: Heard) -> None:
    """Zenoh sends it what the others publish, and only that context sees it."""
    async with context("b2") as second:
        other = Heard(second)
        await heard.past()
        await other.until(False)
        with router_client(meeting_port()):
            await heard.until(True)
            await other.until(True)
        await heard.until(False)
        await other.until(False)


async def test_retransmissions_arrive_in_order_at_their_recipient() -> None:
    """All of them, however fast they are sent."""
    count = 3000
    async with context("a1") as first, context("b2") as second, context("c3") as third:
        got, stray = Collector(), Collector()
        second.peer_directory.on_retransmit = got
        first.peer_directory.on_retransmit = third.peer_directory.on_retransmit = stray
        for number in range(count):
            first.peer_directory.retransmit("b2", number.to_bytes(4, "big") * 100)
        items = await got.have(count)

    assert items == [number.to_bytes(4, "big") * 100 for number in range(count)]
    assert not stray.items


async def test_retransmissions_without_a_connection_are_given_up() -> None:
    """Without one, their recipient is gone as well."""
    async with context("a1") as transport:
        pass
    transport.peer_directory.retransmit("b2", b"late")

    assert not transport.session_state.peer_senders.send_threads()


async def test_nothing_is_declared_without_an_advertisement() -> None:
    """A context without links pays nothing for them."""
    async with context("a1", linked=False) as transport:
        peer_directory = transport.peer_directory
        told = Heard(transport)
        with raw_session() as session:
            _token = announce_node(session, DOMAIN_ID)
            await until_nodes(transport, 1)
            replies = session.liveliness().get("@aionode/**", timeout=1)
            keys = [str(reply.ok.key_expr) for reply in replies if reply.ok is not None]

            # That it acknowledges messages has nothing to do with links.
            assert keys == [f"@aionode/{DOMAIN_ID}/a1/reliable/3"]
        assert (peer_directory._declared, peer_directory._unknown, told.told) == ([], set(), [])


async def test_closing_leaves_nothing_behind() -> None:
    """No timer, no token, and no peer is known when it opens again."""
    with ExitStack() as stack:
        async with router(), context("b2"):
            async with context("a1") as transport:
                heard = Heard(transport)
                session = stack.enter_context(raw_session())
                await known(session, "@aionode/*/*/link/**", 2)
                await heard.until(True)
            peer_directory = transport.peer_directory

            assert not peer_directory.has_unannounced_peers
            tokens = {
                str(each.ok.key_expr) for each in session.liveliness().get("@aionode/**") if each.ok
            }
            assert not any("/a1/" in token for token in tokens)


async def test_it_opens_again() -> None:
    """With the peers present at that time."""
    transport = ZenohTransport("a1", network_from(os.environ))
    heard = Heard(transport)
    for _ in range(2):
        transport.peer_directory.advertisement = "a1/link/1/host/user"
        await transport.open(Graph())
        with raw_session():
            await heard.until(True)
            await transport.close()
        assert not transport.peer_directory.has_unannounced_peers


class Stuck:
    """A session with a hanging peer: everything sent there waits.

    Attributes:
        entered: Set once something waits.
        gate: Lets it go on.
    """

    def __init__(self) -> None:
        self.entered = threading.Event()
        self.gate = threading.Event()

    def put(self, *_: object, **__: object) -> None:
        """Hang."""
        self.entered.set()
        self.gate.wait()


async def test_a_stuck_peer_holds_up_no_large_message_to_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Both used to wait in the thread that sends all large messages."""
    stuck = Stuck()
    done = asyncio.Event()
    async with context("a1") as transport:
        peer_directory: Any = transport.peer_directory
        with monkeypatch.context() as patch:
            patch.setattr(peer_directory, "_session", stuck)
            peer_directory.retransmit("b2", b"late")
            await asyncio.to_thread(stuck.entered.wait)
            queue: Any = transport.session_state.queue(lambda _: done.set())
            transport.session_state.bulk.submit(lambda: queue.put(None))
            await done.wait()
        stuck.gate.set()
