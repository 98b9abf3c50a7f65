"""The format of log lines, and the handlers for the console and for sinks.

The format, the colours and the environment variables are those of rcutils.
"""

from __future__ import annotations

import logging
import os
import re
import sys
import threading
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import TextIO

from msgspec import Struct

from aionode.clock import S_TO_NS
from aionode.errors import ConfigurationError

__all__ = [
    "ConsoleHandler",
    "ConsoleSettings",
    "LineFormatter",
    "LogEvent",
    "RosRecord",
    "SinkHandler",
    "get_logging_directory",
]

DEFAULT_FORMAT = "[{severity}] [{time}] [{name}]: {message}"
RESET = "\033[0m"
COLOURS = {10: "\033[32m", 20: RESET, 30: "\033[33m", 40: "\033[31m", 50: "\033[31m"}
SEVERITIES = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL"}
ESCAPES = {"\\a": "\a", "\\b": "\b", "\\n": "\n", "\\r": "\r", "\\t": "\t"}


class RosRecord(logging.LogRecord):
    """A record of the standard library, extended for ROS.

    Attributes:
        ros_name: Name of the logger in ROS.
        stamp_ns: When it was logged, in nanoseconds since the epoch.
    """

    ros_name: str
    stamp_ns: int


class LogEvent(Struct, frozen=True):
    """One logged message, as passed to a sink: the fields of `rcl_interfaces/msg/Log`.

    Attributes:
        level: 10 to 50.
        name: Name of the logger.
        msg: The text.
        file: Path of the file that logged it.
        function: The function that logged it.
        line: The line that logged it.
        stamp_ns: When it was logged, in nanoseconds since the epoch.
    """

    level: int
    name: str
    msg: str
    file: str
    function: str
    line: int
    stamp_ns: int


# The line


