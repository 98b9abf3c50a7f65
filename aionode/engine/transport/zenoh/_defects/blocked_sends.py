"""A send that waits for a peer blocks other sends, and also the end of the peer's lease.

Zenoh:
    Each peer and priority has a queue. A `put` with BLOCK that finds it full waits with the lock
    of the queue held, for up to `wait_before_close`, and every other `put` of that priority to that
    peer waits for the lock, also with DROP, on any thread. When the lease of the peer ends
    meanwhile, the thread of Zenoh that ends the connection waits as well, and with it everything
    that it does for other connections; if the peer returns meanwhile, its new connection may never
    work.
Known as:
    Not reported.
Seen in:
    1.5.1, 1.8.0, 1.9.0, 1.10.2 (`io/zenoh-transport/src/common/pipeline.rs`)
Mend:
    Each kind of sender has a priority of its own (`_handlers`), and the event loop puts with DROP
    only. A blocking send is given up before the lease of 10 s ends: by Zenoh, as `settings` say,
    and on Linux by the system (`SocketOptions` in `lingering`). The threads that send requests and
    replies look at the socket before they send more than Zenoh's queue holds (`_peer_senders`).
    The switch concerns the time limits.
"""

from __future__ import annotations

from typing import Final

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["BLOCK_US", "settings", "unread_ms"]

BLOCK_US: Final = 7_000_000
"""Time for which a blocking send waits for a peer before the connection is ended, in
microseconds."""

UNREAD_MS: Final = BLOCK_US // 1000
"""Time in which a peer reads nothing, though there is something to read, after which a connection
within this machine is lost, in milliseconds; whichever thread waits for the peer."""


def settings() -> dict[str, object]:
    """Return the settings of sessions that mend this."""
    if not is_mended("blocked_sends"):
        return {}
    return {"transport/link/tx/queue/congestion_control/block/wait_before_close": BLOCK_US}


def unread_ms() -> int:
    """Return the TCP_USER_TIMEOUT of a connection within this machine; 0 is that of the system."""
    return UNREAD_MS if is_mended("blocked_sends") else 0
