"""LeRobot 0.6's own programs drive a robot of aionode: ``make lerobot``.

Run with the Python of an environment that has LeRobot, aionode and `lerobot_robot_aionode`. The
robot and its leader are a node in a thread of this process. `lerobot-record` records an episode
from them, its loader reads the data set, and the actions of a mock policy go through the wrapper by
which `lerobot-rollout` calls a robot.
"""

from __future__ import annotations

import asyncio
import math
import shutil
import sys
import tempfile
import threading
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from aionode import Context, Node
from aionode.image import from_numpy
from aionode.interfaces.sensor_msgs.msg import Image, JointState
from aionode.interfaces.std_msgs.msg import Float64MultiArray

__all__: list[str] = []

HEIGHT, WIDTH, FPS, SECONDS = 96, 128, 30, 4.0

CONTRACT: dict[str, Any] = {
    "fps": FPS,
    "observations": [
        {
            "feature": "observation.images.front",
            "topic": "/camera",
            "type": "sensor_msgs/msg/Image",
            "image": "color",
            "height": HEIGHT,
            "width": WIDTH,
            "max_age": 0.5,
        },
        {
            "feature": "observation.state",
            "topic": "/joint_states",
            "type": "sensor_msgs/msg/JointState",
            "fields": ["position.shoulder"],
            "names": ["shoulder.pos"],
            "max_age": 0.5,
        },
    ],
    "actions": [
        {
            "feature": "action",
            "topic": "/arm/command",
            "type": "std_msgs/msg/Float64MultiArray",
            "fields": ["data.0"],
            "names": ["shoulder.pos"],
            "lower": -1.0,
            "upper": 1.0,
            "stop": "hold",
        }
    ],
}


class Arm:
    """A robot that goes where it is told, and a leader that swings; in a thread of its own."""

    def __init__(self) -> None:
        self.angle = 0.0
        self.commands = 0
        self._end: asyncio.Event | None = None
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_until_complete, args=(self._live(),))
        self._thread.start()

    def stop(self) -> None:
        """End it."""
        assert self._end is not None
        self._loop.call_soon_threadsafe(self._end.set)
        self._thread.join()

    async def _live(self) -> None:
        self._end = asyncio.Event()
        async with Context() as context, Node("arm", context=context) as node:
            camera = node.create_publisher(Image, "/camera", 1)
            joints = node.create_publisher(JointState, "/joint_states", 1)
            leader = node.create_publisher(Float64MultiArray, "/leader/arm/command", 1)

            def take(command: Float64MultiArray) -> None:
                self.angle = float(command.data[0])
                self.commands += 1

            def show() -> None:
                now = node.get_clock().now()
                state = JointState(name=["shoulder"], position=[self.angle])
                state.header.stamp = now.to_msg()
                pixels = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
                column = round((self.angle + 1) / 2 * (WIDTH - 8))
                pixels[:, column : column + 8] = 255
                picture = from_numpy(pixels, "rgb8", header=state.header)
                joints.publish(state)
                camera.publish(picture)
                leader.publish(Float64MultiArray(data=[0.8 * math.sin(now.nanoseconds / 1e9)]))

            node.create_subscription(Float64MultiArray, "/arm/command", take, 10)
            node.create_timer(1 / FPS, show)
            await self._end.wait()


def record(folder: Path, contract: Path) -> None:
    """Record an episode with the program of LeRobot, and look at it with its loader."""
    from lerobot.datasets import LeRobotDataset
    from lerobot.scripts import lerobot_record

    sys.argv = [
        "lerobot-record",
        "--robot.type=aionode",
        f"--robot.contract={contract}",
        "--teleop.type=aionode",
        f"--teleop.contract={contract}",
        "--dataset.repo_id=aionode/swing",
        f"--dataset.root={folder / 'swing'}",
        "--dataset.single_task=swing",
        "--dataset.num_episodes=1",
        f"--dataset.episode_time_s={SECONDS}",
        "--dataset.push_to_hub=false",
        "--play_sounds=false",
        f"--dataset.fps={FPS}",
    ]
    lerobot_record.main()
    (root,) = folder.glob("swing*")
    data = LeRobotDataset("aionode/swing", root=root, video_backend="pyav")
    errors = []
    for index in range(len(data)):
        row = data[index]
        light = row["observation.images.front"].mean(dim=(0, 1)).numpy()
        shown = (
            float(light.argmax()) if light.max() < 0.5 else float(np.flatnonzero(light > 0.5)[0])
        )
        angle = shown / (WIDTH - 8) * 2 - 1
        errors.append(abs(angle - float(row["observation.state"].reshape(-1)[0])))
    print(f"recorded: {len(data)} rows; picture and joint differ by {max(errors):.3f} at most")


def roll_out(contract: Path) -> None:
    """Send actions by what `lerobot-rollout` calls the robot through."""
    from lerobot.robots import make_robot_from_config
    from lerobot.rollout.robot_wrapper import ThreadSafeRobot
    from lerobot_robot_aionode import AionodeRobotConfig

    robot = make_robot_from_config(AionodeRobotConfig(contract=str(contract)))
    robot.connect()
    wrapped = ThreadSafeRobot(robot)
    seen = 0.0
    for step in range(round(SECONDS * FPS)):
        seen = wrapped.get_observation()["shoulder.pos"]
        wrapped.send_action({"shoulder.pos": 0.5 * math.sin(step / FPS)})
        threading.Event().wait(1 / FPS)
    robot.disconnect()
    print(f"rolled out: {round(SECONDS * FPS)} actions; the joint was at {seen:.3f} at the end")


def main() -> None:
    """Do both."""
    folder = Path(tempfile.mkdtemp())
    contract = folder / "contract.yaml"
    contract.write_text(yaml.safe_dump(CONTRACT))
    arm = Arm()
    try:
        record(folder, contract)
        print(f"the arm got {arm.commands} commands")
        roll_out(contract)
        print(f"the arm got {arm.commands} commands, and stands at {arm.angle:.3f}")
    finally:
        arm.stop()
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
