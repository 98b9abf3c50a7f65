"""Finds classes by their ROS names, and the ROS names of classes."""

from __future__ import annotations

from typing import Any

from aionode.idl.search import find
from aionode.message import ActionType, Message, ServiceType, type_name
from rosidl_generator_py import _classes
from rosidl_generator_py._classes import ACTION_PARTS, SERVICE_PARTS, python_class

__all__ = [
    "action_class",
    "aionode_class",
    "classes_of",
    "interface_class",
    "message_class",
    "ros_type_name",
    "service_class",
]


def interface_class(name: str) -> type[Any]:
    """Return the class of a type by its ROS name, such as ``std_msgs/msg/String``.

    Raises:
        InterfaceNotFoundError: There is no such type; the error suggests similar names.
        IdlError: Its definition is not valid.
    """
    return python_class(find(name))


def message_class(name: str) -> type[Any]:
    """Return the class of a message type; see `interface_class`."""
    return of_kind(name, Message)


def service_class(name: str) -> type[Any]:
    """Return the class of a service type, with Request, Response and Event."""
    return of_kind(name, ServiceType)


def action_class(name: str) -> type[Any]:
    """Return the class of an action type, with Goal, Result, Feedback and Impl."""
    return of_kind(name, ActionType)


def of_kind(name: str, base: type[Any]) -> type[Any]:
    """Return the class of a type that must be of one kind."""
    described = find(name)
    if not issubclass(described, base):
        what = {Message: "a message", ServiceType: "a service", ActionType: "an action"}[base]
        raise TypeError(f"{name}: not {what} type")
    return python_class(described)


def aionode_class(cls: Any) -> Any:
    """Return the aionode class of the same ROS type; an aionode class is returned unchanged.

    Raises:
        TypeError: `cls` is not a message, service or action class.
    """
    if isinstance(cls, type):
        if issubclass(cls, Message | ServiceType | ActionType):
            return cls
        described = _classes.aionode_class(cls)
        if described is not None:
            return described
    raise TypeError(f"{cls!r}: not a message, service or action class")


def ros_type_name(cls: Any) -> str:
    """Return the ROS name of a class, such as ``std_msgs/msg/String``.

    Raises:
        TypeError: `cls` is not a message, service or action class.
    """
    return type_name(aionode_class(cls))


def classes_of(name: str) -> dict[str, type[Any]]:
    """Return all classes that rosidl generates for an interface, by their Python names."""
    cls = interface_class(name)
    classes = {cls.__name__: cls}
    if "/msg/" in name:
        return classes
    parts = [getattr(cls, part) for part in (*SERVICE_PARTS, *ACTION_PARTS) if hasattr(cls, part)]
    if hasattr(cls, "Impl"):
        services = (cls.Impl.SendGoalService, cls.Impl.GetResultService)
        parts += [*services, cls.Impl.FeedbackMessage]
        parts += [getattr(service, part) for service in services for part in SERVICE_PARTS]
    return classes | {part.__name__: part for part in parts}
