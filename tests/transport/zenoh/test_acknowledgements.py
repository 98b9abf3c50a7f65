"""Reliable topics over Zenoh: acknowledged where both ends can, and else left to Zenoh."""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import partial
from typing import Any

import pytest

from aionode._concurrency import checkpoint
from aionode.clock import perf_ns
from aionode.graph import EndpointKind
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.node import Node
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from aionode.transport.zenoh import _reliability as reliability
from aionode.transport.zenoh import _session_state as session_state
from aionode.transport.zenoh._acknowledgements import Acknowledgements
from aionode.transport.zenoh._publisher import ZenohWriter
from aionode.transport.zenoh._reliability import WINDOW_BYTES
from aionode.transport.zenoh._subscription import GONE_TICKS, ZenohReader
from aionode.transport.zenoh._writer_proxy import WriterProxy
from aionode.wire import _acknack as acknack
from aionode.wire import cdr
from aionode.wire._acknack import Submessage, SubmessageKind
from aionode.wire._key_expression import Side
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


@pytest.fixture(autouse=True)
def without_links(monkeypatch: pytest.MonkeyPatch) -> None:
    """Links are off, as between hosts."""
    monkeypatch.setenv("AIONODE_LINK", "off")


def writer_of(publisher: Any) -> ZenohWriter:
    """Return a publisher's end in Zenoh."""
    writer = publisher._writers[1]
    assert isinstance(writer, ZenohWriter)
    return writer


