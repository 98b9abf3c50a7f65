"""Reliable topics over Zenoh: acknowledged if both ends support it, otherwise left to Zenoh.

The protocol itself is tested without a network: tests/engine/transport/reliability.
"""

from __future__ import annotations

import asyncio
import logging
import os
import threading
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from typing import Any

import pytest
import zenoh  # noqa: TID251  # plays another process, without aionode

from aionode._process.concurrency import checkpoint
from aionode._process.later import Later
from aionode.clock import perf_ns
from aionode.engine.context import Context
from aionode.engine.transport.link._listener import Listener
from aionode.engine.transport.network import network_from
from aionode.engine.transport.reliability import stateful_writer
from aionode.engine.transport.reliability import submessage as acknack
from aionode.engine.transport.reliability.stateful_reader import StatefulReader
from aionode.engine.transport.reliability.stateful_writer import StatefulWriter
from aionode.engine.transport.reliability.submessage import Submessage, SubmessageKind
from aionode.engine.transport.send_thread import Worker
from aionode.engine.transport.zenoh import _session_state as session_state
from aionode.engine.transport.zenoh._defects import forgotten_peers
from aionode.engine.transport.zenoh._session_state import SessionState
from aionode.engine.transport.zenoh._transport import ZenohTransport
from aionode.engine.transport.zenoh.connections import sockets as _sockets
from aionode.engine.transport.zenoh.delivery import acknowledgements
from aionode.engine.transport.zenoh.endpoints import publisher as publishers
from aionode.engine.transport.zenoh.endpoints.publisher import ZenohWriter
from aionode.engine.transport.zenoh.endpoints.sender import ZenohSender
from aionode.engine.wire import cdr
from aionode.graph import EndpointInfo, Graph
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.node import Node
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from tests.support.peers import (
    DOMAIN_ID,
    KEEP_ALL,
    Collector,
    quiet_node,
    raw_session,
    two_contexts,
)
from tests.support.waiting import until

TRANSIENT = QoSProfile(history=HistoryPolicy.KEEP_ALL, durability=DurabilityPolicy.TRANSIENT_LOCAL)

ACKNACK = SubmessageKind.ACKNACK

Writers = dict[str, ZenohWriter]
"""The Zenoh side of each topic's last publisher, by the name of the topic."""


@pytest.fixture(autouse=True)
def without_links(monkeypatch: pytest.MonkeyPatch) -> None:
    """Disable links, as between hosts."""
    monkeypatch.setenv("AIONODE_LINK", "off")


@pytest.fixture
def writers(monkeypatch: pytest.MonkeyPatch) -> Writers:
    """The Zenoh side of each publisher that a test creates."""
    created: Writers = {}
    create_writer = ZenohTransport.create_writer

    def create(self: ZenohTransport, endpoint: EndpointInfo, msg_type: type[Any]) -> Any:
        writer: Any = create_writer(self, endpoint, msg_type)
        created[endpoint.name] = writer
        return writer

    monkeypatch.setattr(ZenohTransport, "create_writer", create)
    return created


@asynccontextmanager
async def two_nodes() -> AsyncIterator[tuple[Node, Node]]:
    """Two nodes in two contexts."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        yield a, b


def state_of(context: Context) -> SessionState:
    """Return the state of a context's session."""
    (transport,) = (each for each in context.transports if isinstance(each, ZenohTransport))
    return transport.session_state


class Overheard:
    """The submessages that another process receives.

    Args:
        session: Its session.
        topic: The topic that they are about, as a chunk of their keys.
    """

    def __init__(self, session: zenoh.Session, topic: str) -> None:
        self._samples = Collector()
        session.declare_subscriber(f"{DOMAIN_ID}/{topic}/*/*/@aionode/*/**", self._samples)

    def submessages(self) -> list[tuple[str, Submessage]]:
        """Return the key and content of each."""
        pairs = [
            (str(each.key_expr), acknack.unpack(each.payload.to_bytes()))
            for each in self._samples.items
        ]
        return [(key, said) for key, said in pairs if said is not None]

    async def key_and_one_of(self, kind: SubmessageKind) -> tuple[str, Submessage]:
        """Wait for a submessage of a kind."""
        await until(lambda: any(said.kind is kind for _, said in self.submessages()))
        return next(pair for pair in self.submessages() if pair[1].kind is kind)


