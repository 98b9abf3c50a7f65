"""Topics between contexts, byte for byte as in rmw_zenoh_cpp."""

from __future__ import annotations

import asyncio
import json
import logging
import os
import threading
from collections.abc import Iterable
from contextlib import ExitStack
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import zenoh  # noqa: TID251  # plays the other participants, without aionode

from aionode.engine.context import Context
from aionode.engine.transport.loop_waker import ThreadsafeQueue
from aionode.engine.transport.zenoh import _session_state as session_state
from aionode.engine.transport.zenoh.endpoints.publisher import ZenohWriter
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import buffer_key, data_key
from aionode.engine.wire.typehash import type_hash
from aionode.errors import QueueFullError
from aionode.graph import EndpointInfo, EndpointKind
from aionode.interfaces import get_message
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Int32, String, UInt8MultiArray
from aionode.message import from_builtins
from aionode.node import Node
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import ManualClock
from tests.support.arrivals import writers_of
from tests.support.peers import (
    DOMAIN_ID,
    KEEP_ALL,
    Collector,
    kept,
    known,
    quiet_node,
    raw_session,
    ros_value,
    two_contexts,
)
from tests.support.waiting import until

VECTORS: dict[str, Any] = json.loads(
    Path(__file__).parents[3].joinpath("vectors", "vectors.json").read_text()
)
MESSAGES: dict[str, dict[str, Any]] = VECTORS["messages"]
CHATTER = data_key(DOMAIN_ID, "/chatter", "std_msgs/msg/String", type_hash(String))


def numbers(count: int) -> list[Int32]:
    """Return messages that can be told apart."""
    return [Int32(data=n) for n in range(count)]


async def first_numbers(subscription: Any, count: int) -> list[int]:
    """Return what the next messages say."""
    return [(await subscription.receive()).data for _ in range(count)]


async def test_messages_go_both_ways_in_order() -> None:
    """The basic guarantee between participants."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        for here, there in ((a, b), (b, a)):
            publisher = here.create_publisher(Int32, f"from_{here.get_name()}", 100)
            subscription = there.create_subscription(Int32, f"from_{here.get_name()}", None, 100)
            await publisher.wait_for_subscribers()
            for msg in numbers(50):
                publisher.publish(msg)
            assert await first_numbers(subscription, 50) == list(range(50))
            assert subscription.stats.lost == 0


async def test_published_samples_are_those_of_rmw_zenoh() -> None:
    """Key, payload and attachment: one byte off, and a ROS node hears nothing."""
    async with quiet_node("talker") as node:
        with raw_session() as session:
            samples = Collector()
            with closing_all(session.declare_subscriber(f"{DOMAIN_ID}/**", samples)):
                for name, golden in MESSAGES.items():
                    msg_type = get_message(name)
                    publisher = node.create_publisher(msg_type, "/ns/topic", 10)
                    await matched(publisher)
                    publisher.publish(from_builtins(msg_type, ros_value(golden["value"])))
                await samples.have(len(MESSAGES))

        for golden, sample in zip(MESSAGES.values(), samples.items, strict=True):
            extra = attachment.unpack(sample.attachment.to_bytes())
            assert str(sample.key_expr) == (
                f"{DOMAIN_ID}/ns/topic/{golden['dds_type']}/{golden['rihs01']}"
            )
            assert sample.payload.to_bytes().hex() == golden["cdr"]
            assert len(sample.attachment.to_bytes()) == 33
            assert extra is not None
            assert extra.sequence == 1


async def test_a_thread_of_zenoh_keeps_its_state(monkeypatch: pytest.MonkeyPatch) -> None:
    """To make one anew for each message would cost more than the message."""
    local = threading.local()
    new_states: list[int] = []

    class Watched(ThreadsafeQueue[Any]):
        __slots__ = ()

        def put(self, item: Any) -> None:
            if not hasattr(local, "is_old"):
                local.is_old = True
                new_states.append(threading.get_native_id())
            super().put(item)

    async with quiet_node("listener") as node:
        with monkeypatch.context() as patch:
            patch.setattr(session_state, "ThreadsafeQueue", Watched)
            subscription = node.create_subscription(String, "chatter")
        with raw_session() as session:
            await known(session, f"@ros2_lv/{DOMAIN_ID}/**/MS/**", 1)
            for number in range(20):
                session.put(
                    CHATTER, cdr.encode(String()), attachment=attachment.pack(number, 0, bytes(16))
                )
                await subscription.receive()

    assert len(new_states) == len(set(new_states))


async def test_samples_of_rmw_zenoh_are_heard() -> None:
    """Its own encoder made them, with its own attachment."""
    async with quiet_node("listener") as node:
        with raw_session() as session:
            for number, (name, golden) in enumerate(MESSAGES.items(), 1):
                msg_type = get_message(name)
                subscription = node.create_subscription(msg_type, "/ns/topic")
                await known(session, f"@ros2_lv/{DOMAIN_ID}/**/MS/**", number)
                session.put(
                    f"{DOMAIN_ID}/ns/topic/{golden['dds_type']}/{golden['rihs01']}",
                    bytes.fromhex(golden["cdr"]),
                    attachment=bytes.fromhex(VECTORS["attachment"]["bytes"]),
                )
                expected = from_builtins(msg_type, ros_value(golden["value"]))
                assert await subscription.receive() == expected


async def test_the_graph_holds_the_ids_that_go_with_samples() -> None:
    """Otherwise `ros2 topic info -v` and a message's info name different publishers."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        infos: asyncio.Queue[Any] = asyncio.Queue()
        b.create_subscription(Int32, "n", lambda _, info: infos.put_nowait(info), 10)
        publisher = a.create_publisher(Int32, "n", 10)
        await publisher.wait_for_subscribers()
        publisher.publish(Int32())
        gid = (await infos.get())["publisher_gid"]

        assert [e.gid for e in second.graph.endpoints(name="/n") if e.node.name == "a"] == [gid]
        assert [e.gid for e in first.graph.endpoints(name="/n") if e.node.name == "a"] == [gid]


