"""Random messages of any type, for property tests."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from aionode.interfaces import get_interface, interface_names, shipped_packages
from aionode.message import FieldType, Message, fields
from aionode.message._field_types import INT_RANGES

__all__ = ["any_messages", "message_classes", "messages", "shipped_names"]

TEXT = st.characters(exclude_categories=["Cs"])  # lone surrogates cannot be encoded


def message_classes() -> list[type[Message]]:
    """Return every message class that aionode ships, the halves of services and actions too."""
    found: list[type[Message]] = []
    for name in shipped_names():
        cls = get_interface(name)
        halves = ("Request", "Response", "Goal", "Result", "Feedback")
        parts = [cls, *(getattr(cls, half) for half in halves if hasattr(cls, half))]
        found.extend(part for part in parts if issubclass(part, Message))
    return found


def shipped_names() -> list[str]:
    """Return the names of all types that aionode ships; other tests load more."""
    return [name for name in interface_names() if name.split("/")[0] in shipped_packages()]


def any_messages(*, nan: bool = False) -> st.SearchStrategy[Message]:
    """Messages of any class; floats are no NaN unless asked for, as that is not equal to itself."""
    return st.sampled_from(message_classes()).flatmap(lambda cls: messages(cls, nan=nan))


def messages(cls: type[Message], *, nan: bool = False) -> st.SearchStrategy[Message]:
    """Messages of one class."""
    return st.builds(cls, **{field.name: values(field.type, nan=nan) for field in fields(cls)})


def values(type_: FieldType, *, nan: bool) -> st.SearchStrategy[Any]:
    """Values of one field."""
    if type_.container == "single":
        return single(type_, nan=nan)
    low = type_.size if type_.container == "array" else 0
    high = min(type_.size, 3) if type_.container == "bounded" else max(low, 2)
    if type_.form == "bytes":
        return st.binary(min_size=low, max_size=high)
    return st.lists(single(type_, nan=nan), min_size=low, max_size=high)


def single(type_: FieldType, *, nan: bool) -> st.SearchStrategy[Any]:
    """Single values, or elements of containers."""
    if type_.nested is not None:
        return messages(type_.nested, nan=nan)
    if type_.kind in INT_RANGES:
        return st.integers(*INT_RANGES[type_.kind])
    if type_.kind in {"float32", "float64"}:
        return st.floats(width=32 if type_.kind == "float32" else 64, allow_nan=nan)
    if type_.kind == "bool":
        return st.booleans()
    if type_.kind == "byte":
        return st.binary(min_size=1, max_size=1)
    bound = 5 if type_.string_bound is None else min(5, type_.string_bound)
    return st.text(TEXT, max_size=bound)