async def test_the_log_gives_a_publisher_a_remedy_that_it_does_not_use_yet(
    writers: Writers, caplog: pytest.LogCaptureFixture
) -> None:
    """A KEEP_ALL publisher is not told to use KEEP_ALL."""
    with caplog.at_level(logging.WARNING, "aionode.transport.zenoh"):
        async with quiet_node("here") as node:
            for qos in (KEEP_ALL, QoSProfile(depth=10)):
                node.create_publisher(Int32, "n", qos)
                writers["/n"].lost(1)

    keeps_all, keeps_last = (text for text in caplog.messages if "were dropped" in text)
    assert "KEEP_ALL" not in keeps_all
    assert "`await drain()`" in keeps_all
    assert (
        "A greater depth keeps more of them; KEEP_ALL with `await drain()` keeps all" in keeps_last
    )


@pytest.mark.parametrize(
    ("qos", "theirs"),
    [
        (QoSProfile(depth=1000), QoSProfile(depth=1000)),
        (KEEP_ALL, KEEP_ALL),
        (TRANSIENT, TRANSIENT),
        (TRANSIENT, KEEP_ALL),
    ],
    ids=["last", "all", "all transient local", "all transient local to volatile"],
)
async def test_what_is_lost_on_the_way_is_sent_again(
    qos: QoSProfile, theirs: QoSProfile, monkeypatch: pytest.MonkeyPatch, writers: Writers
) -> None:
    """Here every third message is lost, including the last one."""
    put, count = ZenohSender.put, 0

    def put_some(self: ZenohSender, payload: bytes, extra: bytes) -> None:
        nonlocal count
        count += 1
        if count % 3:
            put(self, payload, extra)

    monkeypatch.setattr(ZenohSender, "put", put_some)
    async with two_nodes() as (a, b):
        publisher = a.create_publisher(Int32, "n", qos)
        subscription = b.create_subscription(Int32, "n", None, theirs)
        await publisher.wait_for_subscribers()
        for number in range(300):
            publisher.publish(Int32(data=number))
        heard = [(await subscription.receive()).data for _ in range(300)]
        await until(writers["/n"].is_done)

        assert heard == list(range(300))
        assert subscription.stats.lost == 0
        assert publisher.stats.dropped == 0


@pytest.fixture
def near(monkeypatch: pytest.MonkeyPatch) -> None:
    """Contexts have links, as on one host, but cannot use them."""
    monkeypatch.delenv("AIONODE_LINK")
    monkeypatch.setattr(Listener, "dial", lambda *_: None)


@pytest.mark.usefixtures("near")
async def test_what_is_lost_between_near_contexts_is_sent_again(
    monkeypatch: pytest.MonkeyPatch, writers: Writers
) -> None:
    """As between any others; here every third message is lost, including the last one."""
    put, count = ZenohSender.put, 0

    def put_some(self: ZenohSender, payload: bytes, extra: bytes) -> None:
        nonlocal count
        count += 1
        if count % 3:
            put(self, payload, extra)

    monkeypatch.setattr(ZenohSender, "put", put_some)
    async with two_nodes() as (a, b):
        publisher = a.create_publisher(Int32, "n", KEEP_ALL)
        subscription = b.create_subscription(Int32, "n", None, KEEP_ALL)
        await publisher.wait_for_subscribers()
        for number in range(300):
            publisher.publish(Int32(data=number))
        heard = [(await subscription.receive()).data for _ in range(300)]
        await until(writers["/n"].is_done)

        assert heard == list(range(300))
        assert list(publisher.stats.routes.values()) == ["zenoh"]


@pytest.mark.usefixtures("near")
async def test_a_context_whose_announcement_of_links_was_lost_is_answered(
    monkeypatch: pytest.MonkeyPatch, writers: Writers
) -> None:
    """It listens for near contexts only, as it knows no other ones."""
    monkeypatch.setattr(acknowledgements.Acknowledgements, "note_links", lambda *_, **__: None)
    monkeypatch.setattr(acknowledgements.Acknowledgements, "_check_far", lambda _: None)
    async with two_nodes() as (a, b):
        publisher = a.create_publisher(Int32, "n", KEEP_ALL)
        subscription = b.create_subscription(Int32, "n", None, KEEP_ALL)
        await publisher.wait_for_subscribers()
        publisher.publish(Int32(data=1))
        await subscription.receive()

        await until(writers["/n"].is_done)


