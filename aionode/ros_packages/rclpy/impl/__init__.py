"""Modules that are internal to rclpy, but that some programs use anyway."""

from rclpy._reexports import add_names

add_names(__name__)
