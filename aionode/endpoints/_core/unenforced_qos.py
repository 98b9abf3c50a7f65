"""QoS policies that are accepted and announced to others, but have no effect here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.qos import DeadlineBestAvailable, LivelinessPolicy, is_unlimited
from aionode.qos._profile import duration_text

if TYPE_CHECKING:
    from aionode.clock import Duration
    from aionode.qos import QoSProfile

__all__ = ["policies_without_effect"]


def policies_without_effect(profile: QoSProfile, *, sends: bool) -> list[str]:
    """Return the policies of `profile` that are not enforced, such as ``deadline=1 s``.

    Args:
        profile: What the user asked for.
        sends: Whether the endpoint is a publisher, which lifespan applies to.
    """
    policies = [f"{name}={duration_text(value)}" for name, value in durations(profile, sends=sends)]
    if profile.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC:
        policies.append("liveliness=manual_by_topic")
    return policies


def durations(profile: QoSProfile, *, sends: bool) -> list[tuple[str, Duration]]:
    """Return the durations of `profile` that the user has set."""
    given = [
        ("deadline", profile.deadline),
        ("liveliness_lease_duration", profile.liveliness_lease_duration),
    ]
    if sends:
        given.append(("lifespan", profile.lifespan))
    return [
        (name, value)
        for name, value in given
        if not is_unlimited(value) and value != DeadlineBestAvailable
    ]
