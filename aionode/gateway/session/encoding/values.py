"""Messages in the forms of rosbridge: JSON in both directions, and CBOR for subscribers.

JSON contains bytes as base64 text. Subscribers get null for NaN and infinities, but no client may
send null for a number: a page that computes NaN writes null without noticing. CBOR contains
sequences of numbers as typed arrays (RFC 8746, little endian), as in rosbridge; arrays of a fixed
size are plain lists.
"""

from __future__ import annotations

import base64
import binascii
from collections.abc import Mapping
from functools import cache
from typing import Any, Final, TypeVar

import cbor2
import msgspec

from aionode.errors import MessageError
from aionode.message import FieldType, Message, fields, from_builtins, type_name

__all__ = ["cbor_values", "from_json", "json_of"]

MessageT = TypeVar("MessageT", bound=Message)

TIMES: Final = frozenset({"builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration"})

HEADER: Final = "std_msgs/msg/Header"

TIME_WORDS: Final = {"secs": "sec", "nsecs": "nanosec"}
"""The field names of times in ROS 1, which clients still send."""

TYPED_ARRAYS: Final = {
    "uint16": 69,
    "uint32": 70,
    "uint64": 71,
    "int8": 72,
    "int16": 77,
    "int32": 78,
    "int64": 79,
    "float32": 85,
    "float64": 86,
}
"""The CBOR tag of each kind of number; bytes need none."""


# To clients


def json_of(message: Message) -> bytes:
    """Return the JSON of a valid message."""
    return ENCODER.encode(numbered(message) if holds_byte(type(message)) else message)


def json_value(value: Any) -> object:
    """Return the JSON of a numpy array: base64 text for bytes, otherwise a list."""
    if value.dtype.kind == "u" and value.itemsize == 1:
        return base64.b64encode(value.tobytes()).decode()
    return value.tolist()


ENCODER: Final = msgspec.json.Encoder(enc_hook=json_value)


@cache
def holds_byte(cls: type[Message]) -> bool:
    """Return whether messages of a class contain a `byte`, which is a number in JSON."""
    types = [field.type for field in fields(cls)]
    return any(
        type_.kind == "byte" or (type_.nested is not None and holds_byte(type_.nested))
        for type_ in types
    )


def numbered(message: Message) -> dict[str, object]:
    """Return a message as a dict in which each `byte` is a number."""
    return {
        field.name: numbered_value(field.type, getattr(message, field.name))
        for field in fields(type(message))
    }


def numbered_value(type_: FieldType, value: Any) -> object:
    """Return the value of a field with each `byte` as a number."""
    if type_.kind == "byte":
        return value[0] if type_.container == "single" else list(value)
    if type_.nested is None or not holds_byte(type_.nested):
        return value
    return numbered(value) if type_.container == "single" else list(map(numbered, value))


def cbor_values(message: Message) -> dict[str, object]:
    """Return a valid message as a dict that `cbor2.dumps` can encode."""
    return {
        field.name: cbor_value(field.type, getattr(message, field.name))
        for field in fields(type(message))
    }


def cbor_value(type_: FieldType, value: Any) -> object:
    """Return the value of a field in a form that `cbor2.dumps` can encode."""
    if type_.container == "single":
        if type_.nested is not None:
            return cbor_values(value)
        return value[0] if type_.kind == "byte" else value
    if type_.nested is not None:
        return list(map(cbor_values, value))
    if type_.container == "array":
        return value.tolist() if type_.form == "ndarray" else list(value)
    if type_.kind == "byte":
        return cbor2.CBORTag(TYPED_ARRAYS["int8"], bytes(value))
    if type_.kind in {"uint8", "char"}:
        return bytes(value)
    if type_.kind in TYPED_ARRAYS:
        little = value.astype(value.dtype.newbyteorder("<"), copy=False)
        return cbor2.CBORTag(TYPED_ARRAYS[type_.kind], little.tobytes())
    return value.tolist() if type_.form == "ndarray" else list(value)


# From clients


def from_json(cls: type[MessageT], values: object, now_ns: int) -> MessageT:
    """Return the message described by a client of rosbridge.

    Bytes are base64 text or a list of numbers, and a time may be ``"now"`` or have ``secs`` and
    ``nsecs``. A list contains the values of the fields in order. Each header without a stamp is
    stamped with the current time, at any depth, as in rosbridge.

    Args:
        cls: The class of the message.
        values: Decoded JSON.
        now_ns: The current time of the node's clock, in nanoseconds.

    Raises:
        MessageError: a value does not fit its field, or a field does not exist.
    """
    return from_builtins(cls, reworded(cls, values, now_ns, type_name(cls)))


def stamp(time_ns: int) -> dict[str, int]:
    """Return a time as builtin types."""
    sec, nanosec = divmod(time_ns, 10**9)
    return {"sec": sec, "nanosec": nanosec}


def reworded(cls: type[Message], values: object, now_ns: int, path: str) -> object:
    """Convert a client's values for a message to the forms that `from_builtins` accepts.

    Unknown fields and invalid values are left unchanged, for `from_builtins` to report.
    """
    types = {field.name: field.type for field in fields(cls)}
    if isinstance(values, list):
        values = by_position(list(types), values, path)
    if cls.__ros_type__ in TIMES:
        if values == "now":
            return stamp(now_ns)
        if isinstance(values, Mapping):
            return {TIME_WORDS.get(name, name): value for name, value in values.items()}
    if not isinstance(values, Mapping):
        return values
    if cls.__ros_type__ == HEADER and "stamp" not in values:
        values = {**values, "stamp": stamp(now_ns)}
    return {
        name: value
        if (type_ := types.get(name)) is None
        else reworded_value(type_, value, now_ns, f"{path}.{name}")
        for name, value in values.items()
    }


def by_position(names: list[str], values: list[object], path: str) -> dict[str, object]:
    """Convert a list of values to a dict with the names of the first fields as keys."""
    if len(values) > len(names):
        raise MessageError(path, f"{len(values)} values in a list for {len(names)} fields")
    return dict(zip(names, values, strict=False))


def reworded_value(type_: FieldType, value: object, now_ns: int, path: str) -> object:
    """Convert a client's value for one field."""
    if type_.nested is not None:
        if type_.container == "single":
            return reworded(type_.nested, value, now_ns, path)
        if not isinstance(value, list):
            return value
        return [
            reworded(type_.nested, item, now_ns, f"{path}[{i}]") for i, item in enumerate(value)
        ]
    if type_.container != "single" and isinstance(value, str):
        return bytes_of_text(type_, value, path)
    return value


def bytes_of_text(type_: FieldType, text: str, path: str) -> object:
    """Decode base64 text, if the field contains bytes."""
    if type_.kind not in {"uint8", "char", "byte"}:
        return text
    try:
        data = base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError) as error:
        raise MessageError(
            path, f"not base64 text: {error}; a list of numbers is also accepted"
        ) from None
    return memoryview(data) if type_.form == "ndarray" else data
