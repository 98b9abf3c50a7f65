"""A router that answers a query for its admin space may lock its routing table for good.

Zenoh:
    The router holds the lock of its routing table while it answers, and takes the lock again for
    each reply. With a declaration in between it deadlocks, and no newcomers can join the system any
    more.
Known as:
    https://github.com/eclipse-zenoh/zenoh/pull/2619
Seen in:
    1.7 (that request), 1.8.0, 1.9.0, 1.10.2
Mend:
    aionode's routers have no admin space, and aionode does not query a router's: `router_matching`
    uses only declarations.
"""

from __future__ import annotations

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["settings"]


def settings() -> dict[str, object]:
    """Return router settings that work around this."""
    return {"adminspace/enabled": False} if is_mended("admin_space") else {}
