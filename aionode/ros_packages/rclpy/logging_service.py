"""The services by which other nodes read and set log levels of this process."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.engine.log_levels import LevelAnswers
from rclpy._impl import messages as msg
from rclpy.parameter_service import unless_refused

if TYPE_CHECKING:
    from rclpy._protocols import NodeLike

__all__ = ["LoggingService"]


class LoggingService:
    """The two services of one node."""

    def __init__(self, node: NodeLike) -> None:
        name = node.get_name()
        answers = LevelAnswers(
            msg.LoggerLevel,
            msg.SetLoggerLevelsResult,
            lambda _: "Failed reason: Invalid logger level.",
        )
        for srv_type, service_name, callback in (
            (msg.GetLoggerLevels, "get_logger_levels", answers.get_levels),
            (msg.SetLoggerLevels, "set_logger_levels", answers.set_levels),
        ):
            node.create_service(
                srv_type,
                f"{name}/{service_name}",
                unless_refused(callback, node.get_logger(), service_name),
            )
