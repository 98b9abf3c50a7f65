"""Checks whether a received trajectory can be followed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from aionode.interfaces.trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from aionode.programs._stamps import nanoseconds

__all__ = ["TrajectoryCheck"]

FIELDS: Final = ("positions", "velocities", "accelerations", "effort")
STANDS_STILL: Final = 1.2e-7
"""The resolution of a 32-bit float at 1, as in ros2_controllers."""


@dataclass(frozen=True)
class TrajectoryCheck:
    """Checks trajectories against what a controller can follow.

    Attributes:
        joints: Its joints.
        allows_partial: Whether a trajectory may leave joints out.
        takes_effort: Whether points may have efforts.
        may_end_moving: Whether the last point may have a velocity.
    """

    joints: Sequence[str]
    allows_partial: bool
    takes_effort: bool
    may_end_moving: bool

    def problem(self, msg: JointTrajectory, now_ns: int) -> str:
        """Return why a trajectory cannot be followed; empty if it can."""
        names = set(msg.joint_names)
        is_partial = self.allows_partial and names and names <= set(self.joints)
        if names != set(self.joints) and not is_partial:
            return "Joints on incoming trajectory don't match the controller joints."
        if not msg.points:
            return "Empty trajectory received."
        problems = (self.point_problem(index, msg) for index in range(len(msg.points)))
        return next(filter(None, problems), "") or self.end_problem(msg, now_ns)

    def point_problem(self, index: int, msg: JointTrajectory) -> str:
        """Return what is wrong with a point; empty if nothing is."""
        point: JointTrajectoryPoint = msg.points[index]
        if index and nanoseconds(point.time_from_start) <= nanoseconds(
            msg.points[index - 1].time_from_start
        ):
            return f"Time between points {index - 1} and {index} is not strictly increasing"
        wanted = len(msg.joint_names)
        for key in FIELDS:
            values = getattr(point, key)
            if len(values) != wanted and (len(values) or key == "positions"):
                return (
                    f"Mismatch between joint_names size ({wanted}) and {key} ({len(values)}) at "
                    f"point #{index}."
                )
            if not all(map(math.isfinite, values)):
                return f"{key} at point #{index} are not all finite"
        if len(point.effort) and not self.takes_effort:
            return (
                "Trajectories with effort fields are only supported for controllers using the "
                "'effort' command interface."
            )
        return ""

    def end_problem(self, msg: JointTrajectory, now_ns: int) -> str:
        """Return what is wrong with the last point; empty if nothing is."""
        last = msg.points[-1]
        if not self.may_end_moving:
            for name, speed in zip(msg.joint_names, last.velocities, strict=False):
                if abs(speed) > STANDS_STILL:
                    return f"Velocity of last trajectory point of joint {name} is not zero: {speed}"
        start = nanoseconds(msg.header.stamp)
        end = start + nanoseconds(last.time_from_start)
        if start and end < now_ns:
            return (
                f"Received trajectory with non-zero start time ({start / 1e9:f}) that ends in the "
                f"past ({end / 1e9:f})"
            )
        return ""
