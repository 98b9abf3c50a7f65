"""The exceptions that rclpy's extension module defines."""

from __future__ import annotations

__all__ = [
    "InvalidHandle",
    "NodeNameNonExistentError",
    "RCLError",
    "RCLInvalidROSArgsError",
    "TimerCancelledError",
    "UnknownROSArgsError",
    "UnsupportedEventTypeError",
]


class RCLError(RuntimeError):
    """An operation of the client library failed."""


class InvalidHandle(RuntimeError):  # noqa: N818  # rclpy's name
    """The entity, or what it belongs to, is destroyed."""


class NodeNameNonExistentError(RCLError):
    """There is no node of this name."""


class UnsupportedEventTypeError(RCLError):
    """The middleware does not report events of this type."""


class TimerCancelledError(RCLError):
    """A timer was to be called that is cancelled."""


class UnknownROSArgsError(RuntimeError):
    """An argument between ``--ros-args`` and ``--`` is unknown."""


class RCLInvalidROSArgsError(RCLError):
    """An argument between ``--ros-args`` and ``--`` is malformed."""
