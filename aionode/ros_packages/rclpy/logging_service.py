"""The services by which other nodes read and set log levels of this process."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.engine.log_levels import LevelAnswers
from rclpy.parameter_service import unless_refused
from rosidl_generator_py import message_class, service_class

if TYPE_CHECKING:
    from rclpy._protocols import NodeLike

__all__ = ["LoggingService"]


class LoggingService:
    """The two services of one node."""

    def __init__(self, node: NodeLike) -> None:
        name = node.get_name()
        answers = LevelAnswers(
            message_class("rcl_interfaces/msg/LoggerLevel"),
            message_class("rcl_interfaces/msg/SetLoggerLevelsResult"),
            lambda _: "Failed reason: Invalid logger level.",
        )
        for type_name, service_name, callback in (
            ("GetLoggerLevels", "get_logger_levels", answers.get_levels),
            ("SetLoggerLevels", "set_logger_levels", answers.set_levels),
        ):
            node.create_service(
                service_class(f"rcl_interfaces/srv/{type_name}"),
                f"{name}/{service_name}",
                unless_refused(callback, node.get_logger(), service_name),
            )
