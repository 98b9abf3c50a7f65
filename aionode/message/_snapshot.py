"""Validates and copies messages, with code generated once for each message type.

The generated function handles the usual values of each field in one line, and passes all others to
`fit`. Nested messages are inlined, so a Twist costs one call. The code is generated from the
description of a message class, whose names were validated when the class was created.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, TypeVar

from aionode.errors import MessageError
from aionode.message._field_types import INT_RANGES, FieldType
from aionode.message._message import Message, fields, message_class, type_name
from aionode.message._serialized import unserialized
from aionode.message.validation import (
    check_length,
    dtype_of,
    fit,
    fit_array,
    fit_bytes,
    given,
    listed,
)

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["check", "checker", "holds_arrays", "snapshot", "snapshotter"]

MessageT = TypeVar("MessageT", bound=Message)

FLOAT32_MAX = (2 - 2**-23) * 2.0**127


@cache
def holds_arrays(cls: type[Message]) -> bool:
    """Return whether messages of a class contain numpy arrays, at any depth."""
    types = [field.type for field in fields(cls)]
    return any(
        type_.form == "ndarray" or (type_.nested is not None and holds_arrays(type_.nested))
        for type_ in types
    )


def snapshotter(cls: type[MessageT]) -> Callable[[MessageT], MessageT]:
    """Return a function that validates a message and returns a copy for subscribers.

    The copy shares no mutable data with the message: read-only arrays and bytes are shared, other
    arrays are copied and marked read-only, and lists of numbers become such arrays. The function
    is generated once for each type. It raises `TypeError` for an object of another class and
    `MessageError` for a value that does not fit its field.

    Raises:
        TypeError: `cls` is not a message class, or has no ROS name.
    """
    if unserialized(cls) is not cls:
        return expecting(cls)
    function: Callable[[MessageT], MessageT] = generated(cls, copying=True)
    return function


def checker(cls: type[MessageT]) -> Callable[[MessageT], None]:
    """Return a function that validates like that of `snapshotter`, without a copy.

    Raises:
        TypeError: `cls` is not a message class, or has no ROS name.
    """
    if unserialized(cls) is not cls:
        return expecting(cls)
    function: Callable[[MessageT], None] = generated(cls, copying=False)
    return function


def expecting(cls: type[Any]) -> Callable[[Any], Any]:
    """Return a function that returns a serialized message as is, since its bytes never change."""

    def take(message: Any) -> Any:
        if message.__class__ is not cls:
            refuse(cls, message, type_name(cls))
        return message

    return take


def snapshot(message: MessageT) -> MessageT:
    """Return a validated copy of a message; see `snapshotter`."""
    return snapshotter(type(message))(message)


def check(message: Message) -> None:
    """Raise `MessageError` if a value of the message does not fit its field."""
    checker(type(message))(message)


def generated(cls: type[Message], *, copying: bool) -> Any:
    """Return the function for a class, generated on first use."""
    functions = message_class(cls).__ros_functions__
    purpose = "snapshot" if copying else "check"
    if purpose not in functions:
        functions[purpose] = Unrolling(copying=copying).function(cls)
    return functions[purpose]


class Unrolling:
    """Generates the function of one message type."""

    def __init__(self, *, copying: bool) -> None:
        self.copying = copying
        self.lines: list[str] = []
        self.names: dict[str, Any] = {
            "fit": fit,
            "fit_array": fit_array,
            "fit_bytes": fit_bytes,
            "refuse": refuse,
            "messages": messages,
            "strings": strings,
            "frozen": frozen_array,
            "fixed": fixed_bytes,
        }

    def function(self, cls: type[Message]) -> Callable[..., Any]:
        """Return the generated function."""
        whole = self.message(cls, "message", "")
        result = whole if self.copying else "None"
        text = "\n    ".join(["def take(message, path=TYPE):", *self.lines, f"return {result}"])
        self.names["TYPE"] = type_name(cls)
        exec(compile(text, f"<snapshot of {type_name(cls)}>", "exec"), self.names)  # noqa: S102 (validated names only)
        function: Callable[..., Any] = self.names["take"]
        return function

    def name(self, value: object, prefix: str) -> str:
        """Create a name for a value that the code refers to."""
        name = f"{prefix}{len(self.names)}"
        self.names[name] = value
        return name

    def message(self, cls: type[Message], source: str, path: str) -> str:
        """Generate the code for a message; return the expression of its copy."""
        class_ = self.name(cls, "C")
        where = f"path + {path!r}" if path else "path"
        self.lines.append(
            f"if {source}.__class__ is not {class_}: refuse({class_}, {source}, {where})"
        )
        copies = []
        for field in cls.__ros_fields__:
            value = self.name(field, "v")
            self.lines.append(f"{value} = {source}.{field.name}")
            copies.append(self.field(field.type, value, f"{path}.{field.name}"))
        return f"{class_}({', '.join(copies)})"

    def field(self, type_: FieldType, value: str, path: str) -> str:
        """Generate the code for a field; return the expression of its copy."""
        if type_.nested is not None and type_.container == "single":
            return self.message(type_.nested, value, path)
        known = self.name(type_, "F")
        fitting = f"fit({known}, {value}, path + {path!r})"
        if type_.container == "single":
            self.lines.append(f"if {unusual(type_, value)}: {value} = {fitting}")
        elif type_.nested is not None:
            take = self.name(generated(type_.nested, copying=self.copying), "f")
            self.lines.append(f"{value} = messages({known}, {take}, {value}, path, {path!r})")
        elif type_.form == "list":
            self.lines.append(f"{value} = strings({known}, {value}, path, {path!r})")
        else:
            rule = "fit_array" if type_.form == "ndarray" else "fit_bytes"
            line = fitting.replace("fit(", f"{rule}(", 1)
            if self.copying and type_.form == "ndarray":
                line = f"{value} = frozen({known}, {value}, path, {path!r})"
            elif self.copying:
                line = f"{value} = fixed({line})"
            if type_.form == "bytes" and type_.container == "unbounded":
                line = f"if {value}.__class__ is not bytes: {line}"
            elif not self.copying and type_.container != "array":
                # An empty tuple always fits, which needs no import of numpy.
                line = f"if {value}.__class__ is not tuple or {value}: {line}"
            self.lines.append(line)
        return value


def unusual(type_: FieldType, value: str) -> str:
    """Return the condition under which a single value is passed to `fit`."""
    kind = type_.kind
    if kind in INT_RANGES:
        low, high = INT_RANGES[kind]
        return f"{value}.__class__ is not int or not {low} <= {value} <= {high}"
    if kind == "float32":
        limit = repr(FLOAT32_MAX)
        return f"{value}.__class__ is not float or not -{limit} <= {value} <= {limit}"
    if kind == "float64":
        return f"{value}.__class__ is not float"
    if kind == "bool":
        return f"{value} is not True and {value} is not False"
    if kind == "byte":
        return f"{value}.__class__ is not bytes or len({value}) != 1"
    long = "" if type_.string_bound is None else f" or len({value}) > {type_.string_bound}"
    return f"{value}.__class__ is not str or not {value}.isascii(){long}"


def refuse(cls: type[Message], value: object, path: str) -> None:
    """Raise TypeError for a message that is not of `cls`, MessageError for a nested message."""
    other, wanted = given_type(value), type_name(cls)
    if other == wanted:
        other, wanted = (f"{t.__module__}.{t.__qualname__}" for t in (type(value), cls))
    if path == type_name(cls):
        msg = f"{type_name(cls)}: got {other}, needs an object of {wanted}"
        raise TypeError(msg)
    raise MessageError(path, f"{other}, needs {wanted}")


def given_type(value: object) -> str:
    """Describe an object for an error: the ROS name of a message, or value and type."""
    return getattr(type(value), "__ros_type__", "") or given(value)


def messages(
    type_: FieldType, take: Callable[..., Any], values: Any, path: str, field: str
) -> list[Any]:
    """Return copies of a list of messages."""
    values = listed(type_, values, path + field)
    try:
        return [take(value) for value in values]
    except (MessageError, TypeError):
        for index, value in enumerate(values):  # find and name the invalid one
            take(value, f"{path}{field}[{index}]")
        raise


def strings(type_: FieldType, values: Any, path: str, field: str) -> list[str]:
    """Return a copy of a list of strings."""
    if values.__class__ is list and type_.string_bound is None:
        try:
            usual = "".join(values).isascii()  # fast; raises TypeError for other types
        except TypeError:
            usual = False
        if usual:
            check_length(type_, len(values), path + field)
            return values[:]
    return fit(type_, values, path + field)  # type: ignore[no-any-return] # a list


@cache
def numpy_for(kind: str) -> tuple[Any, Any, Any]:
    """Return ``ndarray``, ``frombuffer`` and the dtype of an element type.

    Numpy is imported on first use; looking it up each time would cost as much as a copy.
    """
    import numpy as np

    return np.ndarray, np.frombuffer, dtype_of(kind)


def frozen_array(type_: FieldType, value: Any, path: str, field: str) -> Any:
    """Return the array of a field if read-only, else a read-only copy.

    The bytes are copied and then viewed as an array, which takes a third of the time of copying an
    array and marking it read-only. Subclasses such as masked arrays hold more than their bytes.
    """
    ndarray, frombuffer, dtype = numpy_for(type_.kind)
    if value.__class__ is ndarray and value.dtype is dtype and value.ndim == 1:
        if type_.container != "unbounded":
            check_length(type_, len(value), path + field)
        array = value
    else:
        array = fit_array(type_, value, path + field)
    if not array.flags.writeable:
        return array
    if array.__class__ is ndarray and len(array):  # an empty buffer cannot be viewed
        return frombuffer(array.tobytes(), dtype)
    array = array.copy()
    array.flags.writeable = False
    return array


def fixed_bytes(value: bytes | bytearray | memoryview) -> bytes | memoryview:
    """Return bytes as is if they are read-only, else a copy."""
    if isinstance(value, bytearray) or (isinstance(value, memoryview) and not value.readonly):
        return bytes(value)
    return value
