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

import asyncio
import logging
import os
import select
import socket
import struct
import sys
import threading
from contextlib import ExitStack, suppress
from stat import S_ISSOCK
from typing import TYPE_CHECKING, ClassVar, Final

import zenoh

from aionode.transport._send_thread import start_thread
from aionode.transport._zenoh_config import BLOCK_US, is_near
from aionode.transport.zenoh._handlers import direct

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["SocketOptions", "arrived_bytes", "cut_stuck", "look"]

logger = logging.getLogger("aionode.transport.zenoh")

DESCRIPTORS: Final = "/proc/self/fd"

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

NOTHING: Final = bytes(8)
"""What is there as long as nothing was."""

ZENOH_LINGER: Final = struct.pack("ii", 1, 10)
"""SO_LINGER as Zenoh sets it."""

SETTLE_S: Final = 0.5
"""How long after a new connection its socket is looked for; several are made at once."""


Descriptor = tuple[int, int]
"""A descriptor and its inode, as its number is used again."""


def sockets(known: set[Descriptor] | None = None) -> Iterator[Descriptor]:
    """Yield the sockets of this process; not those in `known`, from which closed ones are removed.

    Args:
        known: Descriptors that need not be looked at; those of other kinds are added.
    """
    skipped = set() if known is None else known.copy()
    if known is not None:
        known.clear()
    try:
        names = os.listdir(DESCRIPTORS)  # noqa: PTH208 - in half the time
    except OSError:  # the process has no descriptor left
        return
    for name in names:
        with suppress(OSError):  # closed meanwhile
            status = os.fstat(int(name))
            descriptor = int(name), status.st_ino
            if descriptor not in skipped and S_ISSOCK(status.st_mode):
                yield descriptor
            elif known is not None:
                known.add(descriptor)


def connection(descriptor: Descriptor, stack: ExitStack) -> tuple[str, socket.socket] | None:
    """Return a duplicate of a TCP socket, and the address of its peer, empty if it has none."""
    with suppress(OSError):  # closed meanwhile
        one = stack.enter_context(socket.socket(fileno=os.dup(descriptor[0])))
        if one.type == socket.SOCK_STREAM and one.family in INTERNET:
            with suppress(OSError):  # it listens, or is not connected yet, or not any more
                host, port = one.getpeername()[:2]
                return f"[{host}]:{port}" if ":" in host else f"{host}:{port}", one
            return "", one
    return None


def connections() -> Iterator[tuple[str, socket.socket]]:
    """Yield the TCP connections of this process, each with the address of its peer.

    One duplicate is open at a time: several threads that duplicate all sockets, and the duplicates
    of each other, soon have all descriptors that a process may have.
    """
    for descriptor in sockets():
        with ExitStack() as stack:
            peer, one = connection(descriptor, stack) or ("", None)
            if one is not None and peer:
                yield peer, one


def queued_bytes(one: socket.socket) -> int:
    """Return how many bytes wait in a socket; 0 where the system does not tell."""
    try:
        import fcntl
        import termios
    except ImportError:  # Windows
        return 0
    return int.from_bytes(fcntl.ioctl(one, termios.TIOCOUTQ, bytes(4)), sys.byteorder)


def waiting_bytes(session: zenoh.Session) -> dict[str, int]:
    """Return how many bytes wait in the socket of each peer of a session; not those with none."""
    peers = {address_of(link) for link in session.info.links()}
    waiting = {peer: queued_bytes(one) for peer, one in connections() if peer in peers}
    return {peer: size for peer, size in waiting.items() if size}


def address_of(link: zenoh.Link) -> str:
    """Return the address of the peer, such as ``127.0.0.1:7447``."""
    return str(link.dst).partition("/")[2].partition("?")[0]


def unanswered() -> set[str]:
    """Return the peers with which Zenoh has a connection on which nothing was received."""
    return {
        peer
        for peer, one in connections()
        if one.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8) == ZENOH_LINGER
        and one.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, RECEIVED.stop)[RECEIVED] == NOTHING
    }


