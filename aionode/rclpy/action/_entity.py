"""The base of clients and servers of actions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, TypeVar

from aionode.rclpy._entities import in_use
from aionode.rclpy._impl.actions import ActionClientHandle, ActionHandle, ActionServerHandle
from aionode.rclpy.waitable import Waitable

if TYPE_CHECKING:
    from aionode.rclpy._impl.wait_set import WaitSet
    from aionode.rclpy.node import Node

__all__ = ["ActionEntity"]

HandleT = TypeVar("HandleT", ActionClientHandle, ActionServerHandle)


class ActionEntity(Waitable[dict[str, Any]], Generic[HandleT]):
    """A waitable of a node, whose handle stands for several services and topics."""

    _handle: HandleT
    _node: Node

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        """Add its handles."""
        self._handle.add_to_waitset(wait_set)

    def __enter__(self) -> None:
        self._handle.__enter__()

    def __exit__(self, *exc: object) -> None:
        self._handle.__exit__(*exc)

    configure_introspection = in_use(ActionHandle.configure_introspection)

    def destroy(self) -> None:
        """Destroy it; its futures are never completed."""
        self._handle.destroy_when_not_in_use()
        self._node.remove_waitable(self)
