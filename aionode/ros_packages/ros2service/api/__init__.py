"""Graph queries of `ros2 service`."""

from __future__ import annotations

from typing import Any

from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden
from ros2cli.node.strategy import NodeStrategy
from rosidl_runtime_py import get_service_interfaces
from rosidl_runtime_py.utilities import get_service

__all__ = [
    "ServiceNameCompleter",
    "get_service_class",
    "get_service_names",
    "get_service_names_and_types",
    "service_type_completer",
]


def get_service_names_and_types(
    *, node: Any, include_hidden_services: bool = False
) -> list[tuple[str, list[str]]]:
    """Return the services of the graph, with their types."""
    return [
        (name, types)
        for name, types in node.get_service_names_and_types()
        if include_hidden_services or not topic_or_service_is_hidden(name)
    ]


def get_service_names(*, node: Any, include_hidden_services: bool = False) -> list[str]:
    """Return the services of the graph."""
    found = get_service_names_and_types(node=node, include_hidden_services=include_hidden_services)
    return [name for name, _ in found]


def get_service_class(node: Any, service_name: str, include_hidden_services: bool) -> Any:
    """Return the class of a service in the graph.

    Raises:
        RuntimeError: There is no such service, it has several types, or its type is unknown.
    """
    found = dict(
        get_service_names_and_types(node=node, include_hidden_services=include_hidden_services)
    )
    types = found.get(service_name)
    if types is None:
        raise RuntimeError(f"Cannot find type for '{service_name}'")
    if not types:
        raise RuntimeError(f"No types associated with '{service_name}'")
    if len(types) > 1:
        raise RuntimeError(f"More than one type associated with service '{service_name}'")
    try:
        return get_service(types[0])
    except (AttributeError, ModuleNotFoundError, ValueError) as error:
        raise RuntimeError(f"The service type '{types[0]}' is invalid") from error


def service_type_completer(**kwargs: Any) -> list[str]:
    """Return the types of services."""
    found = get_service_interfaces()
    return [f"{package}/{name}" for package, names in found.items() for name in names]


class ServiceNameCompleter:
    """Returns the names of services, for an argument of a command.

    Args:
        include_hidden_services_key: The argument that says whether to include hidden ones.
    """

    def __init__(self, *, include_hidden_services_key: str | None = None) -> None:
        self.include_hidden_services_key = include_hidden_services_key

    def __call__(self, prefix: str, parsed_args: Any, **kwargs: Any) -> list[str]:
        """Return the names."""
        hidden = getattr(parsed_args, self.include_hidden_services_key or "", False)
        with NodeStrategy(parsed_args) as node:
            return get_service_names(node=node, include_hidden_services=hidden)