async def test_the_log_gives_a_publisher_a_remedy_that_it_does_not_use_yet(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """A KEEP_ALL publisher is not told to use KEEP_ALL."""
    with caplog.at_level(logging.WARNING, "aionode.transport.zenoh"):
        async with quiet_node("here") as node:
            for qos in (KEEP_ALL, QoSProfile(depth=10)):
                writer_of(node.create_publisher(Int32, "n", qos)).lost(1)

    keeps_all, keeps_last = (text for text in caplog.messages if "were dropped" in text)
    assert "KEEP_ALL" not in keeps_all
    assert "`await drain()`" in keeps_all
    assert "A greater depth keeps more of them, KEEP_ALL and `await drain()` all" in keeps_last


def reader_of(subscription: Any) -> ZenohReader:
    """Return a subscription's end in Zenoh."""
    return next(each for each in subscription._registrations if isinstance(each, ZenohReader))


async def acknowledged(publisher: Any) -> None:
    """Wait until every reader has acknowledged everything."""
    writer: Any = writer_of(publisher)
    changed = asyncio.Event()
    take_acknack = writer.take_acknack

    def note(submessage: Any) -> None:
        take_acknack(submessage)
        changed.set()

    writer.take_acknack = note
    while not writer._history.readers or not writer._history.done:
        changed.clear()
        await changed.wait()


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
    qos: QoSProfile, theirs: QoSProfile, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every third message here, the last one included."""
    put, count = ZenohWriter.put, 0

    def put_some(self: ZenohWriter, payload: bytes, extra: bytes) -> None:
        nonlocal count
        count += 1
        if count % 3:
            put(self, payload, extra)

    monkeypatch.setattr(ZenohWriter, "put", put_some)
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publisher = a.create_publisher(Int32, "n", qos)
        subscription = b.create_subscription(Int32, "n", None, theirs)
        await publisher.wait_for_subscribers()
        for number in range(300):
            publisher.publish(Int32(data=number))
        heard = [(await subscription.receive()).data for _ in range(300)]
        await acknowledged(publisher)

        assert heard == list(range(300))
        assert subscription.stats.lost == 0
        assert publisher.stats.dropped == 0


@asynccontextmanager
async def without_acknowledgements(
    monkeypatch: pytest.MonkeyPatch,
) -> AsyncIterator[tuple[Node, Node]]:
    """Two nodes, of which each takes the other for an older aionode, or a ROS 2 node."""
    monkeypatch.setattr(Acknowledgements, "_take_token", lambda *_: None)
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        yield a, b


async def test_a_peer_that_does_not_acknowledge_still_hears_everything(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An older aionode; as a ROS 2 node, it is left to Zenoh."""
    async with without_acknowledgements(monkeypatch) as (a, b):
        publisher = a.create_publisher(String, "n", KEEP_ALL)
        subscription = b.create_subscription(String, "n", None, KEEP_ALL)
        await publisher.wait_for_subscribers()
        for number in range(5000):
            if not writer_of(publisher).has_room():
                await publisher.drain()
            publisher.publish(String(data=str(number)))
        heard = [(await subscription.receive()).data for _ in range(5000)]

    assert heard == [str(number) for number in range(5000)]


@pytest.mark.parametrize("depth", [5000, 100], ids=["fits", "does not fit"])
async def test_of_a_burst_that_no_reader_acknowledges_only_what_is_beyond_the_depth_is_dropped(
    depth: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Zenoh would drop what it has no room for, and tell nobody: a thread waits for it instead."""
    in_thread: list[bytes] = []
    all_published = threading.Event()  # else the thread might keep pace
    send_patiently = ZenohWriter._send_patiently

    def note(self: ZenohWriter, publisher: Any, payload: bytes, extra: bytes) -> None:
        in_thread.append(extra)
        assert all_published.wait(30)
        send_patiently(self, publisher, payload, extra)

    monkeypatch.setattr(ZenohWriter, "_send_patiently", note)
    monkeypatch.setattr(session_state, "BURST_BYTES", 4096)  # else the machine would decide
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
        assert in_thread


async def test_a_keep_all_reader_that_takes_nothing_is_sent_no_more_than_a_window(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Nothing on the way has to wait for it, least of all the thread that reads keep-alives."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publisher = a.create_publisher(String, "n", KEEP_ALL)
        subscription: Any = b.create_subscription(String, "n", None, KEEP_ALL)
        await publisher.wait_for_subscribers()
        reader: Any = next(
            each for each in subscription._registrations if isinstance(each, ZenohReader)
        )
        full = True
        has_room = type(reader._reader).has_room
        monkeypatch.setattr(
            type(reader._reader), "has_room", lambda self: not full and has_room(self)
        )
        history: Any = writer_of(publisher)._history
        for number in range(1000):
            publisher.publish(String(data=f"{number:01000}"))
        answers = 0
        take_acknack = history.acknack

        def count(*args: Any) -> None:
            nonlocal answers
            answers += 1
            take_acknack(*args)

        monkeypatch.setattr(history, "acknack", count)
        await until(lambda: answers >= 3)  # it says again and again that it has used nothing

        assert history.unsent
        assert history.sent <= WINDOW_BYTES // 1000
        full = False
        reader._use_room()
        heard = [int((await subscription.receive()).data) for _ in range(1000)]
        assert heard == list(range(1000))


@pytest.mark.parametrize(
    "qos",
    [QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT), QoSProfile(depth=10)],
    ids=["best effort", "reliable"],
)
async def test_a_slow_stream_is_acknowledged_seldom(qos: QoSProfile) -> None:
    """Not once for each message; a best effort one not at all."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        with raw_session() as session:
            sent = Collector()
            subscriber = session.declare_subscriber(f"{DOMAIN_ID}/n/*/*/@aionode/*/**", sent)
            publisher = a.create_publisher(Int32, "n", qos)
            subscription = b.create_subscription(Int32, "n", None, qos)
            await publisher.wait_for_subscribers()
            for number in range(256):
                publisher.publish(Int32(data=number))
                assert (await subscription.receive()).data == number
            subscriber.undeclare()
        kinds = [acknack.unpack(each.payload.to_bytes()) for each in sent.items]
        assert len(kinds) <= (0 if qos.reliability is ReliabilityPolicy.BEST_EFFORT else 20)
        assert all(each is not None and each.kind is not SubmessageKind.DATA for each in kinds)


async def test_malformed_acknowledgements_are_ignored() -> None:
    """Any process may put any data on a key."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publisher = a.create_publisher(Int32, "n", 10)
        subscription = b.create_subscription(Int32, "n", None, 10)
        await publisher.wait_for_subscribers()
        publisher.publish(Int32(data=1))
        assert (await subscription.receive()).data == 1
        writer, state = writer_of(publisher), writer_of(publisher).state
        reader = next(iter(state.acknowledgements.participants))
        gid = next(iter(writer._history.readers))  # type: ignore[union-attr]
        big = 2**63 - 1
        with raw_session() as session:
            for participant in (state.participant, reader):
                side = Side.SUBSCRIPTIONS if participant == state.participant else Side.PUBLISHERS
                key = acknack.submessage_key(writer._key, side, participant)
                for data in (b"", b"\2", bytes(60), b"\2\2" + bytes(50)):
                    session.put(key, data)
                for kind in SubmessageKind:
                    for numbers in ((-5, big), (big, 0), (0, 0), (-big, -big)):
                        rest = acknack.pack_ranges([(-big, big), (5, 3)])
                        for name in (bytes(16), gid):
                            session.put(key, acknack.pack(kind, name, name, *numbers, rest))
                        if kind is not SubmessageKind.DATA:  # that is a message
                            session.put(key, acknack.pack(kind, writer.gid, gid, *numbers, rest))
            for number in range(2, 50):
                publisher.publish(Int32(data=number))
                assert (await subscription.receive()).data == number


async def test_a_submessage_counts_only_on_the_key_of_its_topic() -> None:
    """Whoever may publish on one topic would else speak for all of them."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publisher, other = a.create_publisher(Int32, "n", 10), a.create_publisher(Int32, "m", 10)
        heard: list[int] = []
        subscription = b.create_subscription(Int32, "n", lambda msg: heard.append(msg.data), 10)
        b.create_subscription(Int32, "m", None, 10)
        for each in (publisher, other):
            await each.wait_for_subscribers()
        publisher.publish(Int32(data=1))
        await until(lambda: heard)
        writer = writer_of(publisher)
        (gid,) = writer._history.readers  # type: ignore[union-attr]
        with raw_session() as session:
            while len(heard) < 2:
                for key, number in ((writer_of(other)._key, 66), (writer._key, 2)):
                    payload = cdr.encode(Int32(data=number))
                    data = acknack.pack(SubmessageKind.DATA, writer.gid, gid, 2, 0, payload)
                    for side in Side:
                        session.put(acknack.submessage_key(key, side, second.participant), data)
                await checkpoint()
        assert heard == [1, 2]
        assert not reader_of(subscription).state.malformed


async def test_a_heartbeat_in_a_publishers_name_leads_no_acknowledgement_astray() -> None:
    """A KEEP_ALL publisher would wait for them for good."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publisher = a.create_publisher(Int32, "n", KEEP_ALL)
        subscription = b.create_subscription(Int32, "n", None, KEEP_ALL)
        await publisher.wait_for_subscribers()
        reader, gid = reader_of(subscription), writer_of(publisher).gid
        assert reader.state.graph is not None
        await reader.state.graph.until(lambda: reader._find(gid) is not None)
        lie = Submessage(SubmessageKind.HEARTBEAT, gid, reader.gid, 1, 0, b"abc")
        for is_first in (True, False):
            if is_first:
                reader._proxies.clear()
            reader.take_submessage(lie)
            assert reader._proxies[gid].participant == first.participant
        reader._proxies[gid].participant = "abc"  # as if the graph had not known the publisher yet
        publisher.publish(Int32(data=1))
        await acknowledged(publisher)


async def test_a_reader_that_never_acknowledges_is_left_to_zenoh_until_it_does(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """A lie must not hold up a KEEP_ALL publisher; a reader that only began slowly loses little."""
    monkeypatch.setattr(reliability, "MUTE_TICKS", 2)
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publisher = a.create_publisher(Int32, "n", KEEP_ALL)
        subscription = b.create_subscription(Int32, "n", None, KEEP_ALL)
        reader = reader_of(subscription)
        with monkeypatch.context() as patch:
            patch.setattr(ZenohReader, "take_submessage", lambda *_: None)
            await publisher.wait_for_subscribers()
            history = writer_of(publisher)._history
            assert history is not None
            publisher.publish(Int32(data=1))
            await until(lambda: not history.readers)
            assert history.has_other_readers
            assert publisher.stats.dropped == 1
            assert "and is left out" in caplog.text
            publisher.publish(Int32(data=2))
            assert [(await subscription.receive()).data for _ in range(2)] == [1, 2]
        answer = Submessage(SubmessageKind.ACKNACK, writer_of(publisher).gid, reader.gid, 3, 0, b"")
        writer_of(publisher).take_acknack(answer)
        assert reader.gid in history.readers
        publisher.publish(Int32(data=3))
        assert (await subscription.receive()).data == 3
        await acknowledged(publisher)


async def test_a_context_of_another_version_counts_as_one_that_does_not_acknowledge() -> None:
    """Its acknowledgements go by other keys; it hears everything as a ROS 2 node does."""
    async with quiet_node("a") as a:
        acknowledgements = writer_of(a.create_publisher(Int32, "n", 10)).state.acknowledgements
        with raw_session() as session:
            liveliness = session.liveliness()
            tokens = [
                liveliness.declare_token(
                    f"@aionode/{DOMAIN_ID}/{version}{version}/reliable/{version}"
                )
                for version in (1, 2)
            ]
            await until(lambda: acknowledgements.participants)
            assert acknowledgements.participants == {"22"}
            for token in tokens:
                token.undeclare()


async def test_one_subscriber_for_the_acknowledgements_of_a_topic_goes_with_its_last_endpoint() -> (
    None
):
    """Each is announced to every other process."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publishers = [a.create_publisher(Int32, "n", 10) for _ in range(3)]
        heard = writer_of(publishers[0]).state.acknowledgements._listening
        at_first = len(heard)
        subscription = b.create_subscription(Int32, "n", None, 10)
        for each in publishers:
            await each.wait_for_subscribers()
        await until(lambda: all(writer_of(each)._listens for each in publishers))

        assert len(heard) == at_first + 1
        subscription.destroy()
        for each in publishers:
            each.destroy()
        await until(lambda: len(heard) == at_first)


async def test_a_subscription_that_was_frozen_does_not_give_its_publisher_up() -> None:
    """When it goes on, its clock has jumped, and the publisher is not in the graph yet."""
    async with two_contexts() as (first, _), quiet_node("a", first) as a:
        subscription: Any = a.create_subscription(Int32, "n", None, KEEP_ALL)
        reader = next(each for each in subscription._registrations if isinstance(each, ZenohReader))
        proxy = WriterProxy(b"p" * 16, "f", 1, reader, lambda: 0)
        proxy.last = 3
        reader._proxies[proxy.gid] = proxy
        assert all(reader.tick() for _ in range(GONE_TICKS - 1))
        assert proxy.next == 1
        assert not reader.tick()
        assert proxy.next == 4


async def test_an_idle_keep_all_publisher_hears_of_its_readers(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Else it could not tell one that was frozen from one that has ended."""
    monkeypatch.setattr("aionode.transport.zenoh._acknowledgements.PROBE_S", 0.01)
    monkeypatch.setattr("aionode.transport.zenoh._reliability.UNHEARD_NS", 0)
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publisher = a.create_publisher(Int32, "n", KEEP_ALL)
        b.create_subscription(Int32, "n", None, KEEP_ALL)
        await publisher.wait_for_subscribers()
        writer: Any = writer_of(publisher)
        await until(lambda: writer._history.readers)
        (reader,) = writer._history.readers.values()

        def is_heard_since(before_ns: int) -> bool:
            return bool(reader.heard_ns != before_ns)

        for _ in range(3):
            await until(partial(is_heard_since, reader.heard_ns))


async def test_what_is_published_while_a_frozen_reader_is_away_is_sent_on_its_return() -> None:
    """Its lease has ended, and Zenoh sees no subscriber: the publisher still writes for it."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publisher = a.create_publisher(Int32, "n", KEEP_ALL)
        subscription: Any = b.create_subscription(Int32, "n", None, KEEP_ALL)
        await publisher.wait_for_subscribers()
        publisher.publish(Int32(data=0))
        assert (await subscription.receive()).data == 0
        await acknowledged(publisher)

        writer: Any = writer_of(publisher)
        graph = writer.state.graph
        reader: Any = next(
            each for each in subscription._registrations if isinstance(each, ZenohReader)
        )
        readers = reader.state.acknowledgements.readers
        del readers[reader._key, reader.gid]
        for subscriber in reader._subscribers:
            subscriber.undeclare()
        reader._subscribers.clear()
        publisher.publish(Int32(data=1))
        writer._history.readers[reader.gid].heard_ns = 0
        info = next(iter(graph.endpoints(EndpointKind.SUBSCRIPTION, name="/n")))
        graph.remove_endpoint(info)
        writer._update()
        await until(lambda: not writer._publisher.matching_status.matching)
        writer._update()
        for number in (2, 3):
            publisher.publish(Int32(data=number))

        readers[reader._key, reader.gid] = reader
        reader.declare_data(reader.state.session)
        graph.add_endpoint(info)
        writer._update()
        assert [(await subscription.receive()).data for _ in range(3)] == [1, 2, 3]
        assert subscription.stats.lost == 0
        assert publisher.stats.dropped == 0


@pytest.mark.parametrize("is_forgotten", [True, False], ids=["forgotten", "waited for"])
async def test_a_transient_local_reader_that_returns_gets_each_message_once(
    is_forgotten: bool,
) -> None:
    """From Zenoh's history if its publisher took it for ended, and else from both."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publisher = a.create_publisher(Int32, "n", TRANSIENT)
        publisher.publish(Int32(data=0))
        subscription: Any = b.create_subscription(Int32, "n", None, TRANSIENT)
        await publisher.wait_for_subscribers()
        publisher.publish(Int32(data=1))
        assert [(await subscription.receive()).data for _ in range(2)] == [0, 1]
        await acknowledged(publisher)

        writer: Any = writer_of(publisher)
        graph = writer.state.graph
        reader: Any = next(
            each for each in subscription._registrations if isinstance(each, ZenohReader)
        )
        for subscriber in reader._subscribers:
            subscriber.undeclare()
        reader._subscribers.clear()
        writer._history.readers[reader.gid].heard_ns = perf_ns() if is_forgotten else 0
        info = next(iter(graph.endpoints(EndpointKind.SUBSCRIPTION, name="/n")))
        graph.remove_endpoint(info)
        writer._update()
        assert (reader.gid not in writer._history.readers) is is_forgotten
        for number in (2, 3):
            publisher.publish(Int32(data=number))
        await publisher.drain()

        graph.add_endpoint(info)
        writer._update()
        reader.declare_data(reader.state.session)
        assert [(await subscription.receive()).data for _ in range(2)] == [2, 3]
        publisher.publish(Int32(data=4))
        assert (await subscription.receive()).data == 4
        await acknowledged(publisher)
        assert subscription.stats.received == 5
        assert subscription.stats.lost == 0
        assert publisher.stats.dropped == 0
