"""A newcomer's first afternoon: two ROS packages, launched, driven, recorded and replayed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.support import fork_server
from tests.support.peers import free_ports

pytestmark = [pytest.mark.timeout(120), pytest.mark.one_loop]

FILES = {
    "minibot_interfaces/package.xml": """
        <package format="3"><name>minibot_interfaces</name></package>
    """,
    "minibot_interfaces/action/GoTo.action": """
        # where to, in metres
        float64 x
        float64 tolerance 0.05  # how close is there
        ---
        float64 left
        ---
        float64 left
    """,
    "minibot/package.xml": """
        <package format="3"><name>minibot</name><depend>minibot_interfaces</depend></package>
    """,
    "minibot/setup.py": """
        from setuptools import setup
        setup(
            name="minibot",
            data_files=[("share/minibot/launch", ["launch/minibot.launch.py"])],
            entry_points={"console_scripts": ["base = minibot.base:main"]},
        )
    """,
    "minibot/launch/minibot.launch.py": """
        from launch import LaunchDescription
        from launch_ros.actions import Node

        def generate_launch_description():
            mount = ["--x", "0.1", "--frame-id", "base_link", "--child-frame-id", "laser"]
            return LaunchDescription([
                Node(package="minibot", executable="base", name="base"),
                Node(package="tf2_ros", executable="static_transform_publisher",
                     name="mount", arguments=mount),
            ])
    """,
    "minibot/minibot/__init__.py": "",
    "minibot/minibot/base.py": """
        import aionode
        from aionode import Node
        from aionode.interfaces.geometry_msgs.msg import TransformStamped, Twist
        from aionode.interfaces.minibot_interfaces.action import GoTo
        from aionode.interfaces.nav_msgs.msg import Odometry
        from aionode.tf import TransformBroadcaster

        class Base(Node):
            def __init__(self):
                super().__init__("base")
                self.x, self.speed = 0.0, 0.0
                self.odometry = self.create_publisher(Odometry, "odom", 10)
                self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
                self.create_subscription(
                    Twist, "cmd_vel", self.on_twist, on_silence=self.stop, silence_sec=0.5)
                self.frames = TransformBroadcaster(self)
                self.create_timer(0.02, self.move)
                self.create_action_server(GoTo, "go_to", self.go, on_client_lost="cancel")

            def on_twist(self, twist):
                self.speed = twist.linear.x

            def stop(self, *_):
                self.speed = 0.0

            def move(self):
                self.x += 0.02 * self.speed
                odometry = Odometry(child_frame_id="base_link")
                odometry.header.frame_id = "odom"
                odometry.header.stamp = self.get_clock().now().to_msg()
                odometry.pose.pose.position.x = self.x
                self.odometry.publish(odometry)
                frame = TransformStamped(header=odometry.header, child_frame_id="base_link")
                frame.transform.translation.x = self.x
                self.frames.sendTransform(frame)

            async def go(self, handle):
                async with self.wheels.lease(stop=Twist()) as lease:
                    async for _ in self.create_rate(50):
                        left = handle.request.x - self.x
                        if abs(left) < handle.request.tolerance:
                            break
                        handle.publish_feedback(GoTo.Feedback(left=left))
                        twist = Twist()
                        twist.linear.x = max(-1.0, min(1.0, 4 * left))
                        lease.publish(twist)
                handle.succeed()
                return GoTo.Result(left=left)

        def main():
            aionode.run(Base)
    """,
    "minibot/test/test_base.py": """
        import pytest
        from minibot.base import Base

        @pytest.mark.asyncio
        async def test_the_base_goes_where_it_went(replay_bag):
            async with replay_bag("../../../run") as run:
                Base()
                outputs = await run.play(record=["/odom"], topics=["/cmd_vel"])

            poses = [record.message.pose.pose.position.x for record in outputs.records]
            assert abs(poses[-1] - 0.3) < 0.1
    """,
}


class Terminal:
    """A user's terminals in the workspace's folder."""

    def __init__(self, workspace: Path) -> None:
        self.workspace = workspace
        self.running: list[subprocess.Popen[str]] = []

    def do(self, *words: str, module: str = "aionode", folder: str = ".") -> str:
        """Run a command to its end, and return its output; it must not fail."""
        done = fork_server.run(
            ["-m", module, *words],
            env={**os.environ, "PYTEST_ADDOPTS": ""},  # those of this run of tests
            timeout=60,
            cwd=self.workspace / folder,
            fresh=module != "aionode",
        )
        assert done.returncode == 0, done.stdout + done.stderr
        assert "error" not in done.stderr.lower(), done.stderr
        return done.stdout

    def start(self, *words: str) -> subprocess.Popen[str]:
        """Start a command that runs until Ctrl-C."""
        process = fork_server.start(
            ["-m", "aionode", *words],
            env=os.environ,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            cwd=self.workspace,
        )
        self.running.append(process)
        return process

    def stop(self, process: subprocess.Popen[str]) -> str:
        """Press Ctrl-C in a terminal, and return what was printed there."""
        process.send_signal(signal.SIGINT)
        text, _ = process.communicate(timeout=30)
        assert process.returncode == 0, text
        return text


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[Terminal]:
    """A workspace with the robot's packages, which were not built."""
    for name, text in FILES.items():
        file = tmp_path / "src" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        lines = text.strip("\n").splitlines()
        file.write_text("".join(f"{line[8:]}\n" for line in lines), encoding="utf-8")
    terminal = Terminal(tmp_path)
    yield terminal
    for process in terminal.running:
        process.kill()
        process.communicate()


