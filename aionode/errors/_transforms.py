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
    """The time is outside the range of the buffered data."""


class BackwardExtrapolationException(ExtrapolationException):
    """The time is before the oldest data."""


class ForwardExtrapolationException(ExtrapolationException):
    """The time is after the latest data; waiting may help."""


class NoDataForExtrapolationException(ExtrapolationException):
    """A frame has at most one transform, which is not at this time."""


class InvalidArgumentException(TransformException, ValueError):
    """A frame name is empty or begins with a slash."""


class TimeoutException(TransformException, TimeoutError):
    """A transform did not become available in time; the text says why."""
