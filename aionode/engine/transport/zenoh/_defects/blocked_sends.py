"""A send that waits for a peer blocks other sends, and also the end of the peer's lease.

Zenoh:
    Each peer and priority has a queue. A `put` with BLOCK that finds it full holds the lock of the
    queue while it waits, for up to `wait_before_close`, and every other `put` of that priority to
    that peer waits for the lock, on any thread, even with DROP. If the lease of the peer ends
    meanwhile, the Zenoh thread that ends the connection waits as well, and with it everything that
    it does for other connections; if the peer returns meanwhile, its new connection may never work.
Reported:
    No.
Seen in:
    1.5.1, 1.8.0, 1.9.0, 1.10.2 (`io/zenoh-transport/src/common/pipeline.rs`)
Workaround:
    Each kind of sender has a priority of its own (`handlers`), and the event loop puts only with
    DROP. A blocking send is given up before the lease of 10 s ends: by Zenoh, due to `settings`,
    and on Linux by the system (`SocketOptions` in `lingering`). The threads that send requests and
    replies check the socket before they send more than Zenoh's queue holds (`peer_senders`).
    Only the time limits can be disabled.
"""

from __future__ import annotations

from typing import Final

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["BLOCK_US", "settings", "unread_ms"]

BLOCK_US: Final = 7_000_000
"""How long a blocking send waits for a peer before Zenoh ends the connection, in microseconds."""

UNREAD_MS: Final = BLOCK_US // 1000
"""How long a peer on this machine may leave pending bytes unread before the system ends the
connection, in milliseconds, whichever thread waits for the peer."""


def settings() -> dict[str, object]:
    """Return session settings that work around this."""
    if not is_mended("blocked_sends"):
        return {}
    return {"transport/link/tx/queue/congestion_control/block/wait_before_close": BLOCK_US}


def unread_ms() -> int:
    """Return the TCP_USER_TIMEOUT of connections within this machine; 0 is the system's default."""
    return UNREAD_MS if is_mended("blocked_sends") else 0
