"""The graph as a node sees it. Nobody needs to spin for that."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode._node.graph import GraphQueries
from aionode.clock import MachineTime
from aionode.graph import EndpointKind
from aionode.rclpy._impl.destroyable import Wakeup
from aionode.rclpy.qos import as_own
from aionode.rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from aionode.rclpy.type_hash import TypeHash

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo
    from aionode.rclpy._impl.node import NodeHandle

__all__ = ["NodeGraph"]

CHECK_S = 0.05
"""Time between two looks of `wait_for_node`."""

TYPES = {
    EndpointKind.PUBLISHER: TopicEndpointTypeEnum.PUBLISHER,
    EndpointKind.SUBSCRIPTION: TopicEndpointTypeEnum.SUBSCRIPTION,
}

steady_ns = MachineTime().steady_ns


class NodeGraph(GraphQueries):
    """The part of `Node` that has a name, and looks at others."""

    _handle: NodeHandle

    @property
    def _graph_answers(self) -> NodeHandle:  # type: ignore[override] # it may be destroyed
        return self._handle

    @property
    def handle(self) -> NodeHandle:
        """The handle."""
        return self._handle

    @handle.setter
    def handle(self, value: Any) -> None:
        raise AttributeError("handle cannot be modified after node creation")

    def get_name(self) -> str:
        """Return the name without namespace."""
        with self._handle:
            return self._handle.get_node_name()

    def get_namespace(self) -> str:
        """Return the namespace, which begins with a slash."""
        with self._handle:
            return self._handle.get_namespace()

    def get_fully_qualified_name(self) -> str:
        """Return namespace and name in one."""
        with self._handle:
            return self._handle.get_fully_qualified_name()

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the full name of a topic, remapped unless `only_expand`."""
        with self._handle:
            return self._handle.resolve(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the full name of a service, remapped unless `only_expand`."""
        with self._handle:
            return self._handle.resolve(service, only_expand=only_expand, is_service=True)

    # Nodes

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Block the thread until a node of this name is there; return whether it is in time.

        Args:
            fully_qualified_node_name: Namespace and name; the leading slash may be left out.
            timeout: The longest wait in seconds.
        """
        wanted = "/" + fully_qualified_node_name.removeprefix("/")
        ends_ns = steady_ns() + int(timeout * 1e9)
        wakeup = Wakeup()
        while wanted not in self.get_fully_qualified_node_names():
            left_s = (ends_ns - steady_ns()) / 1e9
            if left_s <= 0:
                return False
            wakeup.wait(min(left_s, CHECK_S))
        return True

    # Endpoints

    def get_publishers_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        """Return the publishers of a topic; with `no_mangle` its name is complete."""
        found = self._handle.endpoints(EndpointKind.PUBLISHER, topic_name, is_complete=no_mangle)
        return [info_of(endpoint) for endpoint in found]

    def get_subscriptions_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        """Return the subscriptions of a topic; with `no_mangle` its name is complete."""
        found = self._handle.endpoints(EndpointKind.SUBSCRIPTION, topic_name, is_complete=no_mangle)
        return [info_of(endpoint) for endpoint in found]


def info_of(endpoint: EndpointInfo) -> TopicEndpointInfo:
    """Return what rclpy tells of an endpoint of a topic."""
    return TopicEndpointInfo(
        node_name=endpoint.node.name,
        node_namespace=endpoint.node.namespace,
        topic_type=endpoint.type_name,
        topic_type_hash=TypeHash.from_text(endpoint.type_hash),
        endpoint_type=TYPES[endpoint.kind],
        endpoint_gid=list(endpoint.gid),
        qos_profile=as_own(endpoint.qos),
    )
