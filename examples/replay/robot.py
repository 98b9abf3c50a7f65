"""A robot of four nodes, a recording of its sensors, and a run on that recording in stepped time.

``python examples/replay/robot.py`` writes a recording of 60 s, runs the nodes on it, and prints
how many messages each topic got, and the digest of all of them. The digest is the same each time.
"""

from __future__ import annotations

import asyncio
import math
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

from aionode import Node, Parameter, Time, bag
from aionode.bag import BagWriter, Outputs
from aionode.errors import TransformException
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.geometry_msgs.msg import TransformStamped, Twist
from aionode.interfaces.sensor_msgs.msg import Imu
from aionode.interfaces.std_msgs.msg import Float64, String
from aionode.tf import Buffer, TransformBroadcaster

OUTPUTS = ["/cmd_vel", "/tf", "/report", "/count/_action/feedback"]


class Odometry(Node):
    """Integrates accelerations, and broadcasts the pose of the robot."""

    def __init__(self, **options: Any) -> None:
        super().__init__("odometry", **options)
        self.speed = self.x = 0.0
        self.broadcaster = TransformBroadcaster(self)
        self.create_subscription(Imu, "/imu", self.on_imu, 10)

    def on_imu(self, msg: Imu) -> None:
        """Advance by 10 ms."""
        self.speed += 0.01 * msg.linear_acceleration.x
        self.x += 0.01 * self.speed
        transform = TransformStamped(child_frame_id="base_link")
        transform.header.stamp = self.get_clock().now().to_msg()
        transform.header.frame_id = "odom"
        transform.transform.translation.x = self.x
        self.broadcaster.sendTransform(transform)


class Driver(Node):
    """Drives towards the goal, 50 times a second."""

    def __init__(self, **options: Any) -> None:
        super().__init__("driver", **options)
        self.declare_parameter("gain", 0.5)
        self.goal = 0.0
        self.buffer = Buffer(self)
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(Float64, "/goal", self.on_goal, 10)
        self.create_timer(0.02, self.drive)

    def on_goal(self, msg: Float64) -> None:
        """Accept a new goal."""
        self.goal = msg.data

    def drive(self) -> None:
        """Publish a command once the pose of the robot is known."""
        try:
            pose = self.buffer.lookup_transform("odom", "base_link", Time())
        except TransformException:
            return
        command = Twist()
        gain = self.get_parameter("gain").value
        command.linear.x = gain * (self.goal - pose.transform.translation.x)
        self.publisher.publish(command)


class Counting(Node):
    """Serves an action that takes some time."""

    def __init__(self, **options: Any) -> None:
        super().__init__("counting", **options)
        self.create_action_server(Fibonacci, "/count", self.execute)

    async def execute(self, goal: Any) -> Fibonacci.Result:
        """Compute one number every 50 ms."""
        sequence = [0, 1]
        for _ in range(goal.request.order):
            await self.get_clock().sleep(0.05)
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        goal.succeed()
        return Fibonacci.Result(sequence=sequence)


class Mission(Node):
    """Sends a goal every second, processes the result in a thread, and reports it."""

    def __init__(self, **options: Any) -> None:
        super().__init__("mission", **options)
        self.client = self.create_action_client(Fibonacci, "/count")
        self.publisher = self.create_publisher(String, "/report", 10)
        self.create_timer(1.0, self.report)

    async def report(self) -> None:
        """Report the sum of a result, and when it arrived."""
        result = await self.client.call(Fibonacci.Goal(order=5))
        total = await asyncio.to_thread(sum, result.sequence.tolist())
        seconds = self.get_clock().now().nanoseconds / 1e9
        self.publisher.publish(String(data=f"{total} at {seconds:.3f}"))


def make_robot(gain: float = 0.5) -> list[Node]:
    """Return the four nodes, in the default context: that of the run."""
    gains = [Parameter("gain", value=gain)]
    return [Odometry(), Driver(parameter_overrides=gains), Counting(), Mission()]


def record(path: Path, seconds: int = 60) -> Path:
    """Write a recording of an inertial sensor with 100 Hz, and of a goal each second."""
    with BagWriter(path) as writer:
        for tick in range(100 * seconds):
            now = Time(nanoseconds=1_700_000_000_000_000_000 + tick * 10_000_000)
            msg = Imu()
            msg.header.stamp = now.to_msg()
            msg.linear_acceleration.x = math.sin(tick / 50)
            writer.write_message("/imu", msg, now)
            if tick % 100 == 0:
                writer.write_message("/goal", Float64(data=tick / 100), now)
    return path


async def run_robot(path: Path, gain: float = 0.5) -> Outputs:
    """Run the robot on a recording, and return what it published."""
    async with bag.replay(path) as run:
        make_robot(gain)
        return await run.play(record=OUTPUTS)


async def main(path: Path) -> None:
    """Run the robot on a recording, and print the digest of what it published."""
    outputs = await run_robot(path)
    for topic, count in Counter(one.topic for one in outputs.records).items():
        print(f"{topic}: {count} messages")
    print(outputs.digest())


if __name__ == "__main__":
    if len(sys.argv) > 1:
        asyncio.run(main(Path(sys.argv[1])))
    else:
        with tempfile.TemporaryDirectory() as folder:
            asyncio.run(main(record(Path(folder) / "run")))
