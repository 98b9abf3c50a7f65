"""Subscriptions of /tf and /tf_static that feed a buffer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.endpoints.core.endpoint import watch_opposite
from aionode.graph import EndpointKind
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.qos import DurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from aionode.endpoints.subscription import MessageInfo, Subscription
    from aionode.graph import EndpointInfo
    from aionode.node import Node
    from aionode.tf.buffer_core import BufferCore

__all__ = ["STATIC_TOPIC", "TOPIC", "TransformListener"]

TOPIC = "/tf"
STATIC_TOPIC = "/tf_static"

DEPTH = 100
"""Maximum queued messages of each topic, as in tf2."""

MAX_SENDERS = 1_000
"""Maximum number of publishers whose node name is remembered."""


class TransformListener:
    """Puts the transforms of /tf and /tf_static into a buffer, as in tf2_ros.

    A `Buffer` creates its own; this is for a `BufferCore`, and for transforms of other topics. The
    authority of a transform is the node that published it.

    Args:
        buffer: The buffer to fill.
        node: The node that subscribes. In a managed node, transforms arrive in every state.
        qos: A profile or depth for /tf; by default 100 messages.
        static_qos: The same for /tf_static; by default also transient local.
        tf_topic: The topic of changing transforms.
        tf_static_topic: The topic of static transforms.
    """

    def __init__(
        self,
        buffer: BufferCore,
        node: Node,
        *,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        tf_topic: str = TOPIC,
        tf_static_topic: str = STATIC_TOPIC,
    ) -> None:
        static_qos = static_qos or QoSProfile(
            depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL
        )
        self.buffer = buffer
        self.node = node
        self.__senders: dict[bytes, str] = {}
        self.__unnamed: set[bytes] = set()  # publishers whose node is not yet known
        self.tf_sub: Subscription[TFMessage] = node.create_subscription(
            TFMessage, tf_topic, self.callback, qos or DEPTH
        )
        self.tf_static_sub: Subscription[TFMessage] = node.create_subscription(
            TFMessage, tf_static_topic, self.static_callback, static_qos
        )
        for subscription in (self.tf_sub, self.tf_static_sub):
            watch_opposite(subscription, self.__note_publisher)

    def callback(self, data: TFMessage, info: MessageInfo) -> None:
        """Handle changing transforms."""
        authority = self.__sender(info["publisher_gid"])
        for transform in data.transforms:
            self.buffer.set_transform(transform, authority)

    def static_callback(self, data: TFMessage, info: MessageInfo) -> None:
        """Handle static transforms."""
        authority = self.__sender(info["publisher_gid"])
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, authority)

    def __sender(self, gid: bytes) -> str:
        """Return the full name of a publisher's node; its gid while unknown."""
        known = self.__senders.get(gid)
        if known is not None:
            return known
        topics = {self.tf_sub.topic_name, self.tf_static_sub.topic_name}
        for endpoint in self.node.graph.endpoints(EndpointKind.PUBLISHER):
            if endpoint.gid == gid and endpoint.name in topics:
                if len(self.__senders) >= MAX_SENDERS:
                    self.__senders.clear()
                name = self.__senders[gid] = endpoint.node.fully_qualified_name
                return name
        if len(self.__unnamed) < MAX_SENDERS:
            self.__unnamed.add(gid)
        return nameless(gid)

    def __note_publisher(self, endpoint: EndpointInfo, present: bool) -> None:
        """Name the sender of transforms that arrived before the graph knew their publisher.

        Static transforms arrive once; without this their sender would never be named.
        """
        if present and endpoint.gid in self.__unnamed:
            self.__unnamed.discard(endpoint.gid)
            name = endpoint.node.fully_qualified_name
            self.buffer._BufferCore__rename_authority(nameless(endpoint.gid), name)

    def unregister(self) -> None:
        """Destroy both subscriptions."""
        self.tf_sub.destroy()
        self.tf_static_sub.destroy()


def nameless(gid: bytes) -> str:
    """Return the placeholder name of a publisher whose node is unknown."""
    return f"publisher {gid.hex()}"
