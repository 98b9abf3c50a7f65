"""Participants that were introduced once are connected again, whatever ended the connection."""

from __future__ import annotations

import asyncio
import itertools
import os
import random
import subprocess
import sys
import threading
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager, closing, suppress
from types import SimpleNamespace
from typing import Any

import pytest
import zenoh  # noqa: TID251  # plays the other participants, without aionode

from aionode._process.concurrency import checkpoint
from aionode.engine.transport.network import Network, network_from, new_participant
from aionode.engine.transport.zenoh._defects import forgotten_peers as recovery
from aionode.engine.transport.zenoh._defects import stale_transports
from aionode.engine.transport.zenoh._defects._connection_mend import ATTEMPTS
from aionode.engine.transport.zenoh._defects.forgotten_peers import (
    GossipSource,
    Recovery,
    addresses_of,
    has_ended,
    participant_of,
)
from aionode.engine.transport.zenoh._defects.incomplete_answers import tokens
from aionode.engine.transport.zenoh._transport import ZenohTransport
from aionode.engine.transport.zenoh.connections import config as _config
from aionode.engine.transport.zenoh.connections import sockets as _sockets
from aionode.engine.transport.zenoh.connections.config import PROBE_IDS, is_probe
from aionode.engine.transport.zenoh.connections.sockets import Descriptor, split_locator
from aionode.engine.transport.zenoh.discovery.graph_watcher import Watcher
from aionode.graph import Graph, NodeInfo
from tests.support.connections import tell
from tests.support.peers import (
    DOMAIN_ID,
    Collector,
    free_ports,
    raw_session,
    ros_router,
    ros_session,
    zenoh_config,
)
from tests.support.waiting import until

pytestmark = pytest.mark.one_loop

LIMIT_S = 15.0

