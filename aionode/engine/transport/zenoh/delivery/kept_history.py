"""Zenoh publishers: a plain one, and one that keeps its last messages for late readers."""

from __future__ import annotations

import zenoh
from zenoh import ext

from aionode.engine.transport.zenoh._defects.heartbeats import miss_detection
from aionode.engine.transport.zenoh.connections.handlers import BLOCK, DROP

__all__ = ["declare_keeping", "declare_plain"]


def declare_plain(
    session: zenoh.Session, key: str, priority: zenoh.Priority, *, reliable: bool, waits: bool
) -> zenoh.Publisher:
    """Declare a publisher that keeps nothing; the arguments are as in `declare_keeping`."""
    return session.declare_publisher(
        key,
        congestion_control=BLOCK if waits else DROP,
        priority=priority,
        reliability=zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT,
        allowed_destination=zenoh.Locality.REMOTE,
    )


def declare_keeping(
    session: zenoh.Session,
    key: str,
    depth: int,
    priority: zenoh.Priority,
    *,
    reliable: bool,
    waits: bool,
    numbered: bool,
) -> ext.AdvancedPublisher:
    """Declare a publisher that keeps its last messages, expired or not, for late readers.

    Args:
        session: The session.
        key: Its key expression.
        depth: Number of messages to keep.
        priority: The Zenoh priority of its messages.
        reliable: Whether no message may be lost on the way.
        waits: Whether it waits for slow readers instead of dropping messages.
        numbered: Whether readers may ask again for what they miss.
    """
    return ext.declare_advanced_publisher(
        session,
        key,
        congestion_control=BLOCK if waits else DROP,
        priority=priority,
        reliability=zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT,
        allowed_destination=zenoh.Locality.REMOTE,
        cache=ext.CacheConfig(max_samples=depth),
        publisher_detection=True,
        # Samples are numbered, so that readers can request what is missing in between.
        sample_miss_detection=miss_detection() if reliable and numbered else None,
    )
