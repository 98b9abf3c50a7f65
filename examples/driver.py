"""Parameters as a class, set at the start or while the program runs.

Run it with ``python examples/driver.py --ros-args -p speed:=0.8``, and from a second terminal
``aionode param set /driver speed 1.5``.
"""

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

import aionode
from aionode import Node


class Driving(msgspec.Struct):
    """The parameters of the driver."""

    frame: str = "base_link"
    speed: Annotated[float, Meta(ge=0.0, le=2.0, description="in m/s")] = 0.5
    mode: Literal["manual", "auto"] = "manual"


class Driver(Node):
    """Logs its speed at the start, and whenever a parameter changes."""

    def __init__(self) -> None:
        super().__init__("driver")
        self.driving = self.declare_struct(Driving, on_change=self.log_driving)
        self.log_driving(self.driving)

    def log_driving(self, driving: Driving) -> None:
        """Log the speed and the mode."""
        self.get_logger().info(f"Driving at {driving.speed} m/s, {driving.mode}")


if __name__ == "__main__":
    aionode.run(Driver)
