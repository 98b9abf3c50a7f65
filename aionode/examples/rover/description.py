"""The description: the rover's URDF, and the transforms that follow from it.

Run it with ``python -m aionode.examples.rover.description``.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree as ET

import aionode
from aionode import DurabilityPolicy, Node, QoSProfile
from aionode.interfaces.geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.tf import StaticTransformBroadcaster, TransformBroadcaster

__all__ = ["Description"]

URDF = Path(__file__).with_name("rover.urdf")
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Joint(NamedTuple):
    """The pose of one link in another; a wheel turns around the y axis."""

    name: str
    parent: str
    child: str
    origin: tuple[float, ...]
    is_fixed: bool

    def transform(self, angle: float, header: Header) -> TransformStamped:
        """Return the pose of the child when the joint is at an angle."""
        x, y, z = self.origin
        stamped = TransformStamped(child_frame_id=self.child)
        stamped.header.stamp = header.stamp
        stamped.header.frame_id = self.parent
        stamped.transform.translation = Vector3(x=x, y=y, z=z)
        stamped.transform.rotation = Quaternion(y=math.sin(angle / 2), w=math.cos(angle / 2))
        return stamped


class Description(Node):
    """Publishes the URDF once (latched), and the transforms of the rover's links."""

    def __init__(self, **options: Any) -> None:
        super().__init__("description", **options)
        urdf = URDF.read_text(encoding="utf-8")
        joints = joints_of(urdf)
        self.wheels = {joint.name: joint for joint in joints if not joint.is_fixed}
        self.transforms = TransformBroadcaster(self)
        self.descriptions = self.create_publisher(String, "/robot_description", LATCHED)
        self.descriptions.publish(String(data=urdf))
        StaticTransformBroadcaster(self).sendTransform(
            [joint.transform(0.0, Header()) for joint in joints if joint.is_fixed]
        )
        self.create_subscription(JointState, "/joint_states", self.turn, 10)

    def turn(self, msg: JointState) -> None:
        """Publish the transforms of the wheels."""
        self.transforms.sendTransform(
            [
                self.wheels[name].transform(float(angle), msg.header)
                for name, angle in zip(msg.name, msg.position, strict=True)
            ]
        )


def joints_of(urdf: str) -> list[Joint]:
    """Return the joints of a URDF."""
    found = []
    for joint in ET.fromstring(urdf).findall("joint"):  # noqa: S314  # our own file
        parts = {part.tag: part.attrib for part in joint}
        xyz = parts.get("origin", {}).get("xyz", "0 0 0")
        found.append(
            Joint(
                joint.attrib["name"],
                parts["parent"]["link"],
                parts["child"]["link"],
                tuple(map(float, xyz.split())),
                joint.attrib["type"] == "fixed",
            )
        )
    return found


if __name__ == "__main__":
    aionode.run(Description)
