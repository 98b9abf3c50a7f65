"""The package that launch files import as `launch_ros`."""

from __future__ import annotations

from aionode.launch._launch_ros import actions as actions
from aionode.launch._launch_ros import descriptions as descriptions
from aionode.launch._launch_ros import event_handlers as event_handlers
from aionode.launch._launch_ros import events as events
from aionode.launch._launch_ros import parameter_descriptions as parameter_descriptions
from aionode.launch._launch_ros import substitutions as substitutions
from aionode.launch._launch_ros import utilities as utilities

__all__ = [
    "actions",
    "descriptions",
    "event_handlers",
    "events",
    "parameter_descriptions",
    "substitutions",
    "utilities",
]
