"""rclpy's API on aionode, for programs that run on rclpy today."""

from __future__ import annotations

from aionode.rclpy._finder import install, provide

__all__ = ["install", "provide"]
