"""Who is on the network and announces nothing, and post between contexts."""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncIterator, Iterator
from contextlib import ExitStack, asynccontextmanager, closing, contextmanager

import pytest
import zenoh  # noqa: TID251  # plays the other participants, without aionode

from aionode.graph import Graph
from aionode.settle import one_turn
from aionode.transport.zenoh.routers import listeners_in, seen_in
from aionode.transport.zenoh.session import close_session, open_router
from aionode.transport.zenoh.transport import ZenohTransport
from aionode.transport.zenoh_config import network_from
from tests.peers import DOMAIN_ID, Collector, known, raw_session, ros_router, zenoh_config


class Heard:
    """Lets a test wait until a context has been told whether there are strangers."""

    def __init__(self, transport: ZenohTransport) -> None:
        self.transport = transport
        self.neighbours = neighbours = transport.neighbours
        self.told: list[bool] = []
        self._changed = asyncio.Event()
        neighbours.on_strangers = self._on_strangers

    def _on_strangers(self, strangers: bool) -> None:
        assert strangers == self.neighbours.strangers
        self.told.append(strangers)
        self._changed.set()

    async def until(self, strangers: bool) -> None:
        """Wait until there are strangers, or none."""
        while self.neighbours.strangers != strangers:
            self._changed.clear()
            await self._changed.wait()

    def asks(self) -> bool:
        """Return whether the routers will be asked again."""
        return self.neighbours._routers._timer is not None

    async def past(self) -> None:
        """Wait until there were strangers, and are none now; both may have been told before."""
        while not self.told or self.neighbours.strangers:
            self._changed.clear()
            await self._changed.wait()

    async def look(self) -> bool:
        """Ask the routers now, wait for the end of their answers, and return what is told."""
        routers = self.neighbours._routers
        done = asyncio.Event()
        on_answer, routers._on_answer = routers._on_answer, done.set
        try:
            while routers._look is not None:  # one that may have begun too early
                await done.wait()
                done.clear()
            routers.ask()
            await done.wait()
        finally:
            routers._on_answer = on_answer
        on_answer()
        return self.neighbours.strangers


@asynccontextmanager
async def context(
    participant: str, *, linked: bool = True, domain_id: int = DOMAIN_ID
) -> AsyncIterator[ZenohTransport]:
    """A transport that is open, and announces that it can be linked."""
    transport = ZenohTransport(participant, network_from(os.environ, domain_id=domain_id))
    if linked:
        transport.neighbours.beacon = f"{participant}/link/1/host/user"
    await transport.open(Graph())
    try:
        yield transport
    finally:
        await transport.close()


@pytest.fixture
async def heard() -> AsyncIterator[Heard]:
    """A context with nobody else around, yet."""
    async with context("a1") as transport:
        yield Heard(transport)


@asynccontextmanager
async def router(*, readable: bool = True) -> AsyncIterator[zenoh.Session]:
    """A router of ROS."""
    session = await asyncio.to_thread(lambda: ros_router(readable=readable))
    try:
        yield session
    finally:
        await asyncio.to_thread(session.close)


@contextmanager
def client(port: str) -> Iterator[zenoh.Session]:
    """A plain Zenoh program that sees nobody but the one that it dials."""
    config = zenoh_config(
        {
            "mode": "client",
            "connect/endpoints": [f"tcp/127.0.0.1:{port}"],
            "scouting/multicast/enabled": False,
        }
    )
    with closing(zenoh.open(config)) as session:
        yield session


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
    """Wait until so many nodes of the domain are in the graph."""
    graph = transport._link.graph
    assert graph is not None
    await graph.until(lambda: len(graph.nodes()) == count)


def nobody(_: object) -> None:
    """Take what was subscribed to."""


async def test_a_plain_session_is_a_stranger_while_it_is_connected(heard: Heard) -> None:
    """It may subscribe to anything, and nobody would know."""
    assert not heard.neighbours.strangers

    with raw_session():
        await heard.until(True)
    await heard.until(False)

    assert heard.told == [True, False]


