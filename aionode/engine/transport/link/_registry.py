"""The links of a context, as its publishers, subscriptions and services use them."""

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
    """The links of one context, as its endpoints see them.

    Attributes:
        drops: What is dropped of what others send.
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
        """Return whether there may be subscriptions to a publisher that nothing announces.

        `changed` is called when the answer may have changed, until the publisher is removed.
        """

    def linked(self, participant: str) -> Connection | None:
        """Return the link to a context, if there is one."""

    def remote(self, kind: EndpointKind, name: str) -> list[EndpointInfo]:
        """Return the endpoints of other contexts that have this name."""

    def later(self, delay_s: float, call: Callable[[], None]) -> None:
        """Call `call` after a delay, unless the links are closed before."""

    def post(self, connection: Connection, stop: bytes) -> None:
        """Send a STOP to the other end of a link over the other transport; from any thread.

        It may be lost.
        """

    def keep(self, gid: bytes, send_queue: LinkSendQueue) -> None:
        """Keep what a destroyed publisher left to be sent or confirmed."""

    def remove(self, gid: bytes) -> None:
        """Forget an endpoint of this context, which was closed."""


class PeerDirectory(Protocol):
    """Facts about other contexts that the other transport knows, apart from the graph.

    Attributes:
        advertisement: What it announces of this context; None for nothing.
        on_advertisement: Called with what another context announces, and whether it is present.
        on_unannounced_peers: Called when participants that announce nothing have come or gone.
        on_retransmit: Called with what another context has retransmitted to this one.
    """

    advertisement: str | None
    on_advertisement: Callable[[str, bool], None]
    on_unannounced_peers: Callable[[bool], None]
    on_retransmit: Callable[[bytes], None]

    def may_be_heard(self, publisher: EndpointInfo, changed: Callable[[], None]) -> bool:
        """Return whether there may be subscriptions to a publisher that nothing announces.

        `changed` is called when the answer may have changed, until `forget`.
        """

    def forget(self, publisher: EndpointInfo, changed: Callable[[], None]) -> None:
        """Do not call `changed` any more, as the publisher is closed."""

    def retransmit(self, participant: str, data: bytes) -> None:
        """Send bytes to one other context, in order."""

    def post(self, participant: str, data: bytes) -> None:
        """Send bytes to one other context at once, from any thread; they may be lost."""

    def note_link(self, participant: str, on: bool) -> None:
        """Record whether there is a link to another context, for tools that ask."""
