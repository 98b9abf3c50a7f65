"""Loggers with ROS names, on top of the standard library's `logging`.

The ROS logger ``ns.talker`` is the logger ``ros.ns.talker`` of `logging`, so handlers, filters,
pytest's caplog and other tools work with it. Loggers of aionode itself (``aionode.…``) have the
same name in both. Nothing is installed until the first message or setting; then ``ros`` and
``aionode`` get a handler that writes to the console like rcutils.
"""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Callable, Mapping
from types import FrameType
from typing import Unpack

from aionode.clock import S_TO_NS, MachineTime
from aionode.errors import brief
from aionode.logging._console import (
    ConsoleHandler,
    ConsoleSettings,
    LineFormatter,
    LogEvent,
    RosRecord,
    SinkHandler,
    get_logging_directory,
)
from aionode.logging._filters import CallSites, LogOptions
from aionode.logging._severity import LoggingSeverity

__all__ = [
    "RcutilsLogger",
    "clear_config",
    "configure",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "initialize",
    "set_logger_level",
    "shutdown",
]

DEFAULT_LEVEL = LoggingSeverity.INFO
ROOT, OWN = "ros", "aionode"
EVERYTHING = 1  # not 0, which means the level of the root logger in `logging`

MAX_LOGGERS = 1_000
"""From this number of loggers in the process on, other nodes cannot create more."""

MAX_NAME = 256
"""Maximum length of a logger name requested by another node, as each part of it creates a logger as
well.
"""

machine = MachineTime()
caller = sys._getframe  # with inspect it would take longer than the rest of a log call


class RcutilsLogger:
    """A logger with a ROS name. Created by `get_logger` and `Node.get_logger`.

    Every logging method takes the keyword arguments of `LogOptions` and returns whether the message
    was logged.
    """

    def __init__(self, name: str = "", *, now_ns: Callable[[], int] = machine.system_ns) -> None:
        self.name = name
        self._now_ns = now_ns
        self._logger = standard_logger(name)
        self._sites = CallSites()

    def __repr__(self) -> str:
        return f"<RcutilsLogger {self.name} {self.get_effective_level().name}>"

    def get_child(self, name: str) -> RcutilsLogger:
        """Return the logger ``<this name>.<name>``, which inherits this one's level.

        Raises:
            ValueError: `name` is empty.
        """
        if not name:
            message = "Child logger name must not be empty."
            raise ValueError(message)
        return RcutilsLogger(f"{self.name}.{name}" if self.name else name, now_ns=self._now_ns)

    def set_level(self, level: int | LoggingSeverity) -> None:
        """Log messages of at least this severity; UNSET inherits the level of the parent."""
        set_logger_level(self.name, level)

    def get_effective_level(self) -> LoggingSeverity:
        """Return the level of this logger or, if unset, of its nearest ancestor with one."""
        return get_logger_effective_level(self.name)

    def is_enabled_for(self, severity: int | LoggingSeverity) -> bool:
        """Return whether a message of this severity would be logged."""
        initialize()
        return self._logger.isEnabledFor(LoggingSeverity(severity))

    def add_sink(self, sink: Callable[[LogEvent], None]) -> Callable[[], None]:
        """Call `sink` with each message of this logger and its children.

        It is called at once, in the thread that logs; messages logged by the sink itself are not
        passed to it.

        Returns:
            A function that removes the sink.
        """
        initialize()
        handler = SinkHandler(self.name, sink)
        self._logger.addHandler(handler)
        return lambda: self._logger.removeHandler(handler)

    # Each method gets its caller's frame itself, at a fixed stack depth.

    def log(
        self,
        message: str,
        severity: int | LoggingSeverity,
        **options: Unpack[LogOptions],
    ) -> bool:
        """Log `message` with the given severity.

        Raises:
            ValueError: Severity, name or options differ from the first call of this call site.
            TypeError: An option is unknown.
        """
        severity = LoggingSeverity(severity)
        return self._log(message, severity, caller(1), options)

    def debug(self, message: str, **options: Unpack[LogOptions]) -> bool:
        """Log `message` with severity DEBUG."""
        return self._log(message, 10, caller(1), options)

    def info(self, message: str, **options: Unpack[LogOptions]) -> bool:
        """Log `message` with severity INFO."""
        return self._log(message, 20, caller(1), options)

    def warning(self, message: str, **options: Unpack[LogOptions]) -> bool:
        """Log `message` with severity WARN."""
        return self._log(message, 30, caller(1), options)

    def warn(self, message: str, **options: Unpack[LogOptions]) -> bool:
        """Log `message` with severity WARN, like `warning`."""
        return self._log(message, 30, caller(1), options)

    def error(self, message: str, **options: Unpack[LogOptions]) -> bool:
        """Log `message` with severity ERROR."""
        return self._log(message, 40, caller(1), options)

    def fatal(self, message: str, **options: Unpack[LogOptions]) -> bool:
        """Log `message` with severity FATAL."""
        return self._log(message, 50, caller(1), options)

    def _log(self, message: str, severity: int, frame: FrameType, options: LogOptions) -> bool:
        initialize()
        if not self._logger.isEnabledFor(severity):
            return False
        name = options.pop("name", None) or self.name
        site = self._sites.find(frame, severity, name, options)
        if not site.lets_through(self._now_ns):
            return False
        logger = self._logger if name == self.name else standard_logger(name)
        code = frame.f_code
        record = RosRecord(
            logger.name, severity, code.co_filename, frame.f_lineno, message, (), None, code.co_name
        )
        record.ros_name = name
        record.stamp_ns = stamp_ns = self._now_ns()
        record.created = stamp_ns / S_TO_NS
        logger.handle(record)
        return True