# What is received, and how often


@pytest.mark.parametrize("qos", [QoSProfile(depth=10), kept(10)], ids=["volatile", "kept"])
async def test_a_reader_of_the_same_context_hears_each_message_once(qos: QoSProfile) -> None:
    """Once as an object, and not again from the network; early or late."""
    async with quiet_node("both") as node:
        early = node.create_subscription(Int32, "n", None, qos)
        publisher = node.create_publisher(Int32, "n", qos)
        with raw_session() as session:
            samples = Collector()
            with closing_all(session.declare_subscriber(f"{DOMAIN_ID}/**", samples)):
                await known(session, f"@ros2_lv/{DOMAIN_ID}/**/MP/**")
                await matched(publisher)
                publisher.publish(Int32(data=1))
                late = node.create_subscription(Int32, "n", None, qos)
                publisher.publish(Int32(data=2))
                await samples.have(2)

        assert await first_numbers(early, 2) == [1, 2]
        expected = [1, 2] if qos == kept(10) else [2]
        assert await first_numbers(late, len(expected)) == expected
        publisher.publish(Int32(data=3))  # the next is the very next
        assert await first_numbers(early, 1) == [3]
        assert await first_numbers(late, 1) == [3]


@pytest.mark.parametrize(("kept_by", "asked_for"), [(3, 5), (5, 3), (10, 10)])
async def test_a_late_reader_gets_the_last_messages_once_and_in_order(
    kept_by: int, asked_for: int
) -> None:
    """As many as both sides keep; then the new ones follow."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        await has_declared(b, a)  # else messages are under way to it when it subscribes
        publisher = a.create_publisher(Int32, "n", kept(kept_by))
        for msg in numbers(8):
            publisher.publish(msg)
        await publisher.drain()  # else it is not late yet
        late = b.create_subscription(Int32, "n", None, kept(asked_for))
        count = min(kept_by, asked_for, 8)
        assert await first_numbers(late, count) == list(range(8 - count, 8))
        publisher.publish(Int32(data=8))
        assert await first_numbers(late, 1) == [8]


async def test_what_was_published_before_the_context_opened_is_kept() -> None:
    """A node publishes in its constructor; the session comes later."""
    async with quiet_node("b") as b:
        late = b.create_subscription(Int32, "n", None, kept(5))
        a = quiet_node("a", Context())
        publisher = a.create_publisher(Int32, "n", kept(2))
        for msg in numbers(4):
            publisher.publish(msg)
        async with a:
            assert await first_numbers(late, 2) == [2, 3]


async def test_what_was_published_before_the_context_opened_is_sent_to_known_readers(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A new message would replace the history of a publisher that is connected afterwards."""
    known_readers: list[int] = []
    declare = ZenohWriter.declare_data

    def note(writer: ZenohWriter, session: zenoh.Session) -> None:
        if writer.endpoint.name == "/n":
            assert writer.state.graph is not None
            known_readers.append(writer.state.graph.count(EndpointKind.SUBSCRIPTION, "/n"))
        declare(writer, session)

    async with quiet_node("b") as b:
        b.create_subscription(Int32, "n", None, kept(5))
        a = quiet_node("a", Context())
        a.create_publisher(Int32, "n", kept(2)).publish(Int32())
        monkeypatch.setattr(ZenohWriter, "declare_data", note)
        async with a:
            assert known_readers == [1]