def arrived_bytes(session: zenoh.Session) -> dict[str, tuple[int, int]]:
    """Return how many bytes have come from each peer, and how many of them Zenoh has not read yet.

    Nothing where the system does not tell.
    """
    if not sys.platform.startswith("linux"):
        return {}
    import fcntl
    import termios

    peers = {address_of(link) for link in session.info.links()}
    found = {}
    for peer, one in connections():
        if peer in peers:
            info = one.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, RECEIVED.stop)
            received = int.from_bytes(info[RECEIVED], sys.byteorder)
            unread = fcntl.ioctl(one, termios.FIONREAD, bytes(4))
            found[peer] = received, int.from_bytes(unread, sys.byteorder)
    return found


def look(session: zenoh.Session, participant: str) -> tuple[bool, int] | None:
    """Return whether the socket to a peer has room, and how many bytes were written to it so far.

    None if there is no such socket, or the system does not tell.
    """
    if not sys.platform.startswith("linux"):
        return None
    peers = {address_of(link) for link in session.info.links() if str(link.zid) == participant}
    for peer, one in connections():
        if peer in peers:
            poll = select.poll()
            poll.register(one, select.POLLOUT)
            info = one.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, ACKED.stop)
            acked = int.from_bytes(info[ACKED], sys.byteorder)
            return bool(poll.poll(0)), acked + queued_bytes(one)
    return None


class SocketOptions:
    """Sets the options of each connection of a session, soon after it was made.

    Closing one never waits for its peer. One whose peer reads nothing for `UNREAD_MS` is lost
    before the lease ends, as Zenoh could not end it while a thread waits for that peer. One to
    another machine is lost when nothing has arrived there for `UNREACHABLE_MS`: otherwise, TCP
    sends again after 0.2, 0.4, 0.8 … s, and when a network was gone for 30 s, and is back, it is
    silent for up to 30 s more. A new connection finds the network at once.

    It works until the session is closed. The connections of a burst are looked for at once, and of
    all descriptors of the process only those that are new.

    Args:
        session: The session.
    """

    # Of all sessions: one of ten would look at the sockets of nine others each time.
    _lock: ClassVar = threading.Lock()
    _searching: ClassVar = threading.Lock()
    # The peers of connections whose options are not set yet.
    _new: ClassVar[set[str]] = set()
    _known: ClassVar[set[Descriptor]] = set()

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
            self._new.add(address_of(event.link))
            if self._timer is None:
                self._timer = threading.Timer(SETTLE_S, self._set)
                self._timer.name = "aionode-zenoh"
                self._timer.daemon = True
                start_thread(self._timer)

    def _set(self) -> None:
        """Set the options of all new connections; in the thread of the timer."""
        with self._searching:
            with self._lock:
                self._timer = None
                new = self._new.copy()
                self._new.clear()
            for descriptor in sockets(self._known) if new else ():
                with ExitStack() as stack, suppress(OSError):  # it is lost already
                    peer, one = connection(descriptor, stack) or ("", None)
                    if one is not None and peer in new:
                        one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, NO_LINGER)
                        limit_ms = UNREAD_MS if is_near(f"tcp/{peer}") else UNREACHABLE_MS
                        one.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, limit_ms)
                    if one is None or peer in new:
                        self._known.add(descriptor)


def cut(peers: set[str]) -> None:
    """Cut the connections to some peers, named by `address_of`."""
    for peer, one in connections():
        if peer in peers:
            with suppress(OSError):  # it is lost already
                one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET)
                one.shutdown(socket.SHUT_RDWR)


def cut_unanswered(done: threading.Event) -> None:
    """Cut connections that are being made with peers that do not answer, until `done` is set.

    A session that is being closed waits for each of them, for ten seconds, and dials those that it
    has lost again meanwhile. Runs in a thread.
    """
    silent: set[str] = set()
    while sys.platform.startswith("linux") and not done.wait(STUCK_S):
        before, silent = silent, unanswered()
        cut(before & silent)


async def cut_stuck(session: zenoh.Session) -> None:
    """Cut connections that a session about to be closed would wait for.

    Those whose peers do not read, and those that are being made with peers that do not answer.
    """
    if not sys.platform.startswith("linux"):
        return
    before, silent = waiting_bytes(session), unanswered()
    if not before and not silent:
        return
    with suppress(TimeoutError):
        async with asyncio.timeout(STUCK_S):
            await asyncio.get_running_loop().create_future()
    after = waiting_bytes(session)
    stuck = {peer for peer, size in before.items() if after.get(peer, 0) >= size}
    stuck |= silent & unanswered()
    if stuck:
        logger.debug("%s: the peer has stopped; the connection is cut", ", ".join(stuck))
        cut(stuck)