Comparisons = list[set[str] | None]
"""The missing participants of each comparison, which cuts connections; None if it decided
nothing."""


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Compare as early as possible: no other process uses these ports."""
    monkeypatch.setattr(recovery, "FIRST_S", 0.1)
    monkeypatch.setattr(recovery, "SURE_S", 0.05)


@asynccontextmanager
async def context(participant: str) -> AsyncIterator[ZenohTransport]:
    """A transport that is open, with the token of one node."""
    transport = ZenohTransport(participant, network_from(os.environ))
    transport.peer_directory.advertisement = f"{participant}/link/1/host/user"
    graph = Graph()
    await transport.open(graph)
    session = transport.session_state.session
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
    assert transport.session_state.graph is not None
    return {node.name for node in transport.session_state.graph.nodes()}


async def until_seen(transport: ZenohTransport, *names: str) -> None:
    """Wait until exactly these nodes are seen."""
    graph = transport.session_state.graph
    assert graph is not None
    async with asyncio.timeout(LIMIT_S):
        await graph.until(lambda: names_in(transport) == set(names))


def ways_between(transport: ZenohTransport, zid: str) -> set[Descriptor]:
    """Return the connections to another session."""
    session = transport.session_state.session
    assert session is not None
    return set(_sockets.connections(session, {zid}))


def lose(transport: ZenohTransport, zid: str) -> None:
    """End all connections to another session, as a network does."""
    ways = ways_between(transport, zid)
    assert ways
    _sockets.cut(ways)


async def until_lost(transport: ZenohTransport, zid: str, name: str) -> None:
    """End all connections to another session, and wait until its node has left the graph.

    The node may be back by then: on a busy machine the loop sees both changes at once.
    """
    graph: Any = transport.session_state.graph
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
        session = ours.session_state.session
        assert session is not None
        async with asyncio.timeout(LIMIT_S):
            while not got.items:
                session.put(f"{DOMAIN_ID}/said", b"hello")
                await checkpoint()


async def test_processes_without_a_meeting_port_find_each_other_again() -> None:
    """Neither dials the other by its configuration."""
    names = ("a1", "b2", "c3", "d4", "e5")
    async with AsyncExitStack() as stack:
        *_, one, two = [await stack.enter_async_context(context(name)) for name in names]
        for each in (one, two):
            await until_seen(each, *(set(names) - {each.session_state.participant}))
        await until_lost(one, "e5", "e5")

        await until_seen(one, "a1", "b2", "c3", "e5")
        await until_seen(two, "a1", "b2", "c3", "d4")


class Forgetful:
    """A session whose answers lack some tokens, as those of Zenoh may beside a router.

    Args:
        session: The session that is asked.
        names: Returns whether a token is named.
        in_time: Whether the answers end in time.
    """

    def __init__(
        self, session: zenoh.Session, names: Callable[[str], bool], *, in_time: bool = True
    ) -> None:
        self._session = session
        self._names = names
        self._in_time = in_time

    def __getattr__(self, name: str) -> Any:
        return getattr(self._session, name)

    def liveliness(self) -> Forgetful:
        """Return what answers."""
        return self

    def get(self, key: str, timeout: float) -> list[Any]:
        """Ask the session, and return a part of what it answers."""
        replies: list[Any] = list(self._session.liveliness().get(key, timeout=timeout))
        named = [reply for reply in replies if self._names(str(reply.ok.key_expr))]
        return named if self._in_time else [*named, SimpleNamespace(ok=None)]


@pytest.fixture
def comparisons(monkeypatch: pytest.MonkeyPatch) -> Comparisons:
    """The findings of comparisons, which are made again soon."""
    monkeypatch.setattr(recovery, "AGAIN_S", 0.05)
    found: Comparisons = []
    take_comparison = Recovery._take_comparison

    def on_comparison(self: Recovery, missing: set[str] | None) -> None:
        take_comparison(self, missing)
        found.append(missing)

    monkeypatch.setattr(Recovery, "_take_comparison", on_comparison)
    return found


def all_ways(transport: ZenohTransport) -> set[Descriptor]:
    """Return all connections of a session."""
    session: Any = transport.session_state.session
    return set(_sockets.connections(session))


async def have_more(comparisons: Comparisons, count: int) -> None:
    """Wait for so many further comparisons."""
    async with asyncio.timeout(2 * LIMIT_S):
        wanted = len(comparisons) + count
        await until(lambda: len(comparisons) >= wanted)


async def test_one_that_ended_is_looked_for_and_nothing_is_cut(comparisons: Comparisons) -> None:
    """No other session sees it either."""
    async with robot("one", "two") as (one, _), context("a1") as ours:
        await until_seen(ours, "one", "two")
        await asyncio.to_thread(one.close)
        await until_seen(ours, "two")
        ways = all_ways(ours)
        comparisons.clear()  # those made while the sessions were opened
        async with asyncio.timeout(2 * LIMIT_S):
            await until(lambda: set() in comparisons)

        assert all_ways(ours) == ways


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux lists sessions")
async def test_where_all_sessions_are_listed_nobody_is_asked_about_one_that_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Zenoh dials listed sessions forever; each question costs a session that is opened for it."""
    monkeypatch.setattr(recovery, "FIRST_S", 0.01)
    asked: list[str] = []
    open_probe = _config.open_probe

    def probe(network: Network, endpoint: str) -> Any:
        asked.append(endpoint)
        return open_probe(network, endpoint)

    monkeypatch.setattr(recovery, "open_probe", probe)
    async with context("a1") as ours, context("a2"):
        checked = asyncio.Event()
        monkeypatch.setattr(ours._watcher, "check", checked.set)
        async with context("a3"):
            await until(lambda: len(ours.session_state.connections.kinds) == 2)
        async with asyncio.timeout(LIMIT_S):
            await checked.wait()

        assert not ours._recovery._later.waits
    assert asked == []


@pytest.fixture
def looked(monkeypatch: pytest.MonkeyPatch) -> asyncio.Event:
    """Set when it was looked whether the process of a lost session runs: that of b2 has ended."""
    event = asyncio.Event()

    def ended(zid: str) -> bool:
        event.set()
        return zid == "b2"

    monkeypatch.setattr(recovery, "has_ended", ended)
    return event


