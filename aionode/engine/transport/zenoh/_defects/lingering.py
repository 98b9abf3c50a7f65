"""The Zenoh thread that closes a connection waits up to ten seconds for a peer that reads nothing.

Zenoh:
    Zenoh sets SO_LINGER to ten seconds on each TCP socket. If the peer has not read everything,
    `close` waits that long, and with it the Zenoh thread that closes the connection, which may be
    the only one that sends or connects for this process.
Reported:
    No.
Seen in:
    1.8.0, 1.9.0, 1.10.2
Workaround:
    `SocketOptions` switches SO_LINGER off once a connection was made: nothing is lost, as the
    system keeps sending. At the same time it sets the time limit of `blocked_sends`. On Linux only.
"""

from __future__ import annotations

import socket
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Final

import zenoh

from aionode.engine.transport.network import is_near
from aionode.engine.transport.zenoh._defects._switch import is_mended
from aionode.engine.transport.zenoh._defects.blocked_sends import unread_ms
from aionode.engine.transport.zenoh.connections.handlers import direct
from aionode.engine.transport.zenoh.connections.sockets import NO_LINGER, duplicates, find, pair_of

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["SocketOptions"]

UNREACHABLE_MS: Final = 5_000
"""How long sent bytes may stay unacknowledged before a connection to another machine is lost, in
milliseconds."""


class SocketOptions:
    """Sets the options of each connection of a session as soon as it is made.

    Closing one never waits for its peer. One whose peer reads nothing for `unread_ms` is lost
    before the lease ends, as Zenoh could not end it while a thread waits for that peer. One to
    another machine is lost when nothing has arrived there for `UNREACHABLE_MS`: otherwise, TCP
    retransmits after 0.2, 0.4, 0.8 … s, and after a network outage of 30 s it is silent for up to
    30 s more. A new connection finds the network immediately.

    It works until the session is closed.

    Args:
        session: The session.
    """

    def __init__(self, session: zenoh.Session) -> None:
        # It exists as long as this object, which its callback holds until the session is closed.
        self._listener = session.info.declare_link_events_listener(direct(self._on_event))
        # After the listener: a connection in between is handled twice, which is harmless.
        set_options(session.info.links())

    def close(self) -> None:
        """Stop watching."""
        self._listener.undeclare()

    def _on_event(self, event: zenoh.LinkEvent) -> None:
        """Handle a connection that was made or lost, in a Zenoh thread.

        There it takes 0.1 ms; a thread for it took several times as much, in every process of the
        domain whenever another one started.
        """
        if event.kind == zenoh.SampleKind.PUT:
            set_options([event.link])


def set_options(links: Iterable[zenoh.Link]) -> None:
    """Set the options of some connections, as far as the system reveals their sockets."""
    if not sys.platform.startswith("linux"):
        return
    peers = {pair: str(link.dst) for link in links if (pair := pair_of(link))}
    found = {descriptor: peers[pair] for pair, descriptor in find(peers).items()}
    for descriptor, copy in duplicates(found):
        limit_ms = unread_ms() if is_near(found[descriptor]) else UNREACHABLE_MS
        with suppress(OSError):  # it is lost already
            if is_mended("lingering"):
                copy.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, NO_LINGER)
            copy.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, limit_ms)
