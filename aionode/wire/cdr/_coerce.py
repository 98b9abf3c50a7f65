"""A closer look at values that are not of Python's or numpy's own classes.

A generated encoder calls these where a value is not what it mostly is. They take what can be
packed as it stands; a `NeedsFallback` makes the encoder leave the message to a snapshot of it.
"""

from __future__ import annotations

import struct
from numbers import Real
from typing import Any

from aionode.wire.cdr._codegen import NeedsFallback

__all__ = ["coerce_array", "octets", "real_numbers", "whole_numbers"]

CLASSES: dict[str, set[type]] = {"b": {bool}, "i": {int}, "u": {int}, "f": {float, int}}
"""Classes of the numbers in a list that need no closer look, by kind of dtype."""


def octets(value: object) -> Any:
    """Return `value` if its bytes are what is sent."""
    if isinstance(value, bytes | bytearray):
        return value
    try:
        view = memoryview(value)  # type: ignore[arg-type] # asked in this way: an ndarray has one
    except (TypeError, BufferError):
        raise NeedsFallback from None
    if view.format == "B" and view.ndim == 1 and view.contiguous:
        return view
    raise NeedsFallback


def whole_numbers(*values: object) -> None:
    """Raise where a value is a bool: struct takes it, and whatever else is no int it refuses."""
    if any(isinstance(value, bool) for value in values):
        raise NeedsFallback


def real_numbers(*values: object) -> None:
    """Raise where a value only behaves like a number, as a bool, a Decimal or an array do."""
    for value in values:
        # The first question is the quick one; numpy's float64 is a float.
        if not isinstance(value, float) and (
            isinstance(value, bool) or not isinstance(value, int | Real)
        ):
            raise NeedsFallback


def coerce_array(value: object, dtype: Any, code: str) -> Any:
    """Return a list of Python's own numbers, or an array of a subclass of ndarray, as an ndarray.

    Args:
        value: What stands where an array is expected.
        dtype: The array's.
        code: The letter of its elements for `struct`.
    """
    import numpy as np

    if isinstance(value, np.ndarray):
        if value.dtype != dtype:
            raise NeedsFallback
        return value.view(np.ndarray)
    if not isinstance(value, list | tuple) or not set(map(type, value)) <= CLASSES[dtype.kind]:
        raise NeedsFallback
    # struct knows the ranges.
    return np.frombuffer(struct.pack(f"<{len(value)}{code}", *value), dtype)
