"""The subscriptions of this process that receive from each publisher at a link's other end."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from aionode.engine.transport.link._protocol import Handler
    from aionode.engine.wire.cdr import Data

__all__ = ["Receiver", "ReceiverTable"]


class Receiver(Protocol):
    """A subscription of this process that receives from one publisher of the other process."""

    @property
    def gid(self) -> bytes:
        """The gid of the subscription."""

    def from_link(
        self, payload: Data, sequence: int, source_ns: int, inline_deadline_ns: int
    ) -> None:
        """Handle a message."""

    def opened(self, sequence: int) -> None:
        """Expect the messages after number `sequence` over the link."""

    def gone(self) -> None:
        """Expect nothing more, as the publisher was destroyed."""

    def broken(self) -> None:
        """Expect nothing more, as the link has ended."""


class ReceiverTable:
    """The receivers of one link, by the gid of their publisher.

    A receiver is added when it asks for the publisher's messages, and removed when either is
    destroyed or the link ends.

    Attributes:
        handlers: Handle a publisher's messages, by its gid; updated with the receivers.
    """

    def __init__(self) -> None:
        self.handlers: dict[bytes, Handler] = {}
        # By publisher, and then by subscription.
        self._receivers: dict[bytes, dict[bytes, Receiver]] = {}

    def add(self, publisher: bytes, receiver: Receiver) -> None:
        """Pass the messages of a publisher of the other process to `receiver`."""
        receivers = self._receivers.setdefault(publisher, {})
        receivers[receiver.gid] = receiver
        self.handlers[publisher] = handler_for(receivers)

    def remove(self, publisher: bytes, receiver: Receiver) -> None:
        """Stop passing messages to `receiver`."""
        receivers = self._receivers.get(publisher, {})
        receivers.pop(receiver.gid, None)
        if receivers:
            self.handlers[publisher] = handler_for(receivers)
        else:
            self._receivers.pop(publisher, None)
            self.handlers.pop(publisher, None)

    def of(self, publisher: bytes) -> list[Receiver]:
        """Return the subscriptions here that receive from a publisher over this link."""
        return list(self._receivers.get(publisher, {}).values())

    def get(self, publisher: bytes, subscription: bytes) -> Receiver | None:
        """Return one subscription if it receives from a publisher.

        It does not scan the others, as each of many asks for each of many publishers.
        """
        return self._receivers.get(publisher, {}).get(subscription)

    def clear(self) -> list[Receiver]:
        """Remove and return all receivers, as the link has ended."""
        receivers = [receiver for many in self._receivers.values() for receiver in many.values()]
        self._receivers.clear()
        self.handlers.clear()
        return receivers


def handler_for(receivers: dict[bytes, Receiver]) -> Handler:
    """Return a function that passes a publisher's messages to its receivers, mostly just one."""
    if len(receivers) == 1:
        (only,) = receivers.values()
        return only.from_link

    def take(payload: Data, sequence: int, source_ns: int, inline_deadline_ns: int) -> None:
        for receiver in tuple(receivers.values()):
            receiver.from_link(payload, sequence, source_ns, inline_deadline_ns)

    return take
