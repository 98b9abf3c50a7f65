"""The thread that sends the stops of leases if the event loop does not."""

from __future__ import annotations

import os
import threading
from contextlib import suppress
from queue import Empty, SimpleQueue
from typing import Final, Protocol

from aionode._process.sudden_end import STOPS
from aionode._process.suspension import suspension
from aionode.clock import perf_ns

__all__ = ["REPEAT_S", "LeaseWatch", "Watched", "watch"]

GRACE_NS: Final = 30_000_000
"""How long the thread leaves the stop to the loop after a time to live has run out: the loop may
only be late, because the process was frozen or the machine is busy.
"""

POLL_S: Final = 0.05
"""Maximum time between two checks of the leases: a clock may have been set, the host suspended, or
a stop may have to be sent again.
"""

AGAIN_S: Final = 0.01
"""Time between two checks while a time to live has run out."""

REPEAT_S: Final = 0.2
"""How long a stop is sent repeatedly if the loop does not take over."""

STOPPED: Final = "the process was about to end or be suspended"


class Watched(Protocol):
    """An open lease, as seen by the thread. Each method may be called in any thread."""

    @property
    def is_sent(self) -> bool:
        """Whether its stop was sent past the loop, which has not yet taken over."""

    @property
    def is_orphaned(self) -> bool:
        """Whether its loop is closed."""

    def left_ns(self) -> int | None:
        """Return the rest of its time to live in nanoseconds; None if it is not running."""

    def send_past_loop(self, reason: str) -> bool:
        """Send the stop, unless another thread is doing so.

        Args:
            reason: The reason, if the time to live is not over. In that case the stop is sent even
                in the middle of publishing a command, and once more after that.

        Returns:
            Whether the stop was sent by this call.
        """

    def repeat(self) -> None:
        """Send the stop again."""

    def leave_to_parent(self) -> None:
        """Stop sending, in a forked child."""


class Record:
    """The thread's record of one lease.

    Attributes:
        noticed_ns: When its end was noticed, by `perf_ns`; 0 before.
        sent_ns: When its stop was sent; 0 before.
    """

    __slots__ = ("noticed_ns", "sent_ns")

    def __init__(self) -> None:
        self.noticed_ns = self.sent_ns = 0


class LeaseWatch:
    """Watches the open leases of a process, in a thread that exists only while there are any.

    A signal handler may interrupt the main thread anywhere, so stops are sent without taking a lock
    of this class, and the thread is woken through a SimpleQueue, whose `put` is reentrant.
    """

    def __init__(self) -> None:
        self._reset()

    def _reset(self) -> None:
        self._leases: dict[Watched, Record] = {}
        self._wakes: SimpleQueue[None] = SimpleQueue()
        self._guard = threading.Lock()  # held while the thread is started or ends
        self._thread: threading.Thread | None = None

    def add(self, lease: Watched) -> None:
        """Watch a lease until `remove`."""
        suspension.install()
        with self._guard:
            self._leases[lease] = Record()
            if self._thread is not None:
                return
            self._thread = threading.Thread(target=self._run, name="aionode-lease", daemon=True)
            try:
                self._thread.start()
            except RuntimeError:  # the interpreter is shutting down; only the loop is left
                self._thread = None

    def remove(self, lease: Watched) -> None:
        """Stop watching a lease."""
        if self._leases.pop(lease, None) is not None and not self._leases:
            suspension.remove()
            self.wake()  # so that it ends

    def wake(self) -> None:
        """Make the thread check now, as a time to live has started."""
        self._wakes.put(None)

    def stop_all(self) -> bool:
        """Send all stops in the calling thread; return whether there were any.

        Signal handlers may call it: it takes only the locks of the leases, which are either held by
        the interrupted thread itself or released in a moment.
        """
        leases = [item for item in list(self._leases.items()) if not item[0].is_sent]
        for lease, record in leases:
            self._send(lease, record, STOPPED)
        self.wake()
        return bool(leases)

    def after_fork(self) -> None:
        """Leave all leases to the parent; called in a forked child, which has no such thread."""
        leases = list(self._leases)
        self._reset()
        for lease in leases:
            lease.leave_to_parent()

    # In the thread

    def _run(self) -> None:
        while True:
            self._wait()
            if not self._leases:
                with self._guard:
                    if not self._leases:
                        self._thread = None
                        return
            for lease, record in list(self._leases.items()):
                self._look(lease, record)

    def _wait(self) -> None:
        """Wait until something may have to be done."""
        timeout_s = POLL_S
        for lease, record in list(self._leases.items()):
            left_ns = lease.left_ns()
            if record.sent_ns:
                continue
            if record.noticed_ns:
                timeout_s = min(timeout_s, AGAIN_S)
            elif left_ns is not None:
                timeout_s = min(timeout_s, max(left_ns / 1e9, 0))
        with suppress(Empty):
            self._wakes.get(timeout=timeout_s)

    def _look(self, lease: Watched, record: Record) -> None:
        """Do what is due for one lease."""
        now_ns = perf_ns()
        left_ns = lease.left_ns()
        if lease.is_sent:
            if now_ns - record.sent_ns < REPEAT_S * 1e9:
                lease.repeat()
            elif lease.is_orphaned:  # nobody will take over
                self.remove(lease)
        elif lease.is_orphaned:
            self._send(lease, record, "its event loop has ended")
        elif left_ns is None or left_ns > 0:
            record.noticed_ns = 0
        elif not record.noticed_ns:
            record.noticed_ns = now_ns
        elif now_ns - record.noticed_ns >= GRACE_NS:
            self._send(lease, record, "")

    def _send(self, lease: Watched, record: Record, reason: str) -> None:
        if lease.send_past_loop(reason):
            record.sent_ns = perf_ns()


watch = LeaseWatch()
"""This process's lease watch."""

STOPS.append(watch.stop_all)

if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(after_in_child=watch.after_fork)
