"""Errors about transforms between frames."""

from __future__ import annotations

from aionode.errors._base import AionodeError

__all__ = [
    "BackwardExtrapolationException",
    "ConnectivityException",
    "ExtrapolationException",
    "ForwardExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NoDataForExtrapolationException",
    "TimeoutException",
    "TransformException",
]


class TransformException(AionodeError, RuntimeError):
    """A transform between two frames is not available, or cannot be used."""


class ConnectivityException(TransformException):
    """The two frames are not part of one tree."""


class LookupException(TransformException, LookupError):
    """A frame does not exist, or the tree has a loop."""


class ExtrapolationException(TransformException):
    """The time lies outside of the data that the buffer holds."""


class BackwardExtrapolationException(ExtrapolationException):
    """The time is earlier than the oldest data."""


class ForwardExtrapolationException(ExtrapolationException):
    """The time is later than the newest data; waiting may help."""


class NoDataForExtrapolationException(ExtrapolationException):
    """A frame has at most one transform, and not at this time."""


class InvalidArgumentException(TransformException, ValueError):
    """The name of a frame is empty, or begins with a slash."""


class TimeoutException(TransformException, TimeoutError):
    """A transform did not become available in time; the text says why."""
