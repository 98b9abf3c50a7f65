"""Modules that rclpy keeps for itself, and some programs use all the same."""