def severity_of(levelno: int) -> int:
    """Return the ROS severity for a level of the standard library, rounded down."""
    return min(max(levelno // 10 * 10, 10), 50)


def name_of(record: logging.LogRecord) -> str:
    """Return the name of the logger in ROS."""
    return record.ros_name if isinstance(record, RosRecord) else record.name


def stamp_of(record: logging.LogRecord) -> int:
    """Return the time of logging in nanoseconds."""
    return record.stamp_ns if isinstance(record, RosRecord) else int(record.created * S_TO_NS)


def text_of(record: logging.LogRecord) -> str:
    """Return the message, with the traceback if there is one."""
    text = record.getMessage()
    if record.exc_info:
        text = f"{text}\n{logging.Formatter().formatException(record.exc_info)}"
    return text


def seconds_text(record: logging.LogRecord) -> str:
    """Return the time in seconds, with at least ten digits and nine decimals."""
    seconds, rest = divmod(stamp_of(record), S_TO_NS)
    return f"{seconds:010d}.{rest:09d}"


def date_text(record: logging.LogRecord) -> str:
    """Return date and local time, with milliseconds."""
    seconds, rest = divmod(stamp_of(record), S_TO_NS)
    local = datetime.fromtimestamp(seconds, tz=UTC).astimezone()
    return f"{local:%Y-%m-%d %H:%M:%S}.{rest // 1_000_000:03d}"


TOKENS: dict[str, Callable[[logging.LogRecord], object]] = {
    "severity": lambda record: SEVERITIES[severity_of(record.levelno)],
    "name": name_of,
    "message": text_of,
    "function_name": lambda record: record.funcName,
    "file_name": lambda record: record.pathname,
    "line_number": lambda record: record.lineno,
    "time": seconds_text,
    "time_as_nanoseconds": lambda record: f"{stamp_of(record):019d}",
    "date_time_with_ms": date_text,
}


class LineFormatter(logging.Formatter):
    """Formats lines like rcutils: the format contains tokens such as ``{severity}``.

    Unknown tokens are left unchanged.
    """

    def __init__(self, text: str = DEFAULT_FORMAT) -> None:
        super().__init__()
        for escape, character in ESCAPES.items():
            text = text.replace(escape, character)
        self._values: list[Callable[[logging.LogRecord], object]] = []
        self._template = re.sub(r"\{(\w+)\}", self._place_of, text.replace("%", "%%"))

    def _place_of(self, token: re.Match[str]) -> str:
        """Return the place of a token's value in the template."""
        value = TOKENS.get(token[1])
        if value is None:
            return token[0]
        self._values.append(value)
        return "%s"

    def format(self, record: logging.LogRecord) -> str:
        """Return the line, without a newline."""
        return self._template % tuple([value(record) for value in self._values])


# Handlers


class ConsoleSettings(Struct, frozen=True):
    """The settings of the console, from the environment.

    Attributes:
        line_format: The format of a line.
        use_stdout: Write to stdout, not stderr.
        flush: Flush each line; None leaves it to the stream.
        colours: Colour lines by severity; None colours them on a terminal.
    """

    line_format: str = DEFAULT_FORMAT
    use_stdout: bool = False
    flush: bool | None = None
    colours: bool | None = None

    @classmethod
    def from_environment(cls, environ: Mapping[str, str] = os.environ) -> ConsoleSettings:
        """Return the settings in the ``RCUTILS_…`` variables.

        Raises:
            ConfigurationError: One of them is neither 0 nor 1 (a ValueError).
        """
        buffered = flag("RCUTILS_LOGGING_BUFFERED_STREAM", environ)
        return cls(
            environ.get("RCUTILS_CONSOLE_OUTPUT_FORMAT") or DEFAULT_FORMAT,
            flag("RCUTILS_LOGGING_USE_STDOUT", environ) or False,
            None if buffered is None else True,  # either way, lines are written one by one
            flag("RCUTILS_COLORIZED_OUTPUT", environ),
        )


def flag(variable: str, environ: Mapping[str, str]) -> bool | None:
    """Return the value of a variable that must be 0 or 1; None if it is not set."""
    value = environ.get(variable, "")
    if value not in {"", "0", "1"}:
        raise ConfigurationError(variable, value, "it must be 0 or 1")
    return None if value == "" else value == "1"


def is_shown_elsewhere(record: logging.LogRecord) -> bool:
    """Return whether one of the application's handlers writes the record to the console.

    Such a handler is on the root logger, as after `logging.basicConfig`, and gets the record after
    this package's handlers.
    """
    root = logging.getLogger()
    top = logging.getLogger(record.name.partition(".")[0])
    if not record.name or not top.propagate:
        return False
    consoles = (sys.stdout, sys.stderr, sys.__stdout__, sys.__stderr__)
    for handler in root.handlers:
        console = getattr(handler, "console", None)  # of rich
        stream = getattr(handler, "stream", getattr(console, "file", None))
        if (
            not isinstance(handler, ConsoleHandler)
            and stream is not None
            and any(stream is own_console for own_console in consoles)
            and record.levelno >= handler.level
        ):
            return True
    return False


class ConsoleHandler(logging.Handler):
    """Writes each record once, to the current sys.stderr (or sys.stdout).

    Records that one of the application's handlers writes to the console are skipped.
    """

    def __init__(self, settings: ConsoleSettings) -> None:
        super().__init__()
        self.settings = settings
        self.setFormatter(LineFormatter(settings.line_format))

    @property
    def stream(self) -> TextIO | None:
        """The current output stream; None if its descriptor was closed when Python started."""
        return sys.stdout if self.settings.use_stdout else sys.stderr

    def emit(self, record: logging.LogRecord) -> None:
        """Write one line."""
        if record.__dict__.get("aionode_shown"):
            return  # already handled, as both the logger and the root logger have this handler
        record.aionode_shown = True
        stream, settings = self.stream, self.settings
        if stream is None or is_shown_elsewhere(record):
            return
        try:
            line = self.format(record)
            colours = settings.colours
            if stream.isatty() if colours is None else colours:
                line = f"{COLOURS[severity_of(record.levelno)]}{line}{RESET}"
            stream.write(line + "\n")
            if settings.flush or not settings.use_stdout:
                stream.flush()
        except (OSError, ValueError):  # the stream is closed, or its reader is gone
            self.handleError(record)


class SinkHandler(logging.Handler):
    """Passes the records of one logger and its children to a function.

    A record is passed only to the sink of the nearest logger: with nodes ``/a`` and ``/a/b``, whose
    loggers are ``a`` and ``a.b``, a record of ``a.b`` is not also published by node ``/a``.
    """

    def __init__(self, name: str, sink: Callable[[LogEvent], None]) -> None:
        super().__init__()
        self._name = name
        self._sink = sink
        self._inside = threading.local()

    def emit(self, record: logging.LogRecord) -> None:
        """Pass on one record, unless the sink itself logged it."""
        taken = record.__dict__.setdefault("aionode_taken", self._name)
        if taken != self._name or getattr(self._inside, "yes", False):
            return
        self._inside.yes = True
        try:
            self._sink(
                LogEvent(
                    severity_of(record.levelno),
                    name_of(record),
                    text_of(record),
                    record.pathname,
                    record.funcName or "",
                    record.lineno,
                    stamp_of(record),
                )
            )
        finally:
            self._inside.yes = False


def get_logging_directory() -> Path:
    """Return the directory of log files.

    It is ``ROS_LOG_DIR``, else ``log`` in ``ROS_HOME``, else ``~/.ros/log``.
    """
    if directory := os.environ.get("ROS_LOG_DIR"):
        return Path(directory).expanduser()
    if home := os.environ.get("ROS_HOME"):
        return Path(home).expanduser() / "log"
    return Path("~/.ros/log").expanduser()
