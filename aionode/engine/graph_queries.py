"""Graph queries shared by both kinds of nodes: rclpy's methods."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Protocol

from msgspec import Struct

from aionode import names
from aionode.errors import NodeNameNonExistentError
from aionode.graph import SERVICE_KINDS, TOPIC_KINDS, EndpointKind

if TYPE_CHECKING:
    from collections.abc import Iterable

    from aionode.graph import EndpointInfo, Graph, NodeInfo
    from aionode.qos import QoSProfile

__all__ = [
    "GraphAnswers",
    "GraphQueries",
    "NamesAndTypes",
    "TopicEndpointInfo",
    "TopicEndpointTypeEnum",
    "actions_among",
    "names_and_types_of",
    "topic_endpoint_info",
]

NamesAndTypes = list[tuple[str, list[str]]]


class TopicEndpointTypeEnum(IntEnum):
    """The kind of endpoint that a `TopicEndpointInfo` describes, with rclpy's values."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


ENDPOINT_TYPES = {
    EndpointKind.PUBLISHER: TopicEndpointTypeEnum.PUBLISHER,
    EndpointKind.SUBSCRIPTION: TopicEndpointTypeEnum.SUBSCRIPTION,
}


class TopicEndpointInfo(Struct, frozen=True):
    """A publisher or subscription, with rclpy's attribute names.

    Attributes:
        node_name: Name of its node.
        node_namespace: Namespace of its node.
        topic_type: ROS name of its type.
        topic_type_hash: RIHS01 hash of the type, as text.
        endpoint_type: Whether it publishes or subscribes.
        endpoint_gid: The 16 bytes that identify it, as numbers.
        qos_profile: Its QoS.
    """

    node_name: str
    node_namespace: str
    topic_type: str
    topic_type_hash: str
    endpoint_type: TopicEndpointTypeEnum
    endpoint_gid: list[int]
    qos_profile: QoSProfile


