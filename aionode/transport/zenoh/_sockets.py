"""What Zenoh's sockets do while a peer has stopped reading, or is out of reach.

Zenoh sets SO_LINGER on each of them: closing one whose peer has not taken everything waits for up
to ten seconds, and with it the thread of Zenoh that closes it, which may be the only one that sends
or connects for this process. `SocketOptions` switches that off soon after a connection was made.

In `close`, and in blocking sends, Zenoh waits until such a peer reads on or the connection is lost;
in `close`, also until one has answered that it has just dialled, or that has just dialled. Shutting
the socket down loses the connection at once (zenoh 1.10).

On Linux only: elsewhere all of this takes as long as Zenoh waits.
"""

from __future__ import annotations

import logging
import select
import socket
import struct
import sys
import threading
from contextlib import suppress
from typing import TYPE_CHECKING, ClassVar, Final

import zenoh

from aionode._socket_queue import queued_bytes
from aionode.transport._network import is_near
from aionode.transport._send_thread import start_thread
from aionode.transport.zenoh._descriptors import (
    Descriptor,
    Pair,
    duplicates,
    find,
    pair_of,
    polled_by_zenoh,
)
from aionode.transport.zenoh._handlers import direct
from aionode.transport.zenoh._settings import BLOCK_US

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["SocketOptions", "arrived_bytes", "cut", "cut_stuck", "cut_unanswered", "look"]

logger = logging.getLogger("aionode.transport.zenoh")

INTERNET: Final = {socket.AF_INET, socket.AF_INET6}
"""The families of connections between hosts."""

STUCK_S: Final = 0.1
"""A peer that reads not one byte for so long, while some wait, is not waited for."""

UNREACHABLE_MS: Final = 5_000
"""After so long without any answer to what was sent, a connection to another machine is lost."""

UNREAD_MS: Final = BLOCK_US // 1000
"""After so long in which the peer has read nothing, though there is something to read, a connection
within this machine is lost, whichever thread waits for it."""

RESET: Final = struct.pack("ii", 1, 0)
"""SO_LINGER for a connection that is cut: what was not taken is dropped."""

NO_LINGER: Final = struct.pack("ii", 0, 0)
"""SO_LINGER for all others: closing returns at once, and the system goes on sending."""

ACKED: Final = slice(120, 128)
"""Where ``struct tcp_info`` says how many bytes the peer's system has acknowledged."""

RECEIVED: Final = slice(128, 136)
"""Where it says how many bytes were received."""

ESTABLISHED: Final = 1
"""How its first byte says that both ends are connected."""

FIRST_BYTES: Final = 2048
"""Zenoh sends 34 bytes before it waits for an answer, and TLS less than this."""

ZENOH_LINGER: Final = struct.pack("ii", 1, 10)
"""SO_LINGER as Zenoh sets it."""

SETTLE_S: Final = 0.5
"""How long after a new connection its socket is looked for; several are made at once."""


def waiting_bytes(session: zenoh.Session) -> dict[Descriptor, int]:
    """Return how many bytes wait in each socket of a session; not those with none."""
    own = find({pair for link in session.info.links() if (pair := pair_of(link))})
    waiting = {descriptor: queued_bytes(one) for descriptor, one in duplicates(own.values())}
    return {descriptor: size for descriptor, size in waiting.items() if size}


def info_of(one: socket.socket) -> bytes:
    """Return the beginning of the ``struct tcp_info`` of a connection."""
    return one.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, RECEIVED.stop)


def number_in(info: bytes, field: slice) -> int:
    """Return one of its numbers."""
    return int.from_bytes(info[field], sys.byteorder)


def unanswered() -> set[Descriptor]:
    """Return the sockets of connections that Zenoh is making with peers that do not answer.

    Of all sessions of the process: the system does not tell them apart.
    """
    return {descriptor for descriptor, one in duplicates(polled_by_zenoh()) if is_unanswered(one)}


def is_unanswered(one: socket.socket) -> bool:
    """Return whether a socket has the options of Zenoh, is connected, and has received nothing."""
    if one.type != socket.SOCK_STREAM or one.family not in INTERNET:
        return False
    if one.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8) != ZENOH_LINGER:
        return False
    info = info_of(one)
    sent = number_in(info, ACKED) + queued_bytes(one)
    return info[0] == ESTABLISHED and not number_in(info, RECEIVED) and sent <= FIRST_BYTES


