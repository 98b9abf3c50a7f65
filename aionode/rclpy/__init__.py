"""rclpy's API on aionode, for programs that run on rclpy today."""

from __future__ import annotations

from aionode.rclpy._finder import install

__all__ = ["install"]