class GraphAnswers(Protocol):
    """The queries behind `GraphQueries`; names are as given by the program."""

    def nodes(self) -> Iterable[NodeInfo]:
        """Return all nodes."""

    def names_and_types(self, kinds: Iterable[EndpointKind]) -> NamesAndTypes:
        """Return the names of endpoints of these kinds, with their types."""

    def names_and_types_of(
        self, kind: EndpointKind, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        """Return the names of a node's endpoints of one kind, with their types."""

    def count(self, kind: EndpointKind, name: str) -> int:
        """Count the endpoints of a kind that have a name."""


class GraphQueries:
    """The graph queries that nodes of both APIs answer in the same way.

    Args:
        answers: Provides the answers. It is not a base class: a program's subclass may have methods
            of any other name.
    """

    def __init__(self, answers: GraphAnswers) -> None:
        self.__answers = answers

    # Nodes

    def get_node_names(self) -> list[str]:
        """Return the names of all nodes, without namespaces."""
        return [node.name for node in self.__answers.nodes()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """Return the full names of all nodes."""
        return [node.fully_qualified_name for node in self.__answers.nodes()]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Return the name and namespace of every node."""
        return [(node.name, node.namespace) for node in self.__answers.nodes()]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Return the name, namespace and security enclave of every node."""
        return [(node.name, node.namespace, node.enclave) for node in self.__answers.nodes()]

    # Topics and services by name

    def get_topic_names_and_types(
        self,
        no_demangle: bool = False,  # noqa: ARG002  # rclpy's signature
        *,
        include_hidden: bool = True,
    ) -> NamesAndTypes:
        """Return every topic with its types; `no_demangle` is ignored.

        Hidden topics, whose names have a part that starts with ``_``, belong to actions and tools;
        without `include_hidden` they are left out, as in ``ros2 topic list``.
        """
        return shown(self.__answers.names_and_types(TOPIC_KINDS), include_hidden)

    def get_service_names_and_types(self, *, include_hidden: bool = True) -> NamesAndTypes:
        """Return every service that has a server or a client, with its types.

        Without `include_hidden`, hidden services are left out, such as those of actions.
        """
        return shown(self.__answers.names_and_types(SERVICE_KINDS), include_hidden)

    def count_publishers(self, topic_name: str) -> int:
        """Count the publishers of `topic_name`; a relative name is resolved for this node."""
        return self.__answers.count(EndpointKind.PUBLISHER, topic_name)

    def count_subscribers(self, topic_name: str) -> int:
        """Count the subscriptions of `topic_name`; a relative name is resolved for this node."""
        return self.__answers.count(EndpointKind.SUBSCRIPTION, topic_name)

    def count_services(self, service_name: str) -> int:
        """Count the servers of `service_name`; a relative name is resolved for this node."""
        return self.__answers.count(EndpointKind.SERVER, service_name)

    def count_clients(self, service_name: str) -> int:
        """Count the clients of `service_name`; a relative name is resolved for this node."""
        return self.__answers.count(EndpointKind.CLIENT, service_name)

    # By node

    def get_publisher_names_and_types_by_node(
        self,
        node_name: str,
        node_namespace: str,
        no_demangle: bool = False,  # noqa: ARG002  # rclpy's signature
    ) -> NamesAndTypes:
        """Return the topics that a node publishes, with their types.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return self.__answers.names_and_types_of(EndpointKind.PUBLISHER, node_name, node_namespace)

    def get_subscriber_names_and_types_by_node(
        self,
        node_name: str,
        node_namespace: str,
        no_demangle: bool = False,  # noqa: ARG002  # rclpy's signature
    ) -> NamesAndTypes:
        """Return the topics that a node subscribes to, with their types.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return self.__answers.names_and_types_of(
            EndpointKind.SUBSCRIPTION, node_name, node_namespace
        )

    def get_service_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        """Return the services that a node serves, with their types.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return self.__answers.names_and_types_of(EndpointKind.SERVER, node_name, node_namespace)

    def get_client_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        """Return the services that a node calls, with their types.

        Raises:
            NodeNameNonExistentError: there is no such node.
        """
        return self.__answers.names_and_types_of(EndpointKind.CLIENT, node_name, node_namespace)


def names_and_types_of(graph: Graph, kind: EndpointKind, full_name: str) -> NamesAndTypes:
    """Return the names of a node's endpoints of one kind, with their types.

    Raises:
        NodeNameNonExistentError: there is no such node.
    """
    node = next(graph.find_nodes(full_name), None)
    if node is None:
        raise NodeNameNonExistentError(full_name)
    return graph.names_and_types(kind, node=node)


def topic_endpoint_info(endpoint: EndpointInfo) -> TopicEndpointInfo:
    """Return `endpoint` as rclpy's `TopicEndpointInfo`."""
    return TopicEndpointInfo(
        node_name=endpoint.node.name,
        node_namespace=endpoint.node.namespace,
        topic_type=endpoint.type_name,
        topic_type_hash=endpoint.type_hash,
        endpoint_type=ENDPOINT_TYPES[endpoint.kind],
        endpoint_gid=list(endpoint.gid),
        qos_profile=endpoint.qos,
    )


def shown(found: NamesAndTypes, include_hidden: bool) -> NamesAndTypes:
    """Return names and types, with or without hidden names."""
    return found if include_hidden else [entry for entry in found if not names.is_hidden(entry[0])]


def actions_among(topics: NamesAndTypes) -> NamesAndTypes:
    """Return the actions among `topics`, found by their feedback topics as rcl_action does."""
    suffix, type_suffix = "/_action/feedback", "_FeedbackMessage"
    return [
        (topic.removesuffix(suffix), [name.removesuffix(type_suffix) for name in types])
        for topic, types in topics
        if topic.endswith(suffix) and all(name.endswith(type_suffix) for name in types)
    ]
