"""Programs of a robot that moves while its system ends: ``python -m tests.system.robot ROLE``."""

from __future__ import annotations

import asyncio
import os
import sys
from pathlib import Path

import aionode
from aionode import Node
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.system import NodeExists, System, TopicPublished, run

__all__ = ["main", "supervise"]

RECORD = "ROBOT_RECORD"
"""The variable with the file to which the wheels write."""


class Wheels(Node):
    """Records each new speed, and its own end. It does not stop by itself."""

    def __init__(self) -> None:
        super().__init__("wheels")
        self.speed = -1.0
        self.create_subscription(Twist, "/cmd_vel", self.drive, 10)
        self.create_timer(0.0, self.last)

    def drive(self, msg: Twist) -> None:
        """Record a speed if it has changed."""
        if msg.linear.x != self.speed:
            self.speed = msg.linear.x
            record(f"{self.speed:.1f}")

    async def last(self) -> None:
        """Record the end of this node."""
        try:
            await asyncio.Event().wait()
        finally:
            record("end")


class Commander(Node):
    """Drives, and commands the wheels to stop when it ends."""

    def __init__(self) -> None:
        super().__init__("commander")
        self.cmd_vel = self.create_publisher(Twist, "/cmd_vel", 10)
        self.start = self.create_timer(0.0, self.drive)

    async def drive(self) -> None:
        """Drive until the end."""
        self.start.cancel()
        async with self.cmd_vel.lease(stop=Twist(), ttl_sec=2.0) as lease:
            async for _ in self.create_rate(50):
                lease.publish(Twist(linear=Vector3(x=0.2)))
                print("driving", flush=True)  # noqa: T201  # a program that prints as it ends


def record(line: str) -> None:
    """Append a line to the record."""
    with Path(os.environ[RECORD]).open("a", encoding="utf-8") as file:
        file.write(f"{line}\n")


async def supervise(system: System) -> None:
    """Start the robot."""
    program = [sys.executable, "-m", "tests.system.robot"]
    system.process("wheels", [*program, "wheels"], ready=NodeExists("/wheels", 60.0))
    system.process(
        "commander",
        [*program, "commander"],
        after="wheels",
        ready=TopicPublished("/cmd_vel", 60.0),
    )
    await system.ready()
    print("ready", flush=True)  # noqa: T201  # for the test


def main() -> None:
    """Play the role that is the only argument."""
    roles = {"wheels": Wheels, "commander": Commander}
    if sys.argv[1] == "system":
        run(supervise, args=[])
    aionode.run(roles[sys.argv[1]], args=[])


if __name__ == "__main__":
    main()
