"""Publishers of managed nodes."""

from __future__ import annotations

from typing import Any, TypeVar

from rclpy.lifecycle.managed_entity import SimpleManagedEntity
from rclpy.publisher import Publisher

__all__ = ["LifecyclePublisher"]

MsgT = TypeVar("MsgT")


class LifecyclePublisher(SimpleManagedEntity, Publisher[MsgT]):
    """A publisher that drops messages published while its node is not active."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *args, **kwargs)

    @SimpleManagedEntity.when_enabled
    def publish(self, msg: MsgT | bytes) -> None:
        """Publish a message, if the node is active."""
        Publisher.publish(self, msg)
