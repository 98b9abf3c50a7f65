"""A router that answers a query for its admin space may lock its routing table for good.

Zenoh:
    The router holds the lock of its routing table while it answers, and takes the lock once more
    for each reply. With a declaration in between it deadlocks, and no newcomer gets into the system
    any more.
Known as:
    https://github.com/eclipse-zenoh/zenoh/pull/2619
Seen in:
    1.7 (that request), 1.8.0, 1.9.0, 1.10.2
Mend:
    Routers of aionode have no admin space, and aionode asks no router for it:
    `_router_matching` learns from declarations alone.
"""

from __future__ import annotations

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["settings"]


def settings() -> dict[str, object]:
    """Return the settings of routers that mend this."""
    return {"adminspace/enabled": False} if is_mended("admin_space") else {}
