"""Converts messages to builtin types, JSON and YAML, and back.

The builtin types are dict, list, int, float, bool and str. Bytes become lists of numbers, and a
single ``byte`` becomes a number; in YAML a ``byte`` is a string of one character, as ROS prints it,
and is read from either. JSON has no NaN and infinities: they are
written and read as the strings ``"NaN"``, ``"Infinity"`` and ``"-Infinity"``; YAML has its own
notation (``.nan``, ``.inf``, ``-.inf``).
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final, TypeVar

import msgspec
from msgspec import Struct

from aionode.errors import MessageError
from aionode.message._field_types import FieldType
from aionode.message._message import Message, message_class, type_name
from aionode.message.validation import fit, given, listed

if TYPE_CHECKING:
    from aionode.message._message import MessageClass

__all__ = ["from_builtins", "from_json", "from_yaml", "to_builtins", "to_json", "to_yaml"]

MAX_FIELD = 100
"""Longer names get no suggestion, as comparing names takes time with their length."""

MessageT = TypeVar("MessageT", bound=Message)

FLOAT_STRINGS = r"NaN|-?Infinity|[-+]?\d+[eE][-+]?\d+"
"""Strings accepted as floats: NaN and infinity in JSON, and 1e5, which is text in YAML 1.1."""


def elements_of(values: Any) -> list[Any]:
    """Return the elements of an array as Python numbers."""
    return values.tolist() if hasattr(values, "tolist") else list(values)


class Form(Struct, frozen=True):
    """How to write values that have more than one form.

    Attributes:
        as_float: Returns a float.
        as_byte: Returns a `byte`, given as its number.
        elements: Returns the elements of an array.
        truncate: Maximum elements of an array and characters of a string; None for all.
        no_arr: Whether to replace arrays by their type and length.
        no_str: Whether to replace strings by their length.
    """

    as_float: Callable[[float], object] = float
    as_byte: Callable[[int], object] = int
    elements: Callable[[Any], list[Any]] = elements_of
    truncate: int | None = None
    no_arr: bool = False
    no_str: bool = False

    def converter(self, type_: FieldType) -> Callable[[Any], object] | None:
        """Return the converter of values of a type; None for types with a single form."""
        if type_.nested is not None:
            return lambda message: plain(message, self)
        if type_.kind in {"float32", "float64"}:
            return self.as_float
        if type_.kind == "byte":
            return self.as_byte
        return self.string if type_.kind in {"string", "wstring"} else None

    def string(self, text: str) -> str:
        """Return a string, with ``...`` replacing the characters beyond the limit."""
        if self.no_str:
            return f"<string length: <{len(text)}>>"
        if self.truncate is None or len(text) <= self.truncate:
            return text
        return f"{text[: self.truncate]}..."


def to_builtins(message: Message, *, truncate: int | None = None) -> dict[str, Any]:
    """Convert a message to dicts, lists, numbers, bools and strings, in the order of its fields.

    Args:
        message: The message.
        truncate: Maximum elements of an array and characters of a string; ``...`` stands for the
            rest, as in ``ros2 topic echo``, which shows 128. By default nothing is cut.

    Raises:
        MessageError: A value does not fit its field.
        ValueError: `truncate` is negative.
    """
    if truncate is not None and truncate < 0:
        raise ValueError(f"truncate: {truncate} given; it is a number of elements, at least 0")
    return plain(validated(message), Form(truncate=truncate))


def from_builtins(cls: MessageClass[MessageT], data: object) -> MessageT:
    """Create a message from builtin types; omitted fields have their default.

    Arrays and bytes-like objects are accepted as well as lists.

    Raises:
        MessageError: A value does not fit its field, or a field does not exist.
    """
    return message_from(message_class(cls), data, type_name(cls))  # type: ignore[return-value] # of cls


def to_json(message: Message) -> str:
    """Convert a message to one line of JSON.

    Raises:
        MessageError: A value does not fit its field.
    """
    return msgspec.json.encode(plain(validated(message), Form(json_float))).decode()


def from_json(cls: MessageClass[MessageT], text: str | bytes) -> MessageT:
    """Create a message from JSON; see `from_builtins`.

    Raises:
        MessageError: The text is not valid JSON, or does not describe such a message.
    """
    return from_builtins(cls, decoded(cls, msgspec.json.decode, text, "JSON"))


def to_yaml(message: Message, *, flow_style: bool = False) -> str:
    """Convert a message to YAML in the format of ``ros2 topic echo``.

    Args:
        message: The message.
        flow_style: Use braces and brackets instead of a line for each value.

    Raises:
        MessageError: A value does not fit its field.
    """
    import yaml

    text: str = yaml.dump(
        plain(validated(message), Form(as_byte=chr)),
        Dumper=getattr(yaml, "CSafeDumper", yaml.SafeDumper),  # libyaml is optional
        allow_unicode=True,
        default_flow_style=flow_style,
        sort_keys=False,
        width=2**31 - 1,
    )
    return text


def from_yaml(cls: MessageClass[MessageT], text: str | bytes) -> MessageT:
    """Create a message from YAML, such as ``{linear: {x: 1.5}}``.

    An empty text gives a message of defaults. See `from_builtins`.

    Raises:
        MessageError: The text is not valid YAML, or does not describe such a message.
    """
    data = decoded(cls, msgspec.yaml.decode, text, "YAML")
    return from_builtins(cls, {} if data is None else data)


def validated(message: Message) -> Message:
    """Return a validated copy of a message."""
    from aionode.message._snapshot import snapshot

    return snapshot(message)


def decoded(
    cls: MessageClass[Message], decode: Callable[[str | bytes], Any], text: str | bytes, form: str
) -> Any:
    """Decode JSON or YAML to builtin types."""
    try:
        return decode(text)
    except (msgspec.DecodeError, ValueError, RecursionError) as error:
        raise MessageError(type_name(cls), f"invalid {form}: {error}") from error


def json_float(number: float) -> float | str:
    """Return a float, or the string for one that JSON does not support."""
    if math.isfinite(number):
        return number
    return "NaN" if math.isnan(number) else "Infinity" if number > 0 else "-Infinity"


def plain(message: Message, form: Form) -> dict[str, Any]:
    """Convert a valid message to builtin types."""
    return {
        field.name: plain_value(field.type, getattr(message, field.name), form)
        for field in message.__ros_fields__
    }


def plain_value(type_: FieldType, value: Any, form: Form) -> object:
    """Convert the valid value of a field to builtin types."""
    convert = form.converter(type_)
    if type_.container == "single":
        return value if convert is None else convert(value[0] if type_.kind == "byte" else value)
    if form.no_arr:
        return described(type_, value)
    cut = form.truncate is not None and len(value) > form.truncate
    shown = value[: form.truncate] if cut else value
    items = form.elements(shown)
    items = items if convert is None else list(map(convert, items))
    return [*items, "..."] if cut else items


IDL_NAMES: Final = {
    "float32": "float",
    "float64": "double",
    "byte": "octet",
    "bool": "boolean",
    "char": "uint8",
}
"""The names of types in IDL, where they differ from those in ``.msg`` files."""


def described(type_: FieldType, value: Any) -> str:
    """Return the description of an array: its type, as ros2 names it, and its length."""
    nested = type_.nested
    name = IDL_NAMES.get(type_.kind, type_.kind) if nested is None else type_name(nested)
    if type_.container == "array":
        return f"<array type: {name}[{type_.size}]>"
    bound = f"[{type_.size}]" if type_.container == "bounded" else ""
    return f"<sequence type: {name}{bound}, length: {len(value)}>"


def message_from(cls: type[Message], data: object, path: str) -> Message:
    """Create a message from builtin types; `path` locates it in error texts."""
    if not isinstance(data, Mapping):
        raise MessageError(path, f"{given(data)}, needs a mapping from field names to values")
    types = {field.name: field.type for field in cls.__ros_fields__}
    for key in data:
        if key not in types:
            raise MessageError(f"{path}.{key}", no_such_field(cls, str(key), list(types)))
    values = {key: value_from(types[key], value, f"{path}.{key}") for key, value in data.items()}
    return cls(**values)


def no_such_field(cls: type[Message], key: str, names: list[str]) -> str:
    """Return the error text for a field that does not exist."""
    import difflib  # for this error only

    if not names:
        return f"no such field; {type_name(cls)} has no fields"
    close = difflib.get_close_matches(key, names, 1) if len(key) <= MAX_FIELD else ()
    meant = f"; did you mean {close[0]!r}?" if close else ""
    return f"no such field{meant}; {type_name(cls)} has {', '.join(names)}"


def value_from(type_: FieldType, value: object, path: str) -> object:
    """Return the value of one field, converted from builtin types."""
    if type_.nested is not None:
        if type_.container == "single":
            return message_from(type_.nested, value, path)
        items = enumerate(listed(type_, value, path))
        return [message_from(type_.nested, item, f"{path}[{i}]") for i, item in items]
    if type_.container == "single":
        value = scalar_from(type_, value, path)
    elif type_.kind in {"float32", "float64", "byte"} and isinstance(value, list | tuple):
        value = [scalar_from(type_, item, f"{path}[{i}]") for i, item in enumerate(value)]
    fitted = fit(type_, value, path)
    if type_.form == "ndarray" and fitted is not value and fitted.flags.owndata:
        fitted.flags.writeable = True  # created for this message only
    return fitted


def scalar_from(type_: FieldType, value: object, path: str) -> object:
    """Return a single value.

    A `byte` may be a number or a string of one character, and special floats a string.
    """
    if type_.kind == "byte" and isinstance(value, str) and len(value) == 1 and ord(value) < 256:
        return bytes((ord(value),))
    if type_.kind == "byte" and not isinstance(value, bytes):
        return bytes((fit(FieldType("uint8"), value, path),))
    if type_.kind in {"float32", "float64"} and isinstance(value, str):
        return float(value) if re.fullmatch(FLOAT_STRINGS, value) else value
    return value
