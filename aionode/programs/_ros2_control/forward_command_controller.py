"""Controllers that write the values of a topic to the hardware as they are."""

from __future__ import annotations

import math
from typing import Any

from aionode import Time
from aionode.errors import CommandError
from aionode.interfaces.std_msgs.msg import Float64MultiArray
from aionode.lifecycle import State, TransitionCallbackReturn
from aionode.programs._ros2_control.controller import Controller
from aionode.programs._ros2_control.hardware import Hardware

__all__ = [
    "ForwardCommandController",
    "JointGroupEffortController",
    "JointGroupPositionController",
    "JointGroupVelocityController",
]


class ForwardCommandController(Controller):
    """Writes the values of `~/commands`, one for each joint, to one interface of the joints."""

    interface = ""
    """The interface that a subclass writes; if empty, a parameter names it."""

    def __init__(self, name: str, hardware: Hardware, **options: Any) -> None:
        super().__init__(name, hardware, **options)
        self.joints: list[str] = list(self.declare_parameter("joints", [""]).value)
        if not self.interface:
            self.interface = self.declare_parameter("interface_name", "").value
        self.values: list[float] = []
        self.create_lifecycle_subscription(Float64MultiArray, "~/commands", self.on_commands, 10)

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Check the parameters.

        Raises:
            CommandError: A parameter is missing.
        """
        joints = [each for each in self.joints if each]
        if not joints:
            raise CommandError("parameter 'joints' is empty; name the joints to control")
        if not self.interface:
            raise CommandError("parameter 'interface_name' is empty; name one, such as position")
        self.command_names = [f"{joint}/{self.interface}" for joint in joints]
        self.get_logger().info("configure successful")
        return super().on_configure(state)

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Start without a command."""
        self.values = []
        self.get_logger().info("activate successful")
        return super().on_activate(state)

    def on_commands(self, msg: Float64MultiArray) -> None:
        """Take commands, unless their number is wrong or one is not finite."""
        values = list(msg.data)
        if len(values) != len(self.command_names):
            self.get_logger().error(
                f"command size ({len(values)}) does not match number of interfaces "
                f"({len(self.command_names)})",
                throttle_duration_sec=1.0,
            )
        elif not all(map(math.isfinite, values)):
            self.get_logger().warning("Non-finite value received. Dropping message")
        else:
            self.values = values

    def update(self, now: Time, period_sec: float) -> None:
        """Write the last commands."""
        del now, period_sec
        if self.values:
            self.hardware.commands |= dict(zip(self.command_names, self.values, strict=True))


class JointGroupPositionController(ForwardCommandController):
    """Writes positions."""

    interface = "position"


class JointGroupVelocityController(ForwardCommandController):
    """Writes velocities."""

    interface = "velocity"


class JointGroupEffortController(ForwardCommandController):
    """Writes efforts."""

    interface = "effort"
