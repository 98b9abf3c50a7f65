"""The package that launch files import as `launch`: ROS 2's names, evaluated into a plan."""

from __future__ import annotations

from aionode.launch._launch import actions as actions
from aionode.launch._launch import conditions as conditions
from aionode.launch._launch import descriptions as descriptions
from aionode.launch._launch import event_handlers as event_handlers
from aionode.launch._launch import events as events
from aionode.launch._launch import frontend as frontend
from aionode.launch._launch import launch_description_sources as launch_description_sources
from aionode.launch._launch import logging as logging
from aionode.launch._launch import substitutions as substitutions
from aionode.launch._launch import utilities as utilities
from aionode.launch._launch.action import Action
from aionode.launch._launch.condition import Condition
from aionode.launch._launch.event import Event
from aionode.launch._launch.event_handler import BaseEventHandler, EventHandler
from aionode.launch._launch.launch_context import LaunchContext
from aionode.launch._launch.launch_description import LaunchDescription
from aionode.launch._launch.launch_description_entity import LaunchDescriptionEntity
from aionode.launch._launch.launch_description_sources import LaunchDescriptionSource
from aionode.launch._launch.launch_service import LaunchService
from aionode.launch._launch.some_substitutions_type import (
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
)
from aionode.launch._launch.substitution import Substitution

__all__ = [
    "Action",
    "BaseEventHandler",
    "Condition",
    "Event",
    "EventHandler",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "LaunchService",
    "SomeSubstitutionsType",
    "SomeSubstitutionsType_types_tuple",
    "Substitution",
    "actions",
    "conditions",
    "descriptions",
    "event_handlers",
    "events",
    "frontend",
    "launch_description_sources",
    "logging",
    "substitutions",
    "utilities",
]
