"""Requests and replies towards other contexts, of which any may be frozen.

They go with congestion control BLOCK, since none may be lost, and so whoever sends one waits when
the peer takes nothing more. The loop sends them itself as long as the peer has shown that it lives,
or has been sent so little that it fits into the queues between; everything else is sent by one
thread for each such peer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Final

from aionode.transport._send_thread import SendThread

if TYPE_CHECKING:
    from aionode.transport._loop_waker import LoopWaker

__all__ = ["Peers"]

ALLOWANCE_BYTES: Final = 128 * 1024
"""How much the loop sends to a peer that gives no sign of life: less than Zenoh's queue holds."""

OVERHEAD_BYTES: Final = 512
"""What a request or reply takes besides its payload, at most about: its key and a message's end."""


REMEMBERED: Final = 1_000


class Peer:
    """One other context.

    Attributes:
        spent_bytes: How much was sent since its last sign of life.
        send_thread: The thread for it, once there was need of one.
    """

    __slots__ = ("send_thread", "spent_bytes")

    def __init__(self) -> None:
        self.spent_bytes = 0
        self.send_thread: SendThread | None = None


class Peers:
    """The other contexts that requests or replies were sent to.

    Args:
        waker: The way from threads to the loop.
    """

    def __init__(self, waker: LoopWaker) -> None:
        self._waker = waker
        self._peers: dict[str, Peer] = {}

    def heard(self, participant: str) -> None:
        """Note that a peer lives."""
        peer = self._peers.get(participant)
        if peer is not None:
            peer.spent_bytes = 0

    def send(self, participants: Iterable[str], size_bytes: int, job: Callable[[], None]) -> None:
        """Send something to some peers: now if that cannot block, else from a thread."""
        slow: Peer | None = None
        size_bytes += OVERHEAD_BYTES
        for participant in participants:
            peer = self._peers.get(participant)
            if peer is None:
                peer = self._peers[participant] = Peer()
            peer.spent_bytes += size_bytes
            busy = peer.send_thread is not None and peer.send_thread.busy
            if busy or peer.spent_bytes > ALLOWANCE_BYTES:
                slow = peer
                if busy:
                    break
        if slow is None:
            job()
            return
        if slow.send_thread is None:
            self._tidy()
            slow.send_thread = SendThread("aionode-peer", self._waker)
        slow.send_thread.submit(job)

    def _tidy(self) -> None:
        """Let threads end that are idle, and forget peers if they are many."""
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
        """Forget all; what waits in a thread is not sent."""
        for send_thread in self.send_threads():
            send_thread.abandon()
        self._peers.clear()
