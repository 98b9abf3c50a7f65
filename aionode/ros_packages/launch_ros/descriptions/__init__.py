"""`launch_ros.descriptions`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from aionode._packages import here
from aionode.launch.plan import Component
from launch.condition import Condition
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from launch_ros.namespaces import namespace_in, text_or_none
from launch_ros.node_arguments import remap_pairs, values_for_node
from launch_ros.parameter_descriptions import (
    Parameter,
    ParameterFile,
    ParameterValue,
)

__all__ = ["ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]


class ComposableNode:
    """A node for a container: a C++ plugin, or a Python class as ``module:Class``."""

    def __init__(
        self,
        *,
        package: SomeSubstitutionsType,
        plugin: SomeSubstitutionsType,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[Any] | None = None,
        extra_arguments: Iterable[Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        self.package = normalize_to_list_of_substitutions(package)
        self._ComposableNode__plugin = normalize_to_list_of_substitutions(plugin)
        self._ComposableNode__name = name
        self._ComposableNode__namespace = namespace
        self.parameters = list(parameters or ())
        self.remappings = list(remappings or ())
        self.extra_arguments = list(extra_arguments or ())
        self._ComposableNode__condition = condition

    def condition(self) -> Condition | None:
        """The condition."""
        return self._ComposableNode__condition

    def _ComposableNode__component(self, context: LaunchContext) -> Component | None:
        """Return the component for the container; None if the condition does not hold."""
        if (
            self._ComposableNode__condition is not None
            and not self._ComposableNode__condition.evaluate(context)
        ):
            return None
        name = text_or_none(context, self._ComposableNode__name)
        namespace = namespace_in(context, text_or_none(context, self._ComposableNode__namespace))
        everywhere = context.launch_configurations.get("global_params", ())
        given = [{key: value} if key else value for key, value in map(as_pair, everywhere)]
        plugin = perform_substitutions(context, self._ComposableNode__plugin)
        package = perform_substitutions(context, self.package)
        standard = here().plugin(package, plugin)
        if standard is not None:
            plugin, name = standard[0], name or standard[1]
        return Component(
            plugin=plugin,
            package=package,
            name=name,
            namespace=namespace,
            parameters=values_for_node(
                context, [*given, *self.parameters], name or "", namespace or ""
            ),
            remappings=remap_pairs(context, self.remappings),
            extra_arguments=values_for_node(
                context, self.extra_arguments, name or "", namespace or ""
            ),
        )


def as_pair(known: Any) -> tuple[Any, Any]:
    """Return a parameter of all nodes by its name; a parameter file has none."""
    return known if isinstance(known, tuple) else (None, known)
