"""Actions that are repeated."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import yaml

from aionode._process.bounded_yaml import loaded_yaml
from launch.action import Action
from launch.event_handler import entities_of
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

__all__ = ["ForEach", "ForLoop", "PopLocals", "PushLocals"]


class ForEach(Action):
    """Calls a function for each set of values; it returns actions.

    The sets are YAML mappings separated by semicolons: ``{name: a, id: 1};{name: b}``.
    """

    SEPARATOR = ";"

    def __init__(
        self, input_values: SomeSubstitutionsType, *, function: Callable[..., Any], **options: Any
    ) -> None:
        super().__init__(**options)
        self.input_values = normalize_to_list_of_substitutions(input_values)
        self.function = function

    def execute(self, context: LaunchContext) -> list[Any]:
        """Return the actions for all sets."""
        texts = perform_substitutions(context, self.input_values).split(self.SEPARATOR)
        sets = [mapping_in(text) for text in texts if text.strip()]
        return [entity for values in sets for entity in entities_of(self.function(**values))]


def mapping_in(text: str) -> dict[str, Any]:
    """Return the values in a YAML text.

    Raises:
        TypeError: It is not a mapping.
    """
    try:
        values = loaded_yaml(text)
    except yaml.YAMLError:
        values = None
    if not isinstance(values, dict):
        raise TypeError(
            f"{text.strip()!r} is not a set of values; use a mapping such as '{{name: a, id: 1}}'"
        )
    return values


class ForLoop(Action):
    """Calls a function with ``i=0``, ``i=1`` and so on; it returns actions."""

    def __init__(
        self,
        length: SomeSubstitutionsType,
        *,
        function: Callable[..., Any],
        name: str | None = None,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        self.length = normalize_to_list_of_substitutions(length)
        self.function = function
        self.name = name

    def execute(self, context: LaunchContext) -> list[Any]:
        """Return the actions for all numbers."""
        text = perform_substitutions(context, self.length)
        try:
            length = int(text)
        except ValueError:
            raise ValueError(f"length is {text!r}; use a whole number") from None
        return [entity for i in range(length) for entity in entities_of(self.function(i=i))]


class PushLocals(Action):
    """Saves `context.locals`, and adds values."""

    def __init__(self, values: dict[str, str]) -> None:
        super().__init__()
        self.values = values

    def execute(self, context: LaunchContext) -> None:
        """Save the locals, and add the values."""
        context.push_locals()
        context.extend_locals(self.values)


class PopLocals(Action):
    """Restores the locals that were saved last."""

    def execute(self, context: LaunchContext) -> None:
        """Restore the locals."""
        context.pop_locals()