async def test_strangers_are_told_with_the_connection(
    heard: Heard, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not in a later turn of the loop, in which something may be published."""
    seen: list[bool] = []
    there = asyncio.Event()

    note = heard.neighbours._on_connected

    def on_connected() -> None:
        note()
        seen.append(heard.neighbours.strangers)
        there.set()

    monkeypatch.setattr(heard.neighbours, "_on_connected", on_connected)
    with raw_session():
        await there.wait()

    assert seen[0]


async def test_a_ros_node_of_another_domain_is_no_stranger(heard: Heard) -> None:
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
async def test_a_context_is_no_stranger(heard: Heard, domain_id: int) -> None:
    """Of any domain, and before it has a node."""
    async with context("b2", domain_id=domain_id):
        while "b2" not in heard.neighbours._connected:
            await one_turn()
        await heard.until(False)


async def test_a_router_that_nobody_strange_listens_behind_is_no_stranger(heard: Heard) -> None:
    """There is one in every system of ROS."""
    heard.neighbours.watch(True)
    async with router(), context("b2"):
        await heard.past()
        await heard.look()
        await heard.until(False)


async def test_our_own_router_tells_who_is_behind_it(heard: Heard) -> None:
    """As that of ROS does."""
    heard.neighbours.watch(True)
    session = await open_router([f"tcp/127.0.0.1:{router_port()}"])
    try:
        await heard.past()
    finally:
        await close_session(session)


async def test_a_router_is_a_stranger_while_nobody_watches(heard: Heard) -> None:
    """Then it is not asked, which would cost an idle context a wake-up each second."""
    async with router():
        await heard.until(True)
        assert not heard.asks()
        heard.neighbours.watch(True)
        await heard.until(False)
        assert heard.asks()
        heard.neighbours.watch(False)

        assert heard.neighbours.strangers
        assert not heard.asks()


async def test_a_router_that_cannot_be_read_is_a_stranger(heard: Heard) -> None:
    """Nobody knows who is behind it."""
    heard.neighbours.watch(True)
    async with router(readable=False):
        await heard.until(True)
        assert await heard.look()
    await heard.until(False)


@pytest.mark.parametrize("key", ["**", f"{DOMAIN_ID}/chatter/**", "*/chatter/*/*"])
async def test_who_subscribes_behind_a_router_is_a_stranger(heard: Heard, key: str) -> None:
    """From the next question on, and until it no longer does."""
    heard.neighbours.watch(True)
    async with router():
        await heard.past()
        with client(router_port()) as session:
            subscriber = session.declare_subscriber(key, nobody)
            assert await heard.look()
            subscriber.undeclare()
            assert not await heard.look()


async def test_routers_are_asked_again(heard: Heard) -> None:
    """Nothing else tells of a new subscription behind one."""
    heard.neighbours.watch(True)
    async with router():
        await heard.past()
        with client(router_port()) as session:
            _subscriber = session.declare_subscriber("**", nobody)
            await heard.until(True)


async def test_who_hears_nothing_of_ours_behind_a_router_is_no_stranger(heard: Heard) -> None:
    """It may ask, answer, publish, watch tokens, and subscribe in another domain."""
    heard.neighbours.watch(True)
    async with router():
        await heard.past()
        with client(router_port()) as session:
            _declared = [
                session.declare_queryable(f"{DOMAIN_ID}/**", nobody),
                session.declare_publisher(f"{DOMAIN_ID}/chatter"),
                session.liveliness().declare_subscriber("**", nobody),
                session.declare_subscriber(f"{DOMAIN_ID + 1}/**", nobody),
            ]
            assert not await heard.look()


async def test_a_ros_node_behind_a_router_is_no_stranger(heard: Heard) -> None:
    """Whatever it subscribes to."""
    heard.neighbours.watch(True)
    async with router():
        await heard.past()
        with client(router_port()) as session:
            _subscriber = session.declare_subscriber("**", nobody)
            assert await heard.look()
            _token = announce_node(session, DOMAIN_ID + 1)
            await heard.until(False)


async def test_a_router_that_subscribes_itself_is_a_stranger() -> None:
    """A plugin of a router, such as a storage, has no session."""
    async with router() as session:
        _subscriber = session.declare_subscriber("**", nobody)
        async with context("a1") as transport:
            heard = Heard(transport)
            heard.neighbours.watch(True)

            assert await heard.look()


async def test_a_client_of_one_context_is_a_stranger_to_all(heard: Heard) -> None:
    """Zenoh brings it what the others publish, and only that context sees it."""
    async with context("b2") as second:
        other = Heard(second)
        await heard.past()
        await other.until(False)
        with client(meeting_port()):
            await heard.until(True)
            await other.until(True)
        await heard.until(False)
        await other.until(False)


async def test_post_arrives_in_order_at_the_one_it_is_for() -> None:
    """All of it, however fast it is sent."""
    count = 3000
    async with context("a1") as first, context("b2") as second, context("c3") as third:
        got, stray = Collector(), Collector()
        second.neighbours.on_post = got
        first.neighbours.on_post = third.neighbours.on_post = stray
        for number in range(count):
            first.neighbours.post("b2", number.to_bytes(4, "big") * 100)
        items = await got.have(count)

    assert items == [number.to_bytes(4, "big") * 100 for number in range(count)]
    assert not stray.items


async def test_post_without_a_connection_is_given_up() -> None:
    """As the context that it is for is not there either."""
    async with context("a1") as transport:
        pass
    transport.neighbours.post("b2", b"late")

    assert transport._link.bulk._worker is None


async def test_nothing_is_declared_without_a_beacon() -> None:
    """Who wants no links pays nothing for them."""
    async with context("a1", linked=False) as transport:
        neighbours = transport.neighbours
        told = Heard(transport)
        neighbours.watch(True)
        with raw_session() as session:
            _token = announce_node(session, DOMAIN_ID)
            await until_nodes(transport, 1)
            replies = session.liveliness().get("@aionode/**", timeout=1)
            keys = [str(reply.ok.key_expr) for reply in replies if reply.ok is not None]

            # That it acknowledges messages has nothing to do with links.
            assert keys == [f"@aionode/{DOMAIN_ID}/a1/reliable/1"]
        assert (neighbours._declared, told.told) == ([], [])


async def test_closing_leaves_nothing_behind() -> None:
    """No timer, no token, and nobody is known when it opens again."""
    with ExitStack() as stack:
        async with router(), context("b2"):
            async with context("a1") as transport:
                heard = Heard(transport)
                heard.neighbours.watch(True)
                session = stack.enter_context(raw_session())
                await known(session, "@aionode/*/*/link/**", 2)
                await heard.until(True)
            neighbours, routers = transport.neighbours, transport.neighbours._routers

            assert not neighbours.strangers
            assert not neighbours._declared
            assert not neighbours._known
            assert not neighbours._connected
            assert routers._timer is None
            assert routers._look is None
            assert not routers._watching
            tokens = {
                str(each.ok.key_expr) for each in session.liveliness().get("@aionode/**") if each.ok
            }
            assert not any("/a1/" in token for token in tokens)


async def test_it_opens_again() -> None:
    """With what is there then."""
    transport = ZenohTransport("a1", network_from(os.environ))
    heard = Heard(transport)
    for _ in range(2):
        transport.neighbours.beacon = "a1/link/1/host/user"
        await transport.open(Graph())
        with raw_session():
            await heard.until(True)
            await transport.close()
        assert not transport.neighbours.strangers


@pytest.mark.parametrize(
    "text",
    [b"", b"\xff", b"[]", b"{}", b'{"sessions": 1}', b'{"sessions": [1]}', b'{"sessions": [{}]}'],
)
def test_an_answer_in_no_known_form_is_none(text: bytes) -> None:
    """The router counts as one that cannot be read."""
    assert seen_in({"r": text}).unread == {"r"}


def test_a_router_behind_a_router_has_to_answer_too() -> None:
    """The first knows only that it is there."""
    first = b'{"sessions": [{"peer": "2", "whatami": "router"}, {"peer": "c", "whatami": "peer"}]}'
    second = b'{"sessions": [{"peer": "1", "whatami": "router"}], "plugins": null}'

    assert seen_in({"1": first}).unread == {"2"}
    assert seen_in({"1": first, "2": second}).unread == set()
    assert seen_in({"1": first, "2": second}).behind == {"c"}


@pytest.mark.parametrize(
    ("text", "listeners"),
    [
        (b'{"routers": ["r"], "peers": ["p"], "clients": ["c"]}', {"p", "c"}),
        (b'{"routers": ["r"], "peers": [], "clients": []}', {"r"}),
        (b'{"routers": ["other"], "peers": [], "clients": []}', set()),
        (b"nonsense", {"r"}),
    ],
)
def test_a_router_says_who_listens(text: bytes, listeners: set[str]) -> None:
    """It has itself in the list also when it subscribes for others."""
    assert listeners_in({"r/router/subscriber/**": text}) == listeners
