"""Gives up connections to processes of this machine that a signal or a debugger has stopped.

Zenoh would notice by its lease: each process regularly tells every other one that it is alive,
which is what wakes an idle process among many. The system knows which processes are stopped, so
each process checks the others without waking them, and sessions that can be checked have a long
lease. Peers that cannot check, such as nodes of ROS 2 and those in other containers, notice a
stopped process when that lease ends.

Each process checks only a few others, so that a hundred do not check a hundred each. A process that
finds a stopped one tells everyone, and then everyone checks all peers for a while.

A process that waits a long time for a processor is not stopped, and is not given up.
"""

from __future__ import annotations

import logging
import os
import threading
from bisect import bisect
from typing import TYPE_CHECKING, Final

import zenoh

from aionode._process.later import Later
from aionode._process.stopped import WatchedProcess
from aionode.engine.transport.network import pid_of
from aionode.engine.transport.send_thread import start_thread
from aionode.engine.transport.zenoh.connections.handlers import direct, translated
from aionode.engine.transport.zenoh.connections.sockets import cut_participants

if TYPE_CHECKING:
    from collections.abc import Set as AbstractSet

    from aionode.engine.transport.zenoh._session_state import SessionState

__all__ = ["StoppedPeers"]

logger = logging.getLogger("aionode.transport.zenoh")

LOOK_S: Final = 2.0
"""The interval of checks, in seconds."""

LOOKS: Final = 4
"""Number of consecutive checks that must find a process stopped: it is given up after 6 to 10 s, as
with a lease of 10 s. Checks are counted, not seconds, as this process may have been stopped too."""

SUCCESSORS: Final = 4
"""Number of peers that a process always checks: the next ones in the order of ids, so that as many
others check it. One of these would be enough, but some may be stopped together with it."""


class StoppedPeers:
    """Gives up the stopped processes among the peers of a session; belongs to the event loop.

    Args:
        state: The state of the session.
    """

    def __init__(self, state: SessionState) -> None:
        self._state = state
        self._session: zenoh.Session | None = None
        self._key = f"@aionode/{state.domain_id}/stopped"
        self._told = state.queue(self._be_told, 1)
        self._subscriber: zenoh.Subscriber[None] | None = None
        # The processes of all peers that can be checked.
        self._pids: dict[str, int | None] = {}
        self._successors: set[str] = set()
        # The processes that are checked: the successors, or all of them.
        self._processes: dict[str, WatchedProcess] = {}
        self._looks_at_all = 0  # number of further checks of all of them
        self._looks: dict[str, int] = {}  # how often each was seen stopped, in a row
        self._later = Later()

    def start(self, session: zenoh.Session) -> None:
        """Check the peers of a session from now on."""
        self._session = session
        with translated(self._key):
            self._subscriber = session.declare_subscriber(
                self._key, direct(self._told.put), allowed_origin=zenoh.Locality.REMOTE
            )
        self._later.call(LOOK_S, self._look)

    def stop(self) -> None:
        """Stop looking."""
        self._later.cancel()
        self._session = None
        subscriber, self._subscriber = self._subscriber, None
        if subscriber is not None:
            subscriber.undeclare()
        self._told.clear()
        self._looks_at_all = 0
        self._watch(set())
        self._pids.clear()
        self._successors.clear()
        self._looks.clear()

    def _be_told(self, _: zenoh.Sample) -> None:
        """Check all peers now and for a while, as another process has seen a stopped one."""
        is_first, self._looks_at_all = not self._looks_at_all, LOOKS
        if is_first:
            self._look()

    def _look(self) -> None:
        session = self._session
        if session is None:
            return
        self._later.call(LOOK_S, self._look)
        stopped = self._stopped()
        if stopped & self._successors:
            # Not a token: declaring one may block, as the stopped process reads nothing.
            self._state.control_messages.put(self._key, b"")
            if not self._looks_at_all:
                self._looks_at_all = LOOKS
                stopped = self._stopped()
        self._looks_at_all = LOOKS if stopped else max(self._looks_at_all - 1, 0)
        self._looks = {zid: self._looks.get(zid, 0) + 1 for zid in stopped}
        lost = {zid for zid, count in self._looks.items() if count == LOOKS}
        if lost:
            pids = sorted(filter(None, map(pid_of, lost)))
            logger.info(
                "processes %s are stopped; cutting their connections, which Zenoh restores when "
                "they continue",
                ", ".join(map(str, pids[:5])),
            )
            start_thread(
                threading.Thread(
                    target=cut_participants, args=(session, lost), name="aionode-zenoh"
                )
            )

    def _stopped(self) -> set[str]:
        """Return the stopped processes among the successors, or among all peers."""
        peers = self._state.connections.kinds.keys()
        if peers != self._pids.keys():
            known = self._pids
            self._pids = {zid: known[zid] if zid in known else visible_pid_of(zid) for zid in peers}
            order = sorted(zid for zid, pid in self._pids.items() if pid is not None)
            first = bisect(order, self._state.participant)
            self._successors = set((order[first:] + order[:first])[:SUCCESSORS])
        self._watch(self._pids.keys() if self._looks_at_all else self._successors)
        return {zid for zid, process in self._processes.items() if process.is_stopped()}

    def _watch(self, zids: AbstractSet[str]) -> None:
        """Check these peers from now on, and no others."""
        processes = self._processes
        if processes.keys() == zids:
            return
        for zid in processes.keys() - zids:
            processes.pop(zid).close()
        for zid in zids - processes.keys():
            pid = self._pids[zid]
            if pid is not None:
                processes[zid] = WatchedProcess(pid)


def visible_pid_of(zid: str) -> int | None:
    """Return the process of a session if this one can check it: the system may hide others'."""
    pid = pid_of(zid)
    return pid if pid is not None and os.access(f"/proc/{pid}/stat", os.R_OK) else None
