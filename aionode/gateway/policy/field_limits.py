"""The limits that a policy sets on the fields of messages, and the check for finite numbers."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from typing import Any, Final, Literal

import msgspec

from aionode.message import FieldType, Message, fields, snapshot

__all__ = ["FieldLimit", "OutOfLimitsError", "check_finite", "limited"]


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
    """A field value is outside its limits. Caught by `Policy.decide`."""


def check_finite(message: Any) -> None:
    """Refuse a message or parameter that contains NaN or infinity.

    Raises:
        OutOfLimitsError: it contains one, whose path the error names.
    """
    if isinstance(message, Message):
        found = next(not_finite_in(message), None) if may_not_be_finite(message) else None
    else:  # the value of a parameter
        found = next((("value", each) for each in not_finite(message["value"])), None)
    if found is not None:
        path, number = found
        raise OutOfLimitsError(
            f"{path} is {number}; the robot accepts only finite numbers, unless the "
            "policy's rule for this name has finite = false"
        )


def may_not_be_finite(message: Message) -> bool:
    """Return whether a message may contain NaN or infinity.

    Walking over 100 000 numbers would block the loop for a tenth of a second. In JSON, which is
    written twenty times faster, such numbers are null; null within a text only costs a needless
    walk.
    """
    if not floating(type(message)):
        return False
    try:
        return b"null" in ENCODER.encode(message)
    except UnicodeError:  # text that is not UTF-8
        return True


def numbers_only(value: Any) -> object:
    """Convert a numpy array of floating-point numbers for JSON, and any other array to nothing."""
    return value.tolist() if value.dtype.kind == "f" else []


ENCODER: Final = msgspec.json.Encoder(enc_hook=numbers_only)


def not_finite_in(message: Message) -> Iterator[tuple[str, float]]:
    """Yield the numbers of a message that are NaN or infinite, with their paths."""
    for name, type_ in floating(type(message)):
        value = getattr(message, name)
        if type_.nested is None:
            yield from ((name, each) for each in not_finite(value))
        else:
            for inner in (value,) if type_.container == "single" else value:
                yield from ((f"{name}.{path}", each) for path, each in not_finite_in(inner))


@cache
def floating(cls: type[Message]) -> list[tuple[str, FieldType]]:
    """Return the fields of a class that may contain floating-point numbers."""
    return [
        (field.name, field.type)
        for field in fields(cls)
        if field.type.kind in {"float32", "float64"}
        or (field.type.nested is not None and floating(field.type.nested))
    ]


def not_finite(value: Any) -> list[float]:
    """Return the numbers of a field or parameter that are NaN or infinite."""
    if hasattr(value, "dtype"):
        import numpy as np  # imported on first use, as in the messages

        numbers: list[float] = value[~np.isfinite(value)].tolist()
        return numbers
    values = value if isinstance(value, list | tuple | array) else (value,)
    return [each for each in values if isinstance(each, float) and not math.isfinite(each)]


def limited(message: Any, limits: Mapping[str, FieldLimit]) -> Any:
    """Return a message whose fields are within their limits, unchanged if they already are.

    Raises:
        OutOfLimitsError: a value is outside its limits, and may not be clamped.
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
    """Yield the values at a path, each with its owner and name, through all messages of an array.

    Raises:
        OutOfLimitsError: there is no such field.
    """
    name = path[0]
    try:
        value = owner[name] if isinstance(owner, Mapping) else getattr(owner, name)
    except (KeyError, AttributeError):
        raise OutOfLimitsError(
            f"the policy limits a field {name!r}, which does not exist"
        ) from None
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
        raise OutOfLimitsError(f"{path} is not a number, and the policy limits it")
    return value if isinstance(value, Iterable) else (value,)


def is_within(number: Any, limit: FieldLimit, path: str) -> bool:
    """Return whether a number is within its limits.

    Raises:
        OutOfLimitsError: the number is NaN, which has no nearest limit.
    """
    if number != number:  # noqa: PLR0124  # only NaN differs from itself
        raise OutOfLimitsError(f"{path} is NaN, and the policy limits it")
    try:
        return bool(limit.min <= number <= limit.max)
    except TypeError:
        raise OutOfLimitsError(
            f"{path} contains something that is not a number, and the policy limits it"
        ) from None


def clamped(value: Any, limit: FieldLimit) -> Any:
    """Clamp a number, or each number of an array, to its limits."""
    if hasattr(value, "dtype") and isinstance(value, Iterable):
        copy: Any = value.copy()  # type: ignore[attr-defined]  # an array of numpy
        copy[:] = [clamped(number, limit) for number in copy.tolist()]
        return copy
    if isinstance(value, Iterable):
        return [clamped(number, limit) for number in value]
    if limit.min <= value <= limit.max:
        return value
    if isinstance(value, int):  # the nearest value within
        return math.ceil(limit.min) if value < limit.min else math.floor(limit.max)
    return limit.min if value < limit.min else limit.max
