"""A router that answers a query for its admin space may lock its routing table for good.

Zenoh:
    The router holds the lock of its routing table while it answers, and acquires it again for each
    reply. A declaration in between makes it deadlock, and no new session can join the system.
Reported:
    https://github.com/eclipse-zenoh/zenoh/pull/2619
Seen in:
    1.7 (according to that pull request), 1.8.0, 1.9.0, 1.10.2
Workaround:
    aionode's routers have no admin space, and aionode queries that of no router: `router_matching`
    uses only declarations.
"""

from __future__ import annotations

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["settings"]


def settings() -> dict[str, object]:
    """Return router settings that work around this."""
    return {"adminspace/enabled": False} if is_mended("admin_space") else {}
