"""Checks of values that are not of the usual Python and numpy classes.

Generated encoders call these functions for unusual values. They accept what can be packed directly,
and otherwise raise `NeedsFallback`: the encoder then encodes a snapshot of the message.
"""

from __future__ import annotations

import struct
from array import array
from functools import cache
from numbers import Real
from typing import TYPE_CHECKING, Any

from aionode.engine.wire.cdr._codegen import NeedsFallback

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["array_coercer", "octets", "real_numbers", "whole_numbers"]

CLASSES: dict[str, set[type]] = {"b": {bool}, "i": {int}, "u": {int}, "f": {float, int}}
"""Classes of numbers that `struct` converts correctly, by kind of dtype."""


def octets(value: object) -> Any:
    """Return `value`, or a view of it, if its memory can be sent directly."""
    if isinstance(value, bytes | bytearray):
        return value
    try:
        view = memoryview(value)  # type: ignore[arg-type] # raises TypeError if it has no buffer
    except (TypeError, BufferError):
        raise NeedsFallback from None
    if view.format == "B" and view.ndim == 1 and view.contiguous:
        return view
    raise NeedsFallback


def whole_numbers(*values: object) -> None:
    """Raise NeedsFallback for a bool: `struct` accepts it, but rejects all other non-integers."""
    if any(isinstance(value, bool) for value in values):
        raise NeedsFallback


def real_numbers(*values: object) -> None:
    """Raise NeedsFallback for values that `struct` accepts although they are not real numbers.

    A bool, a Decimal or an array would also convert to a float.
    """
    for value in values:
        # The first test is the fast one; numpy's float64 is a float.
        if not isinstance(value, float) and (
            isinstance(value, bool) or not isinstance(value, int | Real)
        ):
            raise NeedsFallback


@cache
def array_coercer(dtype: Any, code: str) -> Callable[[object], Any]:
    """Return a function that makes an ndarray of a list, an `array.array` or an ndarray subclass.

    Args:
        dtype: The dtype of the field.
        code: The `struct` format character of its elements.
    """
    import numpy as np

    ndarray, frombuffer, pack, classes = np.ndarray, np.frombuffer, struct.pack, CLASSES[dtype.kind]

    def coerce(value: object) -> Any:
        if isinstance(value, (list, tuple)):  # a union takes three times as long
            if not classes.issuperset(map(type, value)):
                raise NeedsFallback
            return frombuffer(pack(f"<{len(value)}{code}", *value), dtype)  # checks the ranges
        if isinstance(value, array) and value.typecode == code:
            return frombuffer(value, dtype)
        if not isinstance(value, ndarray) or value.dtype != dtype:
            raise NeedsFallback
        return value.view(ndarray)

    return coerce
