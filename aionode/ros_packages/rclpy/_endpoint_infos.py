"""Endpoints of the graph as the info objects of rclpy."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.graph import EndpointKind
from rclpy.endpoint_info import ServiceEndpointInfo
from rclpy.qos import as_own
from rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from rclpy.type_hash import TypeHash

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo

__all__ = ["info_of", "service_info_of"]

TYPES = {
    EndpointKind.PUBLISHER: TopicEndpointTypeEnum.PUBLISHER,
    EndpointKind.SUBSCRIPTION: TopicEndpointTypeEnum.SUBSCRIPTION,
    EndpointKind.CLIENT: TopicEndpointTypeEnum.CLIENT,
    EndpointKind.SERVER: TopicEndpointTypeEnum.SERVER,
}


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
