"""The base of workarounds that act when a connection is lost or made."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar, Final

import zenoh

from aionode._process.concurrency import running_loop
from aionode._process.later import Later
from aionode.engine.transport.zenoh._defects._switch import is_mended
from aionode.engine.transport.zenoh.connections.config import gossip_endpoints

if TYPE_CHECKING:
    from aionode.engine.transport.network import Network
    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.engine.transport.zenoh.connections.connections import ConnectionChange

__all__ = ["ATTEMPTS", "POSTPONED_S", "ConnectionMend"]

POSTPONED_S: Final = 3.0
"""How long a continuing stream of connection changes may postpone the action, in seconds."""

ATTEMPTS: Final = 4
"""Maximum number of cuts per participant, as some are visible but not reachable."""


class ConnectionMend(ABC):
    """Works around a defect after connections are lost or made, while a session is open.

    It does nothing if the session does not keep dialling endpoints, as a connection that is cut
    would not be re-established. Everything belongs to the event loop, unless stated otherwise.

    Args:
        state: The session state of the context.
        network: The settings of the context, with the endpoints that it dials.

    Attributes:
        defect: The name of the defect, by which the workaround is disabled.
    """

    defect: ClassVar[str]

    def __init__(self, state: SessionState, network: Network) -> None:
        self._state = state
        self._network = network
        self._session: zenoh.Session | None = None
        self._later = Later()
        state.connections.on_change.append(self._hear)

    def start(self, session: zenoh.Session) -> None:
        """Act on the connections of a session from now on."""
        if gossip_endpoints(self._network) and is_mended(self.defect):
            self._session = session

    def stop(self) -> None:
        """Stop acting; work started in a thread ends by itself."""
        self._session = None
        self._later.cancel()

    def _hear(self, change: ConnectionChange) -> None:
        if (
            self._session is not None and change.kind != zenoh.WhatAmI.CLIENT
        ):  # clients reconnect themselves
            self._take_change(change, running_loop().time())

    @abstractmethod
    def _take_change(self, change: ConnectionChange, now_s: float) -> None:
        """Act on a connection to a router or peer."""
