"""A robot of four processes, started, supervised and stopped as one unit.

Run it with ``python examples/robot_system.py``; Ctrl-C stops the wheels and leaves nothing behind.
From a second terminal, ``aionode system status`` shows the same table, and ``aionode system restart
battery`` starts one of them anew.
"""

from __future__ import annotations

import sys
from pathlib import Path

from aionode import Node
from aionode.interfaces.sensor_msgs.msg import BatteryState
from aionode.system import NodeExists, System, TopicPublished, run

FOLDER = Path(__file__).parent


class Battery(Node):
    """Publishes the remaining charge once a second."""

    def __init__(self) -> None:
        super().__init__("battery")
        self.left = 1.0
        self.publisher = self.create_publisher(BatteryState, "/battery", 10)
        self.create_timer(1.0, self.measure)

    def measure(self) -> None:
        """Publish the remaining charge as a fraction of a full one."""
        self.left -= 0.01
        self.publisher.publish(BatteryState(percentage=self.left))


class Watch(Node):
    """Warns when the battery is low."""

    def __init__(self) -> None:
        super().__init__("watch")
        self.create_subscription(BatteryState, "/battery", self.look, 10)

    def look(self, battery: BatteryState) -> None:
        """Log the remaining charge."""
        log = self.get_logger()
        (log.info if battery.percentage > 0.2 else log.warning)(
            f"battery: {battery.percentage:.0%}"
        )


async def robot(system: System) -> None:
    """Start the robot; the driver starts after the wheels are ready, and stops before them."""
    wheels, driver = (
        [sys.executable, str(FOLDER / name)] for name in ("wheels.py", "leased_driver.py")
    )
    system.process("wheels", wheels, ready=NodeExists("/wheels"), restart="on-failure")
    system.node("battery", Battery, processes=True, restart="on-failure")
    system.node("watch", Watch, processes=True, restart="on-failure")
    system.process(
        "driver",
        driver,
        after="wheels",
        fails_with="wheels",
        ready=TopicPublished("/cmd_vel"),
        restart="on-failure",
    )
    await system.ready()
    for member in system.status().values():
        print(f"{member.name:>8}  {member.state:8}  pid {member.pid}", flush=True)


if __name__ == "__main__":
    run(robot, name="robot")
