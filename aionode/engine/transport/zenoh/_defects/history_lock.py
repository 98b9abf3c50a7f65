"""A late reader that reads nothing blocks the publisher whose history it has requested.

Zenoh:
    An AdvancedPublisher locks its cache while it answers a query for its history, and sends with
    BLOCK. A `put`, which adds to the cache, waits until the reader has read the answer or is cut
    off: one query of a process that read nothing blocked the event loop for 7 s.
Reported:
    https://github.com/eclipse-zenoh/zenoh/issues/1656
Seen in:
    1.5.1, 1.7.2, 1.8.0, 1.9.0, 1.10.2
Workaround:
    Each transient local publisher sends from a thread of its own, for which messages wait in a
    bounded queue: `ZenohSender` in `endpoints/sender.py`.
"""

from __future__ import annotations

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["needs_thread"]


def needs_thread(*, is_transient: bool) -> bool:
    """Return whether a publisher needs a thread, given whether it keeps a history."""
    return is_transient and is_mended("history_lock")
