"""Compatibility of offered and requested profiles."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import Enum, IntEnum
from typing import Any, TypeVar

from msgspec import Struct

from aionode.clock import Duration
from aionode.qos._profile import (
    DeadlineBestAvailable,
    DurabilityPolicy,
    LivelinessPolicy,
    QoSPolicyEnum,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
    duration_text,
    is_unlimited,
)

__all__ = [
    "Incompatibility",
    "QoSCompatibility",
    "best_available_for_publisher",
    "best_available_for_subscription",
    "incompatibilities",
    "incompatible_qos_text",
    "mismatch",
    "qos_check_compatible",
]

PolicyT = TypeVar("PolicyT", bound="QoSPolicyEnum")

# Compatibility


class Incompatibility(Struct, frozen=True):
    """A policy in which an offer is weaker than a request.

    Attributes:
        kind: The policy.
        reason: The policy with both values, in words.
    """

    kind: QoSPolicyKind
    reason: str


def incompatibilities(offered: QoSProfile, requested: QoSProfile) -> list[Incompatibility]:
    """Return the policies in which `offered` (by a publisher) is weaker than `requested`."""
    offer, request = offered.resolved(), requested.resolved()
    refusals = []
    for name, kind, weak, strong in (
        (
            "reliability",
            QoSPolicyKind.RELIABILITY,
            ReliabilityPolicy.BEST_EFFORT,
            ReliabilityPolicy.RELIABLE,
        ),
        (
            "durability",
            QoSPolicyKind.DURABILITY,
            DurabilityPolicy.VOLATILE,
            DurabilityPolicy.TRANSIENT_LOCAL,
        ),
        (
            "liveliness",
            QoSPolicyKind.LIVELINESS,
            LivelinessPolicy.AUTOMATIC,
            LivelinessPolicy.MANUAL_BY_TOPIC,
        ),
    ):
        if getattr(offer, name) is weak and getattr(request, name) is strong:
            reason = f"{name}: offered {weak.short_key}, requested {strong.short_key}"
            refusals.append(Incompatibility(kind, reason))
    for name, kind in (
        ("deadline", QoSPolicyKind.DEADLINE),
        ("liveliness_lease_duration", QoSPolicyKind.LIVELINESS),  # rmw has no separate kind
    ):
        slow, fast = getattr(offer, name), getattr(request, name)
        if slow > fast and DeadlineBestAvailable not in {slow, fast}:
            reason = f"{name}: offered {duration_text(slow)}, requested {duration_text(fast)}"
            refusals.append(Incompatibility(kind, reason))
    return refusals


def mismatch(offered: QoSProfile, requested: QoSProfile) -> str | None:
    """Return why `offered` does not satisfy `requested`, or None if it does."""
    return "; ".join(refusal.reason for refusal in incompatibilities(offered, requested)) or None


def incompatible_qos_text(topic: str, kind: QoSPolicyKind, *, publisher: bool) -> str:
    """Return the warning about a newly discovered, incompatible publisher or subscription.

    Args:
        topic: Name of the topic.
        kind: The last incompatible policy: ``incompatibilities(…)[-1].kind``.
        publisher: Whether a publisher was discovered; the warning is then for a subscription.
    """
    if publisher:
        what, verb, effect = "publisher", "offering", "received from it"
    else:
        what, verb, effect = "subscription", "requesting", "sent to it"
    return (
        f"New {what} discovered on topic '{topic}', {verb} incompatible QoS. "
        f"No messages will be {effect}. Last incompatible policy: {kind.name}"
    )


class QoSCompatibility(IntEnum):
    """Whether two profiles are compatible; WARNING if that depends on defaults."""

    OK = 0
    WARNING = 1
    ERROR = 2

    __str__ = Enum.__str__  # as rclpy prints it: QoSCompatibility.OK


def qos_check_compatible(
    publisher_qos: QoSProfile, subscription_qos: QoSProfile
) -> tuple[QoSCompatibility, str]:
    """Return whether two profiles are compatible, with the reasons for a warning or an error.

    WARNING means that a policy is left to the system or unknown, so the outcome depends on the
    implementation at the other end.
    """
    decided = [
        qos.replace(
            reliability=undecided(qos.reliability, ReliabilityPolicy.UNKNOWN),
            durability=undecided(qos.durability, DurabilityPolicy.UNKNOWN),
            liveliness=undecided(qos.liveliness, LivelinessPolicy.UNKNOWN),
        )
        for qos in (publisher_qos, subscription_qos)
    ]
    errors = [f"ERROR: {refusal.reason};" for refusal in incompatibilities(*decided)]
    if errors:
        return QoSCompatibility.ERROR, "".join(errors)
    doubts = [
        f"WARNING: {name}: offered {getattr(publisher_qos, name).short_key}, "
        f"requested {getattr(subscription_qos, name).short_key};"
        for name, weak, strong in (
            ("reliability", ReliabilityPolicy.BEST_EFFORT, ReliabilityPolicy.RELIABLE),
            ("durability", DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL),
            ("liveliness", LivelinessPolicy.AUTOMATIC, LivelinessPolicy.MANUAL_BY_TOPIC),
        )
        if is_doubtful(getattr(decided[0], name), getattr(decided[1], name), weak, strong)
    ]
    if doubts:
        return QoSCompatibility.WARNING, "".join(doubts)
    return QoSCompatibility.OK, ""


def undecided(value: PolicyT, unknown: PolicyT) -> PolicyT:
    """Return `unknown` for SYSTEM_DEFAULT, else the value."""
    return value or unknown


def is_doubtful(
    offered: QoSPolicyEnum, requested: QoSPolicyEnum, weak: QoSPolicyEnum, strong: QoSPolicyEnum
) -> bool:
    """Return whether an unknown value could make the pair incompatible."""
    offer_unknown, request_unknown = offered.name == "UNKNOWN", requested.name == "UNKNOWN"
    return (
        (offer_unknown and request_unknown)
        or (offer_unknown and requested is strong)
        or (offered is weak and request_unknown)
    )


# Best available


def best_available_for_subscription(
    profile: QoSProfile, publishers: Iterable[QoSProfile]
) -> QoSProfile:
    """Replace BEST_AVAILABLE by the strongest policies that all publishers offer.

    Without publishers these are the strongest policies that exist.
    """
    others = [other.resolved() for other in publishers]

    def pick(name: str, strong: PolicyT, weak: PolicyT) -> PolicyT:
        return strong if all(getattr(other, name) is strong for other in others) else weak

    def widest(limits: list[Duration]) -> Duration:
        # rmw ignores publishers without a limit, and would then be incompatible with them.
        return Duration() if any(map(is_unlimited, limits)) else max(limits, default=Duration())

    return resolve_best_available(profile, pick, widest, others)


def best_available_for_publisher(
    profile: QoSProfile, subscriptions: Iterable[QoSProfile]
) -> QoSProfile:
    """Replace BEST_AVAILABLE by policies that satisfy all subscriptions.

    A publisher can always be reliable and transient local. It offers manual liveliness, a deadline
    or a lease duration only if a subscription requests it.
    """
    others = [other.resolved() for other in subscriptions]

    def pick(name: str, strong: PolicyT, weak: PolicyT) -> PolicyT:
        if name != "liveliness" or any(getattr(other, name) is strong for other in others):
            return strong
        return weak

    def tightest(limits: list[Duration]) -> Duration:
        return min((limit for limit in limits if not is_unlimited(limit)), default=Duration())

    return resolve_best_available(profile, pick, tightest, others)


def resolve_best_available(
    profile: QoSProfile,
    pick: Callable[[str, Any, Any], QoSPolicyEnum],
    limit: Callable[[list[Duration]], Duration],
    others: list[QoSProfile],
) -> QoSProfile:
    """Replace BEST_AVAILABLE by what `pick` and `limit` choose."""
    changes: dict[str, object] = {}
    for name, strong, weak in (
        ("reliability", ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT),
        ("durability", DurabilityPolicy.TRANSIENT_LOCAL, DurabilityPolicy.VOLATILE),
        ("liveliness", LivelinessPolicy.MANUAL_BY_TOPIC, LivelinessPolicy.AUTOMATIC),
    ):
        if getattr(profile, name).name == "BEST_AVAILABLE":
            changes[name] = pick(name, strong, weak)
    for name in ("deadline", "liveliness_lease_duration"):
        if getattr(profile, name) == DeadlineBestAvailable:
            changes[name] = limit([getattr(other, name) for other in others])
    return profile.replace(**changes)
