"""Errors of contexts and their transports."""

from __future__ import annotations

from aionode.errors._base import AionodeError

__all__ = [
    "ConfigurationError",
    "FrameError",
    "TransportError",
]


class ConfigurationError(AionodeError, ValueError):
    """An environment variable or an argument of `Context` has an invalid value.

    Attributes:
        source: The variable or argument, such as ``ROS_DOMAIN_ID``.
        given: Its value.
        fits: Which values are valid.
    """

    def __init__(self, source: str, given: str, fits: str) -> None:
        self.source = source
        self.given = given
        self.fits = fits
        super().__init__(f"{source}: {given!r} given; {fits}")


class TransportError(AionodeError, ConnectionError):
    """A transport cannot perform an operation; the text says what to change."""


class FrameError(TransportError):
    """A malformed frame was received on, or passed to, the link between two processes.

    The link is closed, and messages go over Zenoh from then on.

    Attributes:
        problem: What was received, or should have been sent.
    """

    def __init__(self, problem: str) -> None:
        self.problem = problem
        super().__init__(f"link: {problem}; do both processes run the same release of aionode?")
