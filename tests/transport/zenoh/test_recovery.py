"""Participants that were introduced once are connected again, whatever ended the connection."""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager, closing, suppress
from types import SimpleNamespace
from typing import Any

import pytest
import zenoh  # noqa: TID251  # plays the other participants, without aionode

from aionode._concurrency import checkpoint
from aionode.graph import Graph, NodeInfo
from aionode.transport._zenoh_config import network_from
from aionode.transport.zenoh import _recovery as recovery
from aionode.transport.zenoh import _sockets
from aionode.transport.zenoh._descriptors import Pair, find
from aionode.transport.zenoh._recovery import (
    Introducer,
    Recovery,
    address_in,
    addresses_of,
    is_look,
)
from aionode.transport.zenoh._session_state import SessionState
from aionode.transport.zenoh._transport import ZenohTransport
from tests.support.peers import (
    DOMAIN_ID,
    Collector,
    free_ports,
    raw_session,
    ros_router,
    ros_session,
)
from tests.support.waiting import until

pytestmark = pytest.mark.one_loop

LIMIT_S = 15.0


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Look as early as possible: no other process uses these ports."""
    monkeypatch.setattr(recovery, "FIRST_S", 0.1)
    monkeypatch.setattr(recovery, "SURE_S", 0.05)


@asynccontextmanager
async def context(participant: str) -> AsyncIterator[ZenohTransport]:
    """A transport that is open, with the token of one node."""
    transport = ZenohTransport(participant, network_from(os.environ))
    transport.peer_directory.advertisement = f"{participant}/link/1/host/user"
    graph = Graph()
    await transport.open(graph)
    session = transport._state.session
    assert session is not None
    token = announce(session, participant, participant)
    try:
        yield transport
    finally:
        token.undeclare()
        await transport.close()


def announce(session: zenoh.Session, participant: str, name: str) -> zenoh.LivelinessToken:
    """Announce a node as ROS does."""
    return session.liveliness().declare_token(
        f"@ros2_lv/{DOMAIN_ID}/{participant}/0/0/NN/%/%/{name}"
    )


@asynccontextmanager
async def robot(*names: str) -> AsyncIterator[list[zenoh.Session]]:
    """A router of ROS, and sessions of nodes that it introduces."""
    async with AsyncExitStack() as stack:
        router = await asyncio.to_thread(ros_router)
        stack.push_async_callback(asyncio.to_thread, router.close)
        sessions = []
        for name in names:
            session = await asyncio.to_thread(ros_session)
            stack.push_async_callback(asyncio.to_thread, session.close)
            token = announce(session, str(session.zid()), name)
            stack.push_async_callback(asyncio.to_thread, token.undeclare)
            sessions.append(session)
        yield sessions


def names_in(transport: ZenohTransport) -> set[str]:
    """Return the nodes that are seen."""
    assert transport._state.graph is not None
    return {node.name for node in transport._state.graph.nodes()}


async def until_seen(transport: ZenohTransport, *names: str) -> None:
    """Wait until exactly these nodes are seen."""
    graph = transport._state.graph
    assert graph is not None
    async with asyncio.timeout(LIMIT_S):
        await graph.until(lambda: names_in(transport) == set(names))


def ways_between(transport: ZenohTransport, zid: str) -> set[Pair]:
    """Return the connections to another session."""
    session = transport._state.session
    assert session is not None
    return recovery.pairs_to(session, {zid})


def lose(transport: ZenohTransport, zid: str) -> None:
    """End all connections to another session, as a network does."""
    ways = ways_between(transport, zid)
    assert ways
    real_cut(find(ways).values())


async def until_lost(transport: ZenohTransport, zid: str, name: str) -> None:
    """End all connections to another session, and wait until its node has left the graph.

    The node may be back by then: on a busy machine the loop sees both changes at once.
    """
    graph: Any = transport._state.graph
    left = asyncio.Event()
    remove_node = graph.remove_node

    def on_remove(node: NodeInfo) -> None:
        remove_node(node)
        if node.name == name:
            left.set()

    graph.remove_node = on_remove
    lose(transport, zid)
    async with asyncio.timeout(LIMIT_S):
        await left.wait()


@pytest.mark.parametrize("participant", ["a1", 32 * "f"])
async def test_a_ros_node_is_seen_again_after_its_connection_was_lost(participant: str) -> None:
    """Its router has introduced it once, and does not do so again by itself.

    Of two nodes of ROS the one with the greater id dials.
    """
    async with robot("theirs") as (theirs,), context(participant) as ours:
        await until_seen(ours, "theirs")
        await until_lost(ours, str(theirs.zid()), "theirs")

        await until_seen(ours, "theirs")
        assert ways_between(ours, str(theirs.zid()))


async def test_a_ros_node_that_was_lost_hears_us_again() -> None:
    """Both directions use the same connection."""
    async with robot("theirs") as (theirs,), context("a1") as ours:
        await until_seen(ours, "theirs")
        await until_lost(ours, str(theirs.zid()), "theirs")
        await until_seen(ours, "theirs")
        got = Collector()
        theirs.declare_subscriber(f"{DOMAIN_ID}/said", got)
        session = ours._state.session
        assert session is not None
        async with asyncio.timeout(LIMIT_S):
            while not got.items:
                session.put(f"{DOMAIN_ID}/said", b"hello")
                await checkpoint()


async def test_processes_without_a_meeting_port_find_each_other_again() -> None:
    """Neither of the two dials the other by its configuration."""
    names = ("a1", "b2", "c3", "d4", "e5")
    async with AsyncExitStack() as stack:
        *_, one, two = [await stack.enter_async_context(context(name)) for name in names]
        for each in (one, two):
            await until_seen(each, *(set(names) - {each._state.participant}))
        await until_lost(one, "e5", "e5")

        await until_seen(one, "a1", "b2", "c3", "e5")
        await until_seen(two, "a1", "b2", "c3", "d4")


async def test_one_that_ended_is_looked_for_and_nothing_is_cut(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """No other session sees it either."""
    cuts: list[object] = []
    monkeypatch.setattr(recovery, "cut", cuts.append)
    looks = Collector()
    take_look = Recovery._take_look

    def on_look(self: Recovery, missing: set[str]) -> None:
        take_look(self, missing)
        looks(missing)

    monkeypatch.setattr(Recovery, "_take_look", on_look)
    async with robot("one", "two") as (one, _), context("a1") as ours:
        await until_seen(ours, "one", "two")
        await asyncio.to_thread(one.close)
        await until_seen(ours, "two")
        looks.items.clear()  # those made while the sessions were opened
        async with asyncio.timeout(2 * LIMIT_S):
            while set() not in looks.items:
                await looks.have(len(looks.items) + 1)

    assert cuts == []


async def test_an_incomplete_answer_says_nothing_of_who_is_missing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """On a busy machine the time of the query ends first: nobody is cut off for that."""
    cuts: list[object] = []
    monkeypatch.setattr(recovery, "cut", cuts.append)
    looks = Collector()
    monkeypatch.setattr(Recovery, "_take_look", lambda _, missing: looks(missing))

    class LateLook:
        """A session whose router does not name all tokens in time."""

        def liveliness(self) -> LateLook:
            return self

        def get(self, key: str, timeout: float) -> list[Any]:
            return [SimpleNamespace(ok=None)]

        def close(self) -> None:
            pass

    async with robot("theirs"), context("a1") as ours:
        await until_seen(ours, "theirs")
        session = ours._state.session
        assert session is not None
        monkeypatch.setattr(recovery, "look_at", lambda *_: LateLook())
        looks.items.clear()
        await asyncio.to_thread(ours._recovery._look_in_thread, session, set())
        await looks.have(1)

    assert looks.items[-1] is None
    assert cuts == []


async def test_one_whose_connection_was_lost_is_missing_though_a_router_brings_its_tokens(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Those of Zenoh 1.7 and 1.8 bring them, but may not bring ours to the other side."""
    async with context("a1") as ours, context("b2"):
        session = ours._state.session
        assert session is not None
        monkeypatch.setattr(
            recovery, "seen_at", lambda _, __, *keys: recovery.tokens(session, *keys)
        )
        await until_seen(ours, "b2")
        token = announce(session, "c3", "brought")
        way = Introducer("", Pair((b"", 0), (b"", 0)), "")
        missing = await asyncio.to_thread(
            lambda: ours._recovery._missing(session, way, {"b2", "c3"})
        )
        token.undeclare()

    assert missing == {"c3"}


