"""The actions in the graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.engine.graph_queries import actions_among

if TYPE_CHECKING:
    from rclpy.node import Node

__all__ = [
    "get_action_client_names_and_types_by_node",
    "get_action_names_and_types",
    "get_action_server_names_and_types_by_node",
]

NamesAndTypes = list[tuple[str, list[str]]]


def get_action_client_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the actions of which a node is a client.

    Raises:
        NodeNameNonExistentError: there is no such node.
    """
    return actions_among(
        node.get_subscriber_names_and_types_by_node(remote_node_name, remote_node_namespace)
    )


def get_action_server_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the actions that a node serves.

    Raises:
        NodeNameNonExistentError: there is no such node.
    """
    return actions_among(
        node.get_publisher_names_and_types_by_node(remote_node_name, remote_node_namespace)
    )


def get_action_names_and_types(node: Node) -> NamesAndTypes:
    """Return all actions."""
    return actions_among(node.get_topic_names_and_types())
