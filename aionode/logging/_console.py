"""How a line looks, and where it goes: the console, a file, a sink.

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
from typing import NamedTuple, TextIO

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
    """A record of the standard library with what ROS adds.

    Attributes:
        ros_name: Name of the logger as ROS knows it.
        stamp_ns: When it was logged, in nanoseconds since the epoch.
    """

    ros_name: str
    stamp_ns: int


class LogEvent(NamedTuple):
    """One logged message, as a sink gets it: the fields of `rcl_interfaces/msg/Log`.

    Attributes:
        level: 10 to 50.
        name: Name of the logger.
        msg: The text.
        file: Path of the file that logged it.
        function: Function there.
        line: Line there.
        stamp_ns: When, in nanoseconds since the epoch.
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
    """Return ROS's severity for a level of the standard library, which may lie between."""
    return min(max(levelno // 10 * 10, 10), 50)


def name_of(record: logging.LogRecord) -> str:
    """Return the name as ROS knows it."""
    return record.ros_name if isinstance(record, RosRecord) else record.name


def stamp_of(record: logging.LogRecord) -> int:
    """Return when it was logged, in nanoseconds."""
    return record.stamp_ns if isinstance(record, RosRecord) else int(record.created * S_TO_NS)


def text_of(record: logging.LogRecord) -> str:
    """Return the message, with the traceback where there is one."""
    text = record.getMessage()
    if record.exc_info:
        text = f"{text}\n{logging.Formatter().formatException(record.exc_info)}"
    return text


def seconds_text(record: logging.LogRecord) -> str:
    """Return the time in seconds, ten digits or more and nine decimals."""
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
    """Makes lines after a format of rcutils: text with tokens such as ``{severity}`` in it.

    What looks like a token and is none stays as it is.
    """

    def __init__(self, text: str = DEFAULT_FORMAT) -> None:
        super().__init__()
        text = re.sub(r"\\[abnrt]", lambda found: ESCAPES[found[0]], text)
        parts = re.split(r"\{(" + "|".join(TOKENS) + r")\}", text)
        literals, tokens = parts[::2], parts[1::2]
        self._template = "%s".join(literal.replace("%", "%%") for literal in literals)
        self._values = [TOKENS[token] for token in tokens]

    def format(self, record: logging.LogRecord) -> str:
        """Return the line, without an end of line."""
        return self._template % tuple([value(record) for value in self._values])


# Where it goes


class ConsoleSettings(NamedTuple):
    """What the environment says about the console.

    Attributes:
        line_format: The format of a line.
        use_stdout: Write to stdout, not stderr.
        flush: Write each line out at once; None leaves it to the stream.
        colours: Colour lines by severity; None colours them on a terminal.
    """

    line_format: str = DEFAULT_FORMAT
    use_stdout: bool = False
    flush: bool | None = None
    colours: bool | None = None

    @classmethod
    def from_environment(cls, environ: Mapping[str, str] = os.environ) -> ConsoleSettings:
        """Return the settings that the ``RCUTILS_…`` variables ask for.

        Raises:
            ConfigurationError: One of them is neither 0 nor 1 (a ValueError).
        """
        buffered = flag("RCUTILS_LOGGING_BUFFERED_STREAM", environ)
        return cls(
            environ.get("RCUTILS_CONSOLE_OUTPUT_FORMAT") or DEFAULT_FORMAT,
            flag("RCUTILS_LOGGING_USE_STDOUT", environ) or False,
            None if buffered is None else True,  # line by line, or at once: a line at a time
            flag("RCUTILS_COLORIZED_OUTPUT", environ),
        )


def flag(variable: str, environ: Mapping[str, str]) -> bool | None:
    """Return a variable that is 0 or 1, or None if it is not set."""
    value = environ.get(variable, "")
    if value not in {"", "0", "1"}:
        raise ConfigurationError(variable, value, "it must be 0 or 1")
    return None if value == "" else value == "1"


def is_shown_elsewhere(record: logging.LogRecord) -> bool:
    """Return whether the application's own handler writes the record to the console.

    That is one of the root logger, as `logging.basicConfig` makes it, which gets the record after
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
            and any(stream is one for one in consoles)
            and record.levelno >= handler.level
        ):
            return True
    return False


class ConsoleHandler(logging.Handler):
    """Writes each record once to the stream that is sys.stderr (or sys.stdout) at that time.

    Where the application writes it there itself, with a handler of the root logger, it is left out.
    """

    def __init__(self, settings: ConsoleSettings) -> None:
        super().__init__()
        self.settings = settings
        self.setFormatter(LineFormatter(settings.line_format))

    @property
    def stream(self) -> TextIO:
        """Where lines go now."""
        return sys.stdout if self.settings.use_stdout else sys.stderr

    def emit(self, record: logging.LogRecord) -> None:
        """Write one line."""
        if record.__dict__.get("aionode_shown"):
            return  # it came by two ways: the logger's own handler and the root's
        record.aionode_shown = True
        if is_shown_elsewhere(record):
            return
        stream, settings = self.stream, self.settings
        try:
            line = self.format(record)
            colours = settings.colours
            if stream.isatty() if colours is None else colours:
                line = f"{COLOURS[severity_of(record.levelno)]}{line}{RESET}"
            stream.write(line + "\n")
            if settings.flush or not settings.use_stdout:
                stream.flush()
        except (OSError, ValueError):  # the stream is closed, or whoever read it is gone
            self.handleError(record)


class SinkHandler(logging.Handler):
    """Hands the records of one logger, and of those below it, to a function.

    A record goes to the nearest logger with a sink only: with nodes ``/a`` and ``/a/b``, whose
    loggers are ``a`` and ``a.b``, what ``a.b`` logs is not published as said by ``a`` too.
    """

    def __init__(self, name: str, sink: Callable[[LogEvent], None]) -> None:
        super().__init__()
        self._name = name
        self._sink = sink
        self._inside = threading.local()

    def emit(self, record: logging.LogRecord) -> None:
        """Hand one record on, unless it was logged by the sink itself."""
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
    """Return where log files go.

    That is ``ROS_LOG_DIR``, else ``log`` in ``ROS_HOME``, else ``~/.ros/log``.
    """
    if directory := os.environ.get("ROS_LOG_DIR"):
        return Path(directory).expanduser()
    if home := os.environ.get("ROS_HOME"):
        return Path(home).expanduser() / "log"
    return Path("~/.ros/log").expanduser()
