"""Programs import this as `py_trees_ros`: trees of PyPI's `py_trees` on rclpy nodes."""

from __future__ import annotations

from py_trees_ros import (
    action_clients,
    actions,
    battery,
    blackboard,
    conversions,
    exceptions,
    mock,
    programs,
    publishers,
    service_clients,
    subscribers,
    transforms,
    trees,
    utilities,
    visitors,
)
from py_trees_ros.version import __version__

__all__ = [
    "__version__",
    "action_clients",
    "actions",
    "battery",
    "blackboard",
    "conversions",
    "exceptions",
    "mock",
    "programs",
    "publishers",
    "service_clients",
    "subscribers",
    "transforms",
    "trees",
    "utilities",
    "visitors",
]
