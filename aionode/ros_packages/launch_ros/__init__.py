"""Launch files import this as `launch_ros`."""

from __future__ import annotations

from launch_ros import actions as actions
from launch_ros import descriptions as descriptions
from launch_ros import event_handlers as event_handlers
from launch_ros import events as events
from launch_ros import parameter_descriptions as parameter_descriptions
from launch_ros import substitutions as substitutions
from launch_ros import utilities as utilities

__all__ = [
    "actions",
    "descriptions",
    "event_handlers",
    "events",
    "parameter_descriptions",
    "substitutions",
    "utilities",
]
