"""Encodes and decodes rosidl messages with aionode's codec."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from functools import cache
from typing import Any, Final

from aionode.engine.wire.cdr import Data, MessageFamily, decoder, encoder
from aionode.message import Field, FieldType, Message, fields, type_name
from rosidl_generator_py._classes import aionode_class, python_class
from rosidl_generator_py._field_types import TYPE_CODES, is_numeric

__all__ = ["decode", "decoder_of", "encode", "encoder_of", "from_aionode", "to_aionode"]

ENCODERS: dict[type[Any], Callable[[Any], bytes]] = {}

OCTETS: Final = [bytes((value,)) for value in range(256)]


def encode(msg: Any) -> bytes:
    """Return a message encoded as ROS 2 does (CDR, little endian, with its header).

    A message of aionode is accepted as well. Values that a field cannot hold are refused, even
    where ROS sends something else instead; a bool field accepts any number by its truth value, and
    an integer field accepts a bool.

    Raises:
        MessageError: A value does not fit its field; a `ValueError`.
        AttributeError: A nested message has no attribute for one of its fields.
        TypeError: `msg` is not a message.
    """
    function = ENCODERS.get(msg.__class__)
    if function is None:
        function = ENCODERS[msg.__class__] = encoder_of(msg.__class__)
    return function(msg)


def decode(cls: Any, data: Data) -> Any:
    """Return the message of this class in `data`; it shares no memory with `data`.

    Raises:
        DecodeError: `data` does not hold such a message.
        TypeError: `cls` is not a message class.
    """
    return decoder_of(cls)(data)


@cache
def decoder_of(cls: Any) -> Callable[[Data], Any]:
    """Return a function that decodes messages of one class, like `decode`.

    Raises:
        TypeError: `cls` is not a message class.
    """
    if issubclass(cls, Message):
        return decoder(cls)
    return decoder(described(cls), FAMILY)


@cache
def encoder_of(cls: Any) -> Callable[[Any], bytes]:
    """Return a function that encodes messages of one class, like `encode`.

    Raises:
        TypeError: `cls` is not a message class.
    """
    if issubclass(cls, Message):
        return encoder(cls)
    return encoder(described(cls), FAMILY)


def described(cls: type[Any]) -> type[Message]:
    """Return the aionode class that describes a message class.

    Raises:
        TypeError: It is not a message class.
    """
    description = aionode_class(cls)
    if description is None or not issubclass(description, Message):
        hint = "; use one of its parts, such as .Request" if description else ""
        raise TypeError(f"{cls!r}: not a message class{hint}")
    return description


def from_aionode(msg: Message) -> Any:
    """Return an aionode message as a rosidl message; they share no mutable data.

    Raises:
        MessageError: A value does not fit its field.
    """
    return decode(python_class(type(msg)), encode(msg))


def to_aionode(msg: Any) -> Message:
    """Return a rosidl message as an aionode message, without validation.

    Raises:
        AttributeError: A nested message has no attribute for one of its fields.
        TypeError: `msg` is not a message.
    """
    return adopted(msg, described(msg.__class__))


def adopted(msg: Any, cls: type[Message]) -> Message:
    """Return any object with the fields of a message as a message of `cls`."""
    return cls(**{f.name: adopted_value(getattr(msg, f.name), f) for f in fields(cls)})


def adopted_value(value: Any, field: Field) -> Any:
    """Return the value of a field in a form that aionode accepts, if possible."""
    type_ = field.type
    if type_.container == "single":
        return adopted_element(value, type_)
    if isinstance(value, str | bytes | bytearray) or not hasattr(value, "__iter__"):
        return value  # refused with aionode's error
    if is_numeric(type_):
        return value if not isinstance(value, set | frozenset) else list(value)
    elements = [adopted_element(element, type_) for element in value]
    if type_.kind == "byte" and all(
        isinstance(element, bytes) and len(element) == 1 for element in elements
    ):
        return b"".join(elements)
    return elements


def adopted_element(value: Any, type_: FieldType) -> Any:
    """Return one element in a form that aionode accepts, if possible."""
    if type_.nested is not None:
        return adopted(value, type_.nested)
    if type_.kind == "bool" and isinstance(value, int):
        return bool(value)
    if isinstance(value, bool) and type_.kind in TYPE_CODES:
        return int(value)
    if type(value).__module__ == "numpy" and not hasattr(value, "__iter__"):
        return value.item()  # a Python number; an array is refused with aionode's error
    return value


@cache
def constructor(cls: type[Message]) -> Callable[..., Any]:
    """Return a function that creates a message from its fields, without the checks of ``__init__``.

    Its source contains only validated field names and numbers.
    """
    own = python_class(cls)
    names = [field.name for field in fields(cls)]
    namespace: dict[str, Any] = {
        "NEW": own.__new__,
        "CLASS": own,
        "CHECKED": own()._check_fields,
        "ARRAY": array,
        "COUNT": len,  # a field may be named len
        "OCTETS": OCTETS,
    }
    lines = [f"def construct({', '.join(names)}):", "    MADE = NEW(CLASS)"]
    for field in fields(cls):
        lines += [f"    {line}" for line in stored(field)]
    lines += ["    MADE._check_fields = CHECKED", "    return MADE"]
    exec(compile("\n".join(lines), f"<construct {type_name(cls)}>", "exec"), namespace)  # noqa: S102
    function: Callable[..., Any] = namespace["construct"]
    return function


def stored(field: Field) -> list[str]:
    """Return the lines that store the value of a field; views of the data are copied."""
    name, type_ = field.name, field.type
    target = f"MADE._{name}"
    if type_.container == "single" or type_.nested is not None:
        return [f"{target} = {name}"]
    if is_numeric(type_) and type_.container == "array":
        return [f"{target} = {name}.copy()"]
    if is_numeric(type_):
        octets = name if type_.form == "bytes" else f"{name}.cast('B')"
        return [
            f"{target} = VALUES = ARRAY({TYPE_CODES[type_.kind]!r})",
            f"if COUNT({name}): VALUES.frombytes({octets})",
        ]
    if type_.kind == "byte":
        return [f"{target} = [OCTETS[ONE] for ONE in {name}]"]
    if type_.kind == "bool":
        return [f"{target} = {name}.tolist() if COUNT({name}) else []"]
    return [f"{target} = {name}"]


FAMILY: Final = MessageFamily(python_class, constructor, to_aionode, prefix="_", has_arrays=False)