async def test_a_look_makes_no_unannounced_peer() -> None:
    """Else everything would go both ways for as long as it takes."""
    async with context("a1") as first, context("b2") as second:
        told: list[bool] = []
        first.peer_directory.on_unannounced_peers = told.append
        await until_seen(second, "a1")
        session = second._state.session
        assert session is not None
        way = await asyncio.to_thread(
            lambda: recovery.introducer_connection(session, second.network)
        )
        assert way is not None
        missing = await asyncio.to_thread(lambda: second._recovery._missing(session, way, set()))

    assert missing == set()
    assert told == []


async def test_many_that_start_at_once_all_see_all() -> None:
    """More than there are meeting ports, so most of them are introduced."""
    names = [f"{number}0" for number in range(1, 10)]
    async with AsyncExitStack() as stack:
        together = await asyncio.gather(
            *(stack.enter_async_context(context(name)) for name in names)
        )
        for each in together:
            await until_seen(each, *(set(names) - {each._state.participant}))


class SlowRoad:
    """A way to a port of this machine on which everything takes a while."""

    def __init__(self, port: int, delay_s: float) -> None:
        self._port = port
        self._delay_s = delay_s

    async def join(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Take a connection."""
        far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self._port)
        await asyncio.gather(self._copy(reader, far_writer), self._copy(far_reader, writer))

    async def _copy(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with closing(writer), suppress(ConnectionError):
            while data := await reader.read(65536):
                asyncio.get_running_loop().call_later(self._delay_s, writer.write, data)


async def test_a_connection_that_takes_long_to_be_made_is_not_given_up() -> None:
    """Where many start at once it takes seconds, and what Zenoh gives up may stay half-open."""
    meeting_port = int(os.environ["AIONODE_MEETING_PORTS"].partition(",")[0])
    (port,) = free_ports(1)
    with raw_session(f"tcp/127.0.0.1:{port}") as theirs:
        token = announce(theirs, str(theirs.zid()), "theirs")
        road = SlowRoad(port, delay_s=0.25)
        server = await asyncio.start_server(road.join, "127.0.0.1", meeting_port)
        async with server, context("a1") as ours:
            await until_seen(ours, "theirs")
        token.undeclare()


async def test_an_unreachable_participant_is_given_up(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A program on a host that only the router reaches would be looked for for ever."""
    cuts = Collector()
    monkeypatch.setattr(recovery, "cut", cuts)
    monkeypatch.setattr(recovery, "AGAIN_S", 0.05)
    looks = Collector()
    take_look = Recovery._take_look

    def on_look(self: Recovery, missing: set[str]) -> None:
        take_look(self, missing)
        looks(missing)

    monkeypatch.setattr(Recovery, "_take_look", on_look)
    async with robot("theirs") as (theirs,), context("a1") as ours:
        await until_seen(ours, "theirs")
        lose_zid = str(theirs.zid())
        lose(ours, lose_zid)
        async with asyncio.timeout(3 * LIMIT_S):
            await looks.have(recovery.ATTEMPTS + 2)

    found = [missing for missing in looks.items if missing and lose_zid in missing]
    assert len(found) == recovery.ATTEMPTS
    assert len(cuts.items) >= recovery.ATTEMPTS


real_cut = _sockets.cut
real_tokens = recovery.tokens


async def test_the_graph_is_compared_with_the_tokens_that_are_there() -> None:
    """What came in the wrong order while connections changed is put right."""
    async with context("a1") as first, context("b2") as second:
        await until_seen(first, "b2")
        watcher = first._watcher
        (real,) = watcher._known
        watcher._remove(real)
        watcher._add(f"@ros2_lv/{DOMAIN_ID}/dead/0/0/NN/%/%/ghost")
        assert names_in(first) == {"ghost"}

        watcher.check()
        await until_seen(first, "b2", "ghost")
        watcher.check()  # an answer may be incomplete, so once is not enough
        await until_seen(first, "b2")
        assert second.network.domain_id == DOMAIN_ID


async def test_nothing_is_watched_where_no_process_is_dialled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Then no session could introduce others."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    async with context("a1") as transport:
        assert transport._recovery._session is None


@pytest.mark.parametrize(
    ("locator", "address"),
    [
        ("tcp/127.0.0.1:7447", ("127.0.0.1", 7447)),
        ("tcp/[::1]:7447?rel=1#iface=lo", ("::1", 7447)),
        ("tls/robot.local:7448", ("robot.local", 7448)),
        ("unixsock-stream//tmp/x", None),
        ("nonsense", None),
    ],
)
def test_a_locator_says_host_and_port(locator: str, address: tuple[str, int] | None) -> None:
    """As Zenoh writes it."""
    assert address_in(locator) == address


def test_an_endpoint_by_name_has_addresses() -> None:
    """Connections say only those."""
    assert ("127.0.0.1", 7447) in set(addresses_of("tcp/localhost:7447"))
    assert list(addresses_of("tcp/no.such.host.invalid:1")) == []


def test_a_look_is_known_by_its_id() -> None:
    """The ids of all others are random."""
    assert is_look(recovery.LOOK_IDS + "0" * 24)
    assert not is_look("a1")
    with closing(ros_session()) as session:
        assert not is_look(str(session.zid()))


@asynccontextmanager
async def silent_after_return(ours: ZenohTransport, *names: str) -> AsyncIterator[None]:
    """Others that run, have returned, and have not declared anything, as `ours` sees it."""
    acknowledgements = ours._state.acknowledgements
    async with AsyncExitStack() as stack:
        for name in names:
            await stack.enter_async_context(context(name))
        await until(lambda: acknowledgements.present.issuperset(names))
        acknowledgements.present.clear()
        ours._recovery._returned.update(names)
        yield


def change(kind: zenoh.SampleKind, zid: str) -> Any:
    """Return what Zenoh says of a connection that was made or lost."""
    transport = SimpleNamespace(zid=zid, whatami=zenoh.WhatAmI.PEER)
    return SimpleNamespace(kind=kind, transport=transport)


async def test_a_participant_is_checked_that_was_lost_and_has_returned() -> None:
    """Not one that is new, and not while it is lost once more."""
    put, delete = zenoh.SampleKind.PUT, zenoh.SampleKind.DELETE
    async with context("a1") as first:
        watch = first._recovery
        watch._take_change(change(put, "new"))
        watch._take_change(change(delete, "b2"))
        assert not watch._returned
        watch._take_change(change(put, "b2"))
        assert watch._returned == {"b2"}
        assert watch._check is not None
        watch._take_change(change(delete, "b2"))
        assert not watch._returned


async def test_no_connection_is_cut_while_others_are_being_made() -> None:
    """Of 100 contexts that started at once, each cut others that were merely slow."""
    async with (
        asyncio.timeout(4 * LIMIT_S),
        context("a1") as first,
        silent_after_return(first, "b2"),
    ):
        first._recovery._changed_s = asyncio.get_running_loop().time()
        first._recovery._check_returned()

        assert not first._recovery._cuts
        assert first._recovery._returned == {"b2"}


@pytest.mark.parametrize(("connected", "limit_s"), [(3, 1.0), (100, 5.0)])
def test_tokens_may_take_longer_where_there_are_many_participants(
    connected: int, limit_s: float
) -> None:
    """On a busy machine all had lost each other, and each cut the others again and again."""
    session = SimpleNamespace(info=SimpleNamespace(transports=lambda: [None] * connected))
    recovery_of_many = Recovery(SessionState("a1", DOMAIN_ID), network_from({}), lambda: None)
    recovery_of_many._session = session  # type: ignore[assignment]  # as far as it is used

    assert recovery_of_many._declared_s() == limit_s


async def test_one_that_has_declared_itself_is_not_connected_anew() -> None:
    """Its tokens came a moment after its connection."""
    async with (
        asyncio.timeout(4 * LIMIT_S),
        context("a1") as first,
        silent_after_return(first, "b2"),
    ):
        first._state.acknowledgements.present.add("b2")
        first._recovery._changed_s = 0.0
        first._recovery._check_returned()

        assert not first._recovery._cuts
        assert not first._recovery._returned


async def test_a_participant_that_is_connected_and_declares_nothing_is_connected_anew() -> None:
    """Zenoh took its new connection for another link of the one that is lost."""
    async with (
        asyncio.timeout(4 * LIMIT_S),
        context("a1") as first,
        silent_after_return(first, "b2"),
    ):
        first._recovery._changed_s = 0.0
        first._recovery._check_returned()
        await until(lambda: "b2" in first._state.acknowledgements.present)

        assert first._recovery._cuts == {"b2": 1}


async def test_many_that_declare_nothing_are_cut_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """Laptops that were closed in one room: more than a few, and none of them is merely slow."""
    names = {f"{number}b" for number in range(1, recovery.FEW + 2)}
    cut: list[set[str]] = []
    monkeypatch.setattr(recovery, "cut_participants", lambda _, silent: cut.append(silent))
    async with (
        asyncio.timeout(4 * LIMIT_S),
        context("a1") as first,
        silent_after_return(first, *names),
    ):
        first._recovery._changed_s = 0.0
        first._recovery._check_returned()
        assert first._recovery._cuts == dict.fromkeys(names, 1)

        await until(lambda: cut)
    assert cut == [names]


async def test_many_that_declare_nothing_are_waited_for_longer() -> None:
    """They are slow, as long as connections go on being made."""
    names = [f"{number}b" for number in range(1, recovery.FEW + 2)]
    async with (
        asyncio.timeout(4 * LIMIT_S),
        context("a1") as first,
        silent_after_return(first, *names),
    ):
        first._recovery._changed_s = asyncio.get_running_loop().time() - recovery.DECLARED_S
        first._recovery._check_returned()
        assert not first._recovery._cuts
        assert first._recovery._check is not None

        first._recovery._returned.discard(names[0])
        first._recovery._check_returned()
        assert len(first._recovery._cuts) == recovery.FEW
