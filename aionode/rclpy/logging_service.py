"""The services through which other nodes read and set log levels of this process."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from aionode.logging import get_logger_level, set_logger_level_for_others
from aionode.rclpy._impl import messages as msg

if TYPE_CHECKING:
    from aionode.rclpy._protocols import NodeLike

__all__ = ["LoggingService"]


MOST_LEVELS: Final = 1_000
"""Loggers of one request that are answered: any node may send any number."""


class LoggingService:
    """The two services of one node."""

    def __init__(self, node: NodeLike) -> None:
        name = node.get_name()
        node.create_service(
            msg.GetLoggerLevels, f"{name}/get_logger_levels", self._get_logger_levels
        )
        node.create_service(
            msg.SetLoggerLevels, f"{name}/set_logger_levels", self._set_logger_levels
        )

    def _get_logger_levels(self, request: Any, response: Any) -> Any:
        names = request.names[:MOST_LEVELS]
        response.levels = [
            msg.LoggerLevel(name=name, level=int(get_logger_level(name))) for name in names
        ]
        return response

    def _set_logger_levels(self, request: Any, response: Any) -> Any:
        response.results = [set_level(wanted) for wanted in request.levels[:MOST_LEVELS]]
        return response


def set_level(wanted: Any) -> Any:
    """Set a level, and return the result."""
    try:
        set_logger_level_for_others(wanted.name, wanted.level)
    except ValueError:
        return msg.SetLoggerLevelsResult(
            successful=False, reason="Failed reason: Invalid logger level."
        )
    return msg.SetLoggerLevelsResult(successful=True)
