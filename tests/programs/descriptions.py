"""Compares where robot_state_publisher puts links with a matrix computation, for many robots.

``make descriptions FOLDER=…`` takes each ``*.urdf`` of a folder, such as those in the wheels of
PyPI's ``example-robot-data`` and ``pybullet``. For ten configurations of each robot, the pose of
every link in the root is computed from the joints of `aionode.programs`, and from the numbers of
the description by matrices alone; they may differ by 1e-9. A description that is refused is printed
with the reason.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from pathlib import Path
from typing import Any, Final
from xml.etree import ElementTree as ET

import numpy as np

from aionode.programs._urdf import Joint, Robot
from tests.programs.test_robot_state_publisher import matrix_of_pose, rotation

LIMIT: Final = 1e-9
CONFIGURATIONS: Final = 10


def matrix_of(element: ET.Element, position: float) -> Any:
    """Return the pose of a joint's child in its parent, by matrices alone."""
    parts = {each.tag: each.attrib for each in element}
    origin = parts.get("origin", {})
    roll, pitch, yaw = (float(word) for word in origin.get("rpy", "0 0 0").split())
    axis = np.array([float(word) for word in parts.get("axis", {}).get("xyz", "1 0 0").split()])
    pose = np.eye(4)
    pose[:3, :3] = rotation([0, 0, 1], yaw) @ rotation([0, 1, 0], pitch) @ rotation([1, 0, 0], roll)
    pose[:3, 3] = [float(word) for word in origin.get("xyz", "0 0 0").split()]
    motion = np.eye(4)
    if element.get("type") in {"revolute", "continuous"}:
        motion[:3, :3] = rotation(axis / np.linalg.norm(axis), position)
    elif element.get("type") == "prismatic":
        motion[:3, 3] = axis / np.linalg.norm(axis) * position
    return pose @ motion


def places(joints: dict[str, tuple[str, str]], poses: dict[str, Any]) -> dict[str, Any]:
    """Return the pose of each link in the root of its tree."""
    of_child = {child: (parent, name) for name, (parent, child) in joints.items()}

    def place(link: str) -> Any:
        if link not in of_child:
            return np.eye(4)
        parent, name = of_child[link]
        return place(parent) @ poses[name]

    return {child: place(child) for child in of_child}


def difference(text: str, described: Robot, seed: int) -> float:
    """Return by how much a link lies elsewhere, at most."""
    random_ = random.Random(seed)  # noqa: S311  # configurations
    elements = {each.get("name", ""): each for each in ET.fromstring(text).findall("joint")}  # noqa: S314  # the reader has taken it
    joints = {joint.name: (joint.parent, joint.child) for joint in described.joints.values()}
    most = 0.0
    for _ in range(CONFIGURATIONS):
        at = {name: random_.uniform(-3, 3) for name in joints}
        found = {name: own_matrix(described.joints[name], at[name]) for name in joints}
        expected = {name: matrix_of(elements[name], at[name]) for name in joints}
        ours, theirs = places(joints, found), places(joints, expected)
        most = max([most, *(float(abs(ours[link] - theirs[link]).max()) for link in ours)])
    return most


def own_matrix(joint: Joint, position: float) -> Any:
    """Return what robot_state_publisher computes."""
    return matrix_of_pose(joint.pose(position))


def main(folders: list[str]) -> int:
    """Compare all; the result is the exit status."""
    counts: Counter[str] = Counter()
    worst = 0.0
    for file in sorted({file for folder in folders for file in Path(folder).rglob("*.urdf")}):
        text = file.read_text(encoding="utf-8", errors="replace")
        try:
            described = Robot.of(text)
        except ValueError as error:
            counts["refused"] += 1
            print(f"{file}: refused: {error}")  # noqa: T201  # a program prints
            continue
        most = difference(text, described, len(text))
        worst = max(worst, most)
        counts["equal" if most <= LIMIT else "different"] += 1
        counts["joints"] += len(described.joints)
        if most > LIMIT:
            print(f"{file}: differs by {most}")  # noqa: T201  # as above
    print(f"{dict(counts)}; the largest difference is {worst:.1e}")  # noqa: T201  # as above
    return 1 if counts["different"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
