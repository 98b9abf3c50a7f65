"""`launch.launch_introspector`: launch descriptions as trees of text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch.actions import EmitEvent, LogInfo, RegisterEventHandler
from launch.event_handler import BaseEventHandler
from launch.launch_description import LaunchDescription
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.substitution import SomeSubstitutionsType, normalize_to_list_of_substitutions

__all__ = [
    "LaunchIntrospector",
    "format_action",
    "format_entities",
    "format_event_handler",
    "format_substitutions",
    "indent",
]


def indent(lines: Iterable[str], indention: str = "    ") -> list[str]:
    """Return lines with a prefix before each."""
    return [f"{indention}{line}" for line in lines]


def format_substitutions(substitutions: SomeSubstitutionsType) -> str:
    """Return substitutions as one text."""
    return " + ".join(sub.describe() for sub in normalize_to_list_of_substitutions(substitutions))


def format_entities(entities: Iterable[LaunchDescriptionEntity]) -> list[str]:
    """Return the lines of entities."""
    return [line for entity in entities for line in format_action(entity)]


def format_event_handler(event_handler: BaseEventHandler) -> list[str]:
    """Return the lines of an event handler, and of its actions as far as they are known."""
    known = event_handler._BaseEventHandler__known_entities() or []
    head = f"{type(event_handler).__name__}({event_handler.describe()})"
    return [head, *indent(format_entities(known))]


def format_action(action: Any) -> list[str]:
    """Return the lines of an action."""
    if isinstance(action, LogInfo):
        return [f"LogInfo({format_substitutions(action.msg)})"]
    if isinstance(action, EmitEvent):
        return [f"EmitEvent(event={action.event.name!r})"]
    if isinstance(action, RegisterEventHandler):
        inner = format_event_handler(action.event_handler)
        return ["RegisterEventHandler:", *indent(inner)]
    return [action.describe()]


class LaunchIntrospector:
    """Shows launch descriptions."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """Return a description as a tree."""
        lines = format_entities(launch_description.entities)
        return "\n".join([launch_description.describe(), *map(branch, lines)])


def branch(line: str) -> str:
    """Return a line as a branch of a tree."""
    text = line.lstrip(" ")
    depth = (len(line) - len(text)) // 4
    return f"{'│   ' * depth}├── {text}"
