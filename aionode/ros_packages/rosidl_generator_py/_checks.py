"""rosidl's checks of assignments when ``check_fields`` is on, with its error texts."""

from __future__ import annotations

import math
from array import array
from collections import UserList, UserString
from collections.abc import Callable, Sequence
from collections.abc import Set as AbstractSet
from typing import Any, Final

from aionode.message import DTYPES, FieldType
from rosidl_generator_py._field_types import TYPE_CODES, is_numeric, python_type

__all__ = ["Check", "field_check", "refuse_unknown"]

Check = Callable[[Any], bool]
"""Checks a value; returns whether it is stored unchanged, without the field's conversion."""

CLASSES: Final = {"bool": bool, "bytes": bytes, "str": str, "float": float, "int": int}

FLOAT_LIMITS: Final = {"float32": 3.402823466e38, "float64": 1.7976931348623157e308}
"""Largest float of each kind, with the digits that rosidl's generator writes."""


def field_check(name: str, type_: FieldType, nested: type[Any] | None) -> Check:
    """Return the check of one field.

    Args:
        name: The field.
        type_: Its type.
        nested: The class of its elements, if they are messages.
    """
    class_ = nested or CLASSES[python_type(type_)]
    if type_.container != "single":
        return collection_check(name, type_, class_)
    if nested is not None:
        what = f"a sub message of type '{python_type(type_)}'"
        return simple_check(name, what, lambda value: isinstance(value, class_))
    if type_.kind == "byte":
        what = "of type 'bytes' or 'ByteString' with length 1"
        return simple_check(
            name, what, lambda value: isinstance(value, bytes | bytearray) and len(value) == 1
        )
    if type_.string_bound is not None:
        return bounded_string_check(name, type_.string_bound)
    limits, range_text = limit_of(type_)
    article = "an" if range_text.startswith(("u", "i")) else "a"

    def check(value: Any) -> bool:
        require(
            isinstance(value, class_), f"The '{name}' field must be of type '{class_.__name__}'"
        )
        require(limits(value), f"The '{name}' field must be {article} {range_text}")
        return False

    return check


def simple_check(name: str, what: str, fits: Callable[[Any], bool]) -> Check:
    """Return a check with one condition."""

    def check(value: Any) -> bool:
        require(fits(value), f"The '{name}' field must be {what}")
        return False

    return check


def bounded_string_check(name: str, bound: int) -> Check:
    """Return the check of a string with a limited length."""
    return simple_check(
        name,
        f"string value not longer than {bound}",
        lambda value: isinstance(value, str | UserString) and len(value) <= bound,
    )


def collection_check(name: str, type_: FieldType, class_: type[Any]) -> Check:
    """Return the check of an array or sequence."""
    bound = type_.string_bound
    limits, range_text = limit_of(type_, nested=True)
    words = ["a set or sequence"]
    if type_.container == "array":
        words.append(f"with length {type_.size}")
    elif type_.container == "bounded":
        words.append(f"with length <= {type_.size}")
    if bound is not None:
        words.append(f"and each string value not longer than {bound}")
    words.append(f"and each value of type '{python_type(type_)}'")
    if range_text:
        words.append(f"and each {range_text}")
    text = f"The '{name}' field must be {' '.join(words)}"
    own = own_array_check(name, type_)

    def check(value: Any) -> bool:
        if own is not None and own(value):
            return True
        require(
            isinstance(value, Sequence | AbstractSet | UserList)
            and not isinstance(value, str | UserString)
            and (bound is None or all(len(element) <= bound for element in value))
            and fits_length(type_, len(value))
            and all(isinstance(element, class_) for element in value)
            and all(limits(element) for element in value),
            text,
        )
        return False

    return check


def own_array_check(name: str, type_: FieldType) -> Check | None:
    """Return the check for a value that is already an `array.array` or `numpy.ndarray`."""
    if not is_numeric(type_):
        return None
    if type_.container == "array":
        dtype = DTYPES[type_.kind]

        def check_ndarray(value: Any) -> bool:
            import numpy as np  # not with the class: most programs make no such array

            if not isinstance(value, np.ndarray):
                return False
            what = f"The '{name}' numpy.ndarray() must have"
            require(value.dtype == dtype, f"{what} the dtype of 'numpy.{dtype}'")
            require(value.size == type_.size, f"{what} a size of {type_.size}")
            return True

        return check_ndarray
    code = TYPE_CODES[type_.kind]

    def check_array(value: Any) -> bool:
        if not isinstance(value, array):
            return False
        what = f"The '{name}' array.array() must have"
        require(value.typecode == code, f"{what} the type code of '{code}'")
        require(fits_length(type_, len(value)), f"{what} a size <= {type_.size}")
        return True

    return check_array


def fits_length(type_: FieldType, length: int) -> bool:
    """Return whether a field of this type may have this many elements."""
    if type_.container == "array":
        return length == type_.size
    return type_.container == "unbounded" or length <= type_.size


def limit_of(type_: FieldType, *, nested: bool = False) -> tuple[Callable[[Any], bool], str]:
    """Return whether a number is in the range of its type, and the text of that range."""
    kind = "uint8" if type_.kind == "char" else type_.kind
    if kind in FLOAT_LIMITS:
        limit = FLOAT_LIMITS[kind]
        name = "float" if kind == "float32" else "double"
        # rosidl prints the limits of elements with all digits.
        shown = f"{limit:f}" if nested else repr_of_limit(kind)
        return (
            lambda value: not (value < -limit or value > limit) or math.isinf(value),
            f"{name} in [-{shown}, {shown}]",
        )
    if kind.startswith("uint"):
        top = 2 ** int(kind[4:])
        return lambda value: 0 <= value < top, f"unsigned integer in [0, {top - 1}]"
    if kind.startswith("int"):
        top = 2 ** (int(kind[3:]) - 1)
        return lambda value: -top <= value < top, f"integer in [{-top}, {top - 1}]"
    return lambda _: True, ""


def repr_of_limit(kind: str) -> str:
    """Return the largest float of a kind as rosidl writes it for single values."""
    return "3.402823466e+38" if kind == "float32" else "1.7976931348623157e+308"


def refuse_unknown(known: Sequence[str], given: dict[str, Any]) -> None:
    """Raise AssertionError for constructor arguments that are not fields."""
    unknown = sorted(name for name in given if f"_{name}" not in known)
    require(not unknown, f"Invalid arguments passed to constructor: {', '.join(unknown)}")


def require(condition: bool, text: str) -> None:
    """Raise AssertionError with a text unless a condition holds."""
    if not condition:
        raise AssertionError(text)