def standard_logger(name: str) -> logging.Logger:
    """Return the standard library's logger for a ROS name."""
    return logging.getLogger(standard_name(name))


def standard_name(name: str) -> str:
    """Return the name of the standard library's logger for a ROS name."""
    if name == OWN or name.startswith(f"{OWN}."):
        return name
    return f"{ROOT}.{name}" if name else ROOT


def known_logger(name: str) -> logging.Logger | None:
    """Return the standard library's logger for a ROS name, if it exists."""
    existing = logging.Logger.manager.loggerDict.get(standard_name(name))
    return existing if isinstance(existing, logging.Logger) else None


def get_logger(name: str, *, now_ns: Callable[[], int] = machine.system_ns) -> RcutilsLogger:
    """Return a logger.

    Args:
        name: Its name; ``a.b`` is a child of ``a``.
        now_ns: The source of its time stamps.

    Raises:
        ValueError: `name` is empty.
    """
    if not name:
        message = "Logger name must not be empty."
        raise ValueError(message)
    return RcutilsLogger(name, now_ns=now_ns)


# Levels


def set_logger_level(name: str, level: int | LoggingSeverity, detailed_error: bool = False) -> None:
    """Set the level of a logger, which need not exist yet; the empty name means the root.

    Raises:
        ValueError: `level` is not one of `LoggingSeverity`.
    """
    del detailed_error  # rclpy's argument; errors are always detailed here
    initialize()
    level = LoggingSeverity(level)
    if name:
        standard_logger(name).setLevel(level)
        return
    for root in (ROOT, OWN):
        logging.getLogger(root).setLevel(level or EVERYTHING)


def set_logger_level_for_others(name: str, level: int) -> None:
    """Set the level of a logger, like `set_logger_level`, on behalf of another node.

    Loggers are never removed, so other nodes can create only a limited number.

    Raises:
        ValueError: `level` is not one of `LoggingSeverity`, or the logger does not exist and its
            name is too long or there are too many already.
    """
    is_full = len(logging.Logger.manager.loggerDict) >= MAX_LOGGERS
    if name and known_logger(name) is None and (is_full or len(name) > MAX_NAME):
        raise ValueError(
            f"there is no logger {brief(name)}; other nodes can create one with a name of "
            f"{MAX_NAME} characters at most, and while there are fewer than {MAX_LOGGERS}"
        )
    set_logger_level(name, level)


def get_logger_level(name: str) -> LoggingSeverity:
    """Return the level set for this logger; UNSET if none was set."""
    initialize()
    known = known_logger(name)  # a logger that is created is never removed
    return LoggingSeverity.UNSET if known is None else nearest_severity(known.level)


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """Return the level that applies to this logger: its own or an inherited one."""
    initialize()
    return nearest_severity(standard_logger(name).getEffectiveLevel())


