"""A connection is reported before the session uses it.

Zenoh:
    Listeners of transports are told of a new one before the session routes anything over it. A
    query for tokens is answered at once, without those of the new peer: on a busy machine, one in
    fifty contexts opened without knowing the endpoints of a peer that was there before. Its
    transient local subscriptions then asked for the history too early.
Reported:
    No.
Seen in:
    1.9.0, 1.10.2
Workaround:
    A connection counts once its link is reported, which happens after that: `Connections.take`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.engine.transport.zenoh._defects._switch import is_mended

if TYPE_CHECKING:
    import zenoh

__all__ = ["waits_for_link"]


def waits_for_link(transport: zenoh.Transport) -> bool:
    """Return whether a new connection counts only once its link is reported as well."""
    return not transport.is_multicast and is_mended("early_connections")
