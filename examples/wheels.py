"""Wheels that stand still unless somebody moves them, and that obey an emergency stop.

Run it with ``python examples/wheels.py``, and move the wheels with ``python
examples/leased_driver.py``. Stop all wheels of the network with ``aionode topic pub -r 10
/emergency_stop std_msgs/msg/Empty``, and release these with ``aionode service call /wheels/release
std_srvs/srv/Trigger``.
"""

from __future__ import annotations

import asyncio

import aionode
from aionode import Context, Node, Supervisor
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.std_msgs.msg import Empty
from aionode.interfaces.std_srvs.srv import Trigger


class Wheels(Node):
    """Sets the motors: to 0 first of all, in silence, when it ends, and in an emergency."""

    def __init__(self, context: Context | None = None) -> None:
        super().__init__("wheels", context=context)
        self.held = False
        self.set_motors(0.0)  # they may still turn as the node before this one has left them
        self.create_subscription(
            Twist, "/cmd_vel", self.drive, 1, on_silence=self.stop, silence_sec=0.3
        )
        self.create_subscription(Empty, "/emergency_stop", self.hold, 1)
        self.create_service(Trigger, "~/release", self.release)
        self.create_timer(0.0, self.guard)

    def drive(self, msg: Twist) -> None:
        """Obey a command."""
        if not self.held:
            self.set_motors(msg.linear.x)

    def stop(self) -> None:
        """Stop: no command for 0.3 s, or the publisher of the last one is gone."""
        self.set_motors(0.0)

    def hold(self, _msg: Empty) -> None:
        """Stop, and obey no command until `release`."""
        self.held = True
        self.set_motors(0.0)

    def release(self, _request: Trigger.Request) -> Trigger.Response:
        """Obey commands again."""
        self.held = False
        return Trigger.Response(success=True, message="the wheels obey commands again")

    async def guard(self) -> None:
        """Stop when this node ends, even when it fails."""
        try:
            await asyncio.Event().wait()
        finally:
            self.set_motors(0.0)

    def set_motors(self, speed: float) -> None:
        """Set the speed of the motors, which this example only logs."""
        self.get_logger().info(f"Motors: {speed:.1f} m/s")


if __name__ == "__main__":
    aionode.run(Supervisor(Wheels).run)
