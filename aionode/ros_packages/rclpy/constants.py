"""Constants."""

from aionode.clock import S_TO_NS
from rclpy._reexports import add_names

__all__ = ["S_TO_NS"]

add_names(__name__)
