"""Checks of values that are not of the usual Python and numpy classes.

Generated encoders call these functions for unusual values. They accept what can be packed directly,
and otherwise raise `NeedsFallback`: the encoder then encodes a snapshot of the message.
"""

from __future__ import annotations

import struct
import sys
from array import array
from functools import cache
from numbers import Real
from typing import TYPE_CHECKING, Any

from aionode.engine.wire.cdr._codegen import NeedsFallback
from aionode.engine.wire.cdr._constants import NOTHING

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
def array_coercer(dtype: str, code: str) -> Callable[[object], Any]:
    """Return a function that makes a buffer of a list, an `array.array` or an ndarray.

    Buffers have the elements of the field, in the order of bytes of the encoding. Only an ndarray
    is returned as one, so that other values need no numpy.

    Args:
        dtype: The dtype of the field, without an order of bytes.
        code: The `struct` format character of its elements.
    """
    pack, classes = struct.pack, CLASSES[dtype[0]]

    def coerce(value: Any) -> Any:
        if isinstance(value, (list, tuple)):  # a union takes three times as long
            if not classes.issuperset(map(type, value)):
                raise NeedsFallback
            if not value:
                return NOTHING
            packed = pack(f"<{len(value)}{code}", *value)  # checks the ranges
            return memoryview(packed).cast(code)  # type: ignore[call-overload]  # a character of `PRIMITIVES`
        if isinstance(value, array) and value.typecode == code:
            return memoryview(value)
        if "numpy" not in sys.modules:
            raise NeedsFallback
        import numpy as np

        if not isinstance(value, np.ndarray) or value.dtype != f"<{dtype}":
            raise NeedsFallback
        return value.view(np.ndarray)

    return coerce
