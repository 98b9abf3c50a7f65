"""The objects that endpoints pass to transports and get from them, and the gids of endpoints."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.graph import EndpointKind
from aionode.node import direct_subscription as subscribe_directly

if TYPE_CHECKING:
    from aionode.endpoints.core.subscription_reader import SubscriptionReader
    from aionode.endpoints.publisher import Publisher
    from aionode.endpoints.service import Service
    from aionode.endpoints.subscription import Subscription
    from aionode.engine.bare_node import BarePublisher
    from aionode.engine.transport.base import Serve, Writer
    from aionode.node import Node

__all__ = ["direct_subscription", "gid_of", "reader_of", "serve_of", "writers_of"]


def gid_of(node: Node, topic: str, kind: EndpointKind = EndpointKind.PUBLISHER) -> bytes:
    """Return the gid of the only endpoint of a kind that a node has on a topic."""
    (endpoint,) = [
        each
        for each in node.graph.endpoints(kind, name=topic)
        if each.node.participant == node.context.participant and each.node.name == node.get_name()
    ]
    return endpoint.gid


def direct_subscription(node: Node, *args: Any) -> Subscription[Any]:
    """Return a subscription that passes messages on as they arrive, as recorders use."""
    return subscribe_directly(node, *args)


def reader_of(subscription: Subscription[Any]) -> SubscriptionReader:
    """Return the object to which each transport delivers for a subscription."""
    return subscription._reader


def writers_of(publisher: Publisher[Any] | BarePublisher) -> tuple[Writer, ...]:
    """Return the writers of a publisher, one from each transport."""
    return tuple(publisher._writers)


def serve_of(service: Service[Any, Any]) -> Serve:
    """Return the function to which each transport passes a service's requests."""
    return service._serve
