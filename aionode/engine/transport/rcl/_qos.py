"""Converts QoS profiles between aionode and rclpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.clock import Duration
from aionode.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["profile_from", "to_rmw"]


def to_rmw(qos: QoSProfile, least_depth: int = 0) -> Any:
    """Return `qos` in the form that rclpy's extension module takes.

    Args:
        qos: The profile.
        least_depth: Minimum depth.
    """
    from rclpy import qos as rclpy_qos
    from rclpy.duration import Duration as RclpyDuration

    def duration(value: Duration) -> Any:
        return RclpyDuration(nanoseconds=value.nanoseconds)

    profile = rclpy_qos.QoSProfile(
        history=rclpy_qos.HistoryPolicy(int(qos.history)),
        depth=max(qos.depth, least_depth),
        reliability=rclpy_qos.ReliabilityPolicy(int(qos.reliability)),
        durability=rclpy_qos.DurabilityPolicy(int(qos.durability)),
        lifespan=duration(qos.lifespan),
        deadline=duration(qos.deadline),
        liveliness=rclpy_qos.LivelinessPolicy(int(qos.liveliness)),
        liveliness_lease_duration=duration(qos.liveliness_lease_duration),
        avoid_ros_namespace_conventions=qos.avoid_ros_namespace_conventions,
    )
    return profile.get_c_qos_profile()


def profile_from(values: Mapping[str, Any]) -> QoSProfile:
    """Return the profile of a discovered endpoint.

    DDS discovery does not transmit history and depth: they stay unknown.
    """

    def duration(name: str) -> Duration:
        return Duration(nanoseconds=values[name].nanoseconds)

    return QoSProfile(
        history=HistoryPolicy(int(values["history"])),
        depth=int(values["depth"]),
        reliability=ReliabilityPolicy(int(values["reliability"])),
        durability=DurabilityPolicy(int(values["durability"])),
        lifespan=duration("lifespan"),
        deadline=duration("deadline"),
        liveliness=LivelinessPolicy(int(values["liveliness"])),
        liveliness_lease_duration=duration("liveliness_lease_duration"),
        avoid_ros_namespace_conventions=bool(values["avoid_ros_namespace_conventions"]),
    )
