"""A lost connection is dialled again before its transport is closed, and may be lost for good.

Zenoh:
    When a link to a configured endpoint is lost, Zenoh dials the endpoint again before it closes
    the transport of that link. If the peer answers soon enough, the new link becomes one of the old
    transport, which is then closed with it, perhaps twice: the second time, Zenoh forgets the
    transport that has taken its place. Its connection stays open, but the session neither uses it
    nor dials again. At best, the new link is refused, and dialled again after a delay.
Reported:
    No.
Seen in:
    1.10.2
Workaround:
    Zenoh dials again this early only if the configured endpoint equals the address of the lost
    link; otherwise it does so after the transport was closed. Each endpoint gets a setting of its
    own, with the value that it has anyway, so that it equals no address. Endpoints of
    configuration files and overrides stay as they are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.engine.transport.zenoh._defects._switch import is_mended

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["dialled"]


def dialled(endpoints: Iterable[str], first_retry_ms: int) -> list[str]:
    """Return the endpoints in a form in which Zenoh redials them only after closing a transport.

    Args:
        endpoints: The endpoints that a session or router keeps dialling.
        first_retry_ms: The session's `connect/retry/period_init_ms`, in milliseconds.
    """
    if not is_mended("early_redial"):
        return list(endpoints)
    return [
        endpoint if "#" in endpoint else f"{endpoint}#retry_period_init_ms={first_retry_ms}"
        for endpoint in endpoints
    ]
