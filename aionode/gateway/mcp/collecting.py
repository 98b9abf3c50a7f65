"""Messages of a topic as tools use them: the next ones, or statistics over some time."""

from __future__ import annotations

import asyncio
import math
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from aionode.message import Message, fields

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.gateway.session.feed import Received

__all__ = ["Arrivals", "Numbers", "numbers_of"]

NUMBERS: Final = frozenset(
    {"float32", "float64", "bool", "char"}
    | {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
)
"""The types of fields that contain numbers."""

MAX_PATHS: Final = 64
"""The most fields of a message for which statistics are kept."""

MAX_ELEMENTS: Final = 1000
"""The most messages of an array for which statistics are kept."""


class Arrivals:
    """Keeps the newest messages as they arrive.

    Args:
        max_messages: How many.

    Attributes:
        count: How many have arrived.
    """

    def __init__(self, max_messages: int) -> None:
        self.count = 0
        self._kept: deque[Received] = deque(maxlen=max_messages)
        self._arrived = asyncio.Event()

    def put(self, received: Received) -> None:
        """Keep a message; called by `Session.subscribe`, for which it returns no frame."""
        self.count += 1
        self._kept.append(received)
        self._arrived.set()

    async def get(self) -> Received:
        """Wait for the oldest message that was not taken yet."""
        while not self._kept:
            self._arrived.clear()
            await self._arrived.wait()
        return self._kept.popleft()


@dataclass(slots=True)
class Numbers:
    """Statistics of the numbers of one field.

    Attributes:
        count: How many finite ones there were.
        least: The least of them.
        greatest: The greatest of them.
        total: Their sum.
        first: The first of them.
        last: The last of them.
        not_finite: How many were NaN or infinite.
    """

    count: int = 0
    least: float = math.inf
    greatest: float = -math.inf
    total: float = 0.0
    first: float = math.nan
    last: float = math.nan
    not_finite: int = 0

    def add(self, values: Any) -> None:
        """Add an array of numbers."""
        import numpy as np  # few clients watch

        numbers = np.asarray(values, dtype=np.float64).ravel()
        finite = numbers[np.isfinite(numbers)]
        self.not_finite += int(numbers.size - finite.size)
        if not finite.size:
            return
        if not self.count:
            self.first = float(finite[0])
        self.last = float(finite[-1])
        self.count += int(finite.size)
        self.least = min(self.least, float(finite.min()))
        self.greatest = max(self.greatest, float(finite.max()))
        self.total += float(finite.sum())

    def summary(self) -> dict[str, Any]:
        """Return the statistics as JSON-compatible values."""
        if not self.count:
            return {"finite_numbers": 0}
        values: dict[str, Any] = {
            "min": rounded(self.least),
            "mean": rounded(self.total / self.count),
            "max": rounded(self.greatest),
            "first": rounded(self.first),
            "last": rounded(self.last),
        }
        if self.not_finite:
            values["not_finite"] = self.not_finite
        return values


def rounded(number: float) -> float:
    """Return a number with seven digits."""
    return float(f"{number:.7g}")


def numbers_of(message: Message) -> Iterator[tuple[str, Any]]:
    """Yield the paths and values of the numbers in a message, except those of its stamps."""
    yield from list(walked(message, ""))[:MAX_PATHS]


def walked(message: Message, prefix: str) -> Iterator[tuple[str, Any]]:
    """Yield the numbers of a message, with paths that begin with a prefix."""
    for each in fields(type(message)):
        value, path = getattr(message, each.name), f"{prefix}{each.name}"
        if each.type.nested is not None:
            if each.type.nested.__ros_type__ == "builtin_interfaces/msg/Time":
                continue
            if each.type.container == "single":
                yield from walked(value, f"{path}.")
            else:
                yield from of_elements(value[:MAX_ELEMENTS], path)
        elif each.type.kind in NUMBERS:
            yield path, [value] if each.type.container == "single" else value


def of_elements(messages: list[Message], path: str) -> Iterator[tuple[str, Any]]:
    """Yield the numbers of the messages in an array; those of one field together."""
    together: dict[str, list[Any]] = {}
    for message in messages:
        for name, values in walked(message, f"{path}[]."):
            together.setdefault(name, []).extend(values)
    yield from together.items()
