"""The base class of action clients and servers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rclpy._impl.actions import ActionClientHandle, ActionServerHandle
from rclpy.waitable import Waitable

if TYPE_CHECKING:
    from aionode.clock import Clock
    from aionode.engine.rules.service_events import ServiceIntrospectionState
    from aionode.qos import QoSProfile
    from rclpy._impl.wait_set import WaitSet
    from rclpy.node import Node

__all__ = ["ActionEntity"]

HandleT = TypeVar("HandleT", ActionClientHandle, ActionServerHandle)


class ActionEntity(Waitable[dict[str, Any]], Generic[HandleT]):
    """A waitable of a node, whose handle represents several services and topics."""

    _ActionEntity__handle: HandleT
    _node: Node

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        """Add its handles."""
        self._ActionEntity__handle.add_to_waitset(wait_set)

    def __enter__(self) -> None:
        self._ActionEntity__handle.__enter__()

    def __exit__(self, *exc: object) -> None:
        self._ActionEntity__handle.__exit__(*exc)

    def configure_introspection(
        self,
        clock: Clock,
        service_event_qos_profile: QoSProfile,
        introspection_state: ServiceIntrospectionState,
    ) -> None:
        """Publish events for calls of its three services on ``…/_service_event``."""
        with self._ActionEntity__handle as handle:
            handle.configure_introspection(clock, service_event_qos_profile, introspection_state)

    def destroy(self) -> None:
        """Destroy it; its futures are never completed."""
        self._ActionEntity__handle.destroy_when_not_in_use()
        self._node.remove_waitable(self)
