"""Descriptions of message classes in the form of rosapi."""

from __future__ import annotations

from typing import Any, Final

from aionode.message import Field, FieldType, Message, constants, fields, type_name

__all__ = ["full_text", "type_definitions"]

WORDS: Final = {"float64": "double", "float32": "float", "bool": "boolean", "byte": "octet"}
"""rosapi's names for field types, which are those of IDL; others are unchanged."""


def short_name(cls: type[Message]) -> str:
    """Return the name of a message type without its kind, such as ``std_msgs/String``."""
    package, _, name = type_name(cls).split("/")
    return f"{package}/{name}"


def type_definitions(cls: type[Message]) -> list[dict[str, Any]]:
    """Return a ``rosapi_msgs/msg/TypeDef`` for a message class and each class nested in it."""
    return [type_definition(message_class) for message_class in with_nested(cls)]


def with_nested(cls: type[Message]) -> list[type[Message]]:
    """Return a message class and those nested in it at any depth, each once."""
    classes = {type_name(cls): cls}

    def visit(inner: type[Message]) -> None:
        for field in fields(inner):
            nested = field.type.nested
            if nested is not None and type_name(nested) not in classes:
                classes[type_name(nested)] = nested
                visit(nested)

    visit(cls)
    return list(classes.values())


def type_definition(cls: type[Message]) -> dict[str, Any]:
    """Return the description of one message class."""
    return {
        "type": short_name(cls),
        "fieldnames": [field.name for field in fields(cls)],
        "fieldtypes": [field_type(field.type) for field in fields(cls)],
        "fieldarraylen": [array_length(field.type) for field in fields(cls)],
        "examples": [example(field) for field in fields(cls)],
        "constnames": [constant.name for constant in constants(cls)],
        "constvalues": [str(constant.value) for constant in constants(cls)],
    }


def field_type(type_: FieldType) -> str:
    """Return the name of a field's type, without array and bound markers."""
    if type_.nested is not None:
        return short_name(type_.nested)
    return "uint8" if type_.kind == "char" else WORDS.get(type_.kind, type_.kind)


def array_length(type_: FieldType) -> int:
    """Return the length of an array, 0 for a sequence, and -1 for a single value."""
    if type_.container == "single":
        return -1
    return type_.size if type_.container == "array" else 0


def example(field: Field) -> str:
    """Return the default of a field, as text."""
    if field.type.container != "single":
        return "[]"
    if field.type.nested is not None:
        return "{}"
    zero = {"bool": False, "string": "", "wstring": "", "byte": b"\0"}
    if field.default is not None:
        return str(field.default)
    return str(zero.get(field.type.kind, 0.0 if field.type.kind.startswith("float") else 0))


def full_text(cls: type[Message]) -> str:
    """Return the definitions of a message type and all types that it needs, in one text."""
    from aionode.idl import definition_text  # of all clients, only Foxglove's requests texts

    root, *needed = with_nested(cls)
    parts = [f"{'=' * 80}\nMSG: {short_name(part)}\n{definition_text(part)}" for part in needed]
    return "\n".join([definition_text(root), *parts])
