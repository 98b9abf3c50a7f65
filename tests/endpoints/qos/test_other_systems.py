"""Policies towards peers that know nothing of them, such as ROS 2 nodes over rmw_zenoh."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack
from typing import Any

import pytest
import zenoh  # noqa: TID251  # plays the ROS 2 node, without aionode
from zenoh import ext  # noqa: TID251  # the same

from aionode._process.concurrency import checkpoint
from aionode.clock import Duration, Time
from aionode.endpoints.events import (
    IncompatibleTypeInfo,
    MatchedInfo,
    QoSLivelinessChangedInfo,
    QoSMessageLostInfo,
    QoSOfferedDeadlineMissedInfo,
    QoSRequestedDeadlineMissedInfo,
    QoSRequestedIncompatibleQoSInfo,
)
from aionode.engine.context import Context
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import Side, data_key, side_key
from aionode.engine.wire._liveliness import endpoint_token, gid_of
from aionode.engine.wire.typehash import type_hash
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.message import type_name
from aionode.node import Node
from aionode.qos import (
    DurabilityPolicy,
    LivelinessPolicy,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
)
from aionode.testing import ManualClock
from tests.endpoints.qos.conftest import next_of, waiting
from tests.support.links import folder, transport_of
from tests.support.peers import DOMAIN_ID, Collector, isolated_environment, quiet_node, raw_session
from tests.support.waiting import until

__all__ = ["folder"]  # a fixture

SECOND = Duration(seconds=1)
PLAIN = QoSProfile(depth=10)


class Numbers:
    """The numbers that a subscriber with history has received."""

    def __init__(self, session: zenoh.Session, key: str) -> None:
        self._collector = Collector()
        self._subscriber = ext.declare_advanced_subscriber(
            session,
            key,
            self._collector,
            history=ext.HistoryConfig(detect_late_publishers=True, max_samples=10),
            recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True),
            subscriber_detection=True,
        )

    async def numbers(self, count: int) -> list[int]:
        """Wait for `count` numbers, and return all."""
        async with asyncio.timeout(10):
            samples = await self._collector.have(count)
        return [cdr.decode(Int32, sample.payload.to_bytes()).data for sample in samples]


class RosNode:
    """A ROS 2 node as seen through rmw_zenoh: tokens, and samples with attachments."""

    def __init__(self, session: zenoh.Session, clock: ManualClock) -> None:
        self._session = session
        self._clock = clock
        self._node = NodeInfo(str(session.info.zid()), 0, "ros", "/")
        self.gid = b""
        self._token: Any = None
        self._publisher: Any = None
        self._sequence = 0

    def announce(self, kind: EndpointKind, profile: QoSProfile, ros_type: Any = Int32) -> None:
        """Declare the token of an endpoint of the topic."""
        hashed = type_hash(ros_type)
        if kind is EndpointKind.PUBLISHER:
            key = data_key(DOMAIN_ID, "/n", type_name(ros_type), hashed)
            self._publisher = self._session.declare_publisher(key)
        token = endpoint_token(
            DOMAIN_ID,
            EndpointInfo(kind, self._node, 1, "/n", type_name(ros_type), hashed, profile, b""),
        )
        self.gid = gid_of(token)
        self._token = self._session.liveliness().declare_token(token)

    def put(self, key: str, payload: bytes) -> None:
        """Send anything."""
        self._session.put(key, payload)

    def subscribe_late(self) -> Numbers:
        """Subscribe with history, like rmw_zenoh for transient local."""
        key = data_key(DOMAIN_ID, "/n", type_name(Int32), type_hash(Int32))
        return Numbers(self._session, key)

    def kept(self) -> list[object]:
        """Return what publishers keep for late subscribers."""
        key = data_key(DOMAIN_ID, "/n", type_name(Int32), type_hash(Int32))
        return list(self._session.get(f"{key}/@adv/**?_anyke", timeout=5.0))

    def withdraw(self) -> None:
        """Undeclare the token, as at the end of the process."""
        self._token.undeclare()

    async def publish(self, number: int, *, age_s: float = 0, skip: int = 0) -> None:
        """Send a sample with a stamp in the past, after samples that are lost.

        The subscription may see the token before this session hears of the subscription: until
        then, what is sent goes nowhere.
        """
        await until(lambda: self._publisher.matching_status.matching)
        self._sequence += 1 + skip
        stamp_ns = self._clock.system_ns() - round(age_s * 1e9)
        self._publisher.put(
            cdr.encode(Int32(data=number)),
            attachment=attachment.pack(self._sequence, stamp_ns, self.gid),
        )


@pytest.fixture
def clock() -> ManualClock:
    """The time, which tests step."""
    return ManualClock(Time(seconds=1000))


@pytest.fixture
async def node(clock: ManualClock, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[Node]:
    """A node of aionode."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    async with AsyncExitStack() as stack:
        context = await stack.enter_async_context(Context(clock=clock))
        yield await stack.enter_async_context(quiet_node("node", context))


