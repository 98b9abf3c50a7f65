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
    """Several services or topics were found where one was expected."""


class NotFoundError(Exception):
    """A service or topic was not found in the graph."""


class NotReadyError(Exception):
    """A method was called before `setup`."""


class ServiceError(Exception):
    """A service sent no response."""


class TimedOutError(Exception):
    """A server, publisher or tree did not become available in time."""
