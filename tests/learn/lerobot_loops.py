"""LeRobot 0.6's own programs drive a robot of aionode: ``make lerobot``.

Run with the Python of an environment that has LeRobot, aionode and `lerobot_robot_aionode`. The
robot and its leader are a node in a thread of this process, or with ``--rclpy`` one of rclpy in
another process, over DDS. `lerobot-record` records an episode from them, aionode's check and
LeRobot's loader read the data set, and `lerobot-rollout` lets a mock policy drive.
"""

from __future__ import annotations

import asyncio
import math
import os
import shutil
import signal
import subprocess
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
from aionode.learn import check_dataset

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
    assert (found := check_dataset(root)) == [], found
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


def roll_out(folder: Path, contract: Path) -> None:
    """Let a mock policy drive, with the program of LeRobot."""
    from lerobot.scripts import lerobot_rollout
    from lerobot_policy import save  # type: ignore[import-not-found]  # beside this program

    save(folder / "policy", HEIGHT, WIDTH)
    sys.argv = [
        "lerobot-rollout",
        "--robot.type=aionode",
        f"--robot.contract={contract}",
        f"--policy.path={folder / 'policy'}",
        "--task=move",
        f"--duration={SECONDS}",
        "--return_to_initial_position=false",
        f"--fps={FPS}",
    ]
    lerobot_rollout.main()


class RclpyArm:
    """The same robot as a program of rclpy, over DDS."""

    def __init__(self) -> None:
        program = [sys.executable, str(Path(__file__).with_name("lerobot_arm.py"))]
        self._program = subprocess.Popen(program, stdout=subprocess.PIPE, text=True)
        self.commands, self.angle = 0, 0.0

    def stop(self) -> None:
        """End it, and read what came."""
        self._program.send_signal(signal.SIGINT)
        told, _ = self._program.communicate(timeout=20)
        commands, angle = told.split()[-2:]
        self.commands, self.angle = int(commands), float(angle)


def main() -> None:
    """Do both; with ``--rclpy``, beside a robot of rclpy over DDS."""
    from lerobot_policy import TARGET

    is_rclpy = "--rclpy" in sys.argv
    if is_rclpy:
        os.environ["AIONODE_TRANSPORT"] = "rcl"
    folder = Path(tempfile.mkdtemp())
    contract = folder / "contract.yaml"
    contract.write_text(yaml.safe_dump(CONTRACT))
    arm = RclpyArm() if is_rclpy else Arm()
    try:
        record(folder, contract)
        roll_out(folder, contract)
    finally:
        arm.stop()
        shutil.rmtree(folder)
    print(f"the arm got {arm.commands} commands, and stands at {arm.angle:.3f} of {TARGET}")
    assert arm.commands > SECONDS * FPS
    assert abs(arm.angle - TARGET) < 0.02


if __name__ == "__main__":
    main()
