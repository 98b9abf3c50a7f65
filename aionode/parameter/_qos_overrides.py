"""QoS overrides: policies that parameters can change when a node starts.

The parameter ``qos_overrides./chatter.publisher.depth`` sets the depth of a publisher on
``/chatter``, if the node allows it with `QoSOverridingOptions`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Literal, Protocol

import msgspec

from aionode.clock import Duration
from aionode.errors import (
    InvalidQosOverridesError,
    InvalidQoSProfileException,
    ParameterAlreadyDeclaredException,
)
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from aionode.parameter._value import Parameter
from aionode.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
)

__all__ = ["QoSOverridingOptions", "declare_qos_overrides"]

POLICIES = {
    QoSPolicyKind.HISTORY: HistoryPolicy,
    QoSPolicyKind.RELIABILITY: ReliabilityPolicy,
    QoSPolicyKind.DURABILITY: DurabilityPolicy,
    QoSPolicyKind.LIVELINESS: LivelinessPolicy,
}


class QoSOverridingOptions(msgspec.Struct, frozen=True):
    """Selects the policies of an endpoint that parameters can override.

    Attributes:
        policy_kinds: The policies.
        callback: Checks the resulting profile.
        entity_id: Suffix of the parameters' names, to distinguish several endpoints of one topic.
    """

    policy_kinds: Iterable[QoSPolicyKind]
    callback: Callable[[QoSProfile], SetParametersResult] | None = None
    entity_id: str | None = None

    @classmethod
    def with_default_policies(
        cls,
        *,
        callback: Callable[[QoSProfile], SetParametersResult] | None = None,
        entity_id: str | None = None,
    ) -> QoSOverridingOptions:
        """Create options for history, depth and reliability."""
        kinds = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
        return cls(kinds, callback, entity_id)


class Declarer(Protocol):
    """A node, or anything else that declares parameters like one."""

    def declare_parameter(
        self, name: str, value: Any, descriptor: ParameterDescriptor
    ) -> Parameter:
        """Declare a parameter."""

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter."""


def declare_qos_overrides(
    node: Declarer,
    topic: str,
    entity: Literal["publisher", "subscription"],
    profile: QoSProfile,
    options: QoSOverridingOptions,
) -> QoSProfile:
    """Declare the read-only parameters of an endpoint, and return the resulting profile.

    Args:
        node: The node.
        topic: Full name of the topic.
        entity: The kind of endpoint.
        profile: The profile without overrides; not modified.
        options: Which policies can be overridden.

    Raises:
        InvalidQosOverridesError: A value is invalid, or the callback rejects the profile (a
            ValueError and a RuntimeError).
    """
    suffix = "" if options.entity_id is None else f"_{options.entity_id}"
    changes: dict[str, object] = {}
    for kind in options.policy_kinds:
        if kind is QoSPolicyKind.LIFESPAN and entity == "subscription":
            continue  # only the publisher determines the lifespan of a message
        policy = kind.name.lower()
        descriptor = ParameterDescriptor(
            description=f"{policy} for {entity} `{topic}` with id `{options.entity_id}`",
            read_only=True,
        )
        name = f"qos_overrides.{topic}.{entity}{suffix}.{policy}"
        try:
            parameter = node.declare_parameter(name, as_parameter(profile, policy), descriptor)
        except ParameterAlreadyDeclaredException:
            parameter = node.get_parameter(name)  # declared for an earlier endpoint
        changes[policy] = as_policy(parameter, kind)
    subject = f"{entity} of {topic}"
    try:
        result = profile.replace(**changes)
    except InvalidQoSProfileException as error:
        raise InvalidQosOverridesError(subject, error.problem) from error
    if options.callback is not None:
        answer = options.callback(result)
        if not answer.successful:
            raise InvalidQosOverridesError(subject, answer.reason)
    return result


def as_parameter(profile: QoSProfile, policy: str) -> str | int | bool:
    """Return a policy of a profile as a parameter value: a word, a number or nanoseconds."""
    value = getattr(profile, policy)
    if isinstance(value, Duration):
        return value.nanoseconds
    short_key: str | int | bool = getattr(value, "short_key", value)
    return short_key


def as_policy(parameter: Parameter, kind: QoSPolicyKind) -> object:
    """Convert a parameter value to a policy.

    Raises:
        InvalidQosOverridesError: No policy has this name.
    """
    value = parameter.value
    if kind in POLICIES:
        try:
            return POLICIES[kind].get_from_short_key(value)
        except KeyError:
            fits = ", ".join(POLICIES[kind].short_keys())
            raise InvalidQosOverridesError(
                parameter.name, f"'{value}' is unknown; it may be {fits}"
            ) from None
    durations = {
        QoSPolicyKind.LIFESPAN,
        QoSPolicyKind.DEADLINE,
        QoSPolicyKind.LIVELINESS_LEASE_DURATION,
    }
    return Duration(nanoseconds=value) if kind in durations else value
