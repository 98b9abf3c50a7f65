"""The routes of a publisher's messages: over links, over Zenoh, or both."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from aionode.engine.transport.link._connection import Connection
    from aionode.engine.transport.link._registry import LinkRegistry
    from aionode.engine.transport.link._send_queue import LinkSendQueue
    from aionode.graph import EndpointInfo

__all__ = ["LinkRoutes"]


class LinkRoutes:
    """Which links a publisher sends over, and whether Zenoh has to carry its messages, too.

    Its writer, and the stops of its leases, send by it.

    Args:
        registry: The links of this context.
        endpoint: The publisher.

    Attributes:
        registry: The links.
        send_queues: One per process that asked for the messages; removed when its last subscription
            leaves, the link ends, or the publisher is destroyed.
        sequence: The number of the last message that was encoded for any route.
        needs_zenoh: Whether Zenoh has to carry messages too, because a matched subscription has not
            switched; `update` checks again.
    """

    def __init__(self, registry: LinkRegistry, endpoint: EndpointInfo) -> None:
        self.registry = registry
        self.send_queues: dict[Connection, LinkSendQueue] = {}
        self.sequence = 0
        self.needs_zenoh = True
        self._endpoint = endpoint
        # The registry's `changes` when `needs_zenoh` was computed; -1 to compute it again.
        self._asked_at = -1

    def reconsider(self) -> None:
        """Make the next message check whether any subscription needs Zenoh.

        Not done now: with many subscriptions to one topic, each of them would check all.
        """
        self.needs_zenoh = True
        self._asked_at = -1

    def update(self) -> bool:
        """Return whether a subscription needs Zenoh: it has not switched, or is unannounced."""
        registry = self.registry
        if not self.send_queues:
            self.needs_zenoh = True
        elif self._asked_at != registry.changes:
            self._asked_at = registry.changes
            switched = {
                gid
                for send_queue in self.send_queues.values()
                for gid, reader in send_queue.readers.items()
                if reader.switched
            }
            self.needs_zenoh = any(
                other.gid not in switched
                for other in registry.remote(EndpointKind.SUBSCRIPTION, self._endpoint.name)
                if self._endpoint.matches(other)
            ) or registry.may_be_heard(self._endpoint, self.reconsider)
        return self.needs_zenoh
