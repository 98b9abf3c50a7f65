"""Log severities."""

from __future__ import annotations

from enum import IntEnum

from aionode.errors import InvalidLogLevelError

__all__ = ["LoggingSeverity", "get_logging_severity_from_string"]


class LoggingSeverity(IntEnum):
    """The severity of a message; a logger passes messages at or above its level.

    The values are those of ROS and of the standard library's `logging`. A logger whose level is
    UNSET has the level of its parent.
    """

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """Return the severity of this name, in upper or lower case.

    Raises:
        InvalidLogLevelError: No severity has this name (a ValueError and a RuntimeError).
    """
    try:
        return LoggingSeverity[log_severity.upper()]
    except KeyError:
        raise InvalidLogLevelError(
            log_severity, [severity.name for severity in LoggingSeverity]
        ) from None
