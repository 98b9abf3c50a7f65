"""Subscriptions."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from enum import Enum
from typing import TYPE_CHECKING, Any, Generic, TypedDict, TypeVar

from rclpy._entities import TopicEntity, in_use
from rclpy._impl.errors import RCLError
from rclpy._impl.topics import SubscriptionHandle
from rclpy.subscription_content_filter_options import ContentFilterOptions
from rclpy.type_support import MsgType

if TYPE_CHECKING:
    from rclpy.callback_groups import CallbackGroup
    from rclpy.event_handler import EventHandler, SubscriptionEventCallbacks
    from rclpy.qos import QoSProfile

__all__ = [
    "BaseSubscription",
    "MessageInfo",
    "MsgType",
    "RCLError",
    "Subscription",
]

MsgT = TypeVar("MsgT")


class MessageInfo(TypedDict):
    """The origin of a message; times are in nanoseconds since 1970."""

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int | None
    reception_sequence_number: int | None
    publisher_gid: dict[str, Any] | None


class Subscription(TopicEntity[SubscriptionHandle], Generic[MsgT]):
    """Receives the messages of a topic. Created by `Node.create_subscription`.

    Attributes:
        msg_type: The class of its messages.
        topic: The name with which it was created.
        callback_group: Its group.
        qos_profile: Its profile.
        raw: Whether the callback gets bytes.
    """

    class CallbackType(Enum):
        """The arguments that the callback takes."""

        MessageOnly = 0
        WithMessageInfo = 1

    def __init__(
        self,
        subscription_impl: SubscriptionHandle,
        msg_type: type[MsgT],
        topic: str,
        callback: Callable[..., object],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        raw: bool,
        event_callbacks: SubscriptionEventCallbacks,
    ) -> None:
        self._handle = subscription_impl
        self.msg_type = msg_type
        self.topic = topic
        self.callback = callback
        self.callback_group = callback_group
        self._executor_event = False
        self.qos_profile = qos_profile
        self.raw = raw
        self.event_handlers: list[EventHandler] = event_callbacks.create_event_handlers(
            callback_group, subscription_impl, topic
        )

    @property
    def __subscription(self) -> SubscriptionHandle:
        """The handle, under the name that programs know."""
        return self._handle

    @property
    def callback(self) -> Callable[..., object]:
        """The function called with each message, or with a message and its `MessageInfo`.

        Raises:
            RuntimeError: set to a function that takes other arguments.
        """
        return self._callback

    @callback.setter
    def callback(self, value: Callable[..., object]) -> None:
        signature = inspect.signature(value)
        for count, kind in enumerate(Subscription.CallbackType, start=1):
            try:
                signature.bind(*[object()] * count)
            except TypeError:
                continue
            self._callback = value
            self._callback_type = kind
            return
        raise RuntimeError(
            "Subscription.__init__(): callback should be either be callable with one argument"
            "(to get only the message) or two (to get message and message info)"
        )

    get_publisher_count = in_use(SubscriptionHandle.get_publisher_count)
    set_content_filter = in_use(SubscriptionHandle.set_content_filter)

    @property
    def is_cft_enabled(self) -> bool:
        """Whether a content filter is set."""
        with self.handle:
            return self._handle.is_cft_enabled()

    @property
    def is_cft_supported(self) -> bool:
        """Whether content filters are supported: they are."""
        return True

    def get_content_filter(self) -> ContentFilterOptions:
        """Return the content filter.

        Raises:
            RCLError: none is set.
        """
        with self.handle:
            return ContentFilterOptions(*self._handle.get_content_filter())


BaseSubscription = Subscription
"""The base of this class and the asynchronous one in rclpy of Lyrical, which are one class here."""
