"""Gives up connections to processes of this machine that a signal or a debugger has stopped.

Zenoh would notice by its lease: each process regularly tells every other one that it is alive,
which is what wakes an idle process among many. The system knows which processes are stopped, so
each process checks the others without waking them, and sessions that can be checked have a long
lease. Peers that cannot check, such as nodes of ROS 2 and those in other containers, notice a
stopped process when that lease ends.

A process that waits a long time for a processor is not stopped, and is not given up.
"""

from __future__ import annotations

import logging
import threading
from typing import TYPE_CHECKING, Final

from aionode._process.later import Later
from aionode._process.stopped import WatchedProcess
from aionode.engine.transport.network import pid_of
from aionode.engine.transport.send_thread import start_thread
from aionode.engine.transport.zenoh.connections.sockets import cut_participants

if TYPE_CHECKING:
    from collections.abc import Collection

    import zenoh

__all__ = ["StoppedPeers"]

logger = logging.getLogger("aionode.transport.zenoh")

LOOK_S: Final = 2.0
"""The interval of checks, in seconds."""

LOOKS: Final = 4
"""Number of consecutive checks that must find a process stopped: it is given up after 6 to 10 s, as
with a lease of 10 s. Checks are counted, not seconds, as this process may have been stopped too."""


class StoppedPeers:
    """Gives up the stopped processes among the peers of a session; belongs to the event loop.

    Args:
        participants: The connected sessions.
    """

    def __init__(self, participants: Collection[str]) -> None:
        self._participants = participants
        self._session: zenoh.Session | None = None
        # The peers, and the processes of those that can be checked.
        self._processes: dict[str, WatchedProcess | None] = {}
        self._looks: dict[str, int] = {}  # how often each was seen stopped, in a row
        self._later = Later()

    def start(self, session: zenoh.Session) -> None:
        """Check the peers of a session from now on."""
        self._session = session
        self._later.call(LOOK_S, self._look)

    def stop(self) -> None:
        """Stop checking."""
        self._later.cancel()
        self._session = None
        for process in self._processes.values():
            if process is not None:
                process.close()
        self._processes.clear()
        self._looks.clear()

    def _look(self) -> None:
        session = self._session
        if session is None:
            return
        self._later.call(LOOK_S, self._look)
        self._meet()
        looks = self._looks
        self._looks = {
            zid: looks.get(zid, 0) + 1
            for zid, process in self._processes.items()
            if process is not None and process.is_stopped()
        }
        lost = {zid for zid, count in self._looks.items() if count == LOOKS}
        if lost:
            pids = sorted(filter(None, map(pid_of, lost)))
            logger.info(
                "processes %s are stopped; cutting their connections, which Zenoh makes anew when "
                "they go on",
                ", ".join(map(str, pids[:5])),
            )
            start_thread(
                threading.Thread(
                    target=cut_participants, args=(session, lost), name="aionode-zenoh"
                )
            )

    def _meet(self) -> None:
        """Check new peers from now on, and no longer those that have gone."""
        processes = self._processes
        for zid in processes.keys() - self._participants:
            process = processes.pop(zid)
            if process is not None:
                process.close()
        for zid in self._participants:
            if zid not in processes:
                pid = pid_of(zid)
                processes[zid] = None if pid is None else WatchedProcess(pid)
