"""Logging for nodes of both APIs: log messages as a topic, and levels set by others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from aionode.errors import RequestRefusedError
from aionode.interfaces.rcl_interfaces.msg import Log, LoggerLevel, SetLoggerLevelsResult
from aionode.logging import get_logger_level, set_logger_level_for_others

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.clock import Time
    from aionode.logging import LogEvent

__all__ = ["LevelAnswers", "log_message"]

MAX_LEVELS: Final = 1_000
"""Maximum loggers in one request."""


class LevelAnswers:
    """The callbacks of the services that read and set the log levels of this process.

    Each raises `RequestRefusedError` for a request about more loggers than any tool would name.

    Args:
        level_class: The class of LoggerLevel.
        result_class: The class of SetLoggerLevelsResult.
        reason: Returns the reason why a level was not set.
    """

    def __init__(
        self,
        level_class: Any = LoggerLevel,
        result_class: Any = SetLoggerLevelsResult,
        reason: Callable[[ValueError], str] = str,
    ) -> None:
        self._level_class = level_class
        self._result_class = result_class
        self._reason = reason

    def get_levels(self, request: Any, response: Any) -> Any:
        """Answer get_logger_levels."""
        refuse_many(request.names)
        response.levels = [
            self._level_class(name=name, level=int(get_logger_level(name)))
            for name in request.names
        ]
        return response

    def set_levels(self, request: Any, response: Any) -> Any:
        """Answer set_logger_levels."""
        refuse_many(request.levels)
        response.results = [self._set_level(wanted) for wanted in request.levels]
        return response

    def _set_level(self, wanted: Any) -> Any:
        try:
            set_logger_level_for_others(wanted.name, wanted.level)
        except ValueError as error:
            return self._result_class(successful=False, reason=self._reason(error))
        return self._result_class(successful=True)


def refuse_many(loggers: Sequence[object]) -> None:
    """Reject a request about more loggers than any tool would name.

    Raises:
        RequestRefusedError: there are more than `MAX_LEVELS`.
    """
    if len(loggers) > MAX_LEVELS:
        raise RequestRefusedError(
            f"the request has {len(loggers)} loggers, but at most {MAX_LEVELS} are allowed; "
            "split it into several requests"
        )


def log_message(event: LogEvent, time: Time) -> Log:
    """Return a logged event as a message."""

    def encodable(text: str) -> str:
        return text.encode(errors="replace").decode()

    return Log(
        stamp=time.to_msg(),
        level=event.level,
        name=encodable(event.name),
        msg=encodable(event.msg),
        file=encodable(event.file),
        function=encodable(event.function),
        line=event.line,
    )
