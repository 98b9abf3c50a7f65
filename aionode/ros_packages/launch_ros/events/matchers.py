"""`launch_ros.events.matchers`."""

from __future__ import annotations

from launch_ros.events.lifecycle import matches_node_name

__all__ = ["matches_node_name"]
