"""Creates classes from type descriptions, for types whose definition is not available.

Descriptions come from other processes and may contain anything. Names are validated where classes
are created; the cost of a class is checked here, before its first message is created.
"""

from __future__ import annotations

import ast
from types import new_class
from typing import TYPE_CHECKING, Annotated, Any, Final

from aionode.errors import TypeDescriptionError, brief
from aionode.message import DTYPES, ActionType, FieldType, Message, ServiceType

if TYPE_CHECKING:
    from aionode.interfaces.type_description_interfaces.msg import TypeDescription

__all__ = ["action_from_descriptions", "type_from_description"]

KINDS: Final = {
    1: "message",
    2: "int8",
    3: "uint8",
    4: "int16",
    5: "uint16",
    6: "int32",
    7: "uint32",
    8: "int64",
    9: "uint64",
    10: "float32",
    11: "float64",
    13: "char",
    15: "bool",
    16: "byte",
    17: "string",
    18: "wstring",
    21: "string",
    22: "wstring",
}
CONTAINERS: Final = ("single", "array", "bounded", "unbounded")
PLACEHOLDER: Final = "structure_needs_at_least_one_member"

MAX_TYPES: Final = 1_000
"""Maximum number of types in a description; MoveIt's largest action uses 80."""

MAX_FIELDS: Final = 10_000
"""Maximum total number of fields in a description."""

MAX_DEPTH: Final = 50
"""Maximum nesting depth of types."""

MAX_BOUND: Final = 2**32 - 1
"""Maximum bound of a sequence or string, whose length is encoded in 32 bits."""

MAX_MESSAGE: Final = 2**26
"""Maximum estimated size of a new message in bytes, including all array elements."""

MAX_DEFAULT: Final = 2**20
"""Maximum length of a default value in characters."""

VALUE_SIZE: Final = 64
"""Approximate memory of one value of a message in bytes: a Python object and its slot."""

ELEMENT_SIZE: Final = 8
"""Maximum memory of one number in an array, in bytes."""


def type_from_description(description: TypeDescription) -> Any:
    """Return the message or service class for a description.

    The class is not registered with `aionode.interfaces.get_interface`.

    Raises:
        TypeDescriptionError: the description is invalid or exceeds a limit (a ValueError).
    """
    described = DescribedTypes(description)
    name = described.name
    halves = [f"{name}_Request", f"{name}_Response"]
    if "/srv/" in name or all(half in described.parts for half in halves):
        return described.composed(ServiceType, ("Request", "Response"), halves)
    return described.message(name)


def action_from_descriptions(
    name: str, send_goal: TypeDescription, get_result: TypeDescription, feedback: TypeDescription
) -> Any:
    """Return the action class for the descriptions of its services and feedback message.

    Args:
        name: The ROS name of the action.
        send_goal: The description of the service ``<name>_SendGoal``.
        get_result: The description of the service ``<name>_GetResult``.
        feedback: The description of the message ``<name>_FeedbackMessage``.

    Raises:
        TypeDescriptionError: a description is invalid or exceeds a limit (a ValueError).
    """
    body = {
        half: DescribedTypes(description, name).message(f"{name}_{half}")
        for half, description in (
            ("Goal", send_goal),
            ("Result", get_result),
            ("Feedback", feedback),
        )
    }
    return composed(ActionType, name, body)


def composed(base: type[Any], name: str, halves: dict[str, type[Message]]) -> Any:
    """Return the class of a service or action."""
    body = {"__doc__": f"{name}, as a node describes it.", **halves}
    return new_type(base, name, body)


def new_type(base: type[Any], name: str, body: dict[str, Any]) -> Any:
    """Create a class with this ROS name.

    Raises:
        TypeDescriptionError: the name of the type or of a field is invalid.
    """
    if not name:
        raise TypeDescriptionError(name, "it has no name")
    options = {"typename": name, "by_name": False}
    short_name = name.rpartition("/")[2]
    try:
        return new_class(short_name, (base,), options, lambda space: space.update(body))
    except (TypeError, ValueError) as error:
        raise TypeDescriptionError(name, brief(str(error))) from error


def default_of(type_: FieldType, text: str) -> object:
    """Parse a default value.

    Raises:
        ValueError: it does not fit the type; other exceptions of `ast.literal_eval` are possible.
        TypeError: it is not a list.
    """
    if len(text) > MAX_DEFAULT:
        raise ValueError("it is too long")
    kind = type_.kind
    if type_.container != "single":
        value = ast.literal_eval(text)
        if not isinstance(value, list | tuple):
            raise TypeError("it is not a list")
        return tuple(value)
    if kind in {"string", "wstring"}:
        return text
    if kind == "bool":
        if text.lower() not in {"true", "false", "1", "0"}:
            raise ValueError("use True or False")
        return text.lower() in {"true", "1"}
    if kind in {"float32", "float64"}:
        return float(text)
    number = int(text, 0)
    return bytes((number,)) if kind == "byte" else number


