"""Modules that rclpy marks as experimental."""

from rclpy.experimental.async_node import (
    AsyncClient,
    AsyncClock,
    AsyncNode,
    AsyncPublisher,
    AsyncService,
    AsyncSubscription,
    AsyncTimer,
)
from rclpy.experimental.events_executor import EventsExecutor

__all__ = [
    "AsyncClient",
    "AsyncClock",
    "AsyncNode",
    "AsyncPublisher",
    "AsyncService",
    "AsyncSubscription",
    "AsyncTimer",
    "EventsExecutor",
]
