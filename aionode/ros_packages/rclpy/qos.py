"""Quality of service."""

from __future__ import annotations

import warnings
from enum import Enum
from typing import Any

from aionode import qos as core
from aionode.errors import InvalidQoSProfileException
from aionode.qos import (
    DeadlineBestAvailable,
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSCompatibility,
    QoSDurabilityPolicy,
    QoSHistoryPolicy,
    QoSLivelinessPolicy,
    QoSPolicyKind,
    QoSReliabilityPolicy,
    ReliabilityPolicy,
    qos_policy_name_from_kind,
)
from rclpy._impl.qos import rmw_qos_profile_t
from rclpy.duration import Duration

__all__ = [
    "DeadlineBestAvailable",
    "DurabilityPolicy",
    "Duration",
    "HistoryPolicy",
    "InvalidQoSProfileException",
    "LivelinessLeaseDurationeBestAvailable",
    "LivelinessPolicy",
    "QoSCompatibility",
    "QoSDurabilityPolicy",
    "QoSHistoryPolicy",
    "QoSLivelinessPolicy",
    "QoSPolicyEnum",
    "QoSPolicyKind",
    "QoSPresetProfiles",
    "QoSProfile",
    "QoSReliabilityPolicy",
    "ReliabilityPolicy",
    "qos_check_compatible",
    "qos_policy_name_from_kind",
    "qos_profile_action_status_default",
    "qos_profile_best_available",
    "qos_profile_default",
    "qos_profile_parameter_events",
    "qos_profile_parameters",
    "qos_profile_rosout_default",
    "qos_profile_sensor_data",
    "qos_profile_services_default",
    "qos_profile_system_default",
    "qos_profile_unknown",
]


class QoSProfile(core.QoSProfile):
    """The policies of one endpoint; a history or a depth is required.

    Raises:
        InvalidQoSProfileException: neither is given, or KEEP_LAST without a depth.
    """

    __slots__ = ()

    def get_c_qos_profile(self) -> rmw_qos_profile_t:
        """Return the profile in the form of the extension module."""
        return rmw_qos_profile_t(self)

    def __str__(self) -> str:
        values = ", ".join(f"{name}={value}" for name, value in policies(self).items())
        return f"QoSProfile({values})"


def policies(profile: core.QoSProfile) -> dict[str, Any]:
    """Return the policies of a profile, by name."""
    return rmw_qos_profile_t(profile).to_dict()


def as_own(profile: core.QoSProfile) -> QoSProfile:
    """Return a profile as one of this module's class."""
    return profile if isinstance(profile, QoSProfile) else QoSProfile(**policies(profile))


def qos_check_compatible(
    publisher_qos: core.QoSProfile, subscription_qos: core.QoSProfile
) -> tuple[QoSCompatibility, str]:
    """Report any two profiles as compatible, as rmw_zenoh does.

    Over Zenoh everything is delivered. Within one context the rules of DDS apply; use
    `aionode.qos.qos_check_compatible` for those.
    """
    del publisher_qos, subscription_qos
    return QoSCompatibility.OK, ""


qos_profile_action_status_default = as_own(core.qos_profile_action_status_default)
qos_profile_best_available = as_own(core.qos_profile_best_available)
qos_profile_default = as_own(core.qos_profile_default)
qos_profile_parameter_events = as_own(core.qos_profile_parameter_events)
qos_profile_parameters = as_own(core.qos_profile_parameters)
qos_profile_rosout_default = as_own(core.qos_profile_rosout_default)
qos_profile_sensor_data = as_own(core.qos_profile_sensor_data)
qos_profile_services_default = as_own(core.qos_profile_services_default)
qos_profile_system_default = as_own(core.qos_profile_system_default)
qos_profile_unknown = as_own(core.qos_profile_unknown)


class QoSPresetProfiles(Enum):
    """The profiles of this module, by name."""

    UNKNOWN = qos_profile_unknown
    DEFAULT = qos_profile_default
    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events
    ACTION_STATUS_DEFAULT = qos_profile_action_status_default
    BEST_AVAILABLE = qos_profile_best_available
    ROSOUT_DEFAULT = qos_profile_rosout_default

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the names in lower case."""
        return [name.lower() for name in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> QoSProfile:
        """Return the profile with a name.

        Raises:
            KeyError: there is none.
        """
        return cls[name.upper()].value

    @property
    def short_key(self) -> str:
        """The name in lower case."""
        return self.name.lower()


QoSPolicyEnum = HistoryPolicy.__base__


class DeprecatedMember:
    """A former name of a policy member, which warns when it is used."""

    def __init__(self, former: str, name: str) -> None:
        self.former = former
        self.name = name

    def __get__(self, member: object, policy: type[Enum]) -> Enum:
        warnings.warn(
            f"{policy.__name__}.{self.former} is deprecated. "
            f"Use {policy.__name__}.{self.name} instead.",
            stacklevel=2,
        )
        return policy[self.name]


FORMER_NAMES: dict[type[Enum], str] = {
    HistoryPolicy: "SYSTEM_DEFAULT KEEP_LAST KEEP_ALL UNKNOWN",
    ReliabilityPolicy: "SYSTEM_DEFAULT RELIABLE BEST_EFFORT UNKNOWN",
    DurabilityPolicy: "SYSTEM_DEFAULT TRANSIENT_LOCAL VOLATILE UNKNOWN",
    LivelinessPolicy: "SYSTEM_DEFAULT AUTOMATIC MANUAL_BY_TOPIC UNKNOWN",
}
"""The members with a former name, such as `RMW_QOS_POLICY_HISTORY_KEEP_LAST`."""

for _policy, _names in FORMER_NAMES.items():
    for _name in _names.split():
        _former = f"RMW_QOS_POLICY_{_policy.__name__.removesuffix('Policy').upper()}_{_name}"
        setattr(_policy, _former, DeprecatedMember(_former, _name))

# rclpy's spelling
LivelinessLeaseDurationeBestAvailable = core.LivelinessLeaseDurationBestAvailable
