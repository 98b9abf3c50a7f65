"""Events of rclpy's publishers and subscriptions, where no other rclpy is available."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

import rclpy
from aionode.clock import Duration
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.message import SerializedMessage
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile
from tests.support.peers import DOMAIN_ID, isolated_environment

PATIENCE_S = 20.0


@pytest.fixture
def contexts(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[rclpy.Context]]:
    """Two contexts that are connected to each other, and to nothing else on the machine."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    contexts = [rclpy.Context(), rclpy.Context()]
    for context in contexts:
        rclpy.init(args=[], context=context, domain_id=DOMAIN_ID)
    yield contexts
    for context in contexts:
        rclpy.shutdown(context=context)


def until(events: list[Any], count: int, *nodes: Node) -> None:
    """Spin until a number of events have arrived."""
    executors = [SingleThreadedExecutor(context=node.context) for node in nodes]
    for node, executor in zip(nodes, executors, strict=True):
        executor.add_node(node)
    while len(events) < count:
        for executor in executors:
            executor.spin_once(timeout_sec=0.05)


def test_another_context_whose_qos_does_not_fit_is_an_event(
    contexts: list[rclpy.Context],
) -> None:
    """The log leaves it to the callback, which was never called for another process."""
    here, there = (Node(f"node{number}", context=each) for number, each in enumerate(contexts))
    offered: list[Any] = []
    here.create_publisher(
        Int32,
        "mismatch",
        QoSProfile(depth=1, durability=DurabilityPolicy.VOLATILE),
        event_callbacks=PublisherEventCallbacks(incompatible_qos=offered.append),
    )

    there.create_subscription(
        Int32,
        "mismatch",
        print,
        QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
    )

    until(offered, 1, here)
    assert str(offered[0].last_policy_kind) == "rmw_qos_policy_kind_t.RMW_QOS_POLICY_DURABILITY"


def test_another_type_is_an_event_of_both_sides(contexts: list[rclpy.Context]) -> None:
    """Each side has its own callback for it."""
    node = Node("node", context=contexts[0])
    told: list[Any] = []
    node.create_publisher(
        Int32, "type", 1, event_callbacks=PublisherEventCallbacks(incompatible_type=told.append)
    )
    node.create_subscription(
        String,
        "type",
        print,
        1,
        event_callbacks=SubscriptionEventCallbacks(incompatible_type=told.append),
    )

    until(told, 2, node)

    assert [(each.total_count, each.total_count_change) for each in told] == [(1, 1)] * 2


def test_changes_add_up_until_they_are_taken(contexts: list[rclpy.Context]) -> None:
    """A busy executor gets all of them at once."""
    node = Node("node", context=contexts[0])
    matched: list[Any] = []
    node.create_publisher(
        Int32, "many", 1, event_callbacks=PublisherEventCallbacks(matched=matched.append)
    )
    for _ in range(3):
        node.create_subscription(Int32, "many", print, 1)
    node.destroy_subscription(next(iter(node.subscriptions)))
    node.handle.io.call(lambda: None)

    until(matched, 1, node)

    assert (matched[0].total_count, matched[0].total_count_change) == (3, 3)
    assert (matched[0].current_count, matched[0].current_count_change) == (2, 2)


def test_a_publisher_that_gives_no_sign_within_the_lease_is_not_alive(
    contexts: list[rclpy.Context],
) -> None:
    """The lease is the one that the subscription requests; a message renews it."""
    node = Node("node", context=contexts[0])
    profile = QoSProfile(
        depth=1,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=0.1),
    )
    changes: list[tuple[int, int]] = []
    node.create_subscription(
        Int32,
        "life",
        print,
        profile,
        event_callbacks=SubscriptionEventCallbacks(
            liveliness=lambda event: changes.append((event.alive_count, event.not_alive_count))
        ),
    )
    publisher = node.create_publisher(Int32, "life", profile)

    publisher.publish(Int32())
    until(changes, 2, node)
    publisher.publish(Int32())
    until(changes, 3, node)
    node.destroy_publisher(publisher)
    until(changes, 4, node)

    assert changes[:2] == [(1, 0), (0, 1)]
    assert changes[-1] == (0, 0)


def test_a_message_that_comes_late_makes_no_other_one_lost(
    contexts: list[rclpy.Context],
) -> None:
    """A resent message arrives after newer ones, which were counted before."""
    node = Node("node", context=contexts[0])
    lost: list[Any] = []
    callbacks = SubscriptionEventCallbacks(message_lost=lost.append)
    subscription = node.create_subscription(Int32, "gaps", print, 10, event_callbacks=callbacks)
    inbox = subscription.handle.inbox

    for sequence in (1, 3, 2, 4, 6):
        inbox.deliver(SerializedMessage(b""), bytes(16), sequence, 0)

    until(lost, 1, node)
    assert lost[-1].total_count == 2
