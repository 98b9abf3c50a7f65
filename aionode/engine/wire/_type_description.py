"""Type descriptions, which ROS 2 nodes exchange and from which type hashes are computed.

A description lists every field with its type, for a type and all types that it uses, like the
messages of `type_description_interfaces`.
"""

from __future__ import annotations

from keyword import iskeyword
from typing import TYPE_CHECKING, Any, TypedDict

from aionode.message import ActionType, FieldType, ServiceType, fields, type_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.interfaces.type_description_interfaces.msg import (
        IndividualTypeDescription,
        TypeDescription,
    )

__all__ = [
    "Description",
    "FieldDescription",
    "FieldTypeDescription",
    "Individual",
    "describe",
    "description_message",
    "referenced_types",
]

TYPE_IDS = {
    "message": 1,
    "int8": 2,
    "uint8": 3,
    "int16": 4,
    "uint16": 5,
    "int32": 6,
    "uint32": 7,
    "int64": 8,
    "uint64": 9,
    "float32": 10,
    "float64": 11,
    "bool": 15,
    "byte": 16,
    "string": 17,
    "wstring": 18,
    # In .msg files, char is an alias of uint8; 13 is IDL's char.
    "char": 3,
}

BOUNDED_TEXT = 4
"""Added to the id of a string that is bounded."""

CONTAINERS = {"single": 0, "array": 48, "bounded": 96, "unbounded": 144}
"""Added to the id of the element type, by container."""


class FieldTypeDescription(TypedDict):
    """The type of a field."""

    type_id: int
    capacity: int
    string_capacity: int
    nested_type_name: str


class FieldDescription(TypedDict):
    """A field."""

    name: str
    type: FieldTypeDescription


class Individual(TypedDict):
    """The fields of one type."""

    type_name: str
    fields: list[FieldDescription]


class Description(TypedDict):
    """A type and all types that it uses, sorted by name."""

    type_description: Individual
    referenced_type_descriptions: list[Individual]


def describe(cls: type[Any]) -> Description:
    """Return the description of a message, service or action class.

    Raises:
        TypeError: `cls` is not such a class.
    """
    return {
        "type_description": individual(cls),
        "referenced_type_descriptions": [individual(part) for part in referenced_types(cls)],
    }


def description_message(cls: type[Any]) -> TypeDescription:
    """Return the description as a message, as nodes send it on request.

    Raises:
        TypeError: `cls` is not a message, service or action class.
    """
    # Imported here, as they are only needed for a request.
    from aionode.interfaces.type_description_interfaces.msg import (
        TypeDescription,
    )

    return TypeDescription(
        type_description=individual_message(cls),
        referenced_type_descriptions=[individual_message(part) for part in referenced_types(cls)],
    )


def individual_message(cls: type[Any]) -> IndividualTypeDescription:
    """Return the description of a single type as a message, including default values."""
    from aionode.interfaces.type_description_interfaces import msg

    form = individual(cls)
    is_whole = issubclass(cls, ServiceType | ActionType)
    defaults = {} if is_whole else {field.name: field.default for field in fields(cls)}
    return msg.IndividualTypeDescription(
        type_name=form["type_name"],
        fields=[
            msg.Field(
                name=member["name"],
                type=msg.FieldType(**member["type"]),
                default_value=default_text(defaults.get(member["name"])),
            )
            for member in form["fields"]
        ],
    )


def default_text(default: object) -> str:
    """Return a default value in ROS's notation; empty if there is none."""
    if default is None:
        return ""
    if isinstance(default, bytes):
        return str(default[0])
    return str(default)


def individual(cls: type[Any]) -> Individual:
    """Return the description of a single type."""
    name = type_name(cls)
    if issubclass(cls, ServiceType | ActionType):
        members = [nested_member(name, part) for name, part in halves(cls)]
    else:
        members = [member(ros_name(field.name), field.type) for field in fields(cls)]
    # IDL does not allow structures without fields.
    placeholder = member("structure_needs_at_least_one_member", FieldType("uint8"))
    return {"type_name": name, "fields": members or [placeholder]}


def ros_name(name: str) -> str:
    """Return a field's name in ROS: here, Python keywords have a trailing underscore."""
    plain = name.removesuffix("_")
    return plain if iskeyword(plain) else name


def halves(cls: type[Any]) -> Iterator[tuple[str, type[Any]]]:
    """Yield the name and type of each part of a service or action."""
    if issubclass(cls, ServiceType):
        yield "request_message", cls.Request
        yield "response_message", cls.Response
        yield "event_message", cls.Event
        return
    yield "goal", cls.Goal
    yield "result", cls.Result
    yield "feedback", cls.Feedback
    yield "send_goal_service", cls.Impl.SendGoalService
    yield "get_result_service", cls.Impl.GetResultService
    yield "feedback_message", cls.Impl.FeedbackMessage


def member(name: str, kind: FieldType) -> FieldDescription:
    """Return the description of a field."""
    bounded = 0 if kind.string_bound is None else BOUNDED_TEXT
    return {
        "name": name,
        "type": {
            "type_id": TYPE_IDS[kind.kind] + bounded + CONTAINERS[kind.container],
            "capacity": kind.size,
            "string_capacity": kind.string_bound or 0,
            "nested_type_name": "" if kind.nested is None else type_name(kind.nested),
        },
    }


def nested_member(name: str, part: type[Any]) -> FieldDescription:
    """Return the description of a field of type `part`, which may be a service."""
    return {
        "name": name,
        "type": {
            "type_id": TYPE_IDS["message"],
            "capacity": 0,
            "string_capacity": 0,
            "nested_type_name": type_name(part),
        },
    }


def referenced_types(cls: type[Any]) -> list[type[Any]]:
    """Return all types that `cls` uses, at any depth, sorted by name."""
    parts: dict[str, type[Any]] = {}
    waiting = used_by(cls)
    while waiting:
        part = waiting.pop()
        name = type_name(part)
        if name not in parts:
            parts[name] = part
            waiting += used_by(part)
    return [parts[name] for name in sorted(parts)]


def used_by(cls: type[Any]) -> list[type[Any]]:
    """Return the types of the fields of `cls` that are not primitive."""
    if issubclass(cls, ServiceType | ActionType):
        return [part for _, part in halves(cls)]
    return [field.type.nested for field in fields(cls) if field.type.nested is not None]
