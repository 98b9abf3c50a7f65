"""Types by their ROS names."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rosidl_parser.definition import NamespacedType
from rosidl_runtime_py.import_message import import_message_from_namespaced_type

__all__ = [
    "get_action",
    "get_action_namespaced_type",
    "get_interface",
    "get_message",
    "get_message_namespaced_type",
    "get_namespaced_type",
    "get_service",
    "get_service_namespaced_type",
    "is_action",
    "is_message",
    "is_service",
]


def get_interface(identifier: str) -> Any:
    """Return the class of any type, such as ``std_msgs/msg/String``."""
    return import_message_from_namespaced_type(get_namespaced_type(identifier))


def get_message(identifier: str) -> Any:
    """Return a message class; ``std_msgs/String`` will do."""
    return of_kind(get_message_namespaced_type(identifier), is_message, "a message", identifier)


def get_service(identifier: str) -> Any:
    """Return a service class; ``std_srvs/Trigger`` will do."""
    return of_kind(get_service_namespaced_type(identifier), is_service, "a service", identifier)


def get_action(identifier: str) -> Any:
    """Return an action class; ``example_interfaces/Fibonacci`` will do."""
    return of_kind(get_action_namespaced_type(identifier), is_action, "an action", identifier)


def of_kind(
    type_: NamespacedType, is_kind: Callable[[Any], bool], what: str, identifier: str
) -> Any:
    """Return the class of a type that must be of one kind."""
    interface = import_message_from_namespaced_type(type_)
    if not is_kind(interface):
        raise ValueError(f"Expected the full name of {what}, got '{identifier}'")
    return interface


def get_namespaced_type(identifier: str) -> NamespacedType:
    """Return the type with a full name."""
    return named(identifier, None)


def get_message_namespaced_type(identifier: str) -> NamespacedType:
    """Return the type with the name of a message."""
    return named(identifier, "msg")


def get_service_namespaced_type(identifier: str) -> NamespacedType:
    """Return the type with the name of a service."""
    return named(identifier, "srv")


def get_action_namespaced_type(identifier: str) -> NamespacedType:
    """Return the type with the name of an action."""
    return named(identifier, "action")


def named(identifier: str, kind: str | None) -> NamespacedType:
    """Return the type with a name; `kind` is added if it is missing."""
    *namespaces, name = identifier.split("/")
    if len(namespaces) == 1 and kind is not None:
        namespaces.append(kind)
    return NamespacedType(namespaces, name)


def is_message(interface: Any) -> bool:
    """Return whether a class is a message class."""
    return hasattr(interface, "SLOT_TYPES")


def is_service(interface: Any) -> bool:
    """Return whether a class is a service class."""
    return hasattr(interface, "Request") and hasattr(interface, "Response")


def is_action(interface: Any) -> bool:
    """Return whether a class is an action class."""
    return all(hasattr(interface, part) for part in ("Goal", "Result", "Feedback"))
