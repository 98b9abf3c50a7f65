"""Graph queries of `ros2 action`; their node is a `DirectNode` or a `NodeStrategy`."""

from __future__ import annotations

from typing import Any

from rclpy.expand_topic_name import expand_topic_name
from rclpy.validate_full_topic_name import validate_full_topic_name
from ros2cli.node.strategy import NodeStrategy
from rosidl_runtime_py import get_action_interfaces

__all__ = [
    "action_name_completer",
    "action_type_completer",
    "get_action_clients_and_servers",
    "get_action_names",
    "get_action_names_and_types",
]

Ends = list[tuple[str, list[str]]]


def get_action_clients_and_servers(*, node: Any, action_name: str) -> tuple[Ends, Ends]:
    """Return the nodes that use an action, and those that offer it, each with its types.

    Raises:
        ValueError: The name is not valid.
    """
    wanted = expand_topic_name(action_name, node.get_name(), node.get_namespace())
    validate_full_topic_name(wanted)
    nodes = node.get_node_names_and_namespaces()

    def having(ask: Any) -> Ends:
        return [
            (f"{namespace.rstrip('/')}/{name}", types)
            for name, namespace in nodes
            for action, types in ask(name, namespace)
            if action == wanted
        ]

    return (
        having(node.get_action_client_names_and_types_by_node),
        having(node.get_action_server_names_and_types_by_node),
    )


def get_action_names_and_types(*, node: Any) -> Any:
    """Return the actions of the graph, with their types."""
    return node.get_action_names_and_types()


def get_action_names(*, node: Any) -> list[str]:
    """Return the actions of the graph."""
    return [name for name, _ in get_action_names_and_types(node=node)]


def action_name_completer(prefix: str, parsed_args: Any, **kwargs: Any) -> list[str]:
    """Return the names of actions, for an argument of a command."""
    with NodeStrategy(parsed_args) as node:
        return get_action_names(node=node)


def action_type_completer(**kwargs: Any) -> list[str]:
    """Return the types of actions."""
    found = get_action_interfaces()
    return [f"{package}/{name}" for package, names in found.items() for name in names]