@pytest.mark.usefixtures("near")
@pytest.mark.parametrize("side", ["pub", "sub"])
async def test_keys_of_topics_wait_for_a_context_that_is_not_near(side: str) -> None:
    """Every process of the domain keeps them, and near contexts use one for all topics."""
    async with two_nodes() as (a, b):
        with raw_session() as session:
            publisher = a.create_publisher(Int32, "n", 10)
            subscription = b.create_subscription(Int32, "n", None, 10)
            await publisher.wait_for_subscribers()
            publisher.publish(Int32(data=1))
            await subscription.receive()
            data: Any = session.declare_publisher(f"{DOMAIN_ID}/n/*/*")
            keys: Any = session.declare_publisher(f"{DOMAIN_ID}/n/*/*/@aionode/{side}/*")
            await until(lambda: data.matching_status.matching)
            before = keys.matching_status.matching

            async with Context(link=False):
                await until(lambda: keys.matching_status.matching)
    assert not before


async def test_a_context_of_another_user_is_not_near() -> None:
    """It can be linked with those of its own user only."""
    state = SessionState("a1", DOMAIN_ID)
    state.acknowledgements.note_links("b2", is_near=False, present=True)
    state.acknowledgements.note_links("c3", is_near=True, present=True)

    assert state.acknowledgements.near == {"c3"}


async def test_a_context_that_starts_is_waited_for_only_until_its_links_are_known(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A timer would wake each process once more for each that starts, in whatever order it hears.

    Zenoh names the tokens of a context that has just been connected in any order.
    """
    monkeypatch.setattr(acknowledgements, "FAR_S", 1000.0)
    calls: list[Later] = []

    class Counted(Later):
        __slots__ = ()

        def call(self, delay_s: float, action: Callable[[], object]) -> None:
            calls.append(self)
            super().call(delay_s, action)

    async with AsyncExitStack() as stack:
        transports: list[ZenohTransport] = []
        for participant in ("a1", "b2"):
            monkeypatch.setattr(acknowledgements, "Later", Counted if not transports else Later)
            transport = ZenohTransport(participant, network_from(os.environ))
            transport.peer_directory.advertisement = f"{participant}/link/1/host/user"
            await transport.open(Graph())
            stack.push_async_callback(transport.close)
            transports.append(transport)
        known = transports[0].session_state.acknowledgements
        await until(lambda: known.present == known.near == {"b2"})

        assert not any(later.waits for later in calls)


@asynccontextmanager
async def without_acknowledgements(
    monkeypatch: pytest.MonkeyPatch,
) -> AsyncIterator[tuple[Node, Node]]:
    """Two nodes, each of which takes the other for an older aionode or a ROS 2 node."""
    monkeypatch.setattr(acknowledgements, "MAX_ID", 0)  # # so no token counts
    async with two_nodes() as nodes:
        yield nodes


async def test_a_peer_that_does_not_acknowledge_still_hears_everything(
    monkeypatch: pytest.MonkeyPatch, writers: Writers
) -> None:
    """With an older aionode, as with a ROS 2 node, delivery is left to Zenoh."""
    async with without_acknowledgements(monkeypatch) as (a, b):
        publisher = a.create_publisher(String, "n", KEEP_ALL)
        subscription = b.create_subscription(String, "n", None, KEEP_ALL)
        await publisher.wait_for_subscribers()
        for number in range(5000):
            if not writers["/n"].has_room():
                await publisher.drain()
            publisher.publish(String(data=str(number)))
        heard = [(await subscription.receive()).data for _ in range(5000)]

    assert heard == [str(number) for number in range(5000)]


@pytest.mark.parametrize(
    "depth",
    [pytest.param(5000, marks=pytest.mark.slow), 100],
    ids=["fits", "does not fit"],
)
async def test_of_a_burst_that_no_reader_acknowledges_only_what_is_beyond_the_depth_is_dropped(
    depth: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Zenoh would silently drop what it has no room for, so a thread waits for room instead."""
    in_thread: list[str] = []
    all_published = threading.Event()  # # otherwise the thread might keep up
    submit = Worker.submit

    def hold(self: Worker, job: Callable[[], None]) -> None:
        def run() -> None:
            in_thread.append(threading.current_thread().name)
            assert all_published.wait(30)
            job()

        submit(self, run)

    monkeypatch.setattr(Worker, "submit", hold)
    # # otherwise the result would depend on the machine
    monkeypatch.setattr(session_state, "BURST_BYTES", 4096)
    monkeypatch.setattr(session_state, "BURST_NS", 1 << 62)
    async with without_acknowledgements(monkeypatch) as (a, b):
        publisher = a.create_publisher(String, "n", depth)
        subscription = b.create_subscription(String, "n", None, 5000)
        await publisher.wait_for_subscribers()
        for number in range(5000):
            publisher.publish(String(data=str(number)))
        all_published.set()
        heard = []
        while "4999" not in heard:
            heard.append((await subscription.receive()).data)

        assert heard == sorted(set(heard), key=int)
        assert len(heard) + publisher.stats.dropped == 5000
        assert (publisher.stats.dropped == 0) is (depth == 5000)
        assert "aionode-blocking" in in_thread


@pytest.mark.parametrize(
    "qos",
    [QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT), QoSProfile(depth=10)],
    ids=["best effort", "reliable"],
)
async def test_a_slow_stream_is_acknowledged_seldom(qos: QoSProfile) -> None:
    """It is not acknowledged per message, and a best-effort stream not at all."""
    async with two_nodes() as (a, b):
        with raw_session() as session:
            overheard = Overheard(session, "n")
            publisher = a.create_publisher(Int32, "n", qos)
            subscription = b.create_subscription(Int32, "n", None, qos)
            await publisher.wait_for_subscribers()
            for number in range(256):
                publisher.publish(Int32(data=number))
                assert (await subscription.receive()).data == number
            kinds = [said.kind for _, said in overheard.submessages()]
        assert len(kinds) <= (0 if qos.reliability is ReliabilityPolicy.BEST_EFFORT else 20)
        assert SubmessageKind.DATA not in kinds


