"""A peer that reconnects to a process that has not noticed the loss receives no declarations.

Zenoh:
    A process that was frozen may accept a new connection while it still reads from the old one.
    Zenoh treats the new one as another link of the same transport, and declares nothing on it: the
    peer never sees a token or a subscription of that process again.
Reported:
    https://github.com/eclipse-zenoh/zenoh/issues/2806
Seen in:
    1.8.0, 1.9.0, 1.10.2
Workaround:
    A participant that uses aionode always has a token. If the tokens of one do not arrive after its
    connection was re-established, `StaleTransports` cuts its connections, so that Zenoh reconnects.
"""

from __future__ import annotations

import logging
import threading
from collections import Counter
from typing import TYPE_CHECKING, Final

from aionode._process.concurrency import running_loop
from aionode.engine.transport.send_thread import start_thread
from aionode.engine.transport.zenoh._defects._connection_mend import (
    ATTEMPTS,
    POSTPONED_S,
    ConnectionMend,
)
from aionode.engine.transport.zenoh.connections.connections import REMEMBERED
from aionode.engine.transport.zenoh.connections.sockets import cut_participants

if TYPE_CHECKING:
    from aionode.engine.transport.network import Network
    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.engine.transport.zenoh.connections.connections import ConnectionChange

__all__ = ["StaleTransports"]

logger = logging.getLogger("aionode.transport.zenoh")

DECLARED_S: Final = 1.0
"""Timeout for the tokens of a participant that has returned, in seconds; they take milliseconds."""

PEERS_PER_SECOND: Final = 20
"""Number of connected peers whose tokens may take a second: all of them may have returned."""

FEW: Final = 3
"""From this number of participants without tokens on, they get more time, as they may be slow."""


class StaleTransports(ConnectionMend):
    """Reconnects participants that have returned, but declare nothing.

    Args:
        state: The session state of the context.
        network: The settings of the context, with the endpoints that it dials.
    """

    defect = "stale_transports"

    def __init__(self, state: SessionState, network: Network) -> None:
        super().__init__(state, network)
        self._changed_s = 0.0  # when a connection was last made or lost
        # Participants whose connection was re-established, until they are known to have declared.
        self._returned: set[str] = set()
        # Number of cuts of the connection to each participant that declared nothing.
        self._cuts: Counter[str] = Counter()

    def stop(self) -> None:
        """Stop acting."""
        super().stop()
        self._cuts.clear()
        self._returned.clear()

    def _take_change(self, change: ConnectionChange, now_s: float) -> None:
        self._changed_s = now_s
        if not change.is_made:
            self._returned.discard(change.zid)
        elif change.is_return:
            self._returned.add(change.zid)
            self._check_in(self._declared_s())

    def _declared_s(self) -> float:
        """Return how long the tokens of a participant that has returned may take."""
        return DECLARED_S * max(len(self._state.connections.kinds) / PEERS_PER_SECOND, 1)

    def _check_in(self, delay_s: float) -> None:
        if not self._later.waits:
            self._later.call(delay_s, self._check_returned)

    def _check_returned(self) -> None:
        """Cut the connections to participants that have returned, but have not declared anything.

        All at once: each cut is itself a change, after which the others would have to wait again.
        """
        session, acknowledgements = self._session, self._state.acknowledgements
        if session is None:
            return
        self._returned &= acknowledgements.participants - acknowledgements.present
        # When many connect at once, tokens take longer, and a cut slows everything down further.
        declared_s = self._declared_s()
        wait_s = declared_s / 2 if len(self._returned) <= FEW else max(POSTPONED_S, declared_s)
        if self._returned and running_loop().time() - self._changed_s < wait_s:
            self._check_in(declared_s / 2)
            return
        silent = {zid for zid in self._returned if self._cuts[zid] < ATTEMPTS}
        # Until they declare: if Zenoh again treats their new connections as links of the old ones,
        # there is no event for it.
        self._returned = silent
        if silent:
            if len(self._cuts) >= REMEMBERED:
                self._cuts.clear()
            self._cuts.update(silent)
            self._check_in(declared_s)
            logger.info(
                "processes %s are connected but declare nothing; cutting their connections, so "
                "that Zenoh reconnects",
                ", ".join(sorted(silent)[:5]),
            )
            start_thread(
                threading.Thread(
                    target=cut_participants, args=(session, silent.copy()), name="aionode-zenoh"
                )
            )
