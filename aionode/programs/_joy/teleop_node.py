"""``teleop_twist_joy teleop_node``: drives a base with a joystick while a button is held."""

from __future__ import annotations

import math
from typing import Any, Final

import aionode
from aionode import Node
from aionode.errors import LeaseExpiredError
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.sensor_msgs.msg import Joy
from aionode.programs._leased_twists import TTL_SEC, LeasedTwists
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["TeleopTwistJoy", "main"]

LINEAR: Final = {"x": (5, 0.5, 1.0), "y": (-1, 0.0, 0.0), "z": (-1, 0.0, 0.0)}
"""The axis of each direction, and its scales: the usual one and that of the turbo button."""

ANGULAR: Final = {"yaw": (2, 0.5, 1.0), "pitch": (-1, 0.0, 0.0), "roll": (-1, 0.0, 0.0)}

START_SEC: Final = 0.01


class TeleopTwistJoy(Node):
    """Publishes the joystick's command on `cmd_vel`, under a lease, while its button is held."""

    def __init__(self) -> None:
        super().__init__("teleop_twist_joy_node")
        is_stamped = self.declare_parameter("publish_stamped_twist", False).value
        frame_id = self.declare_parameter("frame", "teleop_twist_joy").value
        self.declare_parameter("require_enable_button", True)
        self.declare_parameter("enable_button", 5)
        self.declare_parameter("enable_turbo_button", -1)
        self.declare_parameter("inverted_reverse", False)
        for kind, directions in (("linear", LINEAR), ("angular", ANGULAR)):
            for name, (axis, scale, turbo) in directions.items():
                self.declare_parameter(f"axis_{kind}.{name}", axis)
                self.declare_parameter(f"scale_{kind}.{name}", scale)
                self.declare_parameter(f"scale_{kind}_turbo.{name}", turbo)
        self.command: Twist | None = None
        self.twists = LeasedTwists(
            self, lambda: self.command, self.on_expired, is_stamped=is_stamped, frame_id=frame_id
        )
        self.tell()
        self.create_subscription(Joy, "joy", self.on_joy, 10)
        create_wall_timer(self, START_SEC, self.twists.drive)

    def value(self, name: str) -> Any:
        """Return the value of a parameter."""
        return self.get_parameter(name).value

    def tell(self) -> None:
        """Log which buttons and axes are used."""
        log = self.get_logger().get_child("TeleopTwistJoy")
        turbo = self.value("enable_turbo_button")
        if self.value("require_enable_button"):
            log.info(f"Teleop enable button {self.value('enable_button')}.")
        if turbo >= 0:
            log.info(f"Turbo on button {turbo}.")
        for kind, directions in (("linear", LINEAR), ("angular", ANGULAR)):
            for name in sorted(directions):
                axis = self.value(f"axis_{kind}.{name}")
                if axis == -1:
                    continue
                scale = self.value(f"scale_{kind}.{name}")
                log.info(f"{kind.capitalize()} axis {name} on {axis} at scale {scale:f}.")
                if turbo >= 0:
                    scale = self.value(f"scale_{kind}_turbo.{name}")
                    log.info(f"Turbo for {kind} axis {name} is scale {scale:f}.")

    def on_joy(self, joy: Joy) -> None:
        """Publish the joystick's command, or stop."""
        if self.is_pressed(joy, "enable_turbo_button"):
            self.command = self.twist(joy, "_turbo")
        elif not self.value("require_enable_button") or self.is_pressed(joy, "enable_button"):
            self.command = self.twist(joy, "")
        else:
            self.command = None
            if not (self.twists.is_leased or self.twists.has_stopped):
                # The end of a lease is itself a stop; this also ends commands of others.
                self.twists.stop()
        self.twists.repeat()

    def is_pressed(self, joy: Joy, name: str) -> bool:
        """Return whether the button of a parameter is pressed."""
        number = self.value(name)
        return 0 <= number < len(joy.buttons) and bool(joy.buttons[number])

    def twist(self, joy: Joy, which: str) -> Twist:
        """Return the command for the axes."""
        x, y, z = (self.scaled(joy, "linear", name, which) for name in LINEAR)
        yaw, pitch, roll = (self.scaled(joy, "angular", name, which) for name in ANGULAR)
        if x < 0 and self.value("inverted_reverse"):
            yaw = -yaw
        return Twist(linear=Vector3(x=x, y=y, z=z), angular=Vector3(x=roll, y=pitch, z=yaw))

    def scaled(self, joy: Joy, kind: str, name: str, which: str) -> float:
        """Return the part of a command from an axis; 0 if there is none, or it is not finite."""
        axis = self.value(f"axis_{kind}.{name}")
        if not 0 <= axis < len(joy.axes):
            return 0.0
        value = float(joy.axes[axis]) * float(self.value(f"scale_{kind}{which}.{name}"))
        return value if math.isfinite(value) else 0.0

    def on_expired(self, _: LeaseExpiredError) -> None:
        """Forget the command of a joystick that sends nothing any more."""
        self.command = None
        self.get_logger().warning(
            f"stopped: the joystick sent nothing for {TTL_SEC:g} s; it is "
            "unplugged, or its autorepeat_rate is too low"
        )


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(TeleopTwistJoy)
