"""Messages, services and actions as Python classes.

This package provides field annotations, the base classes `Message`, `ServiceType` and `ActionType`,
and functions that describe, validate, copy and convert messages. The only public attributes of a
message class are its fields and constants, since those may have any name.
"""

from __future__ import annotations

from aionode.message._field_types import (
    DTYPES,
    Array,
    Bools,
    Bounded,
    Bytes,
    Constant,
    Field,
    FieldType,
    Floats,
    Ints,
    Sequence,
    byte,
    char,
    float32,
    float64,
    int8,
    int16,
    int32,
    int64,
    uint8,
    uint16,
    uint32,
    uint64,
    wstring,
)
from aionode.message._message import DEFAULT, Message, constants, fields, type_name
from aionode.message._schema import documentation, json_schema
from aionode.message._serialized import SerializedMessage, serialized, unserialized
from aionode.message._service_types import (
    ActionClass,
    ActionType,
    Interface,
    ServiceClass,
    ServiceType,
)
from aionode.message._snapshot import check, checker, holds_arrays, snapshot, snapshotter
from aionode.message._summary import summarize
from aionode.message.conversion import (
    from_builtins,
    from_json,
    from_yaml,
    to_builtins,
    to_json,
    to_yaml,
)
from aionode.message.validation import fit, fit_element

__all__ = [
    "DEFAULT",
    "DTYPES",
    "ActionClass",
    "ActionType",
    "Array",
    "Bools",
    "Bounded",
    "Bytes",
    "Constant",
    "Field",
    "FieldType",
    "Floats",
    "Interface",
    "Ints",
    "Message",
    "Sequence",
    "SerializedMessage",
    "ServiceClass",
    "ServiceType",
    "byte",
    "char",
    "check",
    "checker",
    "constants",
    "documentation",
    "fields",
    "fit",
    "fit_element",
    "float32",
    "float64",
    "from_builtins",
    "from_json",
    "from_yaml",
    "holds_arrays",
    "int8",
    "int16",
    "int32",
    "int64",
    "json_schema",
    "serialized",
    "snapshot",
    "snapshotter",
    "summarize",
    "to_builtins",
    "to_json",
    "to_yaml",
    "type_name",
    "uint8",
    "uint16",
    "uint32",
    "uint64",
    "unserialized",
    "wstring",
]
