"""A publisher offers less than a subscription requests: no message passes, and both are told why.

Run it with ``python -m aionode.examples.quality_of_service.incompatible_qos``, and with the name of
another policy: ``incompatible_qos durability``.
"""

from __future__ import annotations

import argparse
from functools import partial

import aionode
from aionode import (
    DurabilityPolicy,
    Duration,
    LivelinessPolicy,
    Node,
    PublisherEventCallbacks,
    QoSProfile,
    QoSRequestedIncompatibleQoSInfo,
    ReliabilityPolicy,
    SubscriptionEventCallbacks,
)
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import qos_policy_name_from_kind

__all__ = ["POLICIES", "Listener", "Talker", "main"]

POLICIES = {
    "durability": (
        QoSProfile(depth=10, durability=DurabilityPolicy.VOLATILE),
        QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL),
    ),
    "deadline": (QoSProfile(depth=10), QoSProfile(depth=10, deadline=Duration(seconds=1))),
    "liveliness_policy": (
        QoSProfile(depth=10, liveliness=LivelinessPolicy.AUTOMATIC),
        QoSProfile(depth=10, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC),
    ),
    "liveliness_lease_duration": (
        QoSProfile(depth=10),
        QoSProfile(depth=10, liveliness_lease_duration=Duration(seconds=1)),
    ),
    "reliability": (
        QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT),
        QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE),
    ),
}
"""For each policy, what the publisher offers, and what the subscription requests."""


class Talker(Node):
    """Publishes, and reports subscriptions that its profile does not match."""

    def __init__(self, profile: QoSProfile) -> None:
        super().__init__("qos_talker")
        self.publisher = self.create_publisher(
            String,
            "qos_chatter",
            profile,
            event_callbacks=PublisherEventCallbacks(incompatible_qos=self.found),
        )
        self.create_timer(0.2, lambda: self.publisher.publish(String(data="Hello?")))
        self.create_timer(1.0, self.context.shutdown)

    def found(self, event: QoSRequestedIncompatibleQoSInfo) -> None:
        """Log the policy that a subscription requests but is not offered."""
        policy = qos_policy_name_from_kind(event.last_policy_kind)
        self.get_logger().info(f"A subscription requests more than is offered: {policy}")


class Listener(Node):
    """Receives nothing."""

    def __init__(self, profile: QoSProfile) -> None:
        super().__init__("qos_listener")
        self.create_subscription(
            String,
            "qos_chatter",
            lambda msg: self.get_logger().error(f"I heard: {msg.data}"),
            profile,
            event_callbacks=SubscriptionEventCallbacks(incompatible_qos=self.found),
        )

    def found(self, event: QoSRequestedIncompatibleQoSInfo) -> None:
        """Log the policy that a publisher does not offer."""
        policy = qos_policy_name_from_kind(event.last_policy_kind)
        self.get_logger().info(f"A publisher offers less than is requested: {policy}")


def main() -> None:
    """Run both nodes for a second, or until Ctrl-C."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("policy", choices=POLICIES, nargs="?", default="reliability")
    offered, requested = POLICIES[parser.parse_known_args()[0].policy]
    aionode.run(partial(Listener, requested), partial(Talker, offered))


if __name__ == "__main__":
    main()
