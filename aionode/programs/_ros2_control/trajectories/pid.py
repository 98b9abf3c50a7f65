"""A PID for each joint that is commanded by a velocity or an effort alone."""

from __future__ import annotations

import math
from dataclasses import dataclass

from aionode import Node

__all__ = ["Pid"]


@dataclass
class Pid:
    """A PID controller.

    Attributes:
        p: The gain of the position error.
        i: The gain of the integrated position error.
        d: The gain of the velocity error.
        least: The minimum of the integral term.
        greatest: The maximum of the integral term.
        forward: The gain of the desired velocity, which the caller adds.
        total: The integral term.
    """

    p: float
    i: float
    d: float
    least: float
    greatest: float
    forward: float
    total: float = 0.0

    @classmethod
    def declared(cls, node: Node, joint: str) -> Pid:
        """Declare the parameters of a joint's controller, and return the controller."""

        def given(name: str, default: float) -> float:
            return float(node.declare_parameter(f"gains.{joint}.{name}", default).value)

        clamp = given("i_clamp", math.inf)
        return cls(
            given("p", 0.0),
            given("i", 0.0),
            given("d", 0.0),
            max(given("i_clamp_min", -math.inf), -clamp),
            min(given("i_clamp_max", math.inf), clamp),
            given("ff_velocity_scale", 0.0),
        )

    def reset(self) -> None:
        """Forget the errors."""
        self.total = 0.0

    def output(self, error: float, speed_error: float, period_sec: float) -> float:
        """Return the command for the errors over a period; 0 while they are not measured yet."""
        if not (math.isfinite(error) and math.isfinite(speed_error)):
            return 0.0
        self.total = min(max(self.total + self.i * error * period_sec, self.least), self.greatest)
        return self.p * error + self.total + self.d * speed_error
