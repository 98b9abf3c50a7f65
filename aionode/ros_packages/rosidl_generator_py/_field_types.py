"""rosidl's names and storage of field types."""

from __future__ import annotations

from typing import Final

from aionode.message import FieldType, type_name
from aionode.message.conversion import IDL_NAMES
from rosidl_parser.definition import (
    AbstractNestableType,
    AbstractType,
    Array,
    BasicType,
    BoundedSequence,
    BoundedString,
    BoundedWString,
    NamespacedType,
    UnboundedSequence,
    UnboundedString,
    UnboundedWString,
)

__all__ = ["TYPE_CODES", "element_type", "field_text", "is_numeric", "python_type", "slot_type"]

TYPE_CODES: Final = {
    "float32": "f",
    "float64": "d",
    "int8": "b",
    "uint8": "B",
    "char": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
}
"""Type codes of `array.array`, for the numbers whose sequences are such arrays in rosidl.

Their arrays of fixed size are `numpy.ndarray`. Booleans and octets are stored in lists.

Their arrays of fixed size are `numpy.ndarray`. Booleans and octets are in lists.
"""


def is_numeric(type_: FieldType) -> bool:
    """Return whether a field is an array or sequence of numbers, not a list in rosidl."""
    return type_.container != "single" and type_.kind in TYPE_CODES


def element_type(type_: FieldType) -> AbstractNestableType:
    """Return rosidl's description of one element."""
    if type_.nested is not None:
        package, kind, name = type_name(type_.nested).split("/")
        return NamespacedType([package, kind], name)
    bound = type_.string_bound
    if type_.kind == "string":
        return UnboundedString() if bound is None else BoundedString(bound)
    if type_.kind == "wstring":
        return UnboundedWString() if bound is None else BoundedWString(bound)
    return BasicType(IDL_NAMES.get(type_.kind, type_.kind))


def slot_type(type_: FieldType) -> AbstractType:
    """Return rosidl's description of a field, as in ``SLOT_TYPES``."""
    element = element_type(type_)
    if type_.container == "array":
        return Array(element, type_.size)
    if type_.container == "bounded":
        return BoundedSequence(element, type_.size)
    return UnboundedSequence(element) if type_.container == "unbounded" else element


def field_text(type_: FieldType) -> str:
    """Return the type as in ``get_fields_and_field_types``: ``sequence<string<5>, 3>``."""
    element = IDL_NAMES.get(type_.kind, type_.kind)
    if type_.nested is not None:
        package, _, name = type_name(type_.nested).split("/")
        element = f"{package}/{name}"
    elif type_.string_bound is not None:
        element = f"{element}<{type_.string_bound}>"
    ends = {"array": f"{element}[{type_.size}]", "bounded": f"sequence<{element}, {type_.size}>"}
    ends["unbounded"] = f"sequence<{element}>"
    return ends.get(type_.container, element)


def python_type(type_: FieldType) -> str:
    """Return the name of the Python class of one element, as in rosidl's errors."""
    if type_.nested is not None:
        return type_name(type_.nested).rpartition("/")[2]
    kinds = {"bool": "bool", "byte": "bytes", "string": "str", "wstring": "str"}
    return kinds.get(type_.kind, "float" if type_.kind.startswith("float") else "int")
