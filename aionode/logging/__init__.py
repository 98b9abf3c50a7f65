"""Logging: rclpy's loggers, rcutils' console, over the standard library's `logging`."""

from aionode.logging.console import LogEvent, get_logging_directory
from aionode.logging.filters import LogOptions
from aionode.logging.loggers import (
    RcutilsLogger,
    clear_config,
    configure,
    get_logger,
    get_logger_effective_level,
    get_logger_level,
    initialize,
    set_logger_level,
    shutdown,
)
from aionode.logging.severity import LoggingSeverity, get_logging_severity_from_string

__all__ = [
    "LogEvent",
    "LogOptions",
    "LoggingSeverity",
    "RcutilsLogger",
    "clear_config",
    "configure",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "get_logging_directory",
    "get_logging_severity_from_string",
    "initialize",
    "set_logger_level",
    "shutdown",
]
