"""The severities of log messages."""

from aionode.logging import LoggingSeverity

__all__ = ["LoggingSeverity"]