async def test_a_late_volatile_reader_gets_nothing_old() -> None:
    """It requested only new messages."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        await has_declared(b, a)  # as above
        publisher = a.create_publisher(Int32, "n", kept(10))
        publisher.publish(Int32(data=1))
        await publisher.drain()  # else it is not late yet
        late = b.create_subscription(Int32, "n", None, 10)
        await publisher.wait_for_subscribers()
        publisher.publish(Int32(data=2))

        assert await first_numbers(late, 1) == [2]


async def test_a_message_is_encoded_only_for_remote_subscriptions() -> None:
    """Within a process no bytes are made."""
    async with quiet_node("a") as node:
        publisher = node.create_publisher(Int32, "n", 10)
        node.create_subscription(Int32, "n")
        writer = writers_of(publisher)[1]
        assert not writer.active

        with raw_session() as session:
            subscriber = session.declare_subscriber(f"{DOMAIN_ID}/**", lambda _: None)
            await matched(publisher)
            subscriber.undeclare()
            await until(lambda: not writer.active)


# Large messages, many messages


async def test_small_messages_stay_behind_a_large_one() -> None:
    """The large one goes through a thread, and order is what a topic promises."""
    # On a busy machine the link is blocked for longer than a millisecond, and messages dropped.
    patient = {"transport/link/tx/queue/congestion_control/drop/wait_before_drop": 5_000_000}
    async with (
        two_contexts(config=patient) as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publisher = a.create_publisher(UInt8MultiArray, "bytes", 10)
        subscription = b.create_subscription(UInt8MultiArray, "bytes", None, 10)
        await publisher.wait_for_subscribers()
        sizes = [5_000_000, 1, 200_000, 2]
        for size in sizes:
            publisher.publish(UInt8MultiArray(data=bytes([size % 251]) * size))
        await publisher.drain()
        heard = [await subscription.receive() for _ in sizes]

        assert [len(msg.data) for msg in heard] == sizes
        assert all(
            bytes(msg.data) == bytes([n % 251]) * n for n, msg in zip(sizes, heard, strict=True)
        )


async def test_subscriptions_of_a_context_share_a_large_payload() -> None:
    """A recorder and a gateway in one process: Zenoh would copy an image of 6 MB for each."""
    async with (
        two_contexts() as (ours, theirs),
        quiet_node("sender", ours) as sender,
        quiet_node("receiver", theirs) as receiver,
    ):
        publisher = sender.create_publisher(Image, "images", 10)
        some = [receiver.create_subscription(Image, "images", None, 10, raw=True) for _ in range(2)]
        await publisher.wait_for_subscribers(2)
        payloads = []
        for number in range(2):
            publisher.publish(Image(data=bytes([number]) * 1_000_000))
            payloads.append([await each.receive() for each in some])

    assert all(first is second for first, second in payloads)
    assert [first[-1] for first, _ in payloads] == [0, 1]


@pytest.mark.slow
async def test_keep_all_loses_nothing() -> None:
    """However fast the publisher is: it is told to wait, and `drain` waits."""
    count = 12_000
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        heard: list[int] = []
        done = asyncio.Event()

        def hear(msg: Int32) -> None:
            heard.append(msg.data)
            if msg.data == count - 1:
                done.set()

        b.create_subscription(Int32, "n", hear, KEEP_ALL)
        publisher = a.create_publisher(Int32, "n", KEEP_ALL)
        await publisher.wait_for_subscribers()
        for n in range(count):
            try:
                publisher.publish(Int32(data=n))
            except QueueFullError:
                await publisher.drain()
                publisher.publish(Int32(data=n))
        await publisher.drain()
        await done.wait()

        assert heard == list(range(count))


# The second key of Lyrical


async def test_a_topic_with_bytes_has_two_keys_and_hears_each_message_once() -> None:
    """A ROS 2 Lyrical publisher uses one of both."""
    key = data_key(DOMAIN_ID, "/image", "sensor_msgs/msg/Image", type_hash(Image))
    async with quiet_node("viewer") as node:
        subscription = node.create_subscription(Image, "image")
        with raw_session() as session:
            (token,) = await known(session, f"@ros2_lv/{DOMAIN_ID}/**/MS/**")
            for n, each in enumerate((key, buffer_key(key))):
                session.put(each, cdr.encode(Image(height=n)), attachment=sent(n + 1))
            heights = [(await subscription.receive()).height for _ in range(2)]

    assert token.endswith("/backends:cpu:")
    assert sorted(heights) == [0, 1]


async def test_the_numbers_that_lyrical_gives_to_other_subscriptions_are_no_loss() -> None:
    """Its publisher takes one for each subscription that knows only the key of all."""
    key = buffer_key(data_key(DOMAIN_ID, "/image", "sensor_msgs/msg/Image", type_hash(Image)))
    async with quiet_node("viewer") as node:
        subscription = node.create_subscription(Image, "image")
        with raw_session() as session:
            (token,) = await known(session, f"@ros2_lv/{DOMAIN_ID}/**/MS/**")
            *chunks, _ = token.split("/")
            chunks[2], chunks[8] = str(session.zid()), "rviz2"
            _kilted = session.liveliness().declare_token("/".join(chunks))
            await node.graph.until(lambda: node.count_subscribers("image") == 2)
            for sequence in (1, 3, 5, 7, 11, 13):  # number 9 is lost
                session.put(key, cdr.encode(Image(height=sequence)), attachment=sent(sequence))
            heights = [(await subscription.receive()).height for _ in range(6)]

    assert heights == [1, 3, 5, 7, 11, 13]
    assert subscription.stats.lost == 1


@pytest.mark.parametrize(("backends", "is_heard"), [("", True), ("/backends:cpu:", False)])
async def test_a_latched_subscription_is_told_what_holds_for_a_volatile_publisher(
    backends: str, is_heard: bool, caplog: pytest.LogCaptureFixture
) -> None:
    """Kilted's is heard all the same; Lyrical's sends to a key that such subscriptions have not."""
    hash_text = type_hash(Image)
    caplog.set_level(logging.WARNING)
    async with quiet_node("viewer") as node:
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        subscription = node.create_subscription(Image, "image", None, latched)
        with raw_session() as session:
            token = session.liveliness().declare_token(
                f"@ros2_lv/{DOMAIN_ID}/{session.zid()}/0/1/MP/%/%/camera/%image/"
                f"sensor_msgs::msg::dds_::Image_/{hash_text}/::,1:,:,:,,{backends}"
            )
            await node.graph.until(lambda: node.count_publishers("image") == 1)
            assert subscription.get_publisher_count() == int(is_heard)
            token.undeclare()
    (text,) = [text for text in caplog.messages if "incompatible" in text]

    assert ("Messages are delivered over rmw_zenoh" in text) is is_heard
    assert ("No messages will be" in text) is not is_heard


async def test_a_topic_without_bytes_has_one_key() -> None:
    """As ROS nodes of every release announce it."""
    async with quiet_node("listener") as node:
        node.create_subscription(String, "chatter")
        with raw_session() as session:
            (token,) = await known(session, f"@ros2_lv/{DOMAIN_ID}/**/MS/**")

    assert "backends" not in token


# Malformed data from the network


async def test_malformed_data_is_counted_logged_once_and_stops_nothing(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Any process may put any data on a key."""
    async with quiet_node("listener") as node:
        subscription = node.create_subscription(String, "chatter")
        with raw_session() as session:
            await known(session, f"@ros2_lv/{DOMAIN_ID}/**/MS/**")
            with caplog.at_level(logging.WARNING, "aionode.transport.zenoh"):
                for payload in (b"", b"\0\1\0\0", b"\0\1\0\0\xff\xff\xff\xffabc", bytes(3)):
                    session.put(CHATTER, payload, attachment=sent(1))
                session.delete(CHATTER)
                for extra in (None, b"", b"abc", bytes(33), bytes(200)):
                    session.put(CHATTER, cdr.encode(String(data="fine")), attachment=extra)
                session.put(CHATTER, cdr.encode(String(data="last")), attachment=sent(2))
                texts = [(await subscription.receive()).data for _ in range(6)]

        malformed = transport_of(node).malformed
        assert texts == ["fine"] * 5 + ["last"]
        assert subscription.stats.errors == 5
        assert malformed[CHATTER] == 9
        assert sum("unknown form" in record.message for record in caplog.records) == 1