class DescribedTypes:
    """Creates the classes of one description on demand.

    Args:
        description: The description.
        name: The name for errors; by default that of the described type.

    Raises:
        TypeDescriptionError: it has too many types or fields.
    """

    def __init__(self, description: TypeDescription, name: str = "") -> None:
        main = description.type_description
        parts = (main, *description.referenced_type_descriptions)
        self.name: str = name or main.type_name
        self.parts = {part.type_name: part for part in parts}
        self._made: dict[str, type[Message]] = {}
        self._size_bytes: dict[str, int] = {}  # of a new message of each class
        self._open: list[str] = []  # types being created; each uses the next
        if len(parts) > MAX_TYPES:
            raise self._error(f"it has {len(parts)} types, at most {MAX_TYPES} are allowed")
        count = sum(len(part.fields) for part in parts)
        if count > MAX_FIELDS:
            raise self._error(f"it has {count} fields, at most {MAX_FIELDS} are allowed")

    def _error(self, problem: str) -> TypeDescriptionError:
        return TypeDescriptionError(self.name, problem)

    def composed(self, base: type[Any], halves: tuple[str, ...], names: list[str]) -> Any:
        """Return the class of a service, composed of the messages with these names."""
        parts = map(self.message, names)
        return composed(base, self.name, dict(zip(halves, parts, strict=True)))

    def message(self, name: str) -> type[Message]:
        """Return the class of one message.

        Raises:
            TypeDescriptionError: the type is missing, contains itself, or exceeds a limit.
        """
        if name in self._made:
            return self._made[name]
        if name not in self.parts:
            raise self._error(f"it lacks the type {brief(name)}")
        if name in self._open:
            raise self._error(f"{brief(name)} contains itself")
        if len(self._open) >= MAX_DEPTH:
            raise self._error(f"its types are nested more than {MAX_DEPTH} deep")
        self._open.append(name)
        cls = self._make(name)
        self._open.pop()
        self._made[name] = cls
        return cls

    def _make(self, name: str) -> type[Message]:
        types: dict[str, FieldType] = {}
        defaults: dict[str, object] = {}
        size_bytes = VALUE_SIZE
        for field in self.parts[name].fields:
            if field.name != PLACEHOLDER:
                types[field.name] = self._field_type(field)
                if field.default_value:
                    defaults[field.name] = self._default(field, types[field.name])
                size_bytes += self._size_of(types[field.name])
        if size_bytes > MAX_MESSAGE:
            raise self._error(
                f"a new {brief(name)} takes {size_bytes / 2**20:.3g} MiB including its "
                f"arrays; at most {MAX_MESSAGE >> 20} MiB are allowed"
            )
        self._size_bytes[name] = size_bytes
        body = {
            "__annotations__": {field: Annotated[Any, type_] for field, type_ in types.items()},
            "__doc__": f"{name}, as a node describes it.",
            **defaults,
        }
        cls: type[Message] = new_type(Message, name, body)
        return cls

    def _field_type(self, field: Any) -> FieldType:
        """Return the type of a field; its `type_id` encodes kind and container."""
        described = field.type
        container, kind = divmod(described.type_id, 48)
        if kind not in KINDS or container >= len(CONTAINERS):
            raise self._error(f"{brief(field.name)} has the unknown type id {described.type_id}")
        if described.string_capacity > MAX_BOUND:
            raise self._error(
                f"{brief(field.name)} is a string of {described.string_capacity} characters, "
                f"at most {MAX_BOUND} are allowed"
            )
        sized = CONTAINERS[container] in {"array", "bounded"}
        if sized and not 0 < described.capacity <= MAX_BOUND:
            raise self._error(
                f"{brief(field.name)} has {described.capacity} elements; "
                f"1 to {MAX_BOUND} are allowed"
            )
        return FieldType(
            KINDS[kind],
            self.message(described.nested_type_name) if kind == 1 else None,
            described.string_capacity or None,
            CONTAINERS[container],
            described.capacity if sized else 0,
        )

    def _default(self, field: Any, type_: FieldType) -> object:
        """Return the default of a field, which ROS writes in Python notation."""
        text: str = field.default_value
        try:
            return default_of(type_, text)
        except (ValueError, TypeError, SyntaxError, MemoryError, RecursionError) as error:
            raise self._error(
                f"{brief(field.name)} has the default {brief(text)}, which is not a {type_}: "
                f"{brief(str(error))}"
            ) from error

    def _size_of(self, type_: FieldType) -> int:
        """Return the approximate size of the field in a new message, in bytes."""
        size_bytes = VALUE_SIZE
        if type_.nested is not None:
            size_bytes += self._size_bytes[type_.nested.__ros_type__]
        elif type_.container == "array" and type_.kind in DTYPES:
            size_bytes = ELEMENT_SIZE
        return size_bytes * type_.size if type_.container == "array" else size_bytes
