"""The links of a context, as used by its publishers, subscriptions and services."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.drops import Drops
    from aionode.engine.transport.link._connection import Connection
    from aionode.engine.transport.link._send_queue import LinkSendQueue
    from aionode.engine.transport.link._shared_memory import BufferPool
    from aionode.graph import EndpointInfo, EndpointKind

__all__ = ["LinkRegistry", "PeerDirectory"]


class LinkRegistry(Protocol):
    """The links of one context, as seen by its endpoints.

    Attributes:
        drops: Counts what is dropped of what others send.
        pool: Shared memory for large payloads.
        now_ns: Returns the system time, in nanoseconds since 1970.
    """

    drops: Drops
    pool: BufferPool
    now_ns: Callable[[], int]

    @property
    def changes(self) -> int:
        """A number that is incremented whenever endpoints or links change."""

    def may_be_heard(self, publisher: EndpointInfo, changed: Callable[[], None]) -> bool:
        """Return whether a publisher may have subscriptions that are not announced.

        `changed` is called when the answer may have changed, until the publisher is removed.
        """

    def linked(self, participant: str) -> Connection | None:
        """Return the link to a context, if there is one."""

    def remote(self, kind: EndpointKind, name: str) -> list[EndpointInfo]:
        """Return the endpoints of other contexts with this name."""

    def later(self, delay_s: float, call: Callable[[], None]) -> None:
        """Call `call` after a delay, unless the links are closed first."""

    def post(self, connection: Connection, stop: bytes) -> None:
        """Send a STOP to the other end of a link over the other transport, from any thread.

        It may be lost.
        """

    def keep(self, gid: bytes, send_queue: LinkSendQueue) -> None:
        """Keep what a destroyed publisher left to be sent or confirmed."""

    def remove(self, gid: bytes) -> None:
        """Forget a closed endpoint of this context."""


class PeerDirectory(Protocol):
    """What the other transport knows about other contexts, apart from the graph.

    Attributes:
        advertisement: Its announcement of this context; None for none.
        on_advertisement: Called with another context's announcement, and whether it is present.
        on_unannounced_peers: Called when participants without announcements have come or gone.
        on_retransmit: Called with what another context retransmitted to this one.
    """

    advertisement: str | None
    on_advertisement: Callable[[str, bool], None]
    on_unannounced_peers: Callable[[bool], None]
    on_retransmit: Callable[[bytes], None]

    def may_be_heard(self, publisher: EndpointInfo, changed: Callable[[], None]) -> bool:
        """Return whether a publisher may have subscriptions that are not announced.

        `changed` is called when the answer may have changed, until `forget`.
        """

    def forget(self, publisher: EndpointInfo, changed: Callable[[], None]) -> None:
        """Stop calling `changed`, as the publisher is closed."""

    def retransmit(self, participant: str, data: bytes) -> None:
        """Send bytes to one other context, in order."""

    def post(self, participant: str, data: bytes) -> None:
        """Send bytes to one other context immediately, from any thread; they may be lost."""

    def note_link(self, participant: str, on: bool) -> None:
        """Record whether there is a link to another context, for tools that ask."""
