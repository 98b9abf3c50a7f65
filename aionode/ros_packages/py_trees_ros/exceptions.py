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
    """Several of what was looked for were found, where one was expected."""


class NotFoundError(Exception):
    """What was looked for is not in the graph."""


class NotReadyError(Exception):
    """A method was called before `setup`."""


class ServiceError(Exception):
    """A service gave no response."""


class TimedOutError(Exception):
    """What was waited for did not come in time."""
