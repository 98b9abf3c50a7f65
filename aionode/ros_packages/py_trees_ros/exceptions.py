"""The exceptions of py_trees_ros."""

from __future__ import annotations

__all__ = [
    "MultipleFoundError",
    "NotFoundError",
    "NotReadyError",
    "ServiceError",
    "TimedOutError",
]


class MultipleFoundError(Exception):
    """More than one was found where one was expected."""


class NotFoundError(Exception):
    """It was not found in the graph."""


class NotReadyError(Exception):
    """A method was called before `setup`."""


class ServiceError(Exception):
    """A service sent no response."""


class TimedOutError(Exception):
    """It did not become available in time."""
