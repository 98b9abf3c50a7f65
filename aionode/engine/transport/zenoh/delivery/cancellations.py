"""Sends cancellations of requests to servers.

ROS has no message for this, and a Zenoh query cannot be cancelled at its queryable. So each context
subscribes to keys of its own, one per service, on which the client's context publishes the sequence
number of the request. ROS nodes do not take part.

The name of the service is a chunk of the key, as in ROS tokens, so that access rules can cover it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import zenoh

from aionode.engine.transport.loop_waker import ThreadsafeQueue
from aionode.engine.transport.zenoh.connections.handlers import direct
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire._key_expression import demangle, mangle

if TYPE_CHECKING:
    from aionode.engine.transport.loop_waker import LoopWaker
    from aionode.engine.transport.zenoh.delivery.control_messages import ControlMessages

__all__ = ["Cancellations"]

LIMIT = 1_000
"""Number of cancellations that may wait for the loop; they only save work, so the oldest may be
lost."""


class Cancellations:
    """The cancellations that this context sends and receives.

    Attributes:
        listeners: Called with a client's gid and its number for a request, by service.
    """

    def __init__(
        self,
        participant: str,
        domain_id: int,
        waker: LoopWaker,
        note_malformed: Callable[[str, str], None],
        control_messages: ControlMessages,
    ) -> None:
        self.listeners: dict[str, dict[Callable[[bytes, int], None], None]] = {}
        self._participant = participant
        self._domain_id = domain_id
        self._note_malformed = note_malformed
        self._control_messages = control_messages
        self._subscriber: zenoh.Subscriber[None] | None = None
        self._queue: ThreadsafeQueue[zenoh.Sample] = ThreadsafeQueue(waker, self._receive, LIMIT)

    def start(self, session: zenoh.Session) -> None:
        """Subscribe."""
        self._subscriber = session.declare_subscriber(
            self._prefix(self._participant) + "*", direct(self._queue.put)
        )

    def stop(self) -> None:
        """Unsubscribe."""
        subscriber, self._subscriber = self._subscriber, None
        if subscriber is not None:
            subscriber.undeclare()

    def listen(self, service: str, listener: Callable[[bytes, int], None]) -> None:
        """Call `listener` for each request of a service that is cancelled."""
        self.listeners.setdefault(service, {})[listener] = None

    def unlisten(self, service: str, listener: Callable[[bytes, int], None]) -> None:
        """Stop calling `listener`, if it is known."""
        listeners = self.listeners.get(service, {})
        listeners.pop(listener, None)
        if not listeners:
            self.listeners.pop(service, None)

    def tell(self, participants: Iterable[str], service: str, gid: bytes, sequence: int) -> None:
        """Send the cancellation of a request to some contexts with servers of its service."""
        extra = attachment.pack(sequence, 0, gid)
        for participant in participants:
            key = self._prefix(participant) + mangle(service)
            self._control_messages.put(key, b"", extra)

    def _prefix(self, participant: str) -> str:
        return f"@aionode/{self._domain_id}/{participant}/cancel/"

    def _receive(self, sample: zenoh.Sample) -> None:
        extra = sample.attachment
        request = None if extra is None else attachment.unpack(extra.to_bytes())
        if request is None:
            self._note_malformed(self._prefix(self._participant) + "*", "a cancellation")
        else:
            service = demangle(str(sample.key_expr).rpartition("/")[2])
            for listener in list(self.listeners.get(service, ())):
                listener(request.gid, request.sequence)
