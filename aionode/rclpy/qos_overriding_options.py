"""Parameters that override the QoS of publishers and subscriptions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.errors import InvalidQosOverridesError
from aionode.parameter import QoSOverridingOptions, declare_qos_overrides
from aionode.rclpy.impl import _messages as msg
from aionode.rclpy.publisher import Publisher
from aionode.rclpy.subscription import Subscription

if TYPE_CHECKING:
    from aionode.rclpy.node import Node
    from aionode.rclpy.qos import QoSProfile

__all__ = ["InvalidQosOverridesError", "QoSOverridingOptions", "QosCallbackResult"]

QosCallbackResult = msg.SetParametersResult


def _declare_qos_parameters(
    entity_type: type[Any],
    node: Node,
    topic_name: str,
    qos: QoSProfile,
    options: QoSOverridingOptions | None,
) -> QoSProfile:
    """Declare the parameters of an endpoint, and return the profile that they result in.

    Raises:
        TypeError: the endpoint is neither publisher nor subscription.
        InvalidQosOverridesError: a value is invalid, or the callback rejects the profile.
    """
    if not issubclass(entity_type, Publisher | Subscription):
        raise TypeError("Argument `entity_type` should be a subclass of Publisher or Subscription")
    if options is None:
        return qos
    entity: Any = "publisher" if issubclass(entity_type, Publisher) else "subscription"
    declarer: Any = node
    return declare_qos_overrides(declarer, topic_name, entity, qos, options)