async def test_malformed_acknowledgements_are_ignored() -> None:
    """Any process may publish anything under a key."""
    async with two_nodes() as (a, b):
        with raw_session() as session:
            overheard = Overheard(session, "n")
            publisher = a.create_publisher(Int32, "n", 10)
            subscription = b.create_subscription(Int32, "n", None, 10)
            await publisher.wait_for_subscribers()
            publisher.publish(Int32(data=1))
            assert (await subscription.receive()).data == 1
            to_writer, answer = await overheard.key_and_one_of(ACKNACK)
            to_reader, _ = await overheard.key_and_one_of(SubmessageKind.HEARTBEAT)
            big = 2**63 - 1
            for key in (to_writer, to_reader):
                for data in (b"", b"\2", bytes(60), b"\2\2" + bytes(50)):
                    session.put(key, data)
                for kind in SubmessageKind:
                    for numbers in ((-5, big), (big, 0), (0, 0), (-big, -big), (big, big)):
                        rest = acknack.pack_ranges([(-big, big), (5, 3)])
                        for gid in (bytes(16), answer.reader):
                            session.put(key, acknack.pack(kind, gid, gid, *numbers, rest))
                        if kind is not SubmessageKind.DATA:  # # which is a message
                            gids = answer.writer, answer.reader
                            session.put(key, acknack.pack(kind, *gids, *numbers, rest))
            for number in range(2, 50):
                publisher.publish(Int32(data=number))
                assert (await subscription.receive()).data == number


