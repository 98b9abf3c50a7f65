"""The turn to look for the other processes of this machine, which one process has at a time."""

from __future__ import annotations

import asyncio
import socket
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Final

from aionode.clock import perf_ns
from aionode.transport._zenoh_config import LOOPBACK

if TYPE_CHECKING:
    import zenoh

__all__ = ["Turn"]

TURN_S: Final = 1.0
"""How long a process waits while the same other one has the turn: that one may be frozen."""

POLL_S: Final = 0.002
LAST_POLL_S: Final = 0.05
"""The polling interval for the turn, and what it grows to: in a thread, while many start."""

MANY: Final = 16
"""With so many connections, making them takes long enough for those of others to suffer."""

QUIET_S: Final = 0.1
"""All of many peers are taken to be connected after so long without a new one."""

HELD_S: Final = 3.0
"""How long the turn is kept at most."""

UDP_SOCKETS: Final = Path("/proc/net/udp")


class Turn:
    """The turn of a process to look for others, and to be connected with them.

    Two that look at the same moment would both choose the first meeting port; the loser would have
    none, and not dial the winner either. And where a hundred connect with each other at once, none
    gets far: each has 99 connections to make on a hundredth of the machine, peers take each other
    for dead, and begin anew. One after the other, the hundredth is connected within a second.

    The process that holds the UDP port of a meeting port's number has the turn: unlike a lock file
    it belongs to no user, and ends with its process.
    """

    def __init__(self) -> None:
        self._socket: socket.socket | None = None
        self._timer: asyncio.TimerHandle | None = None

    def take(self, port: int) -> None:
        """Wait for the turn, in a thread; go on without it if it does not change hands."""
        turn = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        holder, ends_ns = "", 0
        poll_s = POLL_S
        while True:
            try:
                turn.bind((LOOPBACK, port))
            except OSError:
                pass
            else:
                self._socket = turn
                return
            now_ns = perf_ns()
            holds = holder_of(port)
            if not ends_ns or holds != holder:
                holder, ends_ns = holds, now_ns + int(TURN_S * 1e9)
            elif now_ns > ends_ns:
                turn.close()
                return
            threading.Event().wait(poll_s)
            poll_s = min(poll_s * 1.3, LAST_POLL_S)

    def release(self) -> None:
        """Give the turn up. Doing so again has no effect."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def release_when_connected(self, session: zenoh.Session) -> None:
        """Give the turn up as soon as no more peers are being connected."""
        if self._socket is not None:
            self._check(session, 0, perf_ns() + int(HELD_S * 1e9))

    def _check(self, session: zenoh.Session, before: int, ends_ns: int) -> None:
        count = len(session.info.transports())
        if count < MANY or count == before or perf_ns() > ends_ns:
            self.release()
        else:
            loop = asyncio.get_running_loop()
            self._timer = loop.call_later(QUIET_S, self._check, session, count, ends_ns)


def holder_of(port: int) -> str:
    """Return the number of the socket that is bound to a UDP port; empty where none can be told."""
    try:
        lines = UDP_SOCKETS.read_text(encoding="ascii").splitlines()
    except OSError:
        return ""
    bound = f":{port:04X}"
    return next((line.split()[9] for line in lines if line.split()[1].endswith(bound)), "")
