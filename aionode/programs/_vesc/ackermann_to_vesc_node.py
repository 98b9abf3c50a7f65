"""``vesc_ackermann ackermann_to_vesc_node``: speeds and steering angles become motor commands."""

from __future__ import annotations

import math

import aionode
from aionode import Node
from aionode.interfaces.ackermann_msgs.msg import AckermannDriveStamped
from aionode.interfaces.std_msgs.msg import Float64
from aionode.programs._vesc.numbers import Line

__all__ = ["AckermannToVesc", "main"]


class AckermannToVesc(Node):
    """Publishes the commands of `ackermann_cmd` for the motor and the servo of a VESC.

    When they stop, so does the motor.

    Raises:
        CommandError: A parameter is missing or invalid.
    """

    def __init__(self) -> None:
        super().__init__("ackermann_to_vesc_node")
        self.speed_to_erpm = Line.declared(self, "speed_to_erpm")
        self.steering_to_servo = Line.declared(self, "steering_angle_to_servo")
        self.erpm = self.create_publisher(Float64, "commands/motor/speed", 10)
        self.servo = self.create_publisher(Float64, "commands/servo/position", 10)
        self.create_subscription(
            AckermannDriveStamped, "ackermann_cmd", self.on_command, 10, on_silence=self.stop
        )

    def on_command(self, command: AckermannDriveStamped) -> None:
        """Convert a command."""
        speed, angle = command.drive.speed, command.drive.steering_angle
        if not (math.isfinite(speed) and math.isfinite(angle)):
            self.get_logger().warning(
                f"stopped, because a command is not finite: speed {speed}, steering angle {angle}",
                throttle_duration_sec=5.0,
            )
            self.stop()
            return
        self.erpm.publish(Float64(data=self.speed_to_erpm.convert(speed)))
        self.servo.publish(Float64(data=self.steering_to_servo.convert(angle)))

    def stop(self) -> None:
        """Command a speed of 0; the wheels stay as they are steered."""
        self.erpm.publish(Float64(data=self.speed_to_erpm.convert(0.0)))


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(AckermannToVesc)
