"""The program that turns the positions of joints into transforms."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from aionode import Context, Node, Parameter
from aionode.errors import CommandError
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.programs._robot_state_publisher import RobotStatePublisher
from aionode.programs._urdf import Robot
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start

Matrix = npt.NDArray[np.float64]

ARM = """
<robot name="arm">
  <link name="base"/> <link name="mount"/> <link name="upper"/> <link name="hand"/>
  <link name="finger"/>
  <joint name="screws" type="fixed">
    <parent link="base"/> <child link="mount"/> <origin xyz="0 0 1"/>
  </joint>
  <joint name="lift" type="revolute">
    <parent link="mount"/> <child link="upper"/> <axis xyz="0 0 2"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="upper"/> <child link="hand"/> <origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="grip" type="continuous">
    <parent link="hand"/> <child link="finger"/>
    <mimic joint="slide" multiplier="2" offset="0.5"/>
  </joint>
  <transmission name="t"><joint name="lift"/></transmission>
</robot>
"""


class Watcher:
    """The transforms that the program publishes, and its joints."""

    def __init__(self, node: Node) -> None:
        self.moved: list[Any] = []
        self.fixed: list[Any] = []
        self.descriptions: list[str] = []
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(TFMessage, "/tf", lambda msg: self.moved.extend(msg.transforms))
        node.create_subscription(
            TFMessage, "/tf_static", lambda msg: self.fixed.extend(msg.transforms), latched
        )
        node.create_subscription(
            String, "robot_description", lambda msg: self.descriptions.append(msg.data), latched
        )
        self.joints = node.create_publisher(JointState, "joint_states", 10)

    async def move(self, sec: float, **positions: float) -> dict[str, Any]:
        """Say where joints are, and return what is published, by child."""
        self.moved.clear()
        stamp = Time(sec=int(sec), nanosec=round(sec % 1 * 1e9))
        msg = JointState(
            header=Header(stamp=stamp),
            name=list(positions),
            position=list(positions.values()),
        )
        self.joints.publish(msg)
        await settle()
        return {stamped.child_frame_id: stamped for stamped in self.moved}


@pytest.fixture
def robot(
    manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> Callable[..., tuple[RobotStatePublisher, Watcher]]:
    """Start the program with parameters, and what watches it."""
    del manual_clock  # the context follows it

    def make(**parameters: Any) -> tuple[RobotStatePublisher, Watcher]:
        node = start(RobotStatePublisher, **{"robot_description": ARM, **parameters})
        return node, Watcher(node_factory("watcher"))

    return make


def vector(part: Any) -> list[float]:
    """Return three components, or the four of a quaternion."""
    names = ("x", "y", "z", "w") if hasattr(part, "w") else ("x", "y", "z")
    return [getattr(part, name) for name in names]


async def test_late_subscribers_receive_fixed_joints_and_the_description(
    robot: Callable[..., Any],
) -> None:
    """RViz and others start after the robot."""
    _, watcher = robot()
    await settle()

    assert [(each.header.frame_id, each.child_frame_id) for each in watcher.fixed] == [
        ("base", "mount")
    ]
    assert vector(watcher.fixed[0].transform.translation) == [0, 0, 1]
    assert watcher.descriptions == [ARM]


async def test_each_kind_of_joint_moves_its_link(robot: Callable[..., Any]) -> None:
    """A joint that mimics another one, and whose position nobody publishes, is included."""
    _, watcher = robot()

    links = await watcher.move(1.0, lift=np.pi / 2, slide=0.25)

    half = np.sqrt(0.5)
    assert vector(links["upper"].transform.rotation) == pytest.approx([0, 0, half, half])
    assert vector(links["hand"].transform.translation) == pytest.approx([1, 0.25, 0])
    assert vector(links["hand"].transform.rotation) == pytest.approx([0, 0, half, half])
    assert links["finger"].header.frame_id == "hand"
    assert vector(links["finger"].transform.rotation) == pytest.approx(
        [np.sin(0.5), 0, 0, np.cos(0.5)]
    )
    assert links["upper"].header.stamp == Time(sec=1)


async def test_joints_are_published_at_most_as_often_as_the_frequency_says(
    robot: Callable[..., Any], manual_clock: ManualClock
) -> None:
    """By the stamps of messages, in whole milliseconds, as in ROS; others are left out."""
    _, watcher = robot()
    await manual_clock.advance(2000.0)

    assert await watcher.move(100.0, lift=0.1)
    assert not await watcher.move(100.049, lift=0.2)
    assert await watcher.move(100.05, lift=0.2)
    assert await watcher.move(100.06, slide=0.2)  # not published so far


async def test_a_timestamp_may_be_ignored(
    robot: Callable[..., Any], manual_clock: ManualClock
) -> None:
    """Drivers without a clock stamp nothing."""
    _, watcher = robot(ignore_timestamp=True)
    await manual_clock.advance(10.0)

    assert await watcher.move(0.0, lift=0.1)
    assert await watcher.move(0.0, lift=0.2)


async def test_a_prefix_is_put_before_each_frame(robot: Callable[..., Any]) -> None:
    """Two robots of one kind have frames of their own."""
    _, watcher = robot(frame_prefix="left/")

    links = await watcher.move(1.0, lift=0.1)

    assert links["left/upper"].header.frame_id == "left/mount"
    assert watcher.fixed[0].child_frame_id == "left/mount"


async def test_a_description_may_change_and_an_invalid_one_is_refused(
    robot: Callable[..., Any],
) -> None:
    """A robot gets another gripper while it runs."""
    node, watcher = robot()
    other = ARM.replace("0 0 1", "0 0 3", 1)

    (changed,) = node.set_parameters([Parameter("robot_description", value=other)])
    (empty,) = node.set_parameters([Parameter("robot_description", value="")])
    (broken,) = node.set_parameters([Parameter("robot_description", value="<robot/>")])
    (often,) = node.set_parameters([Parameter("publish_frequency", value=1001.0)])
    await settle()

    assert changed.successful
    assert empty.reason == "Empty URDF is not allowed"
    assert broken.reason == "it has no links"
    assert often.reason == "publish_frequency must be between 0.0 and 1000.0"
    assert watcher.descriptions[-1] == other
    assert vector(watcher.fixed[-1].transform.translation) == [0, 0, 3]


async def test_messages_without_positions_are_ignored(
    robot: Callable[..., Any], capfd: pytest.CaptureFixture[str]
) -> None:
    """With a line that says which."""
    _, watcher = robot()
    watcher.joints.publish(JointState(name=["lift"]))
    watcher.joints.publish(JointState(name=["lift"], position=[1.0, 2.0]))
    await settle()

    assert watcher.moved == []
    err = capfd.readouterr().err
    assert '"lift"(,...) whose position member was empty' in err
    assert "ignored an invalid JointState message" in err


async def test_a_robot_without_a_description_does_not_start(aionode_context: Context) -> None:
    """It would publish nothing, and nobody would know why."""
    with pytest.raises(CommandError, match="robot_description parameter must not be empty"):
        RobotStatePublisher()


@pytest.mark.parametrize(
    ("urdf", "text"),
    [
        ("<sdf/>", "its root is <sdf>, not <robot>"),
        ("<robot>", "it is not XML"),
        ('<!DOCTYPE r [<!ENTITY a "b">]><robot/>', "entities"),
        (ARM.replace('link="base"', 'link="nowhere"', 1), "names link 'nowhere'"),
        (ARM.replace('<child link="mount"/>', '<child link="base"/>'), "loop"),
        (ARM.replace('<link name="base"/>', '<link name="base"/><link name="a"/>'), "two roots"),
        (ARM.replace('axis xyz="0 0 2"', 'axis xyz="0 0 0"'), "axis without length"),
        (ARM.replace('xyz="0 0 1"', 'xyz="0 0 nan"'), "'nan' is not a number"),
        (ARM.replace('name="slide" type', 'name="lift" type'), "'lift' is defined twice"),
        (ARM.replace('"prismatic"', '"hinge"'), "type 'hinge'"),
    ],
)
def test_what_is_no_description_is_named(urdf: str, text: str) -> None:
    """The error says where, not that "the model could not be initialized"."""
    with pytest.raises(ValueError, match=text):
        Robot.of(urdf)


@pytest.mark.slow
def test_the_pose_of_each_link_is_that_of_a_matrix_computation() -> None:
    """For 50 random robots of 20 joints, to 1e-12."""
    for seed in range(50):
        random_ = random.Random(seed)  # noqa: S311  # a description
        urdf = random_robot(random_)
        described = Robot.of(urdf)
        for joint in described.joints.values():
            position = random_.uniform(-10, 10)
            found = matrix_of_pose(joint.pose(position))
            expected = expected_matrix(urdf, joint.name, position)
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)


def random_robot(random_: random.Random) -> str:
    """Return a description of a robot of 21 links."""
    parts = ['<link name="l0"/>']
    for at in range(1, 21):
        kind = random_.choice(["revolute", "continuous", "prismatic", "fixed", "floating"])
        xyz, rpy, axis = (
            " ".join(repr(random_.uniform(-4, 4)) for _ in range(3)) for _ in range(3)
        )
        parts.append(
            f'<link name="l{at}"/><joint name="j{at}" type="{kind}">'
            f'<parent link="l{random_.randrange(at)}"/><child link="l{at}"/>'
            f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>'
            '<limit lower="-1" upper="1"/></joint>'
        )
    return f"<robot>{''.join(parts)}</robot>"


def expected_matrix(urdf: str, name: str, position: float) -> Matrix:
    """Return the pose of a joint's child, by matrices alone."""
    from xml.etree import ElementTree as ET

    root = ET.fromstring(urdf)  # noqa: S314  # our own
    joint = next(each for each in root.iter("joint") if each.get("name") == name)
    parts = {each.tag: each.attrib for each in joint}
    roll, pitch, yaw = (float(word) for word in parts["origin"]["rpy"].split())
    axis = np.array([float(word) for word in parts["axis"]["xyz"].split()])
    axis /= np.linalg.norm(axis)
    pose = np.eye(4)
    pose[:3, :3] = rotation([0, 0, 1], yaw) @ rotation([0, 1, 0], pitch) @ rotation([1, 0, 0], roll)
    pose[:3, 3] = [float(word) for word in parts["origin"]["xyz"].split()]
    motion = np.eye(4)
    if joint.get("type") in ("revolute", "continuous"):
        motion[:3, :3] = rotation(axis, position)
    elif joint.get("type") == "prismatic":
        motion[:3, 3] = axis * position
    placed: Matrix = pose @ motion
    return placed


