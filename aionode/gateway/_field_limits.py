"""The limits that a policy sets to the fields of messages."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Literal

import msgspec

from aionode.message import Message, snapshot

__all__ = ["FieldLimit", "OutOfLimitsError", "limited"]


class FieldLimit(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The limits of one field of a message. A NaN is never within the limits.

    Attributes:
        min: The least value.
        max: The greatest value.
        outside: ``refuse`` refuses a message with a value outside the limits, and ``clamp``
            replaces the value by the nearest limit.
    """

    min: float = -math.inf
    max: float = math.inf
    outside: Literal["refuse", "clamp"] = "refuse"


class OutOfLimitsError(ValueError):
    """A field has a value outside of its limits. Caught by `Policy.decide`."""


def limited(message: Any, limits: Mapping[str, FieldLimit]) -> Any:
    """Return a message whose fields are within their limits: the same one if it already is.

    Raises:
        OutOfLimitsError: a value is not within its limits, and may not be clamped.
    """
    outside = [
        path
        for path, limit in limits.items()
        for _, _, value in leaves(message, path.split("."))
        if not all(is_within(number, limit, path) for number in numbers_of(value, path))
    ]
    if not outside:
        return message
    for path in outside:
        limit = limits[path]
        if limit.outside == "refuse":
            raise OutOfLimitsError(f"{path} is not within {limit.min:g} and {limit.max:g}")
    changed = snapshot(message) if isinstance(message, Message) else dict(message)
    for path in outside:
        for owner, name, value in list(leaves(changed, path.split("."))):
            put(owner, name, clamped(value, limits[path]))
    return changed


def leaves(owner: Any, path: list[str]) -> Iterator[tuple[Any, str, Any]]:
    """Yield what a path leads to, with its owner and name; through all messages of an array.

    Raises:
        OutOfLimitsError: there is no such field.
    """
    name = path[0]
    try:
        value = owner[name] if isinstance(owner, Mapping) else getattr(owner, name)
    except (KeyError, AttributeError):
        raise OutOfLimitsError(f"the policy limits a field {name!r}, which is not there") from None
    if len(path) == 1:
        yield owner, name, value
        return
    for inner in value if isinstance(value, list | tuple) else (value,):
        yield from leaves(inner, path[1:])


def put(owner: Any, name: str, value: Any) -> None:
    """Set a field of a message, or a key of a mapping."""
    if isinstance(owner, dict):
        owner[name] = value
    else:
        setattr(owner, name, value)


def numbers_of(value: Any, path: str) -> Iterable[Any]:
    """Return the numbers of a field: one, or those of an array.

    Raises:
        OutOfLimitsError: the field has none.
    """
    if isinstance(value, str | bytes | Message) or value is None:
        raise OutOfLimitsError(f"{path} is no number, and the policy limits it")
    return value if isinstance(value, Iterable) else (value,)


def is_within(number: Any, limit: FieldLimit, path: str) -> bool:
    """Return whether a number is within its limits.

    Raises:
        OutOfLimitsError: the number is NaN, for which no limit is the nearest.
    """
    if number != number:  # noqa: PLR0124  # only NaN differs from itself
        raise OutOfLimitsError(f"{path} is NaN, and the policy limits it")
    try:
        return bool(limit.min <= number <= limit.max)
    except TypeError:
        raise OutOfLimitsError(f"{path} has what is no number, and the policy limits it") from None


def clamped(value: Any, limit: FieldLimit) -> Any:
    """Return a number or an array with each number within its limits."""
    if hasattr(value, "dtype") and isinstance(value, Iterable):
        array: Any = value.copy()  # type: ignore[attr-defined]  # an array of numpy
        array[:] = [clamped(number, limit) for number in array.tolist()]
        return array
    if isinstance(value, Iterable):
        return [clamped(number, limit) for number in value]
    if limit.min <= value <= limit.max:
        return value
    if isinstance(value, int):  # the nearest one within
        return math.ceil(limit.min) if value < limit.min else math.floor(limit.max)
    return limit.min if value < limit.min else limit.max
