"""Service introspection with handles: each end of a call publishes events, as in aionode."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from aionode.engine.rules import service_events as core
from aionode.engine.transport.base import SampleInfo
from rclpy._impl.topics import PublisherHandle

if TYPE_CHECKING:
    from rclpy._impl.node import NodeHandle

__all__ = ["Introspection"]


class EventPublisher(PublisherHandle):
    """A publisher of service events, with the attribute names of aionode's publishers."""

    destroy = PublisherHandle.destroy_when_not_in_use

    @property
    def destroyed(self) -> bool:
        """Whether it is destroyed, or about to be."""
        return not self.is_valid


class Introspection(core.Introspection):
    """Publishes the requests and responses of one client or server."""

    def __init__(self, node: NodeHandle, srv_type: Any, service: str) -> None:
        super().__init__(srv_type, service, partial(EventPublisher, node))

    def tell(self, event_type: int, client_gid: bytes, sequence: int, content: Any) -> None:
        """Publish one step of a call; its content is the request or the response."""
        if self._publisher is not None:  # as for most services, which need no `SampleInfo` either
            self.publish(event_type, SampleInfo(client_gid, sequence, 0), content)