async def test_a_submessage_counts_only_on_the_key_of_its_topic() -> None:
    """Otherwise anyone allowed to publish on one topic could speak for all of them."""
    async with two_nodes() as (a, b):
        with raw_session() as session:
            overheard, others = Overheard(session, "n"), Overheard(session, "m")
            publisher, other = (a.create_publisher(Int32, name, 10) for name in "nm")
            heard: list[int] = []
            b.create_subscription(Int32, "n", lambda msg: heard.append(msg.data), 10)
            b.create_subscription(Int32, "m", None, 10)
            for each in (publisher, other):
                await each.wait_for_subscribers()
            # Until it is overheard: the session may be known later than the subscriptions.
            a.create_timer(0.2, lambda: other.publish(Int32(data=0)))
            key_of_other, _ = await others.key_and_one_of(SubmessageKind.HEARTBEAT)
            publisher.publish(Int32(data=1))
            await until(lambda: heard)
            key, heartbeat = await overheard.key_and_one_of(SubmessageKind.HEARTBEAT)
            to_writer, _ = await overheard.key_and_one_of(ACKNACK)
            while len(heard) < 2:
                for lying, number in ((key_of_other, 66), (to_writer, 77), (key, 2)):
                    payload = cdr.encode(Int32(data=number))
                    gids = heartbeat.writer, heartbeat.reader
                    session.put(lying, acknack.pack(SubmessageKind.DATA, *gids, 2, 0, payload))
                await checkpoint()
        assert heard == [1, 2]
        assert "malformed" not in state_of(b.context).drops.totals()


async def test_a_reader_that_never_acknowledges_is_left_to_zenoh_until_it_does(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, writers: Writers
) -> None:
    """A false claim must not block a KEEP_ALL publisher; a reader slow to start loses little."""
    monkeypatch.setattr(stateful_writer, "MUTE_TICKS", 2)
    heard: list[Submessage] = []
    receive = StatefulReader.receive
    monkeypatch.setattr(StatefulReader, "receive", lambda _, said: heard.append(said))
    async with two_nodes() as (a, b):
        publisher = a.create_publisher(Int32, "n", KEEP_ALL)
        subscription = b.create_subscription(Int32, "n", None, KEEP_ALL)
        await publisher.wait_for_subscribers()
        publisher.publish(Int32(data=1))
        await until(lambda: "and is ignored" in caplog.text)
        assert publisher.stats.dropped == 1
        assert writers["/n"].is_done()
        publisher.publish(Int32(data=2))
        assert [(await subscription.receive()).data for _ in range(2)] == [1, 2]

        monkeypatch.setattr(StatefulReader, "receive", receive)
        lost = heard[0]
        answer = Submessage(ACKNACK, lost.writer, lost.reader, 3, 0, b"")
        writers["/n"].receive_acknack(answer)
        publisher.publish(Int32(data=3))
        assert not writers["/n"].is_done()
        assert (await subscription.receive()).data == 3
        await until(writers["/n"].is_done)
        assert publisher.stats.dropped == 1


async def test_a_context_of_another_version_counts_as_one_that_does_not_acknowledge() -> None:
    """Its acknowledgements use other keys; it receives everything, like a ROS 2 node."""
    async with quiet_node("a") as a:
        known = state_of(a.context).acknowledgements
        with raw_session() as session:
            liveliness = session.liveliness()
            tokens = [
                liveliness.declare_token(
                    f"@aionode/{DOMAIN_ID}/{version}{version}/reliable/{version}"
                )
                for version in (1, 2, 3)
            ]
            await until(lambda: known.participants)
            assert known.participants == {"33"}
            for token in tokens:
                token.undeclare()


