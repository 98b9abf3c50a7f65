"""The actions in the graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from aionode.rclpy._impl.node import NodeHandle
    from aionode.rclpy.node import Node

__all__ = [
    "get_action_client_names_and_types_by_node",
    "get_action_names_and_types",
    "get_action_server_names_and_types_by_node",
]

FEEDBACK = "/_action/feedback"
FEEDBACK_TYPE = "_FeedbackMessage"

NamesAndTypes = list[tuple[str, list[str]]]


def get_action_client_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the actions that a node is a client of.

    Raises:
        NodeNameNonExistentError: there is no such node.
    """
    return of_node(node.handle, EndpointKind.SUBSCRIPTION, remote_node_name, remote_node_namespace)


def get_action_server_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the actions that a node serves.

    Raises:
        NodeNameNonExistentError: there is no such node.
    """
    return of_node(node.handle, EndpointKind.PUBLISHER, remote_node_name, remote_node_namespace)


def get_action_names_and_types(node: Node) -> NamesAndTypes:
    """Return all actions."""
    with node.handle:
        return actions_among(node.handle.topic_names_and_types())


def of_node(handle: NodeHandle, kind: EndpointKind, name: str, namespace: str) -> NamesAndTypes:
    """Return the actions of whose feedback topics a node has an end."""
    with handle:
        return actions_among(handle.names_and_types_of(kind, name, namespace))


def actions_among(topics: NamesAndTypes) -> NamesAndTypes:
    """Return the actions among topics: each has one for feedback."""
    return [
        (topic.removesuffix(FEEDBACK), [name.removesuffix(FEEDBACK_TYPE) for name in types])
        for topic, types in topics
        if topic.endswith(FEEDBACK) and all(name.endswith(FEEDBACK_TYPE) for name in types)
    ]
