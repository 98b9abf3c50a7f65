"""How the values of fields are made, compared and shown."""

from __future__ import annotations

from functools import cache, partial
from typing import TYPE_CHECKING, Any

import msgspec

from aionode.errors import MessageError
from aionode.message.fieldtypes import DTYPES, INT_RANGES, FieldType
from aionode.message.fit import check_length, fit_element, given, is_listing

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

__all__ = ["default_value", "plain_default", "same", "shown", "zero"]

SHOWN_ELEMENTS = 1000
"""Longer sequences are shortened in a repr, as numpy does, so that an image fits a log line."""


def zero(kind: str) -> Any:
    """Return the value that a field of a kind has when nothing else is said."""
    if kind in INT_RANGES:
        return 0
    return {"bool": False, "byte": b"\0", "string": "", "wstring": ""}.get(kind, 0.0)


def plain_default(type_: FieldType, given_: object, path: str) -> object:
    """Return a default in one form, whoever wrote it: None if it is the type's zero anyway.

    Raises:
        MessageError: It does not fit the field.
    """
    if type_.kind == "message":
        raise MessageError(path, "a message has no default here; write DEFAULT for its own ones")
    if type_.container == "single":
        value = fit_element(type_, given_, path)
        return None if value == zero(type_.kind) and str(value) != "-0.0" else value
    if isinstance(given_, bytes) and type_.form == "bytes":
        given_ = list(given_)
    if not is_listing(given_):
        raise MessageError(path, f"{given(given_)}, needs a list or tuple")
    check_length(type_, len(given_), path)
    unit = FieldType("uint8") if type_.kind == "byte" else type_
    values = tuple(fit_element(unit, v, f"{path}[{i}]") for i, v in enumerate(given_))
    nothing = (zero(unit.kind),) * zeroed(type_)
    return None if values == nothing else values


def default_value(type_: FieldType, default: object) -> Any:
    """Return what msgspec needs to give each message its own default of a field."""
    if type_.form == "value" and type_.nested is None:
        return zero(type_.kind) if default is None else default
    if type_.form == "bytes":
        return bytes(default if isinstance(default, tuple) else zeroed(type_))
    return msgspec.field(default_factory=default_factory(type_, default))


def zeroed(type_: FieldType) -> int:
    """Return how many elements there are when nothing is said of them."""
    return type_.size if type_.container == "array" else 0


def default_factory(type_: FieldType, default: object) -> Callable[[], Any]:
    """Return a function that makes the default of a field that can change."""
    if type_.form == "ndarray":
        dtype = DTYPES[type_.kind]
        if default is not None:
            return partial(filled, dtype, default)
        return partial(zeros, dtype, type_.size) if type_.container == "array" else EMPTY[dtype]
    count = zeroed(type_)
    if type_.nested is not None:
        return (
            partial(several, type_.nested, count) if type_.container != "single" else type_.nested
        )
    if isinstance(default, tuple):
        return partial(list, default)
    return partial(several, str, count) if count else list


def several(make: Callable[[], Any], count: int) -> list[Any]:
    """Return `count` new messages or empty strings."""
    return [make() for _ in range(count)]


def filled(dtype: str, values: Any) -> npt.NDArray[Any]:
    """Return a new array of `values`."""
    import numpy as np

    return np.array(values, dtype)


def zeros(dtype: str, size: int) -> npt.NDArray[Any]:
    """Return a new array of zeros."""
    import numpy as np

    return np.zeros(size, dtype)


@cache
def empty(dtype: str) -> npt.NDArray[Any]:
    """Return the one empty array of a dtype; it has nothing in it that could change."""
    import numpy as np

    array = np.empty(0, dtype)
    array.flags.writeable = False
    return array


EMPTY = {dtype: partial(empty, dtype) for dtype in set(DTYPES.values())}
"""How to get the empty array of each dtype."""

BYTES_LIKE = bytes | bytearray | memoryview

SCALARS = frozenset({int, float, str, bool, bytes})


def same(one: Any, other: Any) -> bool:
    """Return whether two values of a field are equal, in whatever form they are held."""
    kind = one.__class__
    if kind in SCALARS and other.__class__ is kind:
        return bool(one == other)
    if is_listing(one) and is_listing(other):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, BYTES_LIKE) and isinstance(other, BYTES_LIKE):
        return one == other
    if isinstance(one, BYTES_LIKE | list) and isinstance(other, BYTES_LIKE | list):
        return list(one) == list(other)
    if hasattr(one, "__array__") or hasattr(other, "__array__"):
        return same_numbers(one, other)
    return bool(one == other)


def same_numbers(one: Any, other: Any) -> bool:
    """Return whether two values are equal, one of which is an array."""
    import numpy as np  # numpy is loaded when it is first needed

    if isinstance(other, BYTES_LIKE):
        one, other = other, one
    return np.array_equal(np.frombuffer(one, "B") if isinstance(one, BYTES_LIKE) else one, other)


def shown(type_: FieldType, value: Any) -> str:
    """Return a value as rclpy shows it: sequences of numbers as lists, arrays as numpy's."""
    if type_.container == "array" or type_.form in {"value", "list"}:
        return repr(value)
    if len(value) > SHOWN_ELEMENTS:
        first, last = (", ".join(map(repr, elements(part))) for part in (value[:3], value[-3:]))
        return f"[{first}, ..., {last}]"
    if type_.kind == "byte":
        return repr([bytes((item,)) if isinstance(item, int) else item for item in value])
    return repr(elements(value))


def elements(value: Any) -> list[Any]:
    """Return the elements of bytes, an array or a list as Python's own numbers."""
    return value.tolist() if hasattr(value, "tolist") else list(value)
