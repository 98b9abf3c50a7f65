"""Points in time."""

from aionode.clock import Time
from aionode.rclpy.constants import S_TO_NS
from aionode.rclpy.duration import Duration

__all__ = ["S_TO_NS", "Duration", "Time"]
