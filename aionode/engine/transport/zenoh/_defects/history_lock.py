"""A late reader that reads nothing stops the publisher whose history it has asked for.

Zenoh:
    An AdvancedPublisher answers a query for its history with the cache locked, and with BLOCK. A
    `put`, which adds to the cache, waits until the reader has read the answer or is cut: one query
    of a member that read nothing stopped the event loop for 7 s.
Known as:
    https://github.com/eclipse-zenoh/zenoh/issues/1656
Seen in:
    1.5.1, 1.7.2, 1.8.0, 1.9.0, 1.10.2
Mend:
    Each transient local publisher puts from a thread of its own, of which at most so many messages
    wait as fit into a queue: `ZenohSender` in `endpoints/sender.py`.
"""

from __future__ import annotations

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["needs_thread"]


def needs_thread(*, is_transient: bool) -> bool:
    """Return whether a publisher that keeps a history for late readers, or none, needs a thread."""
    return is_transient and is_mended("history_lock")