async def test_an_idle_keep_all_publisher_hears_of_its_readers(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Otherwise it could not tell a frozen reader from one that has ended."""
    monkeypatch.setattr(acknowledgements, "PROBE_S", 0.01)
    monkeypatch.setattr(stateful_writer, "UNHEARD_NS", 0)
    answers: list[Submessage] = []
    receive = ZenohWriter.receive_acknack

    def count(self: ZenohWriter, submessage: Submessage) -> None:
        answers.append(submessage)
        receive(self, submessage)

    monkeypatch.setattr(ZenohWriter, "receive_acknack", count)
    async with two_nodes() as (a, b):
        publisher = a.create_publisher(Int32, "n", KEEP_ALL)
        b.create_subscription(Int32, "n", None, KEEP_ALL)
        await publisher.wait_for_subscribers()
        await until(lambda: len(answers) >= 5)


class Clock:
    """The publishers' clock, which a test may advance."""

    def __init__(self) -> None:
        self.jumped_ns = 0

    def __call__(self) -> int:
        """Return the time."""
        return perf_ns() + self.jumped_ns


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """The publishers' clock; disconnected processes reconnect soon."""
    clock = Clock()
    monkeypatch.setattr(publishers, "perf_ns", clock)
    monkeypatch.setattr(forgotten_peers, "FIRST_S", 0.1)
    monkeypatch.setattr(forgotten_peers, "SURE_S", 0.05)
    return clock


def cut(node: Node, other: Node) -> None:
    """Cut the connections between two contexts, as a network failure does."""
    session = state_of(node.context).session
    assert session is not None
    _sockets.cut(set(_sockets.connections(session, {other.context.participant})))


async def cut_off(node: Node, other: Node, is_lost: Callable[[], bool]) -> None:
    """Cut the connections between two contexts until both have noticed."""
    while not is_lost():
        cut(node, other)
        await asyncio.sleep(0.01)  # noqa: TID251  # there is no event


@pytest.mark.parametrize("qos", [KEEP_ALL, TRANSIENT], ids=["volatile", "transient local"])
async def test_what_is_published_while_a_frozen_reader_is_away_is_sent_on_its_return(
    qos: QoSProfile, writers: Writers, clock: Clock
) -> None:
    """Its lease has expired and Zenoh sees no subscriber, but the publisher still writes for it."""
    async with two_nodes() as (a, b):
        publisher = a.create_publisher(Int32, "n", qos)
        subscription = b.create_subscription(Int32, "n", None, qos)
        await publisher.wait_for_subscribers()
        publisher.publish(Int32(data=0))
        assert (await subscription.receive()).data == 0
        await until(writers["/n"].is_done)

        publisher.publish(Int32(data=1))
        clock.jumped_ns = 10_000_000_000  # # it has not answered for that long
        await cut_off(a, b, lambda: publisher.get_subscription_count() == 0)
        for number in (2, 3):
            publisher.publish(Int32(data=number))
        assert not writers["/n"].is_done()

        assert [(await subscription.receive()).data for _ in range(3)] == [1, 2, 3]
        await until(writers["/n"].is_done)
        assert subscription.stats.received == 4
        assert subscription.stats.lost == 0
        assert publisher.stats.dropped == 0


@pytest.mark.parametrize(
    ("qos", "is_forgotten"),
    [(QoSProfile(depth=10), False), (KEEP_ALL, False), (TRANSIENT, False), (TRANSIENT, True)],
    ids=["last", "all", "all transient local", "all transient local, forgotten"],
)
async def test_a_reader_whose_connection_breaks_for_a_moment_gets_each_message_once(
    qos: QoSProfile,
    is_forgotten: bool,
    writers: Writers,
    clock: Clock,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its publisher keeps them; if the publisher forgets the reader, Zenoh's history has them."""
    vanished = asyncio.Event()
    remove = StatefulWriter.remove

    def remove_and_tell(self: StatefulWriter, gid: bytes) -> None:
        remove(self, gid)
        if is_forgotten:
            self.readers.pop(gid, None)
        vanished.set()

    monkeypatch.setattr(StatefulWriter, "remove", remove_and_tell)
    async with two_nodes() as (a, b):
        publisher = a.create_publisher(Int32, "n", qos)
        subscription = b.create_subscription(Int32, "n", None, qos)
        await publisher.wait_for_subscribers()
        for number in range(3):
            publisher.publish(Int32(data=number))
        assert [(await subscription.receive()).data for _ in range(3)] == [0, 1, 2]
        await until(writers["/n"].is_done)

        cut(a, b)
        await vanished.wait()
        for number in range(3, 8):
            publisher.publish(Int32(data=number))

        assert [(await subscription.receive()).data for _ in range(5)] == [3, 4, 5, 6, 7]
        await publisher.wait_for_subscribers()
        publisher.publish(Int32(data=8))
        assert (await subscription.receive()).data == 8
        await until(writers["/n"].is_done)
        assert subscription.stats.received == 9
        assert subscription.stats.lost == 0
        assert publisher.stats.dropped == 0
