"""Requests and replies towards other contexts, of which any may be frozen.

They go with congestion control BLOCK, since none may be lost, and so whoever sends one waits when
the peer takes nothing more. The loop sends them itself as long as the peer has shown that it lives,
or has been sent so little that it fits into the queues between; everything else is sent by one
thread for each such peer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Final

from aionode.transport.sender import Sender

if TYPE_CHECKING:
    from aionode.transport.wakeup import Wakeup

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
        sender: The thread for it, once there was need of one.
    """

    __slots__ = ("sender", "spent_bytes")

    def __init__(self) -> None:
        self.spent_bytes = 0
        self.sender: Sender | None = None


class Peers:
    """The other contexts that requests or replies were sent to.

    Args:
        wakeup: The way from threads to the loop.
    """

    def __init__(self, wakeup: Wakeup) -> None:
        self._wakeup = wakeup
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
            busy = peer.sender is not None and peer.sender.busy
            if busy or peer.spent_bytes > ALLOWANCE_BYTES:
                slow = peer
                if busy:
                    break
        if slow is None:
            job()
            return
        if slow.sender is None:
            self._tidy()
            slow.sender = Sender("aionode-peer", self._wakeup)
        slow.sender.submit(job)

    def _tidy(self) -> None:
        """Let threads end that are idle, and forget peers if they are many."""
        for peer in self._peers.values():
            if peer.sender is not None and not peer.sender.busy:
                peer.sender.close()
                peer.sender = None
        if len(self._peers) > REMEMBERED:
            self._peers = {
                name: peer
                for name, peer in self._peers.items()
                if peer.sender is not None or peer.spent_bytes
            }

    def senders(self) -> list[Sender]:
        """Return the threads."""
        return [peer.sender for peer in self._peers.values() if peer.sender is not None]

    def clear(self) -> None:
        """Forget all; what waits in a thread is not sent."""
        for sender in self.senders():
            sender.abandon()
        self._peers.clear()
