"""Nodes in the event loop that awaits them."""

from rclpy.experimental.async_node import (
    AsyncClient,
    AsyncClock,
    AsyncNode,
    AsyncPublisher,
    AsyncService,
    AsyncSubscription,
    AsyncTimer,
)

__all__ = [
    "AsyncClient",
    "AsyncClock",
    "AsyncNode",
    "AsyncPublisher",
    "AsyncService",
    "AsyncSubscription",
    "AsyncTimer",
]
