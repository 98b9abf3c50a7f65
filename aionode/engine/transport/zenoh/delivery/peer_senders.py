"""Sends requests and replies to other contexts, any of which may be frozen.

They are sent with congestion control BLOCK, since none may be lost, so a send waits while the peer
reads nothing. The event loop sends them itself while the peer has shown signs of life, or has been
sent so little that the queues on the way can hold it. Otherwise a thread per peer sends them.

That thread waits for the peer before Zenoh would, because of a Zenoh defect
(`_defects.blocked_sends`).
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING, Final

from aionode.engine.transport.send_thread import SendThread

if TYPE_CHECKING:
    from aionode.engine.transport.loop_waker import LoopWaker

__all__ = ["PeerSenders"]

ALLOWANCE_BYTES: Final = 128 * 1024
"""Bytes that the loop sends to a peer without a sign of life: less than Zenoh's queue holds."""

OVERHEAD_BYTES: Final = 512
"""Approximate overhead of a request or reply in bytes: its key and headers."""

UNSEEN_BYTES: Final = 256 * 1024
"""Bytes that a thread sends before it checks again whether the peer accepts them; together with
those of the loop, less than Zenoh's queue holds."""

CHECK_S: Final = 0.05
"""The interval of checks while the peer accepts nothing, in seconds."""

MAX_THREADS: Final = 200
"""Number of peers that may have a thread of their own; others share `SHARED` threads, so that a
process that announces thousands of unresponsive contexts does not cause more."""

SHARED: Final = 8

REMEMBERED: Final = 1_000
"""Number of peers to remember before idle ones are dropped."""


class PeerSender:
    """The sender of requests and replies to one other context.

    Attributes:
        spent_bytes: Number of bytes sent since its last sign of life.
        unseen_bytes: Number of bytes the thread has sent since it saw that the peer accepts them.
        written_bytes: Number of bytes that had been written to the connection at that point.
        send_thread: The thread for it, once it was needed.
    """

    __slots__ = ("send_thread", "spent_bytes", "unseen_bytes", "written_bytes")

    def __init__(self) -> None:
        # Only the loop uses `spent_bytes` and `send_thread`, and only the thread the other two.
        self.spent_bytes = 0
        self.unseen_bytes = UNSEEN_BYTES
        self.written_bytes = 0
        self.send_thread: SendThread | None = None


class PeerSenders:
    """The senders of this context, one for each context that it sends requests or replies to.

    Args:
        waker: Wakes the event loop from threads.
        progress: Returns, in a thread, whether the connection to a participant has room, and how
            many bytes were written to it so far; None if unknown.

    Attributes:
        is_crowded: Whether threads send everything; see `ControlMessages.is_crowded`.
    """

    def __init__(
        self, waker: LoopWaker, progress: Callable[[str], tuple[bool, int] | None]
    ) -> None:
        self.is_crowded = False
        self._waker = waker
        self._progress = progress
        # Set to end the waits of jobs, and then replaced: each job has the current one.
        self._stopped = threading.Event()
        # By participant.
        self._peers: dict[str, PeerSender] = {}

    def heard(self, participant: str) -> None:
        """Record a sign of life of a peer."""
        peer = self._peers.get(participant)
        if peer is not None:
            peer.spent_bytes = 0

    def _peer(self, participant: str) -> PeerSender:
        return self._peers.setdefault(participant, PeerSender())

    def send(self, participants: Iterable[str], size_bytes: int, job: Callable[[], None]) -> None:
        """Run `job`, which sends to some peers: now if it cannot block, otherwise in a thread."""
        slow = ""
        size_bytes += OVERHEAD_BYTES
        for participant in participants:
            peer = self._peers.get(participant)
            if peer is None:
                peer = self._peers[participant] = PeerSender()
            peer.spent_bytes += size_bytes
            busy = peer.send_thread is not None and peer.send_thread.busy
            if busy or peer.spent_bytes > ALLOWANCE_BYTES or self.is_crowded:
                slow = participant
                if busy:
                    break
        if slow:
            self.submit(slow, size_bytes, job)
        else:
            job()

    def submit(self, participant: str, size_bytes: int, job: Callable[[], None]) -> None:
        """Run `job`, which sends to a peer, in that peer's thread."""
        peer = self._peer(participant)
        if peer.send_thread is None:
            self._tidy()
            if len(self.send_threads()) >= MAX_THREADS:
                peer = self._peer(f"shared {hash(participant) % SHARED}")
            if peer.send_thread is None:
                peer.send_thread = SendThread("aionode-peer", self._waker)
        peer.send_thread.submit(
            partial(self._run, participant, peer, size_bytes, job, self._stopped)
        )

    def _run(
        self,
        participant: str,
        peer: PeerSender,
        size_bytes: int,
        job: Callable[[], None],
        stopped: threading.Event,
    ) -> None:
        """Run `job` once the peer accepts what was sent before, in its thread."""
        if peer.unseen_bytes + size_bytes > UNSEEN_BYTES:
            self._wait_for_room(participant, peer, stopped)
            peer.unseen_bytes = 0
        peer.unseen_bytes += size_bytes
        if not stopped.is_set():
            job()

    def _wait_for_room(self, participant: str, peer: PeerSender, stopped: threading.Event) -> None:
        """Wait until Zenoh has sent what it has, and could send more.

        A connection also has room if Zenoh has not had time to fill it. So what was passed to Zenoh
        must have been written, or there must be room twice in a row.
        """
        had_room = False
        while (seen := self._progress(participant)) is not None:
            has_room, written_bytes = seen
            is_sent = written_bytes - peer.written_bytes >= peer.unseen_bytes
            if has_room and (is_sent or had_room):
                peer.written_bytes = written_bytes
                return
            had_room = has_room
            if stopped.wait(CHECK_S):
                return

    def _tidy(self) -> None:
        """End idle threads, and forget idle peers if there are many."""
        for peer in self._peers.values():
            if peer.send_thread is not None and not peer.send_thread.busy:
                peer.send_thread.close()
                peer.send_thread = None
        if len(self._peers) > REMEMBERED:
            self._peers = {
                name: peer
                for name, peer in self._peers.items()
                if peer.send_thread is not None or peer.spent_bytes
            }

    def send_threads(self) -> list[SendThread]:
        """Return the threads."""
        return [peer.send_thread for peer in self._peers.values() if peer.send_thread is not None]

    def clear(self) -> None:
        """Forget all peers; jobs waiting in threads are dropped."""
        self._stopped.set()
        self._stopped = threading.Event()
        for send_thread in self.send_threads():
            send_thread.abandon()
        self._peers.clear()
