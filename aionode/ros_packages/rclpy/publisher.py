"""Publishers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, TypeVar

from rclpy._entities import TopicEntity, in_use
from rclpy._impl.topics import PublisherHandle
from rclpy.duration import Duration
from rclpy.type_support import MsgType

if TYPE_CHECKING:
    from rclpy.callback_groups import CallbackGroup
    from rclpy.event_handler import EventHandler, PublisherEventCallbacks
    from rclpy.qos import QoSProfile

__all__ = ["BasePublisher", "MsgType", "Publisher"]

MsgT = TypeVar("MsgT")

FOREVER = Duration(seconds=-1)


class Publisher(TopicEntity[PublisherHandle], Generic[MsgT]):
    """Sends messages to a topic. Created by `Node.create_publisher`.

    Attributes:
        msg_type: The class of its messages.
        topic: The name with which it was created.
        qos_profile: Its profile.
        event_handlers: Its event handlers.
    """

    def __init__(
        self,
        publisher_impl: PublisherHandle,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile,
        event_callbacks: PublisherEventCallbacks,
        callback_group: CallbackGroup,
    ) -> None:
        self._handle = publisher_impl
        self.msg_type = msg_type
        self.topic = topic
        self.qos_profile = qos_profile
        self.event_handlers: list[EventHandler] = event_callbacks.create_event_handlers(
            callback_group, publisher_impl, topic
        )

    @property
    def __publisher(self) -> PublisherHandle:
        """The handle, under the name that programs know."""
        return self._handle

    def publish(self, msg: MsgT | bytes) -> None:
        """Send a message, or one that is already encoded. Nobody needs to spin.

        Raises:
            TypeError: it is of another class, or a value does not fit its field.
            InvalidHandle: the publisher is destroyed.
        """
        handle = self._handle
        handle._uses.append(None)  # `with handle` inlined: three calls less for each message
        try:
            if handle._unwanted:
                handle.refuse()
            if isinstance(msg, self.msg_type):
                handle.publish(msg)
            elif isinstance(msg, bytes):
                handle.publish_raw(msg)
            else:
                raise TypeError(f"Expected {self.msg_type}, got {type(msg)}")
        finally:
            handle._uses.pop()
            if handle._unwanted:
                handle._destroy_if_unused()

    get_subscription_count = in_use(PublisherHandle.get_subscription_count)
    assert_liveliness = in_use(PublisherHandle.assert_liveliness)

    def wait_for_all_acked(self, timeout: Duration = FOREVER) -> bool:
        """Wait until everything published is passed on; return whether it was in time."""
        with self.handle:
            return self._handle.wait_for_all_acked(timeout)


BasePublisher = Publisher
"""The base of this class and the asynchronous one in rclpy of Lyrical, which are one class here."""
