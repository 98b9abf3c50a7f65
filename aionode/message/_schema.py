"""JSON Schema of messages, for tools, OpenAPI and Pydantic.

Pydantic is optional. With it, and thus with FastAPI, messages can be used as types of fields,
bodies and responses: Pydantic gets `pydantic_core_schema` and `pydantic_json_schema` from a message
class.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from aionode.message._field_types import INT_RANGES, Field, FieldType
from aionode.message._message import Message, message_class

if TYPE_CHECKING:
    from pydantic import GetJsonSchemaHandler
    from pydantic_core import CoreSchema
    from pydantic_core.core_schema import SerializationInfo

    from aionode.message._message import MessageClass

__all__ = [
    "json_schema",
    "pydantic_core_schema",
    "pydantic_json_schema",
    "pydantic_serializer",
]

Schema = dict[str, Any]

NUMBER: Schema = {"type": "number"}

NUMBER_OR_WORD: Schema = {
    "anyOf": [NUMBER, {"type": "string", "enum": ["NaN", "Infinity", "-Infinity"]}]
}
"""A float as `to_json` writes it, with strings for NaN and the infinities."""


def json_schema(cls: MessageClass[Message]) -> dict[str, Any]:
    """Return the JSON Schema of what `from_json` and `from_builtins` accept for a message class.

    It is a self-contained ``object`` without references, as tools of language models expect, with
    the descriptions from the class's docstring, the ranges of numbers, and the defaults. No field
    is required, as each has a default. For a service or an action, use its ``Request`` or ``Goal``.

    Raises:
        TypeError: `cls` is not a message class.
    """
    return schema_of(message_class(cls), json_schema, NUMBER)


def schema_of(
    cls: type[Message], nested: Callable[[type[Message]], Schema], real: Schema
) -> Schema:
    """Return the schema of a message.

    Args:
        cls: The message class.
        nested: Returns the schema of a nested message.
        real: The schema of a float.
    """
    text, described = documentation(cls)
    schema: Schema = {"title": title(cls), "type": "object"}
    if text:
        schema["description"] = text
    schema["properties"] = {
        field.name: with_notes(
            field, described.get(field.name), value_schema(field.type, nested, real)
        )
        for field in cls.__ros_fields__
    }
    schema["additionalProperties"] = False
    return schema


def title(cls: type[Message]) -> str:
    """Return the name of a message without its package, such as ``AddTwoInts_Request``."""
    return (cls.__ros_type__ or cls.__qualname__).rpartition("/")[2]


def value_schema(
    type_: FieldType, nested: Callable[[type[Message]], Schema], real: Schema
) -> Schema:
    """Return the schema of a field's value."""
    if type_.container != "single":
        element = value_schema(type_.element, nested, real)
        limits = {
            "array": {"minItems": type_.size, "maxItems": type_.size},
            "bounded": {"maxItems": type_.size},
            "unbounded": {},
        }[type_.container]
        return {"type": "array", "items": element, **limits}
    if type_.nested is not None:
        return nested(type_.nested)
    if type_.kind in {"float32", "float64"}:
        return dict(real)
    if type_.kind == "bool":
        return {"type": "boolean"}
    if type_.kind in {"string", "wstring"}:
        bound = {} if type_.string_bound is None else {"maxLength": type_.string_bound}
        return {"type": "string", **bound}
    low, high = INT_RANGES["uint8" if type_.kind == "byte" else type_.kind]
    # 64-bit limits are omitted, since tools that hold them as floats would round them up.
    limits = {"minimum": low, "maximum": high}
    return {"type": "integer", **{name: at for name, at in limits.items() if abs(at) < 2**53}}


def with_notes(field: Field, text: str | None, schema: Schema) -> Schema:
    """Return the schema of a field with its description and default."""
    notes: Schema = {} if text is None else {"description": text}
    if field.type.nested is None and field.type.container == "single":
        zero = {"boolean": False, "string": "", "integer": 0}.get(schema.get("type", ""), 0.0)
        default = zero if field.default is None else field.default
        notes["default"] = default[0] if isinstance(default, bytes) else default
    elif field.default is not None:
        notes["default"] = list(field.default)  # type: ignore[call-overload]  # a tuple
    if "$ref" in schema and notes:  # older OpenAPI tools ignore siblings of a reference
        return {"allOf": [schema], **notes}
    return {**schema, **notes}


def documentation(cls: object) -> tuple[str, dict[str, str]]:
    """Return the docstring's text, and its description of each field under ``Attributes:``."""
    text, _, attributes = inspect.cleandoc(cls.__doc__ or "").partition("\nAttributes:\n")
    described: dict[str, str] = {}
    name = ""
    for line in attributes.splitlines():
        began = re.match(r" {4}(\w+): (.*)", line)
        if began is not None:
            name = began[1]
            described[name] = began[2]
        elif name and line.startswith(" " * 5):
            described[name] += f" {line.strip()}"
        else:
            name = ""
    return " ".join(text.split()), described


# Pydantic


def pydantic_core_schema(cls: type[Message]) -> CoreSchema:
    """Return the Pydantic schema that parses like `from_builtins` and serializes like `to_json`."""
    from pydantic_core import core_schema

    return core_schema.no_info_plain_validator_function(
        partial(validated, cls),
        ref=f"{cls.__module__}.{title(cls)}:{id(cls)}",  # the part before the colon is the name
        serialization=core_schema.plain_serializer_function_ser_schema(serialized, info_arg=True),
    )


def validated(cls: type[Message], value: object) -> Message:
    """Convert `value` to a message of `cls`; raise MessageError, a ValueError, if it is invalid."""
    from aionode.message.conversion import from_builtins

    if isinstance(value, cls):
        return value
    return from_builtins(cls, value)


def serialized(message: Message, info: SerializationInfo) -> dict[str, Any]:
    """Convert a message to builtin types; in JSON mode, with only values that JSON supports."""
    from aionode.message.conversion import to_builtins

    return in_json(message) if info.mode == "json" else to_builtins(message)


def in_json(message: Message) -> dict[str, Any]:
    """Convert a message to builtin types, with only values that JSON supports."""
    from aionode.message._snapshot import snapshot
    from aionode.message.conversion import Form, json_float, plain

    return plain(snapshot(message), Form(json_float))


def pydantic_serializer(cls: type[Message]) -> Any:
    """Return Pydantic's serializer for a message class.

    Raises:
        AttributeError: Pydantic is not installed.
    """
    try:
        from pydantic import TypeAdapter
    except ImportError:
        raise AttributeError("__pydantic_serializer__") from None
    return TypeAdapter(cls).serializer


def pydantic_json_schema(cls: type[Message], handler: GetJsonSchemaHandler) -> Schema:
    """Return the JSON Schema of a message, with references to those of nested messages."""
    from pydantic import TypeAdapter
    from pydantic_core import core_schema

    def nested(other: type[Message]) -> Schema:
        # The handler creates references only for the items of a list.
        several = handler(core_schema.list_schema(TypeAdapter(other).core_schema))
        item: Schema = several["items"]
        return item

    return schema_of(cls, nested, NUMBER_OR_WORD)
