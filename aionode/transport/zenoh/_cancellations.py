"""Sending servers the cancellations of requests.

ROS has no message for this, and a Zenoh query cannot be cancelled at its queryable. So each context
subscribes to a key of its own, and the context of the client publishes the sequence number of the
request there. ROS nodes do not take part.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import zenoh

from aionode.transport._loop_waker import ThreadsafeQueue
from aionode.transport.zenoh._handlers import LOOP_PRIORITY, direct
from aionode.wire import _attachment as attachment

if TYPE_CHECKING:
    from aionode.transport._loop_waker import LoopWaker

__all__ = ["Cancellations"]

LIMIT = 1_000
"""How many cancellations wait for the loop; they only save work, so the oldest may be lost."""


class Cancellations:
    """The cancellations that this context sends and receives.

    Attributes:
        listeners: Called with the gid of the client and its number of the request.
    """

    def __init__(
        self,
        participant: str,
        domain_id: int,
        waker: LoopWaker,
        note_malformed: Callable[[str, str], None],
    ) -> None:
        self.listeners: dict[Callable[[bytes, int], None], None] = {}
        self._participant = participant
        self._domain_id = domain_id
        self._note_malformed = note_malformed
        self._session: zenoh.Session | None = None
        self._subscriber: zenoh.Subscriber[None] | None = None
        self._queue: ThreadsafeQueue[zenoh.Sample] = ThreadsafeQueue(waker, self._take, LIMIT)

    def start(self, session: zenoh.Session) -> None:
        """Subscribe."""
        self._session = session
        self._subscriber = session.declare_subscriber(
            self._key(self._participant), direct(self._queue.put)
        )

    def stop(self) -> None:
        """Unsubscribe."""
        subscriber, self._subscriber = self._subscriber, None
        self._session = None
        if subscriber is not None:
            subscriber.undeclare()

    def tell(self, participants: Iterable[str], gid: bytes, sequence: int) -> None:
        """Send the cancellation of a request to some contexts."""
        if self._session is not None:
            for participant in participants:
                self._session.put(
                    self._key(participant),
                    b"",
                    attachment=attachment.pack(sequence, 0, gid),
                    congestion_control=zenoh.CongestionControl.DROP,
                    priority=LOOP_PRIORITY,
                )

    def _key(self, participant: str) -> str:
        return f"@aionode/{self._domain_id}/{participant}/cancel"

    def _take(self, sample: zenoh.Sample) -> None:
        extra = sample.attachment
        request = None if extra is None else attachment.unpack(extra.to_bytes())
        if request is None:
            self._note_malformed(self._key(self._participant), "a cancellation")
        else:
            for listener in list(self.listeners):
                listener(request.gid, request.sequence)
