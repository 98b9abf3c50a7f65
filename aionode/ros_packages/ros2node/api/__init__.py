"""Graph queries of `ros2 node`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from rclpy.node import HIDDEN_NODE_PREFIX
from ros2cli.helpers import wait_for
from ros2cli.node.strategy import NodeStrategy

__all__ = [
    "INFO_NONUNIQUE_WARNING_TEMPLATE",
    "NodeName",
    "NodeNameCompleter",
    "TopicInfo",
    "get_absolute_node_name",
    "get_action_client_info",
    "get_action_server_info",
    "get_node_names",
    "get_publisher_info",
    "get_service_client_info",
    "get_service_server_info",
    "get_subscriber_info",
    "get_topics",
    "has_duplicates",
    "parse_node_name",
    "wait_for_node",
]

INFO_NONUNIQUE_WARNING_TEMPLATE = (
    'There are {num_nodes} nodes in the graph with the exact name "{node_name}". '
    "You are seeing information about only one of them."
)


class NodeName(NamedTuple):
    """A node's name: its parts and the whole."""

    name: str
    namespace: str
    full_name: str


class TopicInfo(NamedTuple):
    """A topic, service or action, and its types."""

    name: str
    types: list[str]


def is_hidden(name: str) -> bool:
    """Return whether a part of a name makes it hidden."""
    return any(part.startswith(HIDDEN_NODE_PREFIX) for part in name.split("/"))


def get_absolute_node_name(node_name: str | None) -> str | None:
    """Return a name with a leading slash; None for None."""
    if not node_name:
        return None
    return node_name if node_name.startswith("/") else f"/{node_name}"


def parse_node_name(node_name: str) -> NodeName:
    """Return the parts of a node's name."""
    whole = node_name if node_name.startswith("/") else f"/{node_name}"
    namespace, _, name = whole.rpartition("/")
    return NodeName(name, namespace or "/", whole)


def has_duplicates(values: list[Any]) -> bool:
    """Return whether a value occurs twice."""
    return len(set(values)) < len(values)


def get_node_names(*, node: Any, include_hidden_nodes: bool = False) -> list[NodeName]:
    """Return the nodes of the graph."""
    return [
        NodeName(name, namespace, f"{namespace.rstrip('/')}/{name}")
        for name, namespace in node.get_node_names_and_namespaces()
        if include_hidden_nodes or (name and not name.startswith(HIDDEN_NODE_PREFIX))
    ]


def wait_for_node(
    node: Any, node_name: str, include_hidden_nodes: bool = False, timeout: float = 1.0
) -> bool:
    """Wait until a node with a full name exists, and return whether it does."""

    def is_there() -> bool:
        names = get_node_names(node=node, include_hidden_nodes=include_hidden_nodes)
        return any(node_name == each.full_name for each in names)

    return wait_for(is_there, timeout)


def get_topics(
    remote_node_name: str,
    func: Callable[[str, str], Any],
    *,
    include_hidden_topics: bool = False,
) -> list[TopicInfo]:
    """Return the result of a query about a node.

    Args:
        remote_node_name: The node.
        func: The query, which takes the node's name and namespace.
        include_hidden_topics: Whether to include hidden names.
    """
    asked = parse_node_name(remote_node_name)
    return [
        TopicInfo(name, types)
        for name, types in func(asked.name, asked.namespace)
        if include_hidden_topics or not is_hidden(name)
    ]


def get_subscriber_info(
    *, node: Any, remote_node_name: str, include_hidden: bool = False
) -> list[TopicInfo]:
    """Return the topics that a node subscribes to."""
    ask = node.get_subscriber_names_and_types_by_node
    return get_topics(remote_node_name, ask, include_hidden_topics=include_hidden)


def get_publisher_info(
    *, node: Any, remote_node_name: str, include_hidden: bool = False
) -> list[TopicInfo]:
    """Return the topics that a node publishes."""
    ask = node.get_publisher_names_and_types_by_node
    return get_topics(remote_node_name, ask, include_hidden_topics=include_hidden)


def get_service_client_info(
    *, node: Any, remote_node_name: str, include_hidden: bool = False
) -> list[TopicInfo]:
    """Return the services that a node calls."""
    ask = node.get_client_names_and_types_by_node
    return get_topics(remote_node_name, ask, include_hidden_topics=include_hidden)


def get_service_server_info(
    *, node: Any, remote_node_name: str, include_hidden: bool = False
) -> list[TopicInfo]:
    """Return the services that a node offers."""
    ask = node.get_service_names_and_types_by_node
    return get_topics(remote_node_name, ask, include_hidden_topics=include_hidden)


def get_action_server_info(
    *, node: Any, remote_node_name: str, include_hidden: bool = False
) -> list[TopicInfo]:
    """Return the actions that a node offers; the node is a `DirectNode` or a `NodeStrategy`."""
    ask = node.get_action_server_names_and_types_by_node
    return get_topics(remote_node_name, ask, include_hidden_topics=include_hidden)


def get_action_client_info(
    *, node: Any, remote_node_name: str, include_hidden: bool = False
) -> list[TopicInfo]:
    """Return the actions that a node uses; the node is a `DirectNode` or a `NodeStrategy`."""
    ask = node.get_action_client_names_and_types_by_node
    return get_topics(remote_node_name, ask, include_hidden_topics=include_hidden)


class NodeNameCompleter:
    """Returns the names of nodes, for an argument of a command.

    Args:
        include_hidden_nodes_key: The argument that says whether to include hidden ones.
    """

    def __init__(self, *, include_hidden_nodes_key: str | None = None) -> None:
        self.include_hidden_nodes_key = include_hidden_nodes_key

    def __call__(self, prefix: str, parsed_args: Any, **kwargs: Any) -> list[str]:
        """Return the names."""
        key = self.include_hidden_nodes_key
        hidden = bool(key) and getattr(parsed_args, key or "")
        with NodeStrategy(parsed_args) as node:
            return [
                each.full_name for each in get_node_names(node=node, include_hidden_nodes=hidden)
            ]
