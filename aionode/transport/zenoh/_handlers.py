"""Small things around Zenoh's own calls."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

import zenoh

from aionode.errors import TransportError

__all__ = [
    "BULK_PRIORITY",
    "CALL_PRIORITY",
    "LOOP_PRIORITY",
    "PATIENT_PRIORITY",
    "direct",
    "reason",
    "translated",
]

# Zenoh has a queue for each priority and peer. Who waits for room in one (congestion control BLOCK,
# and for a moment DROP) holds it, and everyone else who wants to put something there waits too, on
# whatever thread. So what the loop sends itself has a queue in which nobody ever waits; Zenoh's
# default, DATA, is left to what Zenoh sends itself and to replies to ROS 2 nodes.

LOOP_PRIORITY = zenoh.Priority.DATA_HIGH
"""Of what the loop's thread puts itself: always with congestion control DROP."""

CALL_PRIORITY = zenoh.Priority.INTERACTIVE_LOW
"""Of requests and their replies, which BLOCK."""

BULK_PRIORITY = zenoh.Priority.DATA_LOW
"""Of large messages, sent from a thread: DROP, but each fragment may wait."""

PATIENT_PRIORITY = zenoh.Priority.BACKGROUND
"""Of what has to arrive at readers that do not acknowledge, sent from threads that BLOCK."""

T = TypeVar("T")


def reason(error: zenoh.ZError) -> str:
    """Return what went wrong, without the place in Zenoh's own source."""
    return str(error).partition(" at /")[0]


@contextmanager
def translated(what: str) -> Iterator[None]:
    """Turn Zenoh's errors into ours, which say what was being done."""
    try:
        yield
    except zenoh.ZError as error:
        raise TransportError(f"{what}: {reason(error)}") from error


def direct(
    callback: Callable[[T], None], drop: Callable[[], None] | None = None
) -> zenoh.handlers.Callback[T]:
    """Return a handler that runs in Zenoh's network thread, for what comes seldom.

    It saves a thread for each entity and each call, and costs some latency where much comes.
    """
    return zenoh.handlers.Callback(callback, drop, indirect=False)
