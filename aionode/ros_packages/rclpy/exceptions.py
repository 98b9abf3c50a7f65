"""The exceptions of rclpy."""

from __future__ import annotations

from aionode.errors import (
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NameValidationException,
    ParameterAlreadyDeclaredException,
    ParameterException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from rclpy._impl.errors import InvalidHandle, TimerCancelledError

__all__ = [
    "InvalidHandle",
    "InvalidNamespaceException",
    "InvalidNodeNameException",
    "InvalidParameterException",
    "InvalidParameterTypeException",
    "InvalidParameterValueException",
    "InvalidServiceNameException",
    "InvalidTopicNameException",
    "NameValidationException",
    "NoTypeSupportImportedException",
    "NotInitializedException",
    "ParameterAlreadyDeclaredException",
    "ParameterException",
    "ParameterImmutableException",
    "ParameterNotDeclaredException",
    "ParameterUninitializedException",
    "ROSInterruptException",
    "TimeSourceChangedError",
    "TimerCancelledError",
]


class NotInitializedException(Exception):  # noqa: N818  # rclpy's name
    """The context is not initialised, or already shut down."""

    def __init__(self, message: str | None = None) -> None:
        text = "rclpy.init() has not been called."
        super().__init__(f"{text} msg:{message}" if message else text)


class NoTypeSupportImportedException(Exception):  # noqa: N818  # rclpy's name
    """A class has no type support."""

    def __init__(self) -> None:
        super().__init__("no type_support imported")


class TimeSourceChangedError(Exception):
    """The source of time changed during a sleep, as in rclpy of Lyrical."""


class ROSInterruptException(Exception):  # noqa: N818  # rclpy's name
    """The context was shut down during a sleep."""

    def __init__(self) -> None:
        super().__init__("rclpy.shutdown() has been called")
