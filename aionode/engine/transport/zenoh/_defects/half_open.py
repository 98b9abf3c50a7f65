"""A connection that is given up at the wrong moment stays for good, and is never read.

Zenoh:
    When `open_timeout` or `accept_timeout` expires, Zenoh cancels the task that makes a connection,
    wherever it is. If the connection is already registered but its receiving task has not started,
    that leaves a connection on which Zenoh sends and keeps alive, but never reads. The process sees
    no token of that peer and has no lease that could end, and the peer refuses every further
    connection with MAX_LINKS.
Reported:
    No.
Seen in:
    1.8.0, 1.9.0, 1.10.2
Workaround:
    Both timeouts are longer than connecting takes when many processes start at once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from aionode.engine.transport.zenoh._defects._switch import is_mended

if TYPE_CHECKING:
    from aionode.engine.transport.network import Network

__all__ = ["settings"]

OPEN_MS: Final = 30_000
"""How long making a connection may take, in milliseconds."""

FAR_OPEN_MS: Final = 3_000
"""The limit if other machines may be dialled: `close` waits for one that is switched off."""


def settings(network: Network) -> dict[str, object]:
    """Return session settings that work around this."""
    if not is_mended("half_open"):
        return {}
    return {
        "transport/unicast/open_timeout": FAR_OPEN_MS if network.may_reach_far else OPEN_MS,
        "transport/unicast/accept_timeout": OPEN_MS,
    }