@pytest.fixture
async def ros_node(node: Node, clock: ManualClock) -> AsyncIterator[RosNode]:
    """A ROS 2 node."""
    with raw_session() as session:
        yield RosNode(session, clock)


async def test_a_deadline_is_kept_by_the_samples_that_come(
    node: Node, ros_node: RosNode, clock: ManualClock
) -> None:
    """Nothing else is needed of the publisher."""
    subscription = node.create_subscription(Int32, "n", None, QoSProfile(depth=10, deadline=SECOND))
    ros_node.announce(EndpointKind.PUBLISHER, PLAIN)
    events = subscription.events
    await next_of(events, MatchedInfo)
    for number in range(3):
        await ros_node.publish(number)
        assert (await subscription.receive()).data == number
        await clock.advance(0.7)
    assert waiting(events, QoSRequestedDeadlineMissedInfo) == []
    await clock.advance(0.3)
    assert waiting(events, QoSRequestedDeadlineMissedInfo) == [QoSRequestedDeadlineMissedInfo(1, 1)]


async def test_a_publisher_keeps_its_deadline_towards_ros_2(
    node: Node, ros_node: RosNode, clock: ManualClock
) -> None:
    """It is the publisher's own business."""
    publisher = node.create_publisher(Int32, "n", QoSProfile(depth=10, deadline=SECOND))
    ros_node.announce(EndpointKind.SUBSCRIPTION, PLAIN)
    assert await next_of(publisher.events, MatchedInfo) == MatchedInfo(1, 1, 1, 1)
    publisher.publish(Int32())
    await clock.advance(1)
    assert waiting(publisher.events, QoSOfferedDeadlineMissedInfo) == [
        QoSOfferedDeadlineMissedInfo(1, 1)
    ]


@pytest.mark.parametrize(
    ("offered", "requested"),
    [
        (QoSProfile(depth=10, lifespan=SECOND), PLAIN),
        (PLAIN, QoSProfile(depth=10, lifespan=SECOND)),
    ],
    ids=["publisher", "subscription"],
)
async def test_an_old_sample_is_not_delivered(
    node: Node, ros_node: RosNode, offered: QoSProfile, requested: QoSProfile
) -> None:
    """Its stamp tells its age, and the token of its publisher the limit."""
    subscription = node.create_subscription(Int32, "n", None, requested)
    ros_node.announce(EndpointKind.PUBLISHER, offered)
    await next_of(subscription.events, MatchedInfo)
    await ros_node.publish(1, age_s=1.5)
    await ros_node.publish(2, age_s=0.5)
    assert (await subscription.receive()).data == 2
    assert subscription.stats.expired == 1


KEPT = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=SECOND)


@pytest.mark.parametrize("reliability", [ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT])
async def test_a_late_subscriber_gets_no_history_that_has_expired(
    node: Node, ros_node: RosNode, clock: ManualClock, reliability: ReliabilityPolicy
) -> None:
    """Zenoh keeps messages by number, so it is made to forget them when all are too old."""
    publisher = node.create_publisher(Int32, "n", KEPT.replace(reliability=reliability))
    for number in range(3):
        publisher.publish(Int32(data=number))
    early = ros_node.subscribe_late()
    assert await early.numbers(3) == [0, 1, 2]
    await clock.advance(1)
    async with asyncio.timeout(10):
        while await asyncio.to_thread(ros_node.kept):
            pass  # a thread makes Zenoh forget them, as it may have to wait inside Zenoh
    late = ros_node.subscribe_late()
    for number in range(3, 6):
        publisher.publish(Int32(data=number))
        assert await early.numbers(number + 1) == list(range(number + 1))
    assert min(await late.numbers(1)) >= 3


async def test_what_waits_for_a_session_expires(
    node: Node, ros_node: RosNode, clock: ManualClock
) -> None:
    """A node may publish long before it runs."""
    context = Context(clock=clock)
    talker = quiet_node("talker", context)
    publisher = talker.create_publisher(Int32, "n", KEPT)
    publisher.publish(Int32(data=1))
    await clock.advance(0.6)
    publisher.publish(Int32(data=2))
    await clock.advance(0.6)
    ros_node.announce(EndpointKind.SUBSCRIPTION, KEPT)
    async with talker:
        await publisher.wait_for_subscribers()
        assert await ros_node.subscribe_late().numbers(1) == [2]


