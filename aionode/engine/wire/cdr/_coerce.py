"""Checks of values that are not of the usual Python and numpy classes.

Generated encoders call these functions for unusual values. They accept what can be packed directly,
and otherwise raise `NeedsFallback`: the encoder then encodes a snapshot of the message.
"""

from __future__ import annotations

import struct
from array import array
from numbers import Real
from typing import Any

from aionode.engine.wire.cdr._codegen import NeedsFallback

__all__ = ["coerce_array", "octets", "real_numbers", "whole_numbers"]

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


def coerce_array(value: object, dtype: Any, code: str) -> Any:
    """Return a list of numbers, an `array.array` or an ndarray subclass as an ndarray.

    Args:
        value: The value of an array field.
        dtype: The dtype of the field.
        code: The `struct` format character of its elements.
    """
    import numpy as np

    if isinstance(value, np.ndarray):
        if value.dtype != dtype:
            raise NeedsFallback
        return value.view(np.ndarray)
    if isinstance(value, array) and value.typecode == code:
        return np.frombuffer(value, dtype)
    if not isinstance(value, list | tuple) or not set(map(type, value)) <= CLASSES[dtype.kind]:
        raise NeedsFallback
    # struct checks the ranges.
    return np.frombuffer(struct.pack(f"<{len(value)}{code}", *value), dtype)