@pytest.mark.parametrize("leaves", [False, True])
async def test_tokens_are_compared_after_the_end_of_a_process_only_if_it_has_left_some(
    leaves: bool, looked: asyncio.Event, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each of the others would compare all tokens for each process that ends."""
    checks: list[bool] = []
    monkeypatch.setattr(Watcher, "check", lambda _: checks.append(True))
    async with context("a1") as ours:
        async with context("b2"):
            await until_seen(ours, "b2")
            if leaves:  # as if its withdrawal were lost
                assert ours.session_state.announced.admit("b2", "left")
        async with asyncio.timeout(LIMIT_S):
            await looked.wait()

    assert bool(checks) == leaves


async def test_no_gossip_source_is_asked_about_a_process_that_has_ended(
    looked: asyncio.Event, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each question costs a session that is opened for it, and there are forty in two minutes."""
    asking: list[threading.Thread] = []
    async with robot("theirs"), context("a1") as ours:
        async with context("b2"):
            await until_seen(ours, "b2", "theirs")
            kinds = ours.session_state.connections.kinds
            await until(lambda: len(kinds) == 3)
            monkeypatch.setattr(recovery, "start_thread", asking.append)
        async with asyncio.timeout(LIMIT_S):
            await looked.wait()

    assert asking == []


def test_a_process_has_ended_once_the_system_does_not_know_it() -> None:
    """A session's id names its process."""
    own = new_participant()
    process = subprocess.Popen([sys.executable, "-c", ""])
    zid = f"{own[:17]}{process.pid:08x}{own[25:]}"
    runs = not has_ended(zid)  # also as a zombie
    process.wait()

    assert (runs, has_ended(zid), has_ended(own), has_ended("a1")) == (True, True, False, False)


@pytest.mark.parametrize("named", ["nothing", "own", "half"])
async def test_an_incomplete_answer_of_the_own_session_cuts_nobody_off(
    named: str, comparisons: Comparisons
) -> None:
    """A query that ended too early named none of 169 tokens, and all connections were cut.

    A call that ran did not come back.
    """
    chance = random.Random(1)  # noqa: S311  # which tokens are named
    is_named: dict[str, Callable[[str], bool]] = {
        "nothing": lambda _: False,
        "own": lambda token: participant_of(token) == "a1",
        "half": lambda _: chance.random() < 0.5,
    }
    names = ("one", "two", "three", "four", "five")
    async with robot(*names) as (one, two, *_), context("a1") as ours:
        await until_seen(ours, *names)
        session: Any = ours.session_state.session
        ours._recovery._session = Forgetful(session, is_named[named])  # type: ignore[assignment]
        asked = Collector()
        two.declare_queryable(f"{DOMAIN_ID}/asked", asked)
        answers = Collector()
        querier = session.declare_querier(f"{DOMAIN_ID}/asked")
        await until(lambda: querier.matching_status.matching)
        querier.get(answers)
        await asked.have(1)

        comparisons.clear()  # those made while the sessions were opened
        ended = str(one.zid())
        await asyncio.to_thread(one.close)
        await until_seen(ours, *names[1:])
        await until(lambda: not ways_between(ours, ended))
        ways = all_ways(ours)
        await have_more(comparisons, 6)

        assert not any(comparisons)  # none that was missing, for which connections are cut
        assert all_ways(ours) == ways
        (query,) = asked.items
        query.reply(query.key_expr, b"answer")
        query.drop()
        await answers.have(1)


def looking(
    monkeypatch: pytest.MonkeyPatch, names: Callable[[str], bool], times: int, **options: bool
) -> None:
    """Have the next comparisons at the gossip source lack all tokens but some."""
    open_probe = _config.open_probe
    left = iter(range(times))

    def probe(network: Network, endpoint: str) -> Any:
        session = open_probe(network, endpoint)
        return session if next(left, None) is None else Forgetful(session, names, **options)

    monkeypatch.setattr(recovery, "open_probe", probe)


@pytest.mark.parametrize("in_time", [True, False])
async def test_an_incomplete_answer_of_the_gossip_source_cuts_nobody_off(
    in_time: bool, comparisons: Comparisons, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It had named nobody, so that this context was taken for one that it does not see.

    On a busy machine the time of the query may end first.
    """
    async with robot("one", "two", "three") as (one, *_), context("a1") as ours:
        await until_seen(ours, "one", "two", "three")
        await asyncio.to_thread(one.close)
        await until_seen(ours, "two", "three")
        await have_more(comparisons, 1)
        ways = all_ways(ours)
        looking(monkeypatch, lambda _: False, 2, in_time=in_time)
        await have_more(comparisons, 4)

        assert all_ways(ours) == ways


async def test_an_answer_of_the_gossip_source_that_lacks_only_this_context_cuts_nobody_off(
    comparisons: Comparisons, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beside ROS nodes, the token of this context is the only one that a query asks for.

    An answer that ended too early in two comparisons cut the connection to a router that saw this
    context: in one of ten runs of another test here.
    """
    answers = itertools.count()

    def is_named(token: str) -> bool:
        return participant_of(token) != "a1" or next(answers) % 3 == 2

    async with robot("one", "two", "three") as (one, *_), context("a1") as ours:
        await until_seen(ours, "one", "two", "three")
        await asyncio.to_thread(one.close)
        await until_seen(ours, "two", "three")
        await have_more(comparisons, 1)
        ways = all_ways(ours)
        looking(monkeypatch, is_named, 4)
        await have_more(comparisons, 2)

        assert all_ways(ours) == ways


@pytest.mark.parametrize("sees", ["the others", "nobody"])
async def test_a_gossip_source_that_does_not_see_this_context_is_connected_anew(
    sees: str, comparisons: Comparisons, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At once if it sees the others; one comparison later if it sees nobody."""
    async with robot("one", "two") as (one, *_), context("a1") as ours:
        await until_seen(ours, "one", "two")
        await asyncio.to_thread(one.close)
        await until_seen(ours, "two")
        await have_more(comparisons, 1)
        session: Any = ours.session_state.session
        (router,) = (str(zid) for zid in session.info.routers_zid())
        ways = ways_between(ours, router)

        def is_seen(token: str) -> bool:
            return sees == "the others" and participant_of(token) != "a1"

        looking(monkeypatch, is_seen, 4)
        comparisons.clear()
        async with asyncio.timeout(LIMIT_S):
            while ways & all_ways(ours):
                await have_more(comparisons, 1)
            await until(lambda: ways_between(ours, router))


async def test_one_whose_connection_was_lost_is_missing_though_a_router_brings_its_tokens(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Routers of Zenoh 1.7 and 1.8 bring them, but may not bring ours to the other side."""
    async with context("a1") as ours, context("b2"):
        session = ours.session_state.session
        assert session is not None
        monkeypatch.setattr(recovery, "seen_at", lambda _, __, *keys, **___: tokens(session, *keys))
        await until_seen(ours, "b2")
        token = announce(session, "c3", "brought")
        way = GossipSource("", "")
        missing, is_sure = await asyncio.to_thread(
            lambda: ours._recovery._missing(session, way, {"b2", "c3"}, set())
        )
        token.undeclare()

    assert missing == {"c3"}
    assert is_sure


async def test_a_probe_makes_no_unannounced_peer() -> None:
    """Else everything would go both ways for as long as it takes."""
    async with context("a1") as first, context("b2") as second:
        await until_seen(first, "b2")
        await until_seen(second, "a1")
        # Each is unannounced until its tokens have come.
        await until(lambda: not first.peer_directory.has_unannounced_peers)
        told: list[bool] = []
        first.peer_directory.on_unannounced_peers = told.append
        session = second.session_state.session
        assert session is not None
        way = await asyncio.to_thread(lambda: recovery.gossip_source(session, second.network))
        assert way is not None
        missing, is_sure = await asyncio.to_thread(
            lambda: second._recovery._missing(session, way, set(), set())
        )

    assert missing == set()
    assert is_sure
    assert told == []


async def test_many_that_start_at_once_all_see_all() -> None:
    """More than there are meeting ports, so most of them are introduced."""
    names = [f"a{number}" for number in range(1, 10)]
    async with AsyncExitStack() as stack:
        together = await asyncio.gather(
            *(stack.enter_async_context(context(name)) for name in names)
        )
        for each in together:
            await until_seen(each, *(set(names) - {each.session_state.participant}))


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


@asynccontextmanager
async def only_at_router() -> AsyncIterator[str]:
    """A session that only the router of ROS reaches, with the token of a node."""
    settings = {
        "mode": "peer",
        "connect/endpoints": [f"tcp/127.0.0.1:{os.environ['AIONODE_ROUTER_PORT']}"],
        "listen/endpoints": [],
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
    }
    with closing(await asyncio.to_thread(zenoh.open, zenoh_config(settings))) as hidden:
        zid = str(hidden.zid())
        token = announce(hidden, zid, "hidden")
        yield zid
        token.undeclare()


async def test_an_unreachable_participant_is_given_up(comparisons: Comparisons) -> None:
    """A program on a host that only the router reaches would be looked for forever."""
    async with robot("theirs", "one") as (_, one), context("a1") as ours, only_at_router() as zid:
        await until_seen(ours, "theirs", "one")
        await asyncio.to_thread(one.close)
        async with asyncio.timeout(3 * LIMIT_S):
            await until(lambda: times_found(comparisons, zid) == ATTEMPTS)
        await have_more(comparisons, 3)

    assert times_found(comparisons, zid) == ATTEMPTS


@pytest.mark.slow
async def test_an_unreachable_participant_that_one_answer_lacks_is_given_up(
    comparisons: Comparisons, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A router that was just connected anew may not name it yet, after each cut."""
    async with robot("theirs", "one") as (_, one), context("a1") as ours, only_at_router() as zid:
        await until_seen(ours, "theirs", "one")
        await asyncio.to_thread(one.close)
        async with asyncio.timeout(3 * LIMIT_S):
            await until(lambda: times_found(comparisons, zid) == 1)
            looking(monkeypatch, lambda token: participant_of(token) != zid, 2)
            comparisons_before = len(comparisons)
            await until(lambda: set() in comparisons[comparisons_before:])
            await until(lambda: times_found(comparisons, zid) == ATTEMPTS)
        await have_more(comparisons, 3)

    assert times_found(comparisons, zid) == ATTEMPTS


def times_found(comparisons: Comparisons, zid: str) -> int:
    """Return how many comparisons cut connections for a participant that is missing."""
    return sum(missing is not None and zid in missing for missing in comparisons)


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


async def test_answers_without_the_tokens_of_this_context_take_nobody_out_of_the_graph(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Nodes behind the router of another machine would vanish: nobody is connected with them."""
    async with context("a1") as first:
        node = NodeInfo("a1", 7, "ours", "/")
        declared = first.create_node(node)
        watcher: Any = first._watcher
        watcher._add(f"@ros2_lv/{DOMAIN_ID}/far/0/0/NN/%/%/far")
        session: Any = first.session_state.session

        class Empty:
            """Its answers end too early, and name nothing."""

            def liveliness(self) -> Empty:
                return self

            def get(self, key: str, handler: zenoh.handlers.Callback[Any], timeout: float) -> None:
                none = f"{key}/none"
                session.liveliness().get(none, handler, timeout=timeout)

            def __getattr__(self, name: str) -> Any:
                return getattr(session, name)

        with monkeypatch.context() as patch:
            patch.setattr(first.session_state, "session", Empty())
            for _ in range(3):
                watcher.check()
                await until(lambda: not watcher._check)
        assert names_in(first) == {"far"}

        watcher.check()
        await until(lambda: not watcher._check)
        watcher.check()
        await until_seen(first)
        declared.close()


async def test_nothing_is_watched_where_no_process_is_dialled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Then no session could introduce others."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    async with context("a1") as transport:
        assert transport._recovery._session is None
        assert transport._stale_transports._session is None


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
    assert split_locator(locator) == address


def test_an_endpoint_by_name_has_addresses() -> None:
    """Connections say only those."""
    assert (bytes([127, 0, 0, 1]), 7447) in set(addresses_of("tcp/localhost:7447"))
    assert list(addresses_of("tcp/no.such.host.invalid:1")) == []


def test_a_probe_is_known_by_its_id() -> None:
    """The ids of all others are random."""
    assert is_probe(PROBE_IDS + "0" * 24)
    assert not is_probe("a1")
    with closing(ros_session()) as session:
        assert not is_probe(str(session.zid()))


@asynccontextmanager
async def silent_after_return(ours: ZenohTransport, *names: str) -> AsyncIterator[None]:
    """Others that run, have returned, and have not declared anything, as `ours` sees it."""
    state = ours.session_state
    async with AsyncExitStack() as stack:
        for name in names:
            await stack.enter_async_context(context(name))
        await until(lambda: state.acknowledgements.present.issuperset(names))
        state.acknowledgements.present.clear()
        for is_made in (False, True):
            for name in names:
                tell(state.connections, name, is_made=is_made)
        yield


async def test_a_participant_that_still_declares_nothing_is_connected_anew_once_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its two connections were cut one after the other: Zenoh took the third for one of theirs."""
    monkeypatch.setattr(stale_transports, "DECLARED_S", 0.2)
    cut_participants = _sockets.cut_participants
    cuts: list[set[str]] = []

    def cut(session: zenoh.Session, zids: set[str]) -> None:
        cuts.append(zids)
        if len(cuts) > 1:
            cut_participants(session, zids)

    monkeypatch.setattr(stale_transports, "cut_participants", cut)
    async with (
        asyncio.timeout(4 * LIMIT_S),
        context("a1") as first,
        silent_after_return(first, "b2"),
    ):
        await until(lambda: "b2" in first.session_state.acknowledgements.present)

    assert len(cuts) > 1


async def test_many_that_declare_nothing_are_connected_anew_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Laptops that were closed in one room: more than a few, and none of them is merely slow."""
    monkeypatch.setattr(stale_transports, "DECLARED_S", 0.2)
    monkeypatch.setattr(stale_transports, "POSTPONED_S", 0.4)
    names = {f"{number}b" for number in range(1, stale_transports.FEW + 2)}
    async with (
        asyncio.timeout(4 * LIMIT_S),
        context("a1") as first,
        silent_after_return(first, *names),
    ):
        ways = set().union(*(ways_between(first, name) for name in names))

        await until(lambda: ways.isdisjoint(all_ways(first)))
        await until(lambda: names <= first.session_state.acknowledgements.present)
