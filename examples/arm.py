#!/usr/bin/env python3
"""Where is the gripper? An arm of six joints publishes transforms, and a program awaits one.

``Joints`` moves the joints, ``RobotState`` does what robot_state_publisher does: it reads the arm's
description, arm.urdf, and turns the angles of the joints into transforms. ``find_gripper`` knows
nothing of joints: it asks for the gripper in the map. Run it with ``python examples/arm.py``, and
look at it from another terminal with ``aionode tf tree``.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, sin, tau
from pathlib import Path
from xml.etree import ElementTree as ET

import aionode
from aionode import Node
from aionode.interfaces.geometry_msgs.msg import (
    PointStamped,
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
)
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import Header
from aionode.tf import Buffer, StaticTransformBroadcaster, TransformBroadcaster

RATE_HZ = 50.0
URDF = Path(__file__).with_name("arm.urdf")


@dataclass(frozen=True)
class Joint:
    """One joint of a URDF: where it sits in its parent, and the axis around which it turns."""

    name: str
    parent: str
    child: str
    origin: tuple[float, ...]
    axis: tuple[float, ...]
    is_fixed: bool

    def transform(self, angle: float, header: Header) -> TransformStamped:
        """Return the pose of the child in the parent when the joint is at an angle."""
        half, (x, y, z) = angle / 2, self.axis
        return TransformStamped(
            header=Header(stamp=header.stamp, frame_id=self.parent),
            child_frame_id=self.child,
            transform=Transform(
                translation=Vector3(x=self.origin[0], y=self.origin[1], z=self.origin[2]),
                rotation=Quaternion(x=x * sin(half), y=y * sin(half), z=z * sin(half), w=cos(half)),
            ),
        )


def joints_of(urdf: Path) -> list[Joint]:
    """Return the joints of a robot description."""
    found: list[Joint] = []
    # Those of transmissions and sensors, deeper in the file, only name joints.
    for joint in ET.parse(urdf).getroot().findall("joint"):  # noqa: S314  # our own file
        texts = {part.tag: part.attrib for part in joint}
        found.append(
            Joint(
                joint.attrib["name"],
                texts["parent"]["link"],
                texts["child"]["link"],
                numbers(texts.get("origin", {}).get("xyz", "0 0 0")),
                unit(numbers(texts.get("axis", {}).get("xyz", "1 0 0"))),
                joint.attrib["type"] == "fixed",
            )
        )
    return found


def unit(axis: tuple[float, ...]) -> tuple[float, ...]:
    """Return an axis normalized to length 1, since a URDF may give any length."""
    length = hypot(*axis)
    return tuple(part / length for part in axis) if length else axis


def numbers(text: str) -> tuple[float, ...]:
    """Return the numbers of an attribute."""
    return tuple(float(word) for word in text.split())


class Joints(Node):
    """Swings all joints, and publishes their positions on /joint_states."""

    def __init__(self) -> None:
        super().__init__("joints")
        self.names = [joint.name for joint in joints_of(URDF) if not joint.is_fixed]
        self.publisher = self.create_publisher(JointState, "joint_states", 10)
        self.steps = 0
        self.create_timer(1 / RATE_HZ, self.step)

    def step(self) -> None:
        """Publish the angles; each joint swings at its own pace."""
        self.steps += 1
        angles = [
            0.6 * sin(tau * self.steps / RATE_HZ / (4 + number))
            for number in range(len(self.names))
        ]
        header = Header(stamp=self.get_clock().now().to_msg())
        self.publisher.publish(JointState(header=header, name=self.names, position=angles))


class RobotState(Node):
    """Turns joint angles into transforms: those of fixed joints once, the others each time."""

    def __init__(self) -> None:
        super().__init__("robot_state")
        joints = joints_of(URDF)
        self.joints = {joint.name: joint for joint in joints if not joint.is_fixed}
        self.broadcaster = TransformBroadcaster(self)
        StaticTransformBroadcaster(self).sendTransform(
            [joint.transform(0.0, Header()) for joint in joints if joint.is_fixed]
        )
        self.create_subscription(JointState, "joint_states", self.on_joints, 10)

    def on_joints(self, msg: JointState) -> None:
        """Publish the transforms of the links."""
        self.broadcaster.sendTransform(
            [
                self.joints[name].transform(float(angle), msg.header)
                for name, angle in zip(msg.name, msg.position, strict=False)
                if name in self.joints
            ]
        )


async def find_gripper() -> None:
    """Await the pose of the gripper in the map, now and as it moves."""
    async with Joints(), RobotState(), Node("gripper_finder") as node:
        buffer = Buffer(node)
        found = await buffer.wait_for_transform("map", "gripper", timeout_sec=5.0)
        place = found.transform.translation
        print(f"gripper in the map: {place.x:.2f} {place.y:.2f} {place.z:.2f}", flush=True)

        now = node.get_clock().now()  # the joints of this moment are published a little later
        cup = PointStamped(header=Header(stamp=now.to_msg(), frame_id="map"))
        cup.point.x, cup.point.y = 3.0, 1.0
        seen = await buffer.transform(cup, "gripper", timeout_sec=5.0)
        at = seen.point
        print(f"cup in the gripper: {at.x:.2f} {at.y:.2f} {at.z:.2f}", flush=True)

        count = 0
        async for stamped in buffer.follow("map", "gripper"):
            count += 1
            if count % int(RATE_HZ) == 0:
                print(f"height of the gripper: {stamped.transform.translation.z:.2f}", flush=True)


if __name__ == "__main__":
    aionode.run(find_gripper)
