"""How far joints may be from their trajectory."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from aionode import Node
from aionode.programs._ros2_control.trajectories.splines import Point

__all__ = ["Tolerances"]

KINDS = ("positions", "velocities", "accelerations")

Limits = dict[str, tuple[float, float, float]]
"""For each joint the tolerance of its position, velocity and acceleration; 0 means any error."""


@dataclass(frozen=True)
class Tolerances:
    """The tolerances of all joints.

    Attributes:
        path: The tolerances on the way.
        goal: The tolerances at the end.
        goal_time_sec: How late the end may be reached; 0 means any time.
    """

    path: Limits
    goal: Limits
    goal_time_sec: float

    @classmethod
    def declared(cls, node: Node, joints: list[str]) -> Tolerances:
        """Declare the parameters of the tolerances, and return the tolerances."""

        def given(name: str, default: float) -> float:
            return float(node.declare_parameter(f"constraints.{name}", default).value)

        stopped = given("stopped_velocity_tolerance", 0.01)
        return cls(
            {joint: (given(f"{joint}.trajectory", 0.0), 0.0, 0.0) for joint in joints},
            {joint: (given(f"{joint}.goal", 0.0), stopped, 0.0) for joint in joints},
            given("goal_time", 0.0),
        )

    def of_goal(self, goal: Any) -> tuple[Tolerances, str]:
        """Return the tolerances for a goal, which may change some; and what is wrong with them.

        If something is wrong, nothing is changed.
        """
        changed: dict[str, Limits] = {"path": dict(self.path), "goal": dict(self.goal)}
        for key, limits in changed.items():
            for each in getattr(goal, f"{key}_tolerance"):
                if each.name not in limits:
                    return self, (
                        f"joint '{each.name}' specified in goal.{key}_tolerance does not exist. "
                        "Using default tolerances."
                    )
                wanted = (each.position, each.velocity, each.acceleration)
                if any(value < 0 and value != -1 for value in wanted):
                    return self, (
                        f"joint '{each.name}' specified in goal.{key}_tolerance has an invalid "
                        "tolerance. Using default tolerances."
                    )
                x, y, z = map(chosen, limits[each.name], wanted)
                limits[each.name] = (x, y, z)
        given = goal.goal_time_tolerance
        time_sec = given.sec + given.nanosec / 1e9
        return (
            replace(self, **changed, goal_time_sec=chosen(self.goal_time_sec, time_sec)),
            "",
        )

    def on_the_way(self, error: Point) -> str:
        """Return which joint is too far from the trajectory; empty if none is."""
        return violation(self.path, error)

    def at_the_end(self, error: Point) -> str:
        """Return which joint is too far from the end; empty if none is."""
        return violation(self.goal, error)


def chosen(usual: float, wanted: float) -> float:
    """Return a tolerance: 0 leaves the usual one, and below 0 there is none."""
    return usual if wanted == 0 else max(wanted, 0.0)


def violation(limits: Limits, error: Point) -> str:
    """Return which joint exceeds a limit; empty if none does."""
    for joint, (name, allowed) in enumerate(limits.items()):
        for kind, limit in zip(KINDS, allowed, strict=True):
            found = getattr(error, kind)
            if limit > 0 and found and not abs(found[joint]) <= limit:  # also if it is not measured
                return f"{kind} of {name} are off by {found[joint]:f}; the limit is {limit:f}"
    return ""
