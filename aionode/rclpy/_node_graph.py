"""The graph as a node sees it. Nobody needs to spin for that."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode import names
from aionode.clock import MachineTime
from aionode.errors import NameValidationException
from aionode.graph import SERVICE_KINDS, EndpointKind
from aionode.rclpy._impl.destroyable import Wakeup
from aionode.rclpy.qos import as_own
from aionode.rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from aionode.rclpy.type_hash import TypeHash

if TYPE_CHECKING:
    from aionode.rclpy._impl.node import NodeHandle

__all__ = ["NodeGraph"]

NamesAndTypes = list[tuple[str, list[str]]]

CHECK_S = 0.05
"""Time between two looks of `wait_for_node`."""

TYPES = {
    EndpointKind.PUBLISHER: TopicEndpointTypeEnum.PUBLISHER,
    EndpointKind.SUBSCRIPTION: TopicEndpointTypeEnum.SUBSCRIPTION,
}

steady_ns = MachineTime().steady_ns


class NodeGraph:
    """The part of `Node` that has a name, and looks at others."""

    _handle: NodeHandle

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

    def get_node_names(self) -> list[str]:
        """Return the names of all nodes, without namespaces."""
        return [name for name, _ in self.get_node_names_and_namespaces()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """Return the full names of all nodes."""
        return [
            names.fully_qualified_name(namespace, name)
            for name, namespace in self.get_node_names_and_namespaces()
        ]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Return name and namespace of every node."""
        with self._handle:
            return self._handle.get_node_names_and_namespaces()

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Return name, namespace and enclave of every node."""
        with self._handle:
            return self._handle.get_node_names_and_namespaces_with_enclaves()

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

    # Names and types

    def get_topic_names_and_types(self, no_demangle: bool = False) -> NamesAndTypes:
        """Return every topic with its types."""
        with self._handle:
            return self._handle.topic_names_and_types()

    def get_service_names_and_types(self) -> NamesAndTypes:
        """Return every service that has a server or a client, with its types."""
        with self._handle:
            return self._handle.service_names_and_types()

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """Return what a node publishes.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return self._of_node(EndpointKind.PUBLISHER, node_name, node_namespace)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """Return what a node subscribes to.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return self._of_node(EndpointKind.SUBSCRIPTION, node_name, node_namespace)

    def get_service_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        """Return what a node serves.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return self._of_node(EndpointKind.SERVER, node_name, node_namespace)

    def get_client_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        """Return what a node calls.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return self._of_node(EndpointKind.CLIENT, node_name, node_namespace)

    def _of_node(self, kind: EndpointKind, node_name: str, node_namespace: str) -> NamesAndTypes:
        with self._handle:
            return self._handle.names_and_types_of(kind, node_name, node_namespace)

    # Counts

    def count_publishers(self, topic_name: str) -> int:
        """Return how many publishers a topic has."""
        return self._count(EndpointKind.PUBLISHER, topic_name)

    def count_subscribers(self, topic_name: str) -> int:
        """Return how many subscriptions a topic has."""
        return self._count(EndpointKind.SUBSCRIPTION, topic_name)

    def count_clients(self, service_name: str) -> int:
        """Return how many clients a service has."""
        return self._count(EndpointKind.CLIENT, service_name)

    def count_services(self, service_name: str) -> int:
        """Return how many servers a service has."""
        return self._count(EndpointKind.SERVER, service_name)

    def _count(self, kind: EndpointKind, name: str) -> int:
        is_service = kind in SERVICE_KINDS
        with self._handle:
            full_name = self._expected(name, only_expand=True, is_service=is_service)
            return self._handle.count(kind, full_name)

    def _expected(self, name: str, *, only_expand: bool = False, is_service: bool = False) -> str:
        """Return the full name of a topic or service.

        Raises:
            ValueError: the name is invalid, in the words that rclpy has for questions.
        """
        try:
            return self._handle.resolve(name, only_expand=only_expand, is_service=is_service)
        except NameValidationException as error:
            what = "service" if is_service else "topic"
            raise ValueError(f"{what} name is invalid: {error}") from None

    # Endpoints

    def get_publishers_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        """Return the publishers of a topic; with `no_mangle` its name is complete."""
        return self._info_by_topic(EndpointKind.PUBLISHER, topic_name, no_mangle)

    def get_subscriptions_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        """Return the subscriptions of a topic; with `no_mangle` its name is complete."""
        return self._info_by_topic(EndpointKind.SUBSCRIPTION, topic_name, no_mangle)

    def _info_by_topic(
        self, kind: EndpointKind, topic_name: str, no_mangle: bool
    ) -> list[TopicEndpointInfo]:
        with self._handle:
            name = topic_name if no_mangle else self._expected(topic_name)
            found = self._handle.endpoints(kind, name)
        return [
            TopicEndpointInfo(
                node_name=endpoint.node.name,
                node_namespace=endpoint.node.namespace,
                topic_type=endpoint.type_name,
                topic_type_hash=TypeHash.from_text(endpoint.type_hash),
                endpoint_type=TYPES[kind],
                endpoint_gid=list(endpoint.gid),
                qos_profile=as_own(endpoint.qos),
            )
            for endpoint in found
        ]
