"""The QoS profile of rclpy's extension module."""

from __future__ import annotations

from typing import Any

from aionode.qos import QoSProfile

__all__ = ["profile_of", "rmw_qos_profile_t"]


class rmw_qos_profile_t:  # noqa: N801  # rclpy's name
    """A profile as returned by `QoSProfile.get_c_qos_profile`.

    Attributes:
        profile: The profile that it represents.
    """

    def __init__(self, profile: QoSProfile) -> None:
        self.profile = profile

    def to_dict(self) -> dict[str, Any]:
        """Return the policies by name."""
        profile = self.profile
        return {
            name: getattr(profile, name)
            for name in (
                "history",
                "depth",
                "reliability",
                "durability",
                "lifespan",
                "deadline",
                "liveliness",
                "liveliness_lease_duration",
                "avoid_ros_namespace_conventions",
            )
        }


def profile_of(given: Any) -> QoSProfile:
    """Return the profile given in either form."""
    profile: QoSProfile = given.profile if isinstance(given, rmw_qos_profile_t) else given
    return profile
