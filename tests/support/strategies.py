"""Random messages of any type, and the list of all types that come with aionode."""

from __future__ import annotations

import copy
import pkgutil
from functools import cache
from importlib import import_module
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from hypothesis import strategies as st

import aionode.interfaces
from aionode.message import (
    DTYPES,
    ActionType,
    FieldType,
    Message,
    ServiceType,
    fields,
    type_name,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

__all__ = [
    "any_messages",
    "message_classes",
    "messages",
    "packages_of",
    "shipped_types",
    "values",
    "various_classes",
]

HEAVIEST = 160
"""The most values that a message may have to be drawn as a whole."""

MAX_ELEMENTS = 4
"""The longest random sequence: further elements would test nothing new."""

INTEGERS = {
    name: (np.iinfo(dtype).min, np.iinfo(dtype).max)
    for name, dtype in DTYPES.items()
    if np.dtype(dtype).kind in "iu"
}


@cache
def shipped_types() -> dict[str, Any]:
    """Return every message, service and action class of `aionode.interfaces` by its ROS name."""
    found: dict[str, Any] = {}
    for package in pkgutil.iter_modules(aionode.interfaces.__path__):
        root = f"aionode.interfaces.{package.name}"
        for module in pkgutil.iter_modules(import_module(root).__path__):
            members = vars(import_module(f"{root}.{module.name}")).values()
            named = [member for member in members if is_type(member)]
            found |= {type_name(cls): cls for cls in named if cls.__module__.startswith(root)}
    return dict(sorted(found.items()))


def is_type(member: object) -> bool:
    """Return whether a member of a module is a class with a ROS name."""
    return isinstance(member, type) and bool(getattr(member, "__ros_type__", ""))


@cache
def message_classes() -> dict[str, type[Message]]:
    """Return every message class of aionode, including parts of services and actions."""
    return {type_name(part): part for cls in shipped_types().values() for part in parts_of(cls)}


def packages_of(classes: Iterable[str]) -> list[str]:
    """Return the packages of some classes, by which tests go through all of them.

    pytest would take a second to collect a test of each class.
    """
    return sorted({name.partition("/")[0] for name in classes})


@cache
def various_classes() -> dict[str, type[Message]]:
    """Return a tenth of all message classes, with every pair of successive kinds of fields.

    The code for a class depends on the kinds of its fields and, by their alignment, on their order:
    other classes would show nothing new, and each package adds more of them.
    """
    various: dict[str, type[Message]] = {}
    seen: set[tuple[object, object]] = set()
    for name, cls in message_classes().items():
        kinds = [(kind.nested is None and kind.kind, kind.container) for kind in types_of(cls)]
        pairs = set(pairwise([None, *kinds, None]))
        if not pairs <= seen:
            various[name] = cls
            seen |= pairs
    return various


def types_of(cls: type[Message]) -> list[FieldType]:
    """Return the types of the fields of a class."""
    return [field.type for field in fields(cls)]


def parts_of(cls: Any) -> Iterator[type[Message]]:
    """Yield the messages that a type consists of."""
    if issubclass(cls, ServiceType):
        yield from (cls.Request, cls.Response, cls.Event)
    elif issubclass(cls, ActionType):
        yield from (cls.Goal, cls.Result, cls.Feedback, cls.Impl.FeedbackMessage)
        yield from parts_of(cls.Impl.SendGoalService)
        yield from parts_of(cls.Impl.GetResultService)
    else:
        yield cls


def any_messages(*, nan: bool = False) -> st.SearchStrategy[Any]:
    """Return a strategy for messages of any class; see `messages`."""
    # Only a test that runs imports all classes.
    classes = st.deferred(lambda: st.sampled_from(list(message_classes().values())))
    return classes.flatmap(lambda cls: messages(cls, nan=nan))


@cache  # hypothesis takes longer to make a strategy than to draw from it
def messages(cls: type[Message], *, nan: bool = False) -> st.SearchStrategy[Any]:
    """Return a strategy for messages of one class, in the forms that readers get.

    Args:
        cls: The class.
        nan: Whether floats may be NaN, which equals nothing.
    """
    drawn = {field.name: values(field.type, nan=nan) for field in fields(cls)}
    if weight(cls) <= HEAVIEST:
        return st.builds(cls, **drawn)
    # More than hypothesis draws at once: one field at a time.
    return st.one_of(*(st.builds(cls, **{name: field}) for name, field in drawn.items()))


@cache
def weight(cls: Any) -> int:
    """Return the approximate number of values in a random message of a class."""
    return sum(
        (weight(field.type.nested) if field.type.nested else 1)
        * (1 if field.type.container == "single" else 2)
        for field in fields(cls)
    )


def values(kind: FieldType, *, nan: bool = False) -> st.SearchStrategy[Any]:
    """Return a strategy for the values of a field."""
    if kind.container == "single":
        return single_values(kind, nan=nan)
    least = kind.size if kind.container == "array" else 0
    most = min(kind.size or MAX_ELEMENTS, MAX_ELEMENTS)
    if kind.form == "bytes":
        return st.binary(min_size=least, max_size=max(least, most))
    if kind.form == "list" and kind.container != "array":
        return st.lists(
            single_values(kind, nan=nan), max_size=min(most, 2 if kind.nested else most)
        )
    if kind.form == "list":
        # A message in several places would be one object: each is built anew.
        drawn = st.lists(single_values(kind, nan=nan), min_size=1, max_size=1)
        return drawn.map(lambda some: [copy.deepcopy(some[0]) for _ in range(least)])
    drawn = st.lists(single_values(kind, nan=nan), min_size=min(least, most), max_size=most)
    dtype = DTYPES[kind.kind]
    # A long array repeats the few values that were drawn.
    return drawn.map(lambda some: np.resize(np.array(some, dtype), least or len(some)))


def single_values(kind: FieldType, *, nan: bool) -> st.SearchStrategy[Any]:
    """Return a strategy for one value."""
    if kind.nested is not None:
        return messages(kind.nested, nan=nan)
    if kind.kind in INTEGERS:
        return st.integers(*INTEGERS[kind.kind])
    if kind.kind in {"float32", "float64"}:
        return st.floats(width=32 if kind.kind == "float32" else 64, allow_nan=nan)
    if kind.kind == "bool":
        return st.booleans()
    if kind.kind == "byte":
        return st.binary(min_size=1, max_size=1)
    return st.text(max_size=min(kind.string_bound or 8, 8))
