"""A closer look at values that are not of Python's or numpy's own classes.

A generated encoder calls these where a value is not what it mostly is. They take what can be
packed as it stands; a `Misfit` makes the encoder leave the message to a snapshot of it.
"""

from __future__ import annotations

from numbers import Real
from typing import Any

from aionode.wire.source import Misfit

__all__ = ["base_array", "octets", "real_numbers", "whole_numbers"]


def octets(value: object) -> Any:
    """Return `value` if its bytes are what is sent."""
    if isinstance(value, bytes | bytearray):
        return value
    if isinstance(value, memoryview) and value.format == "B" and value.ndim == 1:
        return value
    raise Misfit


def whole_numbers(*values: object) -> None:
    """Raise where a value is a bool: struct takes it, and whatever else is no int it refuses."""
    if any(isinstance(value, bool) for value in values):
        raise Misfit


def real_numbers(*values: object) -> None:
    """Raise where a value only behaves like a number, as a bool, a Decimal or an array do."""
    if not all(isinstance(value, Real) and not isinstance(value, bool) for value in values):
        raise Misfit


def base_array(value: object, dtype: Any) -> Any:
    """Return what is an ndarray of this dtype, but of a subclass such as memmap, as an ndarray."""
    import numpy as np

    if not isinstance(value, np.ndarray) or value.dtype != dtype:
        raise Misfit
    return value.view(np.ndarray)
