"""A test of a whole system."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import pytest

from aionode import Node
from aionode.errors import ConfigurationError, LaunchFileError, NotReadyError
from aionode.interfaces.std_msgs.msg import String
from aionode.system import NodeExists, System
from aionode.testing import system_under_test

if TYPE_CHECKING:
    from pathlib import Path

TALKER = """
import aionode
from aionode.interfaces.std_msgs.msg import String
class Talker(aionode.Node):
    def __init__(self):
        super().__init__("talker")
        self.words = self.create_publisher(String, "/words", 10)
        self.create_timer(0.1, lambda: self.words.publish(String(data="hello")))
aionode.run(Talker)
"""


async def test_a_file_is_started_in_a_domain_of_its_own_and_is_ready(tmp_path: Path) -> None:
    """The test talks to it through a node in the same context."""
    (tmp_path / "talker.py").write_text(TALKER)
    description = tmp_path / "robot.py"
    description.write_text(
        "import sys\n"
        "from aionode.system import NodeExists\n"
        "async def main(system):\n"
        f"    talker = [sys.executable, {str(tmp_path / 'talker.py')!r}]\n"
        "    system.process('talker', talker, ready=NodeExists('/talker', timeout_sec=30.0))\n"
    )

    async with (
        system_under_test(description) as system,
        Node("listener", context=system.context) as node,
    ):
        assert system.context.domain_id >= 102
        assert (await node.create_subscription(String, "/words").receive()).data == "hello"


LAUNCH = """
import os
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo, RegisterEventHandler
from launch.event_handlers import OnShutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import ComposableNodeContainer, Node
from launch_ros.descriptions import ComposableNode
def generate_launch_description():
    talker = ComposableNode(package="", plugin="aionode.examples.pubsub:Talker", name="talker",
                            namespace=LaunchConfiguration("robot"))
    return LaunchDescription([
        DeclareLaunchArgument("robot"),
        ComposableNodeContainer(name="c", namespace="", composable_node_descriptions=[talker]),
        RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg="good bye")])),
    ])
"""


async def test_a_launch_file_is_started_with_arguments_and_is_ready(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its nodes are in the graph, and its event handlers see the end of the test."""
    file = tmp_path / "robot.launch.py"
    file.write_text(LAUNCH)

    async with system_under_test(file, {"robot": "r1"}) as system:
        assert system.graph_node.graph.nodes_named("/r1/talker")

    assert "good bye" in capsys.readouterr().out


async def test_a_node_of_a_launch_file_that_does_not_come_fails_with_its_last_lines(
    tmp_path: Path,
) -> None:
    """In each launch language; the error names the missing node."""
    file = tmp_path / "robot.launch.xml"
    camera = tmp_path / "camera.sh"
    camera.write_text("#!/bin/sh\necho no camera; exit 3\n")
    camera.chmod(0o755)
    file.write_text(f'<launch><node exec="{camera}" name="camera" namespace="/"/></launch>')

    with pytest.raises(NotReadyError, match=r"camera\.sh-1.*exit status 3.*\n  no camera"):
        async with system_under_test(file):
            pass


async def test_an_error_of_a_test_is_not_hidden_by_its_launch_file(tmp_path: Path) -> None:
    """The assertion's error is raised as it is, not in a group."""
    file = tmp_path / "robot.launch.py"
    file.write_text(LAUNCH)

    with pytest.raises(AssertionError, match=r"^wrong$"):
        async with system_under_test(file, {"robot": "r1"}):
            raise AssertionError("wrong")


async def test_a_bad_launch_file_is_refused_before_anything_starts(tmp_path: Path) -> None:
    """The error has its file and line."""
    file = tmp_path / "robot.launch.py"
    file.write_text(LAUNCH)
    with pytest.raises(LaunchFileError, match=r"robot\.launch\.py:13: .*add robot:=VALUE"):
        async with system_under_test(file):
            pass


async def test_a_member_that_does_not_come_fails_with_its_last_lines() -> None:
    """They explain the failure of the test."""

    async def main(system: System) -> None:
        code = "print('no camera'); import time; time.sleep(100)"
        system.process(
            "camera", [sys.executable, "-S", "-c", code], ready=NodeExists("/camera", 0.5)
        )

    with pytest.raises(NotReadyError, match=r"node /camera.*\n  no camera"):
        async with system_under_test(main):
            pass


async def test_a_file_without_main_is_refused(tmp_path: Path) -> None:
    """The error says what a file needs."""
    file = tmp_path / "empty.py"
    file.write_text("")
    with pytest.raises(ConfigurationError, match="async def main"):
        async with system_under_test(file):
            pass
