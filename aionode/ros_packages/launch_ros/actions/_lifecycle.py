"""Managed nodes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch.action import Action
from launch.actions import EmitEvent
from launch.launch_context import LaunchContext
from launch.substitution import SomeSubstitutionsType
from launch.utilities.type_utils import perform_typed_substitution
from launch_ros.actions._node import Node
from launch_ros.events.lifecycle import ChangeState, matches_node_name
from launch_ros.namespaces import text_or_none

__all__ = ["LifecycleNode", "LifecycleTransition"]


class LifecycleNode(Node):
    """Starts a managed node."""

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        autostart: Any = False,
        **options: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **options)
        self._LifecycleNode__autostart = autostart

    def _ExecuteLocal__autostarts(self, context: LaunchContext) -> bool:
        """Return whether the node is configured and activated automatically."""
        return bool(perform_typed_substitution(context, self._LifecycleNode__autostart, bool))


class LifecycleTransition(Action):
    """Triggers transitions of managed nodes."""

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[SomeSubstitutionsType],
        transition_ids: Iterable[int],
        **options: Any,
    ) -> None:
        super().__init__(**options)
        self._LifecycleTransition__lifecycle_node_names = list(lifecycle_node_names)
        self._LifecycleTransition__transition_ids = list(transition_ids)

    def execute(self, context: LaunchContext) -> list[Action]:
        """Return the requests."""
        names = [
            text_or_none(context, name) or ""
            for name in self._LifecycleTransition__lifecycle_node_names
        ]
        return [
            EmitEvent(
                event=ChangeState(
                    lifecycle_node_matcher=matches_node_name(name), transition_id=transition
                )
            )
            for name in names
            for transition in self._LifecycleTransition__transition_ids
        ]
