"""Nodes that share a process."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from aionode._packages import here, remark_on
from aionode.errors import PackageNotFoundError
from aionode.launch.plan import Component, LoadNodes, Missing
from launch.action import Action
from launch.launch_context import LaunchContext
from launch.substitution import SomeSubstitutionsType
from launch_ros.actions._node import Node
from launch_ros.descriptions import ComposableNode
from launch_ros.namespaces import text_or_none

__all__ = ["ComposableNodeContainer", "LoadComposableNodes"]


class ComposableNodeContainer(Node):
    """Starts a container, and loads nodes into it.

    A container whose nodes are all aionode classes needs no process: they run as tasks.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        package: SomeSubstitutionsType = "rclcpp_components",
        executable: SomeSubstitutionsType = "component_container",
        **options: Any,
    ) -> None:
        super().__init__(
            name=name, namespace=namespace, package=package, executable=executable, **options
        )
        self._ComposableNodeContainer__composable_node_descriptions = list(
            composable_node_descriptions or ()
        )

    def execute(self, context: LaunchContext) -> Any:
        """Record the container, if it needs a process, and its nodes."""
        components = components_of(
            context, self._ComposableNodeContainer__composable_node_descriptions
        )
        if components and all(component.is_aionode for component in components):
            self._ExecuteLocal__arguments_of_ros(context)  # which determines its name
        else:
            try:
                super().execute(context)
            except PackageNotFoundError as error:
                self.__leave_out(context, components, error)
                components = [each for each in components if each.is_aionode]
                self._ExecuteLocal__arguments_of_ros(context)
        if components:
            context.steps.append(
                LoadNodes(self.node_name, components, self._LaunchDescriptionEntity__where)
            )

    def __leave_out(
        self, context: LaunchContext, components: list[Component], error: PackageNotFoundError
    ) -> None:
        """Record the nodes that need the container, which does not exist.

        Raises:
            PackageNotFoundError: Nothing may be left out. It names the package of such a node if
                that says more, and otherwise the container's.
        """
        foreign = [each for each in components if not each.is_aionode]
        known = [each.package for each in foreign if remark_on(each.package)]
        if known and not context.skips_missing:
            raise here().not_found(known[0]) from None
        if foreign and not context.skips_missing:
            plugins = ", ".join(dict.fromkeys(each.plugin for each in foreign))
            remark = f"{error.remark}; it is needed for {plugins}"
            raise PackageNotFoundError(error.name, error.places, (), remark) from None
        if not foreign:
            raise error
        for each in foreign:
            package = each.package if each.package in known else error.name
            left_out = LeftOut(each.plugin, self._LaunchDescriptionEntity__where)
            context.left_out.setdefault(Missing(package), []).append(left_out)


@dataclass(frozen=True)
class LeftOut:
    """A node that is not loaded into a container."""

    plugin: str
    _LaunchDescriptionEntity__where: str

    def describe(self) -> str:
        """Return its name for users."""
        return self.plugin


class LoadComposableNodes(Action):
    """Loads nodes into a container that is started elsewhere."""

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[ComposableNode],
        target_container: SomeSubstitutionsType | ComposableNodeContainer,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        self._LoadComposableNodes__composable_node_descriptions = list(composable_node_descriptions)
        self._LoadComposableNodes__target_container = target_container

    def execute(self, context: LaunchContext) -> None:
        """Record the nodes."""
        target = self._LoadComposableNodes__target_container
        if isinstance(target, ComposableNodeContainer):
            name: str | None = target.node_name
        else:
            name = text_or_none(context, target)
        components = components_of(context, self._LoadComposableNodes__composable_node_descriptions)
        if components:
            context.steps.append(
                LoadNodes(name or "", components, self._LaunchDescriptionEntity__where)
            )


def components_of(
    context: LaunchContext, descriptions: Iterable[ComposableNode]
) -> list[Component]:
    """Return the nodes whose conditions hold."""
    components = (description._ComposableNode__component(context) for description in descriptions)
    return [component for component in components if component is not None]
