"""How grave a message is."""

from __future__ import annotations

from enum import IntEnum

from aionode.errors import InvalidLogLevelError

__all__ = ["LoggingSeverity", "get_logging_severity_from_string"]


class LoggingSeverity(IntEnum):
    """How grave a message is; a logger lets through what is at least as grave as its level.

    The numbers are those of ROS and of the standard library's `logging`. UNSET as the level of a
    logger means that of its parent.
    """

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """Return the severity called `log_severity`, in upper or lower case.

    Raises:
        InvalidLogLevelError: There is none of this name (a ValueError and a RuntimeError).
    """
    try:
        return LoggingSeverity[log_severity.upper()]
    except KeyError:
        raise InvalidLogLevelError(log_severity, [each.name for each in LoggingSeverity]) from None
