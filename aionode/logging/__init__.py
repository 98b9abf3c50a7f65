"""Logging: rclpy's loggers and rcutils' console output, on top of the standard `logging`."""

from aionode.logging._console import LogEvent, get_logging_directory
from aionode.logging._filters import LogOptions
from aionode.logging._loggers import (
    RcutilsLogger,
    clear_config,
    configure,
    get_logger,
    get_logger_effective_level,
    get_logger_level,
    initialize,
    release_root,
    set_logger_level,
    set_logger_level_for_others,
    shutdown,
)
from aionode.logging._severity import LoggingSeverity, get_logging_severity_from_string

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
    "release_root",
    "set_logger_level",
    "set_logger_level_for_others",
    "shutdown",
]
