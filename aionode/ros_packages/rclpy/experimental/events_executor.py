"""The events executor: here, every executor waits for events instead of collecting wait sets."""

from __future__ import annotations

from rclpy.executors import SingleThreadedExecutor

__all__ = ["EventsExecutor"]


class EventsExecutor(SingleThreadedExecutor):
    """Calls callbacks in the thread that spins, like `SingleThreadedExecutor`."""
