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
    `SocketOptions` switches SO_LINGER off soon after a connection was made: nothing is lost, as the
    system keeps sending. At the same time it sets the time limit of `blocked_sends`. On Linux only.
"""

from __future__ import annotations

import socket
import sys
import threading
from contextlib import suppress
from typing import TYPE_CHECKING, ClassVar, Final

import zenoh

from aionode.engine.transport.network import is_near
from aionode.engine.transport.send_thread import start_thread
from aionode.engine.transport.zenoh._defects._switch import is_mended
from aionode.engine.transport.zenoh._defects.blocked_sends import unread_ms
from aionode.engine.transport.zenoh.connections.handlers import direct
from aionode.engine.transport.zenoh.connections.sockets import (
    NO_LINGER,
    duplicates,
    find,
    numbers,
    pair_of,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    from aionode.engine.transport.zenoh.connections.sockets import Descriptor, Pair

__all__ = ["SocketOptions", "stop_lingering"]

UNREACHABLE_MS: Final = 5_000
"""How long sent bytes may stay unacknowledged before a connection to another machine is lost, in
milliseconds."""

SETTLE_S: Final = 0.5
"""Delay before looking for the sockets of several new connections, in seconds."""

FEW: Final = 200
"""Up to this many descriptors of a process, the socket of a single connection is looked for at
once, in 0.1 ms: a thread for it takes several times as much, in every process of the domain
whenever another one starts. With more of them, a process of many contexts would look through all
for each of hundreds of connections."""


class SocketOptions:
    """Sets the options of each connection of a session, soon after it was made.

    Closing one never waits for its peer. One whose peer reads nothing for `unread_ms` is lost
    before the lease ends, as Zenoh could not end it while a thread waits for that peer. One to
    another machine is lost when nothing has arrived there for `UNREACHABLE_MS`: otherwise, TCP
    retransmits after 0.2, 0.4, 0.8 … s, and after a network outage of 30 s it is silent for up to
    30 s more. A new connection finds the network immediately.

    It works until the session is closed. The first connections are looked for together, as are
    all in a process with many descriptors.

    Args:
        session: The session.
    """

    # Shared by all sessions, as those of one process are often connected with each other. Zenoh's
    # threads, the timer's and the loop hold it to use `_new`, `_timer` and `_closed`; nothing
    # blocks meanwhile.
    _lock: ClassVar = threading.Lock()
    # Connections whose options are not set yet, and Zenoh's names of their peers.
    _new: ClassVar[dict[Pair, str]] = {}

    def __init__(self, session: zenoh.Session) -> None:
        self._timer: threading.Timer | None = None
        self._is_new = True
        self._closed = not sys.platform.startswith("linux")
        # It exists as long as this object, which its callback holds until the session is closed.
        self._listener = session.info.declare_link_events_listener(
            direct(self._on_event), history=True
        )

    def close(self) -> None:
        """Stop watching."""
        with self._lock:
            self._closed = True
            if self._timer is not None:
                self._timer.cancel()
        self._listener.undeclare()

    def _on_event(self, event: zenoh.LinkEvent) -> None:
        """Handle a connection that was made or lost, in a Zenoh thread."""
        if event.kind != zenoh.SampleKind.PUT:
            return
        with self._lock:
            if self._closed:
                return
            if pair := pair_of(event.link):
                self._new[pair] = str(event.link.dst)
            is_first, self._is_new = self._is_new, False
            if self._timer is not None:
                return
            if is_first or len(numbers()) > FEW:
                self._timer = threading.Timer(SETTLE_S, self._set_later)
                self._timer.name = "aionode-zenoh"
                self._timer.daemon = True
                start_thread(self._timer)
                return
        self._set()

    def _set_later(self) -> None:
        """Set the options of several connections, in the timer's thread."""
        with self._lock:
            self._timer = None
        self._set()

    def _set(self) -> None:
        """Set the options of all new connections."""
        with self._lock:
            new = self._new.copy()
            self._new.clear()
        peers = {descriptor: new[pair] for pair, descriptor in find(new).items()}
        stop_lingering(peers)
        for descriptor, copy in duplicates(peers):
            limit_ms = unread_ms() if is_near(peers[descriptor]) else UNREACHABLE_MS
            with suppress(OSError):  # it is lost already
                copy.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, limit_ms)


def stop_lingering(those: Iterable[Descriptor]) -> None:
    """Let nothing wait for the peers when some connections are closed."""
    if is_mended("lingering"):
        for _, copy in duplicates(those):
            with suppress(OSError):  # it is lost already
                copy.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, NO_LINGER)
