"""Sending requests and replies to other contexts, each of which may be frozen.

They are sent with congestion control BLOCK, since none may be lost, so sending one waits while the
peer reads nothing. The event loop sends them itself while the peer has shown signs of life, or has
been sent so little that the queues on the way hold it. Otherwise one thread for each such peer
sends them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Final

from aionode.transport._send_thread import SendThread

if TYPE_CHECKING:
    from aionode.transport._loop_waker import LoopWaker

__all__ = ["PeerSenders"]

ALLOWANCE_BYTES: Final = 128 * 1024
"""How much the loop sends to a peer that shows no sign of life: less than Zenoh's queue holds."""

OVERHEAD_BYTES: Final = 512
"""What a request or reply takes besides its payload, approximately: its key and headers."""

REMEMBERED: Final = 1_000
"""How many peers are remembered before idle ones are dropped."""


class PeerSender:
    """The sender of requests and replies to one other context.

    Attributes:
        spent_bytes: How much was sent since its last sign of life.
        send_thread: The thread for it, once it was needed.
    """

    __slots__ = ("send_thread", "spent_bytes")

    def __init__(self) -> None:
        self.spent_bytes = 0
        self.send_thread: SendThread | None = None


class PeerSenders:
    """The senders of this context, one for each context that it sends requests or replies to.

    Args:
        waker: Wakes the event loop from threads.
    """

    def __init__(self, waker: LoopWaker) -> None:
        self._waker = waker
        # By participant.
        self._peers: dict[str, PeerSender] = {}

    def heard(self, participant: str) -> None:
        """Record a sign of life of a peer."""
        peer = self._peers.get(participant)
        if peer is not None:
            peer.spent_bytes = 0

    def send(self, participants: Iterable[str], size_bytes: int, job: Callable[[], None]) -> None:
        """Run `job`, which sends to some peers: at once if it cannot block, else in a thread."""
        slow: PeerSender | None = None
        size_bytes += OVERHEAD_BYTES
        for participant in participants:
            peer = self._peers.get(participant)
            if peer is None:
                peer = self._peers[participant] = PeerSender()
            peer.spent_bytes += size_bytes
            busy = peer.send_thread is not None and peer.send_thread.busy
            if busy or peer.spent_bytes > ALLOWANCE_BYTES:
                slow = peer
                if busy:
                    break
        if slow is None:
            job()
        else:
            self._submit(slow, job)

    def submit(self, participant: str, job: Callable[[], None]) -> None:
        """Run `job`, which sends to one peer, in the thread for it."""
        peer = self._peers.get(participant)
        if peer is None:
            peer = self._peers[participant] = PeerSender()
        self._submit(peer, job)

    def _submit(self, peer: PeerSender, job: Callable[[], None]) -> None:
        if peer.send_thread is None:
            self._tidy()
            peer.send_thread = SendThread("aionode-peer", self._waker)
        peer.send_thread.submit(job)

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
        """Forget all peers; jobs that wait in a thread are dropped."""
        for send_thread in self.send_threads():
            send_thread.abandon()
        self._peers.clear()