def nearest_severity(level: int) -> LoggingSeverity:
    """Convert a level of `logging`, which may be any number, to a severity."""
    return LoggingSeverity(min(max(level, 0) // 10 * 10, 50))


# Configuration


class SetUp:
    """The handlers installed in the standard library's logging, to be removed at the end."""

    def __init__(self) -> None:
        self.ready = False
        self._installed: list[tuple[logging.Logger, logging.Handler]] = []
        self._root_levels: tuple[int, int] | None = None  # before, and as set

    def install(self, handler: logging.Handler, *names: str) -> None:
        """Add a handler to these loggers."""
        for name in names:
            logger = logging.getLogger(name)
            logger.addHandler(handler)
            self._installed.append((logger, handler))

    def take_root(self, level: int) -> None:
        """Set the level of the root logger, like basicConfig, for all other loggers."""
        root = logging.getLogger()
        self._root_levels = root.level, level
        root.setLevel(level)

    def release_root(self) -> None:
        """Undo what was set for all other loggers, unless the program has changed it."""
        root = logging.getLogger()
        for logger, handler in self._installed:
            if logger is root:
                root.removeHandler(handler)
        if self._root_levels is not None:
            before, level = self._root_levels
            self._root_levels = None
            if root.level == level:
                root.setLevel(before)

    def remove(self) -> None:
        """Remove all handlers and settings."""
        self.release_root()
        for logger, handler in self._installed:
            logger.removeHandler(handler)
            handler.close()
        self._installed.clear()
        self.ready = False


set_up = SetUp()


def initialize() -> None:
    """Configure logging from the environment, once; every use of a logger does this.

    Raises:
        ConfigurationError: An environment variable is invalid (a ValueError).
    """
    if not set_up.ready:
        configure()


def configure(
    *,
    level: int | LoggingSeverity | None = None,
    levels: Mapping[str, int] | None = None,
    console: bool = True,
    file_name: str | None = None,
    whole_process: bool = False,
) -> None:
    """Configure logging, replacing the previous configuration.

    Args:
        level: Level of all loggers that have none of their own; INFO by default.
        levels: Levels of individual loggers.
        console: Whether to log to the console.
        file_name: Also log to the file ``<file_name>_<pid>_<milliseconds>.log`` in
            `get_logging_directory`; by default to no file.
        whole_process: Also show the messages of all other loggers of the standard library, in the
            same format, unless the application has configured `logging` itself. `aionode.run`
            uses this.

    Raises:
        ConfigurationError: An environment variable is invalid (a ValueError).
        OSError: The file cannot be created.
    """
    settings = ConsoleSettings.from_environment()
    set_up.remove()
    set_up.ready = True
    set_logger_level("", DEFAULT_LEVEL if level is None else level)
    for name, logger_level in (levels or {}).items():
        set_logger_level(name, logger_level)
    root_is_free = whole_process and not logging.getLogger().handlers
    if console:
        set_up.install(ConsoleHandler(settings), ROOT, OWN, *([""] if root_is_free else []))
    else:
        set_up.install(logging.NullHandler(), ROOT, OWN)  # or `logging` would write to stderr
    if root_is_free:
        set_up.take_root(logging.getLogger(ROOT).level)
    if file_name is not None:
        set_up.install(log_file(file_name, settings.line_format), ROOT, OWN)


def log_file(prefix: str, line_format: str) -> logging.Handler:
    """Create a handler that writes to a new file in the logging directory."""
    directory = get_logging_directory()
    directory.mkdir(parents=True, exist_ok=True)
    stamp_ms = machine.system_ns() // 1_000_000
    handler = logging.FileHandler(
        directory / f"{prefix}_{os.getpid()}_{stamp_ms}.log", encoding="utf-8"
    )
    handler.setFormatter(LineFormatter(line_format))
    return handler


def release_root() -> None:
    """Undo what `configure` set for all loggers of the process (``whole_process=True``).

    aionode's own loggers stay configured. `aionode.run` calls this when it returns.
    """
    set_up.release_root()


def shutdown() -> None:
    """Remove everything from the standard library's logging; the next use configures it again."""
    set_up.remove()


def clear_config() -> None:
    """Reset all levels, and configure logging from the environment again."""
    for name, logger in list(logging.root.manager.loggerDict.items()):
        ours = name.partition(".")[0] in {ROOT, OWN}
        if ours and isinstance(logger, logging.Logger):
            logger.setLevel(logging.NOTSET)
    configure()
