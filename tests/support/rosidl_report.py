"""Describes rosidl's message classes, to compare those of ROS with those of aionode.

As a program, run by a Python with ROS's packages, it describes those of ROS: it reads ROS names
from standard input and writes the description as JSON.
"""

from __future__ import annotations

import array
import collections
import importlib
import json
import sys
from collections.abc import Callable
from typing import Any

import numpy as np

__all__ = ["VALUES", "message_report", "parts_of", "report"]

VALUES: list[Any] = [
    None,
    1,
    -1,
    300,
    2**40,
    2**70,
    1.5,
    1e300,
    float("inf"),
    "x",
    "x" * 200,
    b"x",
    b"xy",
    True,
    [],
    [1],
    [1, 2, 3],
    [1, 2, 3, 4],
    [300] * 3,
    [-1] * 3,
    [2**80] * 3,
    [1.0, 2.0, 3.0],
    [1e300] * 3,
    ["a", "b", "c"],
    ["x" * 200] * 3,
    [True] * 3,
    [b"a"] * 3,
    (1, 2, 3),
    {1},
    array.array("B", [1, 2, 3]),
    array.array("f", [1, 2, 3]),
    array.array("d", [1, 2, 3, 4]),
    np.zeros(3, dtype=np.uint8),
    np.zeros(4, dtype=np.uint8),
    np.zeros(3, dtype=np.float32),
    np.float32(1),
    np.int32(3),
    np.bool_(True),
    bytearray(b"x"),
    b"abc",
    "abc",
    collections.UserString("abc"),
    collections.UserList([1, 2, 3]),
]
"""What is assigned to every field."""


def outcome(action: Callable[[], Any]) -> str:
    """Return what an action returns, or the exception that it raises."""
    try:
        return repr(action())
    except Exception as error:  # noqa: BLE001 (the exception is the result)
        return f"{type(error).__name__}: {error}"


def type_report(type_: Any) -> list[Any]:
    """Describe one of SLOT_TYPES."""
    names = ("typename", "namespaces", "name", "size", "maximum_size")
    values = {name: str(getattr(type_, name)) for name in names if hasattr(type_, name)}
    inner = type_report(type_.value_type) if hasattr(type_, "value_type") else None
    bounded = type_.has_maximum_size() if hasattr(type_, "has_maximum_size") else None
    return [[cls.__name__ for cls in type(type_).__mro__], values, inner, bounded]


def message_report(cls: Any) -> dict[str, Any]:
    """Describe a message class and the behaviour of its objects."""
    fields = cls.get_fields_and_field_types()
    fresh = cls()
    constants = [name for name in dir(cls) if name.isupper() and name != "SLOT_TYPES"]
    found: dict[str, Any] = {
        "names": [str(cls), cls.__name__, cls.__qualname__, cls.__module__, str(cls.__mro__)],
        "doc": cls.__doc__,
        "metaclass": [type(cls).__name__, type(cls).__module__, type(cls).__doc__],
        "metaclass has": sorted(vars(type(cls))),
        "slots": cls.__slots__,
        "fields": fields,
        "types": [type_report(one) for one in cls.SLOT_TYPES],
        "attributes": [sorted(dir(cls)), sorted(vars(cls))],
        "repr": repr(fresh),
        "values": {f: [type(getattr(fresh, f)).__name__, repr(getattr(fresh, f))] for f in fields},
        "constants": {name: repr(getattr(cls, name)) for name in constants},
        "constants set": {name: outcome(lambda n=name: setattr(cls, n, 1)) for name in constants},  # type: ignore[misc]
        "unknown": outcome(lambda: cls(zzz=1, aaa=2, check_fields=True)),
        "positional": outcome(lambda: cls(1)),
        "new attribute": outcome(lambda: setattr(cls(), "zzz", 1)),
        "hash": outcome(lambda: hash(cls())),
        "equal": [cls() == cls(), cls() != cls(), cls() == 5],
    }
    for field in fields:
        found[f"set {field}"] = [assigned(cls, field, value, False) for value in VALUES]
        found[f"set {field}, checked"] = [assigned(cls, field, value, True) for value in VALUES]
        found[f"given {field}"] = [
            outcome(lambda f=field, v=value: cls(check_fields=True, **{f: v}))  # type: ignore[misc]
            for value in VALUES[::6]
        ]
    return found


def assigned(cls: Any, field: str, value: Any, check: bool) -> str:
    """Return the result of assigning a value to a field."""

    def assign() -> list[Any]:
        message = cls(check_fields=check)
        setattr(message, field, value)
        got = getattr(message, field)
        return [type(got).__name__, got, got is value]

    return outcome(assign)


def parts_of(name: str, cls: Any) -> dict[str, Any]:
    """Return the message classes of an interface, by name."""
    if "/msg/" in name:
        return {name: cls}
    if "/srv/" in name:
        return {f"{name}.{part}": getattr(cls, part) for part in ("Request", "Response", "Event")}
    found = {f"{name}.{part}": getattr(cls, part) for part in ("Goal", "Result", "Feedback")}
    found[f"{name}.FeedbackMessage"] = cls.Impl.FeedbackMessage
    for service in ("SendGoalService", "GetResultService"):
        found |= parts_of(f"{name}.{service}/srv/", getattr(cls.Impl, service))
    return found


def report(classes: dict[str, Any]) -> dict[str, Any]:
    """Describe interfaces, given by their ROS names."""
    found: dict[str, Any] = {}
    for name, cls in classes.items():
        if "/msg/" not in name:
            found[name] = {
                "names": [str(cls), type(cls).__name__, type(cls).__doc__],
                "instance": outcome(cls),
                "attributes": sorted(vars(cls)),
            }
        found |= {part: message_report(one) for part, one in parts_of(name, cls).items()}
    return found


if __name__ == "__main__":
    known: dict[str, Any] = {}
    for line in sys.stdin.read().split():
        package, kind, short = line.split("/")
        try:
            known[line] = getattr(importlib.import_module(f"{package}.{kind}"), short)
        except ImportError:
            continue  # not every package is installed
    json.dump(report(known), sys.stdout, default=str)
