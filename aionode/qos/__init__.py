"""Quality of service: policies, profiles, and which profiles are compatible.

A publisher *offers* and a subscription *requests* a profile; the pair communicates if the offer is
at least as strong as the request. `mismatch` returns the reason if it is not, as logs and the
command line show it.

SYSTEM_DEFAULT leaves the choice to aionode: `QoSProfile.resolved` chooses like rmw_zenoh. A
duration of zero means "not limited", as in rclpy.
"""

from __future__ import annotations

from aionode.qos._compatibility import (
    Incompatibility,
    QoSCompatibility,
    best_available_for_publisher,
    best_available_for_subscription,
    incompatibilities,
    incompatible_qos_text,
    mismatch,
    qos_check_compatible,
)
from aionode.qos._profile import (
    DEFAULT_DEPTH,
    KEEP_ALL_DEPTH,
    DeadlineBestAvailable,
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessLeaseDurationBestAvailable,
    LivelinessPolicy,
    QoSDurabilityPolicy,
    QoSHistoryPolicy,
    QoSLivelinessPolicy,
    QoSPolicyKind,
    QoSPresetProfiles,
    QoSProfile,
    QoSReliabilityPolicy,
    ReliabilityPolicy,
    as_profile,
    depth_of,
    is_unlimited,
    keeps_all,
    qos_policy_name_from_kind,
    qos_profile_action_status_default,
    qos_profile_best_available,
    qos_profile_default,
    qos_profile_parameter_events,
    qos_profile_parameters,
    qos_profile_rosout_default,
    qos_profile_sensor_data,
    qos_profile_services_default,
    qos_profile_system_default,
    qos_profile_unknown,
)

__all__ = [
    "DEFAULT_DEPTH",
    "KEEP_ALL_DEPTH",
    "DeadlineBestAvailable",
    "DurabilityPolicy",
    "HistoryPolicy",
    "Incompatibility",
    "LivelinessLeaseDurationBestAvailable",
    "LivelinessPolicy",
    "QoSCompatibility",
    "QoSDurabilityPolicy",
    "QoSHistoryPolicy",
    "QoSLivelinessPolicy",
    "QoSPolicyKind",
    "QoSPresetProfiles",
    "QoSProfile",
    "QoSReliabilityPolicy",
    "ReliabilityPolicy",
    "as_profile",
    "best_available_for_publisher",
    "best_available_for_subscription",
    "depth_of",
    "incompatibilities",
    "incompatible_qos_text",
    "is_unlimited",
    "keeps_all",
    "mismatch",
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
