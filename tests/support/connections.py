"""Reports of connections that only a test makes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import zenoh  # noqa: TID251  # tells of connections, as Zenoh does

from aionode.engine.transport.zenoh.connections.connections import Connections

__all__ = ["tell", "tell_early"]


def tell(
    connections: Connections, zid: str, kind: zenoh.WhatAmI = zenoh.WhatAmI.PEER, *, is_made: bool
) -> None:
    """Have Zenoh report a connection, and its link."""
    tell_early(connections, zid, kind, is_made=is_made)
    if is_made:
        connections.take(zid)


def tell_early(
    connections: Connections, zid: str, kind: zenoh.WhatAmI = zenoh.WhatAmI.PEER, *, is_made: bool
) -> None:
    """Have Zenoh report a connection, and not its link yet."""
    transport = SimpleNamespace(zid=zid, whatami=kind, is_multicast=False)
    event_kind = zenoh.SampleKind.PUT if is_made else zenoh.SampleKind.DELETE
    event: Any = SimpleNamespace(kind=event_kind, transport=transport)
    connections.take(event)
