"""A PID for each joint that is commanded by a velocity or an effort alone."""

from __future__ import annotations

import math
from dataclasses import dataclass

from aionode import Node

__all__ = ["Pid"]


@dataclass
class Pid:
    """A regulator.

    Attributes:
        p: What an error of the position adds.
        i: What the sum of the errors adds.
        d: What an error of the velocity adds.
        least: The minimum of what the sum adds.
        greatest: The maximum of what the sum adds.
        forward: The share of the wanted velocity.
        total: What the sum adds now.
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
        """Return the regulator of a joint, by parameters that are declared for it."""

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
        """Return the command, given the errors over a period; 0 for what is not measured yet."""
        if not (math.isfinite(error) and math.isfinite(speed_error)):
            return 0.0
        self.total = min(max(self.total + self.i * error * period_sec, self.least), self.greatest)
        return self.p * error + self.total + self.d * speed_error