def arrived_bytes(session: zenoh.Session) -> dict[str, tuple[int, int]]:
    """Return how many bytes have come from each peer, and how many of them Zenoh has not read yet.

    Nothing where the system does not tell.
    """
    if not sys.platform.startswith("linux"):
        return {}
    import fcntl
    import termios

    peers = {pair: str(link.dst) for link in session.info.links() if (pair := pair_of(link))}
    own = {descriptor: peers[pair] for pair, descriptor in find(peers).items()}
    arrived = {}
    for descriptor, one in duplicates(own):
        unread = fcntl.ioctl(one, termios.FIONREAD, bytes(4))
        arrived[own[descriptor]] = (
            number_in(info_of(one), RECEIVED),
            int.from_bytes(unread, sys.byteorder),
        )
    return arrived


def look(session: zenoh.Session, participant: str) -> tuple[bool, int] | None:
    """Return whether the socket to a peer has room, and how many bytes were written to it so far.

    None if there is no such socket, or the system does not tell.
    """
    if not sys.platform.startswith("linux"):
        return None
    links = [link for link in session.info.links() if str(link.zid) == participant]
    for _, one in duplicates(find({pair for link in links if (pair := pair_of(link))}).values()):
        poll = select.poll()
        poll.register(one, select.POLLOUT)
        return bool(poll.poll(0)), number_in(info_of(one), ACKED) + queued_bytes(one)
    return None


class SocketOptions:
    """Sets the options of each connection of a session, soon after it was made.

    Closing one never waits for its peer. One whose peer reads nothing for `UNREAD_MS` is lost
    before the lease ends, as Zenoh could not end it while a thread waits for that peer. One to
    another machine is lost when nothing has arrived there for `UNREACHABLE_MS`: otherwise, TCP
    sends again after 0.2, 0.4, 0.8 … s, and when a network was gone for 30 s, and is back, it is
    silent for up to 30 s more. A new connection finds the network at once.

    It works until the session is closed. The connections of a burst are looked for at once.

    Args:
        session: The session.
    """

    # Of all sessions: those of one process are often connected with each other at the same time.
    _lock: ClassVar = threading.Lock()
    # The connections whose options are not set yet, and what Zenoh has named their peers.
    _new: ClassVar[dict[Pair, str]] = {}

    def __init__(self, session: zenoh.Session) -> None:
        self._timer: threading.Timer | None = None
        self._closed = not sys.platform.startswith("linux")
        # It exists as long as this does, which its callback holds until the session is closed.
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
        """Handle a connection that was made or lost; in a thread of Zenoh."""
        if event.kind != zenoh.SampleKind.PUT:
            return
        with self._lock:
            if self._closed:
                return
            if pair := pair_of(event.link):
                self._new[pair] = str(event.link.dst)
            if self._timer is None:
                self._timer = threading.Timer(SETTLE_S, self._set)
                self._timer.name = "aionode-zenoh"
                self._timer.daemon = True
                start_thread(self._timer)

    def _set(self) -> None:
        """Set the options of all new connections; in the thread of the timer."""
        with self._lock:
            self._timer = None
            new = self._new.copy()
            self._new.clear()
        peers = {descriptor: new[pair] for pair, descriptor in find(new).items()}
        for descriptor, one in duplicates(peers):
            limit_ms = UNREAD_MS if is_near(peers[descriptor]) else UNREACHABLE_MS
            with suppress(OSError):  # it is lost already
                one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, NO_LINGER)
                one.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, limit_ms)


def cut(those: Iterable[Descriptor], linger: bytes = NO_LINGER) -> None:
    """Cut connections, as the network would.

    Args:
        those: The sockets of Zenoh.
        linger: `RESET` if the peer is not to get what has been sent.
    """
    for _, one in duplicates(those):
        with suppress(OSError):  # it is lost already
            logger.debug("%s: the connection is cut", one.getpeername())
            one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, linger)
            one.shutdown(socket.SHUT_RDWR)


def cut_unanswered(done: threading.Event) -> None:
    """Cut connections that are being made with peers that do not answer, until `done` is set.

    A session that is being closed waits for each of them, for ten seconds, and dials those that it
    has lost again meanwhile. Runs in a thread.
    """
    silent: set[Descriptor] = set()
    while sys.platform.startswith("linux") and not done.wait(STUCK_S):
        before, silent = silent, unanswered()
        cut(before & silent, RESET)


def cut_stuck(session: zenoh.Session) -> None:
    """Cut connections that a session about to be closed would wait for.

    Those whose peers do not read, and those that are being made with peers that do not answer. Runs
    in a thread.
    """
    if not sys.platform.startswith("linux"):
        return
    before, silent = waiting_bytes(session), unanswered()
    if not before and not silent:
        return
    threading.Event().wait(STUCK_S)
    after = waiting_bytes(session)
    stuck = {descriptor for descriptor, size in before.items() if after.get(descriptor, 0) >= size}
    cut(stuck | (silent & unanswered()), RESET)