async def test_automatic_liveliness_is_that_of_the_token(node: Node, ros_node: RosNode) -> None:
    """Zenoh withdraws it when the process ends or is not heard any more."""
    profile = QoSProfile(depth=10, liveliness_lease_duration=SECOND)
    subscription = node.create_subscription(Int32, "n", None, profile)
    ros_node.announce(EndpointKind.PUBLISHER, profile)
    assert await next_of(subscription.events, QoSLivelinessChangedInfo) == (
        QoSLivelinessChangedInfo(1, 0, 1, 0)
    )
    ros_node.withdraw()
    assert await next_of(subscription.events, QoSLivelinessChangedInfo) == (
        QoSLivelinessChangedInfo(0, 0, -1, 0)
    )


async def test_automatic_liveliness_without_assertions_has_no_lease(
    node: Node, ros_node: RosNode, clock: ManualClock
) -> None:
    """rmw_zenoh sends none, so their absence means nothing."""
    profile = QoSProfile(depth=10, liveliness_lease_duration=SECOND)
    subscription = node.create_subscription(Int32, "n", None, profile)
    ros_node.announce(EndpointKind.PUBLISHER, profile)
    await next_of(subscription.events, QoSLivelinessChangedInfo)
    await ros_node.publish(1)
    await subscription.receive()
    await clock.advance(5)
    assert waiting(subscription.events, QoSLivelinessChangedInfo) == []


async def test_a_malformed_assertion_is_counted_and_renews_nothing(
    node: Node, ros_node: RosNode, clock: ManualClock
) -> None:
    """Any process may put anything on any key."""
    profile = QoSProfile(depth=10, liveliness_lease_duration=SECOND)
    subscription = node.create_subscription(Int32, "n", None, profile)
    ros_node.announce(EndpointKind.PUBLISHER, profile)
    await next_of(subscription.events, QoSLivelinessChangedInfo)
    malformed = transport_of(node).zenoh.malformed  # type: ignore[attr-defined]  # is Zenoh's
    key = data_key(DOMAIN_ID, "/n", type_name(Int32), type_hash(Int32))
    while not malformed.total():
        ros_node.put(side_key(key, Side.PUBLISHERS, "alive"), b"no gid")
        await checkpoint()
    await clock.advance(5)  # whoever has asserted once has to continue
    assert waiting(subscription.events, QoSLivelinessChangedInfo) == []


async def test_manual_liveliness_is_that_of_the_samples(
    node: Node, ros_node: RosNode, clock: ManualClock
) -> None:
    """They are all that can be seen: rmw_zenoh keeps `assert_liveliness` to itself."""
    profile = QoSProfile(
        depth=10,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=SECOND,
    )
    subscription = node.create_subscription(Int32, "n", None, profile)
    ros_node.announce(EndpointKind.PUBLISHER, profile)
    events = subscription.events
    await next_of(events, MatchedInfo)
    for number in range(3):
        await ros_node.publish(number)
        await subscription.receive()
        await clock.advance(0.7)
    assert waiting(events, QoSLivelinessChangedInfo) == [QoSLivelinessChangedInfo(1, 0, 1, 0)]
    await clock.advance(0.3)
    assert waiting(events, QoSLivelinessChangedInfo) == [QoSLivelinessChangedInfo(0, 1, -1, 1)]


async def test_missing_numbers_are_lost_messages(node: Node, ros_node: RosNode) -> None:
    """The sequence numbers of the attachments tell."""
    subscription = node.create_subscription(
        Int32, "n", None, QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
    )
    ros_node.announce(EndpointKind.PUBLISHER, PLAIN)
    await next_of(subscription.events, MatchedInfo)
    await ros_node.publish(1)
    await ros_node.publish(2, skip=3)
    assert await next_of(subscription.events, QoSMessageLostInfo) == QoSMessageLostInfo(3, 3)


async def test_what_does_not_fit_is_an_event(node: Node, ros_node: RosNode) -> None:
    """The QoS is in its token, although rmw_zenoh delivers all the same."""
    subscription = node.create_subscription(Int32, "n")
    ros_node.announce(
        EndpointKind.PUBLISHER, QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    )
    assert await next_of(subscription.events, QoSRequestedIncompatibleQoSInfo) == (
        QoSRequestedIncompatibleQoSInfo(1, 1, QoSPolicyKind.RELIABILITY)
    )
    assert await next_of(subscription.events, MatchedInfo) == MatchedInfo(1, 1, 1, 1)


async def test_another_type_is_an_event(node: Node, ros_node: RosNode) -> None:
    """It uses another key, so nothing arrives."""
    publisher = node.create_publisher(Int32, "n", 10)
    ros_node.announce(EndpointKind.SUBSCRIPTION, PLAIN, String)
    assert await next_of(publisher.events, IncompatibleTypeInfo) == IncompatibleTypeInfo(1, 1)
