"""Actions that change the environment of later actions."""

from __future__ import annotations

import os
from typing import Any

from launch.action import Action
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from launch.utilities.type_utils import perform_typed_substitution

__all__ = [
    "AppendEnvironmentVariable",
    "PopEnvironment",
    "PrependEnvironmentVariable",
    "PushEnvironment",
    "ResetEnvironment",
    "SetEnvironmentVariable",
    "UnsetEnvironmentVariable",
]


class SetEnvironmentVariable(Action):
    """Gives a variable a value."""

    def __init__(
        self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **options: Any
    ) -> None:
        super().__init__(**options)
        self.name = normalize_to_list_of_substitutions(name)
        self.value = normalize_to_list_of_substitutions(value)

    def execute(self, context: LaunchContext) -> None:
        """Set the variable."""
        value = perform_substitutions(context, self.value)
        context.environment[perform_substitutions(context, self.name)] = value


class UnsetEnvironmentVariable(Action):
    """Removes a variable."""

    def __init__(self, name: SomeSubstitutionsType, **options: Any) -> None:
        super().__init__(**options)
        self.name = normalize_to_list_of_substitutions(name)

    def execute(self, context: LaunchContext) -> None:
        """Remove the variable."""
        context.environment.pop(perform_substitutions(context, self.name), None)


class AppendEnvironmentVariable(Action):
    """Appends or prepends to a list in an environment variable."""

    _AppendEnvironmentVariable__at_front = False

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: Any = None,
        separator: SomeSubstitutionsType = os.pathsep,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        self.name = normalize_to_list_of_substitutions(name)
        self.value = normalize_to_list_of_substitutions(value)
        self.separator = normalize_to_list_of_substitutions(separator)
        self.prepend = self._AppendEnvironmentVariable__at_front if prepend is None else prepend

    def execute(self, context: LaunchContext) -> None:
        """Add to the variable."""
        name = perform_substitutions(context, self.name)
        parts = [context.environment[name]] if name in context.environment else []
        at = 0 if perform_typed_substitution(context, self.prepend, bool) else len(parts)
        parts.insert(at, perform_substitutions(context, self.value))
        context.environment[name] = perform_substitutions(context, self.separator).join(parts)


class PrependEnvironmentVariable(AppendEnvironmentVariable):
    """Prepends to a list in an environment variable."""

    _AppendEnvironmentVariable__at_front = True


class PushEnvironment(Action):
    """Saves the environment."""

    def execute(self, context: LaunchContext) -> None:
        """Save the environment."""
        context.push_environment()


class PopEnvironment(Action):
    """Restores the environment that was saved last."""

    def execute(self, context: LaunchContext) -> None:
        """Restore the environment."""
        context.pop_environment()


class ResetEnvironment(Action):
    """Restores the initial environment."""

    def execute(self, context: LaunchContext) -> None:
        """Restore the environment."""
        context.reset_environment()
