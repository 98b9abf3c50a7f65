"""The graph as seen by a node. Nobody needs to spin for these queries."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.engine.graph_queries import GraphQueries
from aionode.graph import EndpointKind
from rclpy._entities import in_use_by_node, wait_until
from rclpy._impl.node import NodeHandle
from rclpy.endpoint_info import ServiceEndpointInfo
from rclpy.qos import as_own
from rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from rclpy.type_hash import TypeHash

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo
    from rclpy.context import Context

__all__ = ["NodeGraph"]

TYPES = {
    EndpointKind.PUBLISHER: TopicEndpointTypeEnum.PUBLISHER,
    EndpointKind.SUBSCRIPTION: TopicEndpointTypeEnum.SUBSCRIPTION,
    EndpointKind.CLIENT: TopicEndpointTypeEnum.CLIENT,
    EndpointKind.SERVER: TopicEndpointTypeEnum.SERVER,
}


class NodeGraph(GraphQueries):
    """The part of `Node` with its name, and queries about other nodes."""

    _Node__handle: NodeHandle
    _context: Context

    @property
    def handle(self) -> NodeHandle:
        """The handle."""
        return self._Node__handle

    @handle.setter
    def handle(self, value: Any) -> None:
        raise AttributeError("handle cannot be modified after node creation")

    get_name = in_use_by_node(NodeHandle.get_node_name)
    get_namespace = in_use_by_node(NodeHandle.get_namespace)
    get_fully_qualified_name = in_use_by_node(NodeHandle.get_fully_qualified_name)

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the full name of a topic, remapped unless `only_expand`."""
        with self._Node__handle:
            return self._Node__handle.resolve(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the full name of a service, remapped unless `only_expand`."""
        with self._Node__handle:
            return self._Node__handle.resolve(service, only_expand=only_expand, is_service=True)

    # Nodes

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Block the thread until a node with this name exists; return whether it appeared in time.

        Args:
            fully_qualified_node_name: Namespace and name; the leading slash may be omitted.
            timeout: The longest wait in seconds.
        """
        wanted = "/" + fully_qualified_node_name.removeprefix("/")
        return wait_until(
            lambda: wanted in self.get_fully_qualified_node_names(), self._context, timeout
        )

    # Endpoints

    def get_publishers_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        """Return the publishers of a topic; with `no_mangle` its name is complete."""
        return self._Node__infos(EndpointKind.PUBLISHER, topic_name, is_complete=no_mangle)

    def get_subscriptions_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        """Return the subscriptions of a topic; with `no_mangle` its name is complete."""
        return self._Node__infos(EndpointKind.SUBSCRIPTION, topic_name, is_complete=no_mangle)

    def get_clients_info_by_service(
        self, service_name: str, no_mangle: bool = False
    ) -> list[ServiceEndpointInfo]:
        """Return the clients of a service, in Lyrical; with `no_mangle` its name is complete."""
        return self._Node__services(EndpointKind.CLIENT, service_name, is_complete=no_mangle)

    def get_servers_info_by_service(
        self, service_name: str, no_mangle: bool = False
    ) -> list[ServiceEndpointInfo]:
        """Return the servers of a service, in Lyrical; with `no_mangle` its name is complete."""
        return self._Node__services(EndpointKind.SERVER, service_name, is_complete=no_mangle)

    def _Node__services(
        self, kind: EndpointKind, service_name: str, *, is_complete: bool
    ) -> list[ServiceEndpointInfo]:
        endpoints = self._Node__handle.endpoints(kind, service_name, is_complete=is_complete)
        return [service_info_of(endpoint) for endpoint in endpoints]

    def _Node__infos(
        self, kind: EndpointKind, topic_name: str, *, is_complete: bool
    ) -> list[TopicEndpointInfo]:
        endpoints = self._Node__handle.endpoints(kind, topic_name, is_complete=is_complete)
        return [info_of(endpoint) for endpoint in endpoints]


def info_of(endpoint: EndpointInfo) -> TopicEndpointInfo:
    """Return an endpoint of a topic as rclpy's info object."""
    return TopicEndpointInfo(
        node_name=endpoint.node.name,
        node_namespace=endpoint.node.namespace,
        topic_type=endpoint.type_name,
        topic_type_hash=TypeHash.from_text(endpoint.type_hash),
        endpoint_type=TYPES[endpoint.kind],
        endpoint_gid=list(endpoint.gid),
        qos_profile=as_own(endpoint.qos),
    )


def service_info_of(endpoint: EndpointInfo) -> ServiceEndpointInfo:
    """Return a client or server as rclpy's info object."""
    return ServiceEndpointInfo(
        node_name=endpoint.node.name,
        node_namespace=endpoint.node.namespace,
        service_type=endpoint.type_name,
        service_type_hash=TypeHash.from_text(endpoint.type_hash),
        qos_profiles=[as_own(endpoint.qos)],
        endpoint_gids=[list(endpoint.gid)],
        endpoint_type=TYPES[endpoint.kind],
        endpoint_count=1,
    )
