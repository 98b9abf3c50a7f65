"""Actions that set, save and restore launch configurations, and functions as actions."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from aionode.launch.plan import Call
from launch.action import Action
from launch.actions._environment import (
    PopEnvironment,
    PushEnvironment,
    ResetEnvironment,
)
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    text_of,
)

__all__ = [
    "DeclareLaunchArgument",
    "GroupAction",
    "OpaqueCoroutine",
    "OpaqueFunction",
    "PopLaunchConfigurations",
    "PushLaunchConfigurations",
    "ResetLaunchConfigurations",
    "SetLaunchConfiguration",
    "UnsetLaunchConfiguration",
]


class DeclareLaunchArgument(Action):
    """Declares an argument of a description."""

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeSubstitutionsType | None = None,
        description: str | None = None,
        choices: Iterable[str] | None = None,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        self.name = name
        self.default_value = (
            None if default_value is None else normalize_to_list_of_substitutions(default_value)
        )
        self.description = description or ""
        self.choices = None if choices is None else list(choices)
        if self.choices is not None and isinstance(default_value, str):
            self._DeclareLaunchArgument__check(default_value)

    def _DeclareLaunchArgument__check(self, value: str) -> None:
        if self.choices is not None and value not in self.choices:
            raise ValueError(
                f"argument '{self.name}' is {value!r}; use one of {', '.join(self.choices)}"
            )

    def execute(self, context: LaunchContext) -> None:
        """Set the argument to its default, unless it has a value."""
        context.declared.add(self.name)
        if self.name not in context.launch_configurations:
            if self.default_value is None:
                described = f" ({self.description})" if self.description else ""
                raise ValueError(
                    f"argument '{self.name}'{described} is required and has no default; add "
                    f"{self.name}:=VALUE"
                )
            value = perform_substitutions(context, self.default_value)
            context.launch_configurations[self.name] = value
        self._DeclareLaunchArgument__check(context.launch_configurations[self.name])


class SetLaunchConfiguration(Action):
    """Gives a launch configuration a value."""

    def __init__(
        self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **options: Any
    ) -> None:
        super().__init__(**options)
        self.name = normalize_to_list_of_substitutions(name)
        self.value = normalize_to_list_of_substitutions(value)

    def execute(self, context: LaunchContext) -> None:
        """Set the launch configuration."""
        name = perform_substitutions(context, self.name)
        context.launch_configurations[name] = perform_substitutions(context, self.value)


class UnsetLaunchConfiguration(Action):
    """Removes a launch configuration."""

    def __init__(self, name: SomeSubstitutionsType, **options: Any) -> None:
        super().__init__(**options)
        self.name = normalize_to_list_of_substitutions(name)

    def execute(self, context: LaunchContext) -> None:
        """Remove the launch configuration."""
        context.launch_configurations.pop(perform_substitutions(context, self.name), None)


class PushLaunchConfigurations(Action):
    """Saves the launch configurations."""

    def execute(self, context: LaunchContext) -> None:
        """Save the launch configurations."""
        context.push_launch_configurations()


class PopLaunchConfigurations(Action):
    """Restores the launch configurations that were saved last."""

    def execute(self, context: LaunchContext) -> None:
        """Restore the launch configurations."""
        context.pop_launch_configurations()


class ResetLaunchConfigurations(Action):
    """Removes all launch configurations except the given ones."""

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        self._ResetLaunchConfigurations__launch_configurations = dict(launch_configurations or {})

    def execute(self, context: LaunchContext) -> None:
        """Remove the other launch configurations."""
        kept = {
            text_of(context, name): text_of(context, value)
            for name, value in self._ResetLaunchConfigurations__launch_configurations.items()
        }
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)


class GroupAction(Action):
    """A group of actions; anything they set ends with the group, unless it is not scoped."""

    def __init__(
        self,
        actions: Iterable[Any],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[Any, Any] | None = None,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        self._GroupAction__actions = list(actions)
        self._GroupAction__scoped = scoped
        self._GroupAction__forwarding = forwarding
        self._GroupAction__launch_configurations = dict(launch_configurations or {})

    def get_sub_entities(self) -> list[Any]:
        """Return the actions, enclosed by those that begin and end the scope."""
        given = self._GroupAction__launch_configurations
        sets: list[Action] = [SetLaunchConfiguration(*pair) for pair in given.items()]
        if not self._GroupAction__scoped:
            return [*sets, *self._GroupAction__actions]
        if not self._GroupAction__forwarding:
            sets = [ResetEnvironment(), ResetLaunchConfigurations(given)]
        begin = [PushLaunchConfigurations(), PushEnvironment()]
        end = [PopEnvironment(), PopLaunchConfigurations()]
        return [*begin, *sets, *self._GroupAction__actions, *end]

    def execute(self, context: LaunchContext) -> list[Any]:
        """Return the actions."""
        return self.get_sub_entities()


class OpaqueFunction(Action):
    """Calls a function with the context; it may return further actions."""

    def __init__(
        self,
        *,
        function: Callable[..., Any],
        args: Sequence[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        self._OpaqueFunction__function = function
        self._OpaqueFunction__args = list(args or ())
        self._OpaqueFunction__kwargs = dict(kwargs or {})

    def execute(self, context: LaunchContext) -> Any:
        """Call the function."""
        context.need_present(self.describe())
        return self._OpaqueFunction__function(
            context, *self._OpaqueFunction__args, **self._OpaqueFunction__kwargs
        )

    def describe(self) -> str:
        """Return the name of the function that it calls."""
        function = self._OpaqueFunction__function
        return f"OpaqueFunction({getattr(function, '__name__', function)})"


class OpaqueCoroutine(Action):
    """Runs a coroutine function with the context, beside the processes, until the launch ends."""

    def __init__(
        self,
        *,
        coroutine: Callable[..., Any],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        ignore_context: bool = False,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        if not inspect.iscoroutinefunction(coroutine):
            raise TypeError(f"OpaqueCoroutine: coroutine= is {coroutine!r}; use an async function")
        self._OpaqueCoroutine__coroutine = coroutine
        self._OpaqueCoroutine__args = list(args or ())
        self._OpaqueCoroutine__kwargs = dict(kwargs or {})
        self._OpaqueCoroutine__ignore_context = ignore_context

    def execute(self, context: LaunchContext) -> None:
        """Mark it to be run."""
        context.steps.append(Call(self, context.fork(), self._OpaqueCoroutine__call))

    async def _OpaqueCoroutine__call(self, context: LaunchContext) -> None:
        """Run the coroutine to its end."""
        first = () if self._OpaqueCoroutine__ignore_context else (context,)
        await self._OpaqueCoroutine__coroutine(
            *first, *self._OpaqueCoroutine__args, **self._OpaqueCoroutine__kwargs
        )

    def describe(self) -> str:
        """Return the name of the function that it runs."""
        coroutine = self._OpaqueCoroutine__coroutine
        return f"OpaqueCoroutine({getattr(coroutine, '__name__', coroutine)})"