def rotation(axis: Any, angle: float) -> Matrix:
    """Return the matrix of a rotation, by Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turned: Matrix = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)
    return turned


def matrix_of_pose(pose: Any) -> Matrix:
    """Return a pose as a matrix."""
    x, y, z, i, j, k, w = pose
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (j * j + k * k), 2 * (i * j - k * w), 2 * (i * k + j * w)],
        [2 * (i * j + k * w), 1 - 2 * (i * i + k * k), 2 * (j * k - i * w)],
        [2 * (i * k - j * w), 2 * (j * k + i * w), 1 - 2 * (i * i + j * j)],
    ]
    matrix[:3, 3] = x, y, z
    return matrix


async def test_a_planar_joint_is_fixed_as_in_the_original(
    robot: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    """kdl_parser makes it one: its link would otherwise be in no tree of frames."""
    planar = ARM.replace('name="screws" type="fixed"', 'name="screws" type="planar"')
    _, watcher = robot(robot_description=planar)
    await settle()

    assert [each.child_frame_id for each in watcher.fixed] == ["mount"]
    assert "unknown joint type of joint 'screws' into a fixed joint" in capsys.readouterr().err


async def test_of_two_positions_of_a_joint_the_first_counts(robot: Callable[..., Any]) -> None:
    """As in the original, whose map keeps what it has."""
    _, watcher = robot()
    watcher.joints.publish(
        JointState(header=Header(stamp=Time(sec=1)), name=["slide"] * 2, position=[0.25, 0.75])
    )
    await settle()

    hand = next(each for each in watcher.moved if each.child_frame_id == "hand")
    assert hand.transform.translation.y == pytest.approx(0.25)
