"""The battery: a managed node, which publishes its charge only while it is active.

Run it with ``python -m aionode.examples.rover.battery``, and start it with ``aionode lifecycle set
/battery configure`` and ``activate``.
"""

from __future__ import annotations

import math
from typing import Any

import aionode
from aionode.interfaces.nav_msgs.msg import Odometry
from aionode.interfaces.sensor_msgs.msg import BatteryState
from aionode.lifecycle import LifecycleNode, State, TransitionCallbackReturn

__all__ = ["Battery"]

PERIOD_SEC = 1.0
PER_METRE = 0.002
PER_SEC = 0.0001
LOW = 0.2


class Battery(LifecycleNode):
    """Loses charge over time, and with each metre that the rover drives."""

    def __init__(self, **options: Any) -> None:
        super().__init__("battery", **options)
        self.left = 1.0
        self.place: tuple[float, float] | None = None
        self.states = self.create_lifecycle_publisher(BatteryState, "/battery", 10)
        self.create_lifecycle_subscription(Odometry, "/odom", self.drain, 10)
        self.create_lifecycle_timer(PERIOD_SEC, self.measure)

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Start with a full battery."""
        self.left = 1.0
        self.place = None
        return super().on_configure(state)

    def drain(self, odometry: Odometry) -> None:
        """Subtract the charge that the last part of the way took."""
        position = odometry.pose.pose.position
        before, self.place = self.place, (position.x, position.y)
        self.left -= PER_METRE * math.dist(before or self.place, self.place)

    def measure(self) -> None:
        """Publish the remaining charge, and warn when it is low."""
        self.left = max(0.0, self.left - PER_SEC * PERIOD_SEC)
        state = BatteryState(percentage=self.left, voltage=10.0 + 2.6 * self.left, present=True)
        state.header.stamp = self.get_clock().now().to_msg()
        self.states.publish(state)
        if self.left < LOW:
            self.get_logger().warning(f"the battery is at {self.left:.0%}", once=True)


if __name__ == "__main__":
    aionode.run(Battery)
