"""Arrays over the bytes of messages."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["array_over"]


def array_over(
    data: Any, shape: tuple[int, ...], dtype: np.dtype[Any], strides: tuple[int, ...]
) -> npt.NDArray[Any]:
    """Return an array over the bytes of a message, which are only copied if they are a list.

    Args:
        data: The field of the message.
        shape: The shape of the array.
        dtype: The type of the array.
        strides: The distance between elements in bytes, in each dimension; not negative.

    Raises:
        TypeError: The message has less data than its size needs.
    """
    if isinstance(data, list):
        data = bytearray(data)
    given = len(memoryview(data).cast("B")) if len(data) > 0 else 0
    needed = 0
    if 0 not in shape:
        steps = ((count - 1) * stride for count, stride in zip(shape, strides, strict=True))
        needed = sum(steps) + dtype.itemsize
    if given < needed:  # numpy does not check the size of an empty buffer
        raise TypeError(f"the message has {given} bytes of data; its size needs {needed}")
    return np.ndarray(shape, dtype, buffer=data if given else None, strides=strides)
