"""The exceptions that rclpy's extension module defines."""

from __future__ import annotations

__all__ = [
    "InvalidHandle",
    "NodeNameNonExistentError",
    "RCLError",
    "RCLInvalidROSArgsError",
    "RMWError",
    "TimerCancelledError",
    "UnknownROSArgsError",
    "UnsupportedEventTypeError",
]


class RCLError(RuntimeError):
    """An operation of the client library failed."""

    __module__ = "rclpy._rclpy_pybind11"


class RMWError(RuntimeError):
    """An operation of the middleware failed."""

    __module__ = "rclpy._rclpy_pybind11"


class InvalidHandle(RuntimeError):  # noqa: N818  # rclpy's name
    """The entity, or its owner, is destroyed."""

    __module__ = "rclpy._rclpy_pybind11"


class NodeNameNonExistentError(RCLError):
    """There is no node with this name."""

    __module__ = "rclpy._rclpy_pybind11"


class UnsupportedEventTypeError(RCLError):
    """The middleware does not report events of this type."""

    __module__ = "rclpy._rclpy_pybind11"


class TimerCancelledError(RCLError):
    """A cancelled timer was to be called."""

    __module__ = "rclpy._rclpy_pybind11"


class UnknownROSArgsError(RuntimeError):
    """An argument between ``--ros-args`` and ``--`` is unknown."""

    __module__ = "rclpy._rclpy_pybind11"


class RCLInvalidROSArgsError(RCLError):
    """An argument between ``--ros-args`` and ``--`` is malformed."""

    __module__ = "rclpy._rclpy_pybind11"
