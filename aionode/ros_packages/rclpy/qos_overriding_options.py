"""Parameters that override the QoS of publishers and subscriptions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.clock import Duration
from aionode.errors import InvalidQosOverridesError
from aionode.parameter import QoSOverridingOptions, declare_qos_overrides
from rclpy._impl import messages as msg
from rclpy.publisher import Publisher
from rclpy.qos import QoSPolicyKind, as_own
from rclpy.subscription import Subscription

if TYPE_CHECKING:
    from rclpy._protocols import NodeLike
    from rclpy.qos import QoSProfile

__all__ = ["InvalidQosOverridesError", "QoSOverridingOptions", "QoSPolicyKind", "QosCallbackResult"]

QosCallbackResult = msg.SetParametersResult


def _declare_qos_parameters(
    entity_type: type[Any],
    node: NodeLike,
    topic_name: str,
    qos: QoSProfile,
    options: QoSOverridingOptions | None,
) -> QoSProfile:
    """Declare the parameters of an endpoint, and return the resulting profile.

    Raises:
        TypeError: the endpoint is neither a publisher nor a subscription.
        InvalidQosOverridesError: a value is invalid, or the callback rejects the profile.
    """
    if not issubclass(entity_type, Publisher | Subscription):
        raise TypeError("Argument `entity_type` should be a subclass of Publisher or Subscription")
    if options is None:
        return qos
    entity: Any = "publisher" if issubclass(entity_type, Publisher) else "subscription"
    declarer: Any = node
    return as_own(declare_qos_overrides(declarer, topic_name, entity, qos, options))


def _get_qos_policy_parameter(qos: QoSProfile, policy: QoSPolicyKind) -> str | int | bool:
    """Return a policy as a parameter value: a word, a number, or nanoseconds."""
    value = getattr(qos, policy.name.lower())
    if isinstance(value, Duration):
        return value.nanoseconds
    short_key: str | int | bool = getattr(value, "short_key", value)
    return short_key