async def test_strange_tokens_are_counted_and_the_graph_goes_on(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Any process may declare any token below the prefix."""
    strange = [
        *["x", "a/0/0/NN/%/%/n", "z/0/0/XX/%/%/n", "z/0/1/MP/%/%/n/%t/not_dds/h/::,1:,:,:,,"],
        "z/0/0/NN/%/%..%..%etc/n",
        "z/0/1/SS/%/%/n/%..%..%etc/p::srv::dds_::T_/h/::,1:,:,:,,",
    ]
    good = "zz/0/0/NN/%/%/fine"
    async with quiet_node("watcher") as node:
        with raw_session() as session, caplog.at_level(logging.WARNING):
            with closing_all(
                *(
                    session.liveliness().declare_token(f"@ros2_lv/{DOMAIN_ID}/{each}")
                    for each in [*strange, good]
                )
            ):
                await node.graph.until(lambda: "fine" in {n.name for n in node.graph.nodes()})
                # they may come after it
                await until(lambda: transport_of(node).malformed.total() >= 5)
            await node.graph.until(lambda: [n.name for n in node.graph.nodes()] == ["watcher"])

        assert transport_of(node).malformed.total() == 5
        assert sum("unknown form" in record.message for record in caplog.records) == 1


async def test_domains_that_meet_do_not_hear_each_other_or_say_anything(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """A setting or a router may join them; `aionode doctor` names them when it is asked."""
    clock = ManualClock()
    with caplog.at_level(logging.INFO, "aionode"):
        async with (
            quiet_node("there", Context(domain_id=DOMAIN_ID + 1)),
            quiet_node("here", Context(clock=clock)) as here,
        ):
            transport = transport_of(here)
            await until(lambda: bool(transport.session_state.connections.kinds))
            assert DOMAIN_ID + 1 in await transport.other_domains()
            await clock.advance(10.0)
            assert [n.name for n in here.graph.nodes()] == ["here"]
    assert [text for text in caplog.messages if "domain" in text] == []


async def test_processes_of_different_domains_are_not_connected(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Twenty simulated robots of one machine cost each other nothing."""
    monkeypatch.delenv("AIONODE_MEETING_PORTS")
    first = 1000 + os.getpid() % 1000  # other tests have others
    async with (
        Context(domain_id=first) as here,
        Context(domain_id=first + 1) as there,
        Context(domain_id=first) as twin,
        quiet_node("here", here),
        quiet_node("there", there),
        quiet_node("twin", twin) as node,
    ):
        await node.graph.until(lambda: len(node.graph.nodes()) == 2)
        transports: list[Any] = [each.transports[1] for each in (here, there, twin)]
        connected = [set(each.session_state.connections.kinds) for each in transports]
        assert connected == [{twin.participant}, set(), {here.participant}]
        assert first + 1 in await here.transports[1].other_domains()


async def test_a_hundred_domains_are_named_at_most() -> None:
    """A peer can announce nodes in as many as it likes."""
    with raw_session() as session:
        _tokens = announced(session, range(200, 350))
        async with quiet_node("here") as here:
            transport = transport_of(here)
            await until(lambda: bool(transport.session_state.connections.kinds))

            assert len(await transport.other_domains()) == 100


async def test_hidden_nodes_of_another_domain_are_not_named() -> None:
    """The daemon of ros2cli runs on for hours in each domain that was asked for anything."""
    with raw_session() as session:
        _tokens = announced(session, [DOMAIN_ID], "sign")
        _tokens += announced(session, [200], "_ros2cli_daemon_200_5f4dcc3b")
        async with quiet_node("here") as here:
            await here.graph.until(lambda: "sign" in {node.name for node in here.graph.nodes()})

            assert 200 not in await transport_of(here).other_domains()


def announced(
    session: zenoh.Session, domains: Iterable[int], name: str = "theirs"
) -> list[zenoh.LivelinessToken]:
    """Announce one node in each of these domains."""
    return [
        session.liveliness().declare_token(
            f"@ros2_lv/{domain_id}/{session.zid()}/0/0/NN/%/%/{name}"
        )
        for domain_id in domains
    ]


# Lifetime


async def test_a_closed_context_leaves_no_thread_and_opens_again() -> None:
    """Programs open and close nodes as they like."""
    before = set(threading.enumerate())
    context = Context()
    publisher_node = quiet_node("a", context)
    publisher = publisher_node.create_publisher(Int32, "n", 10)
    async with quiet_node("other", context):
        pass
    assert [t for t in threading.enumerate() if t not in before] == []

    async with quiet_node("other", context), quiet_node("b") as b:
        subscription = b.create_subscription(Int32, "n")
        await publisher.wait_for_subscribers()
        publisher.publish(Int32(data=7))
        assert await first_numbers(subscription, 1) == [7]
    publisher_node.destroy_node()


async def test_raw_subscriptions_get_the_bytes() -> None:
    """For tools that record or forward messages."""
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        subscription = b.create_subscription(String, "chatter", raw=True)
        publisher = a.create_publisher(String, "chatter", 10)
        await publisher.wait_for_subscribers()
        publisher.publish(String(data="hi"))

        assert await subscription.receive() == cdr.encode(String(data="hi"))


# Helpers


def closing_all(*declared: Any) -> ExitStack:
    """Undeclare in the end."""
    stack = ExitStack()
    for each in declared:
        stack.callback(each.undeclare)
    return stack


def sent(sequence: int) -> bytes:
    """Return an attachment."""
    return attachment.pack(sequence, 1, b"g" * 16)


def transport_of(node: Node) -> Any:
    """Return the Zenoh transport of a node's context."""
    return node.context.transports[1]


async def has_declared(there: Node, here: Node) -> None:
    """Wait until a node's context knows what another has declared so far.

    Until then, Zenoh sends there whatever is published.
    """
    await here.context.graph.until(
        lambda: any(node.name == there.get_name() for node in here.context.graph.nodes())
    )


async def matched(publisher: Any) -> None:
    """Wait until a subscriber without a token matches."""
    await until(lambda: writers_of(publisher)[1].active)


async def test_without_a_hash_every_definition_of_a_type_is_heard() -> None:
    """For tools that look at topics whose definition they do not have."""
    other_key = data_key(DOMAIN_ID, "/chatter", "std_msgs/msg/String", "RIHS01_" + "0" * 64)
    async with quiet_node("tool") as node:
        heard: asyncio.Queue[bytes] = asyncio.Queue()
        endpoint = EndpointInfo(
            EndpointKind.SUBSCRIPTION,
            node.context.graph.nodes()[0],
            99,
            "/chatter",
            "std_msgs/msg/String",
            "",
            QoSProfile(depth=10),
            b"",
        )
        reader: Any = SimpleNamespace(
            endpoint=endpoint,
            raw=True,
            deliver=lambda data, *_: heard.put_nowait(data),
            reject=None,
        )
        announcement = transport_of(node).create_reader(endpoint, String, reader)
        with raw_session() as session:
            publisher = session.declare_publisher(other_key)
            matching = Collector()
            listener = publisher.declare_matching_listener(matching)
            if not publisher.matching_status.matching:  # type: ignore[attr-defined]  # no bool
                await matching.have(1)
            publisher.put(b"any")
            assert await heard.get() == b"any"
            listener.undeclare()
        announcement.close()
        announcement.close()


async def test_subscriptions_start_no_threads() -> None:
    """Zenoh would start one for each subscriber, unless it may call in its own thread."""
    async with quiet_node("many") as node:
        before = threading.active_count()
        for number in range(20):
            node.create_subscription(String, f"t{number}", None, 10)
            node.create_subscription(Image, f"i{number}", None, 10)
        assert threading.active_count() == before


async def test_a_new_publisher_is_asked_for_its_history_only_by_existing_subscriptions() -> None:
    """Those that were destroyed asked as well: the more of them, the longer it took."""
    asked: list[str] = []
    history = f"{CHATTER}/@adv/pub/{'1' * 16}/1/_"

    def note(query: zenoh.Query) -> None:
        if str(query.key_expr) == history:  # and not one for all publishers, as at first
            asked.append(history)

    async with Context() as context, quiet_node("node", context) as node:
        with raw_session() as session:
            session.declare_queryable(history, note)
            for _ in range(10):
                node.create_subscription(String, "/chatter", print, kept(1)).destroy()
            node.create_subscription(String, "/chatter", print, kept(1))

            with session.liveliness().declare_token(history):
                await until(lambda: asked != [])
            with session.liveliness().declare_token(history):
                await until(lambda: len(asked) > 1)

    assert asked == [history, history]
