"""Lengths of vectors, and products of matrices."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = [
    "EPSILON",
    "Array",
    "concatenate_matrices",
    "floats",
    "inverse_matrix",
    "is_same_transform",
    "random_vector",
    "unit_vector",
    "vector_norm",
]

Array = npt.NDArray[Any]

EPSILON = 4.0 * float(np.finfo(float).eps)
"""Numbers below this are treated as zero."""


def floats(data: npt.ArrayLike, size: int | None = None) -> Array:
    """Return a new array of floats; of the first `size` if that is given."""
    return np.array(data, dtype=np.float64)[:size]


def vector_norm(data: npt.ArrayLike, axis: int | None = None, out: Array | None = None) -> Any:
    """Return the length of a vector, or the lengths along an axis.

    Args:
        data: A vector, or an array of vectors.
        axis: The axis of their components; all by default.
        out: Receives the lengths; then nothing is returned.
    """
    values = floats(data)
    if out is not None:
        np.sqrt(np.sum(values * values, axis=axis), out=out)
        return None
    if values.ndim == 1:
        return math.sqrt(np.dot(values, values))
    return np.atleast_1d(np.sqrt(np.sum(values * values, axis=axis)))


def unit_vector(data: npt.ArrayLike, axis: int | None = None, out: Array | None = None) -> Any:
    """Return a vector of length 1 in the same direction, or such vectors along an axis.

    Args:
        data: A vector, or an array of vectors.
        axis: The axis of their components; all by default.
        out: Receives the vectors, and may be `data`; then nothing is returned.
    """
    values = floats(data)
    lengths = np.sqrt(np.sum(values * values, axis=axis, keepdims=axis is not None))
    if out is None:
        return values / lengths
    np.divide(values, lengths, out=out)
    return None


def random_vector(size: int | tuple[int, ...]) -> Array:
    """Return random numbers from 0 up to, but excluding, 1."""
    return np.random.random(size)  # noqa: NPY002  # programs seed this generator


def inverse_matrix(matrix: npt.ArrayLike) -> Array:
    """Return the inverse of a square matrix.

    Raises:
        numpy.linalg.LinAlgError: It has none.
    """
    return np.linalg.inv(floats(matrix))


def concatenate_matrices(*matrices: npt.ArrayLike) -> Array:
    """Return the product of 4x4 matrices; the last is applied first."""
    product = np.identity(4)
    for matrix in matrices:
        product = product @ floats(matrix)
    return product


def is_same_transform(matrix0: npt.ArrayLike, matrix1: npt.ArrayLike) -> bool:
    """Return whether two 4x4 matrices have the same effect on every point, whatever their scale."""
    first, second = floats(matrix0), floats(matrix1)
    return bool(np.allclose(first / first[3, 3], second / second[3, 3]))
