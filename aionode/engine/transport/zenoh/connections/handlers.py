"""Helpers for calls of Zenoh: priorities, error texts, handlers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

import zenoh

from aionode.errors import TransportError

__all__ = [
    "BLOCK",
    "BLOCKING_PRIORITY",
    "BULK_BYTES",
    "BULK_PRIORITY",
    "CALL_PRIORITY",
    "DROP",
    "LOOP_PRIORITY",
    "RETRANSMIT_PRIORITY",
    "direct",
    "reason",
    "translated",
]

# Zenoh has a queue per priority and peer, which is locked while a thread waits for room in it
# (`_defects.blocked_sends`). So messages from the event loop have a queue of their own, in which no
# thread ever waits. Zenoh's default, DATA, is left to Zenoh's own messages and to replies to ROS 2
# nodes; tokens and other declarations are CONTROL.

LOOP_PRIORITY = zenoh.Priority.DATA_HIGH
"""For messages from the event loop, always with congestion control DROP."""

RETRANSMIT_PRIORITY = zenoh.Priority.INTERACTIVE_HIGH
"""For what a broken link did not deliver, sent from a thread per peer with BLOCK."""

CALL_PRIORITY = zenoh.Priority.INTERACTIVE_LOW
"""For requests and their replies, sent with BLOCK."""

BULK_PRIORITY = zenoh.Priority.DATA_LOW
"""For large messages, sent from a thread with DROP; each fragment may wait."""

BULK_BYTES = 60_000
"""Size from which a message is sent from a thread: it takes more than one Zenoh packet."""

BLOCKING_PRIORITY = zenoh.Priority.BACKGROUND
"""For reliable messages to readers that do not acknowledge, sent from threads with BLOCK."""

DROP = zenoh.CongestionControl.DROP
"""Drops a message for which Zenoh's queue has no room, after a moment at most."""

BLOCK = zenoh.CongestionControl.BLOCK
"""Waits for room with the queue locked: only threads may use it."""

T = TypeVar("T")


def reason(error: zenoh.ZError) -> str:
    """Return the text of an error without the position in Zenoh's source."""
    return str(error).partition(" at /")[0]


@contextmanager
def translated(what: str) -> Iterator[None]:
    """Translate Zenoh's errors to `TransportError`, naming the subject."""
    try:
        yield
    except zenoh.ZError as error:
        raise TransportError(f"{what}: {reason(error)}") from error


def direct(
    callback: Callable[[T], None], drop: Callable[[], None] | None = None
) -> zenoh.handlers.Callback[T]:
    """Return a handler that runs in Zenoh's network thread.

    Zenoh's other kind starts a thread for each subscriber and call. `callback` must only pass on:
    while it waits for Python, nothing else arrives.
    """
    return zenoh.handlers.Callback(callback, drop, indirect=False)
