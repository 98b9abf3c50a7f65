"""Modules that rclpy calls experimental."""

from aionode.rclpy.experimental.events_executor import EventsExecutor

__all__ = ["EventsExecutor"]