def fetched(port: int, path: str, body: dict[str, Any] | None = None) -> str:
    """Return what the gateway answers."""
    request = urllib.request.Request(
        f"http://127.0.0.1:{port}{path}",
        data=None if body is None else json.dumps(body).encode(),
        headers={"Content-Type": "application/json"},
    )
    with urllib.request.urlopen(request, timeout=30) as answer:  # noqa: S310  # our own gateway
        text: str = answer.read().decode()
    return text


@pytest.mark.slow
def test_a_first_afternoon_with_a_robot_has_no_stumble(terminal: Terminal) -> None:
    """A newcomer's steps in order; each has failed for someone in an earlier version."""
    (port,) = free_ports(1)
    robot = terminal.start("launch", "minibot", "minibot.launch.py")
    gateway = terminal.start("gateway", "--port", str(port), "--allow-write")

    action = terminal.do("interface", "show", "minibot_interfaces/action/GoTo")
    assert action.count("# where to, in metres") == 1
    recording = terminal.start("bag", "record", "--all", "--output", "run")
    assert recording.stdout is not None
    assert "Recording to run" in recording.stdout.readline()
    heard = "/cmd_vel [geometry_msgs/msg/Twist] 2 subscribers"  # the base and the recorder
    while heard not in terminal.do("topic", "list", "--verbose"):
        pass
    goal = ("action", "send_goal", "/go_to", "minibot_interfaces/action/GoTo")
    assert "SUCCEEDED" in terminal.do(*goal, "{x: 0.3}", "--feedback")
    assert "SUCCEEDED" in terminal.do(*goal, "{x: 0.3}")  # it is there: within the default of 0.05
    assert "laser  static, /mount" in terminal.do("tf", "tree")
    assert "<title>" in fetched(port, "/")
    assert "/go_to" in fetched(port, "/actions")
    assert '"status":"SUCCEEDED"' in fetched(port, "/actions/go_to", {"x": 0.3})

    assert "lost: nothing" in terminal.stop(recording)
    terminal.stop(gateway)
    assert "ERROR" not in terminal.stop(robot)
    played = terminal.do("bag", "info", "run")
    assert "minibot_interfaces/action/GoTo_FeedbackMessage" in played
    assert "1 passed" in terminal.do("-q", module="pytest", folder="src/minibot")
