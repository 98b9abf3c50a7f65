"""Messages as dictionaries, YAML and comma-separated values."""

from __future__ import annotations

import sys
from array import array
from collections import OrderedDict
from dataclasses import dataclass
from typing import Any

import numpy as np
import yaml

from aionode.rclpy._rosidl_parser.definition import (
    AbstractString,
    AbstractWString,
    Array,
    BasicType,
    BoundedSequence,
    NamespacedType,
)

__all__ = [
    "get_message_slot_types",
    "message_to_csv",
    "message_to_ordereddict",
    "message_to_yaml",
]


def get_message_slot_types(msg: Any) -> OrderedDict[str, Any]:
    """Return the type of each field of a message, or of a message class."""
    return OrderedDict(zip(msg.get_fields_and_field_types(), msg.SLOT_TYPES, strict=True))


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Return a message as a dictionary of numbers, strings, lists and dictionaries.

    Args:
        msg: The message.
        truncate_length: The largest number of elements or characters that are shown.
        no_arr: Show type and length instead of arrays and sequences.
        no_str: Show the length instead of strings.
    """
    return Conversion(truncate_length, no_arr, no_str).message(msg)


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Return a message as YAML; see `message_to_ordereddict`."""
    shown = message_to_ordereddict(
        msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str
    )
    return yaml.dump(
        shown,
        Dumper=OrderedDumper,
        allow_unicode=True,
        width=sys.maxsize,
        default_flow_style=flow_style,
    )


def message_to_csv(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> str:
    """Return the values of a message in a line; see `message_to_ordereddict`."""
    conversion = Conversion(truncate_length, no_arr, no_str)
    values = (
        conversion.text(getattr(msg, name), type_)
        for name, type_ in get_message_slot_types(msg).items()
    )
    return ",".join(values)


class OrderedDumper(yaml.Dumper):
    """Writes dictionaries in their order."""


OrderedDumper.add_representer(
    OrderedDict,
    lambda dumper, data: dumper.represent_mapping("tag:yaml.org,2002:map", data.items()),
)


@dataclass(frozen=True)
class Conversion:
    """The extent to which a message is shown."""

    truncate_length: int | None
    no_arr: bool
    no_str: bool

    def message(self, msg: Any) -> OrderedDict[str, Any]:
        """Return a message as a dictionary."""
        return OrderedDict(
            (name, self.value(getattr(msg, name, None), type_))
            for name, type_ in get_message_slot_types(msg).items()
        )

    def value(self, value: Any, type_: Any = None) -> Any:
        """Return the value of a field, or an element if no type is given."""
        if isinstance(value, bytes):
            return self.shortened(value.decode("latin-1"))
        if isinstance(value, str):
            return f"<string length: <{len(value)}>>" if self.no_str else self.shortened(value)
        if isinstance(value, list | tuple | array | np.ndarray):
            if self.no_arr and type_ is not None:
                return described(value, type_)
            shown = [self.value(element) for element in value[: self.truncate_length]]
            if self.is_long(value):
                shown.append("...")
            return tuple(shown) if isinstance(value, tuple) else shown
        if isinstance(value, np.number):
            return value.item()
        if isinstance(value, bool | float | int):
            return value
        return self.message(value)

    def text(self, value: Any, type_: Any = None) -> str:
        """Return the value of a field, or an element if no type is given, for a line of values."""
        if isinstance(value, list | tuple | array | np.ndarray):
            if self.no_arr and type_ is not None:
                return described(value, type_)
            shown = [self.text(element) for element in value[: self.truncate_length]]
            return ",".join([*shown, "..."] if self.is_long(value) else shown)
        if isinstance(value, str):
            return f"<string length: <{len(value)}>>" if self.no_str else self.shortened(value)
        if isinstance(value, bytes):
            short = value[: self.truncate_length]
            return str(short + b"..." if self.is_long(value) else short)
        if isinstance(value, bool | float | int | np.number):
            return str(value)
        return message_to_csv(
            value, truncate_length=self.truncate_length, no_arr=self.no_arr, no_str=self.no_str
        )

    def shortened(self, text: str) -> str:
        """Return a string, with dots for what is left out."""
        return f"{text[: self.truncate_length]}..." if self.is_long(text) else text

    def is_long(self, value: Any) -> bool:
        """Return whether a part of a string or collection is left out."""
        return self.truncate_length is not None and len(value) > self.truncate_length


def described(value: Any, type_: Any) -> str:
    """Return type and length of an array or sequence."""
    element = type_.value_type
    name = "unknown"
    if isinstance(element, BasicType):
        name = element.typename
    elif isinstance(element, NamespacedType):
        name = "/".join(element.namespaced_name())
    elif isinstance(element, AbstractString | AbstractWString):
        name = "string" if isinstance(element, AbstractString) else "wstring"
    if isinstance(type_, Array):
        return f"<array type: {name}[{type_.size}]>"
    if isinstance(type_, BoundedSequence):
        name = f"{name}[{type_.maximum_size}]"
    return f"<sequence type: {name}, length: {len(value)}>"
