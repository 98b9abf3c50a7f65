"""Managed nodes: their states, the transitions between them, and a manager for several nodes.

::

    class Camera(LifecycleNode):
        def __init__(self) -> None:
            super().__init__("camera")
            self.images = self.create_lifecycle_publisher(Image, "image", 10)

        async def on_configure(self, state: State) -> TransitionCallbackReturn:
            self.device = await open_camera()
            return TransitionCallbackReturn.SUCCESS

`LifecycleNode` has rclpy's names and behaviour; its callbacks may be coroutines, and can be
canceled. ``aionode lifecycle`` and ``ros2 lifecycle`` manage it from a terminal, and
`LifecycleManager` from a program.
"""

from __future__ import annotations

from aionode.engine.rules.lifecycle_states import State, TransitionCallbackReturn
from aionode.engine.rules.managed_entity import ManagedEntity, SimpleManagedEntity
from aionode.errors import EntityInactiveError, TransitionError
from aionode.lifecycle._entities import LifecyclePublisher, LifecycleTimer
from aionode.lifecycle._manager import LifecycleManager
from aionode.lifecycle._node import LifecycleNode
from aionode.lifecycle._node_watch import ManagedNodeEvent
from aionode.lifecycle._runner import LifecycleEvent

__all__ = [
    "EntityInactiveError",
    "LifecycleEvent",
    "LifecycleManager",
    "LifecycleNode",
    "LifecyclePublisher",
    "LifecycleState",
    "LifecycleTimer",
    "ManagedEntity",
    "ManagedNodeEvent",
    "Node",
    "Publisher",
    "SimpleManagedEntity",
    "State",
    "TransitionCallbackReturn",
    "TransitionError",
]

Node = LifecycleNode
"""rclpy's other name for `LifecycleNode`."""

LifecycleState = State
"""rclpy's other name for `State`."""

Publisher = LifecyclePublisher
"""rclpy's other name for `LifecyclePublisher`."""
