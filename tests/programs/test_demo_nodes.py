"""ROS 2's demos: talker and listener, and a dummy robot."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from aionode.interfaces.nav_msgs.msg import OccupancyGrid
from aionode.interfaces.sensor_msgs.msg import JointState, LaserScan
from aionode.interfaces.std_msgs.msg import String
from aionode.programs._demo_nodes.dummy_joint_states import DummyJointStates
from aionode.programs._demo_nodes.dummy_laser import DummyLaser
from aionode.programs._demo_nodes.dummy_map_server import DummyMapServer
from aionode.programs._demo_nodes.listener import Listener
from aionode.programs._demo_nodes.talker import Talker
from aionode.programs._demo_nodes.talker_of_rclpy import TalkerOfRclpy
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start


async def test_what_the_talker_says_the_listener_hears(
    start: Start, manual_clock: ManualClock, capfd: pytest.CaptureFixture[str]
) -> None:
    """In the originals' words, which tutorials show."""
    start(Talker)
    start(Listener)
    await manual_clock.advance(2.0)
    await settle()

    err = capfd.readouterr().err
    assert "[talker]: Publishing: 'Hello World: 2'" in err
    assert "[listener]: I heard: [Hello World: 2]" in err


async def test_what_others_publish_is_shown_escaped(
    start: Start, node_factory: Callable[..., Any], capfd: pytest.CaptureFixture[str]
) -> None:
    """It could recolour or retitle the terminal."""
    start(Listener)
    node_factory("user").create_publisher(String, "chatter", 10).publish(String(data="\x1b[31mred"))
    await settle()

    assert r"I heard: [\x1b[31mred]" in capfd.readouterr().err


async def test_the_talker_in_python_counts_from_0(
    start: Start, manual_clock: ManualClock, capfd: pytest.CaptureFixture[str]
) -> None:
    """It uses different quotes."""
    start(TalkerOfRclpy)
    await manual_clock.advance(1.0)
    await settle()

    assert 'Publishing: "Hello World: 0"' in capfd.readouterr().err


async def test_a_dummy_robot_swings_sees_and_has_a_map(
    start: Start, manual_clock: ManualClock, node_factory: Callable[..., Any]
) -> None:
    """With the values of the originals."""
    user = node_factory("user")
    heard: dict[Any, list[Any]] = {JointState: [], LaserScan: [], OccupancyGrid: []}
    for kind, topic in zip(heard, ("joint_states", "scan", "map"), strict=True):
        user.create_subscription(kind, topic, heard[kind].append, 100)
    for kind in (DummyJointStates, DummyLaser, DummyMapServer):
        start(kind)
    await manual_clock.advance(1.0)
    await settle()
    joints, scan, grid = (each[-1] for each in heard.values())

    assert list(joints.position) == [pytest.approx(math.sin(0.1 * len(heard[JointState])))] * 2
    assert len(scan.ranges) == 1081
    assert scan.angle_max == pytest.approx(math.radians(135))
    assert list(grid.data[:5]) == [-1, 0, 100, 0, -1]
    assert grid.info.origin.position.x == pytest.approx(-5)
