"""Modules that rclpy keeps for itself, and some programs use all the same."""

from rclpy._reexports import add_names

add_names(__name__)
