"""Modules that are internal to rclpy, but that some programs use anyway."""

from rclpy.impl import implementation_singleton, logging_severity, rcutils_logger

__all__ = ["implementation_singleton", "logging_severity", "rcutils_logger"]
