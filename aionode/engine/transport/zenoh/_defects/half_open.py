"""A connection that is given up at the wrong moment stays for good, and is never read.

Zenoh:
    When `open_timeout` or `accept_timeout` is over, Zenoh cancels what makes a connection, wherever
    it is. Between the moment in which the connection is registered and the one in which its
    receiving task starts, that leaves a connection which is sent on and kept alive, but never read.
    The process sees no token of that peer, has no lease that could end, and the peer refuses every
    further connection with MAX_LINKS.
Known as:
    Not reported.
Seen in:
    1.8.0, 1.9.0, 1.10.2
Mend:
    Both timeouts are longer than connecting takes where many processes start at once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from aionode.engine.transport.zenoh._defects._switch import is_mended

if TYPE_CHECKING:
    from aionode.engine.transport.network import Network

__all__ = ["settings"]

OPEN_MS: Final = 30_000
"""Limit of the time that making a connection takes, in milliseconds."""

FAR_OPEN_MS: Final = 3_000
"""The limit where other machines may be dialled: `close` waits for one that is switched off."""


def settings(network: Network) -> dict[str, object]:
    """Return the settings of sessions that mend this."""
    if not is_mended("half_open"):
        return {}
    return {
        "transport/unicast/open_timeout": FAR_OPEN_MS if network.may_reach_far else OPEN_MS,
        "transport/unicast/accept_timeout": OPEN_MS,
    }
