"""Cutting connections whose peer has stopped reading, or is out of reach.

Zenoh waits in `close`, and in blocking sends, until such a peer reads on or the connection is lost;
shutting the socket down loses it at once. Closing the socket would then wait for ten more seconds
(SO_LINGER), unless that is switched off first (zenoh 1.10). On Linux only: elsewhere closing takes
as long as Zenoh waits.
"""

from __future__ import annotations

import asyncio
import logging
import socket
import struct
import sys
from contextlib import ExitStack, contextmanager, suppress
from os import dup, fstat
from pathlib import Path
from stat import S_ISSOCK
from typing import TYPE_CHECKING, Final

import zenoh

from aionode.transport._zenoh_config import is_near
from aionode.transport.zenoh._handlers import direct

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["cut_stuck", "give_up_unreachable"]

logger = logging.getLogger("aionode.transport.zenoh")

DESCRIPTORS: Final = Path("/proc/self/fd")

STUCK_S: Final = 0.1
"""A peer that reads not one byte for so long, while some wait, is not waited for."""

UNREACHABLE_MS: Final = 5_000
"""After so long without any answer to what was sent, a connection to another machine is lost."""

NO_LINGER: Final = struct.pack("ii", 1, 0)


@contextmanager
def connections() -> Iterator[list[tuple[str, socket.socket]]]:
    """Yield the TCP connections of this process, each with the address of its peer."""
    with ExitStack() as stack:
        found = []
        for entry in list(DESCRIPTORS.iterdir()):
            with suppress(OSError):  # no socket, or closed meanwhile
                fd = int(entry.name)
                if not S_ISSOCK(fstat(fd).st_mode):
                    continue
                one = stack.enter_context(socket.socket(fileno=dup(fd)))
                if one.type == socket.SOCK_STREAM and one.family != socket.AF_UNIX:
                    host, port = one.getpeername()[:2]
                    found.append((f"[{host}]:{port}" if ":" in host else f"{host}:{port}", one))
        yield found


def give_up_unreachable(session: zenoh.Session) -> None:
    """Let the connections of a session to other machines end soon when nothing arrives there.

    Otherwise, TCP sends again after 0.2, 0.4, 0.8 … s: after a network was gone for 30 s, and is
    back, it is silent for up to 30 s more. A new connection finds the network at once.
    """
    option = getattr(socket, "TCP_USER_TIMEOUT", None)
    if option is None:  # not on Linux
        return
    held: list[zenoh.TransportEventsListener[None]] = []

    def limit(event: zenoh.TransportEvent) -> None:
        if event.kind != zenoh.SampleKind.PUT:
            return
        with connections() as found:
            for peer, one in found:
                if not is_near(f"tcp/{peer}"):
                    with suppress(OSError):  # it is lost already
                        one.setsockopt(socket.IPPROTO_TCP, option, UNREACHABLE_MS)

    listener = session.info.declare_transport_events_listener(direct(limit), history=True)
    # It listens as long as it exists; its callback holds it until the session is closed.
    held.append(listener)


def waiting_bytes(session: zenoh.Session) -> dict[str, int]:
    """Return how many bytes wait in the socket of each peer of a session; not those with none."""
    try:
        import fcntl
        import termios
    except ImportError:  # Windows
        return {}
    peers = {str(state.dst).partition("/")[2].partition("?")[0] for state in session.info.links()}
    with connections() as found:
        waiting = {
            peer: int.from_bytes(fcntl.ioctl(one, termios.TIOCOUTQ, bytes(4)), sys.byteorder)
            for peer, one in found
            if peer in peers
        }
    return {peer: size for peer, size in waiting.items() if size}


def cut(peers: set[str]) -> None:
    """Cut the connections to some peers."""
    with connections() as found:
        for peer, one in found:
            if peer in peers:
                with suppress(OSError):  # it is lost already
                    one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, NO_LINGER)
                    one.shutdown(socket.SHUT_RDWR)


async def cut_stuck(session: zenoh.Session) -> None:
    """Cut those connections of a session that is about to be closed whose peers do not read."""
    if not sys.platform.startswith("linux"):
        return
    before = waiting_bytes(session)
    if not before:
        return
    with suppress(TimeoutError):
        async with asyncio.timeout(STUCK_S):
            await asyncio.get_running_loop().create_future()
    after = waiting_bytes(session)
    stuck = {peer for peer, size in before.items() if after.get(peer, 0) >= size}
    if stuck:
        logger.debug("%s: the peer has stopped reading; the connection is cut", ", ".join(stuck))
        cut(stuck)
