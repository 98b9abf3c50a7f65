"""The links and joints of a URDF robot description, as read by urdfdom and kdl_parser."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final
from xml.etree import ElementTree as ET

from aionode._process.bounded_files import LFS_POINTER, is_lfs_pointer
from aionode.tf.apply import Pose, composed, from_angles

__all__ = ["Joint", "Mimic", "Robot"]

Vector = tuple[float, float, float]

MAX_BYTES: Final = 20_000_000
"""Maximum length of a description; with meshes in other files they have at most a few MB."""

KINDS: Final = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")


@dataclass(frozen=True)
class Mimic:
    """A joint that follows another one.

    Attributes:
        joint: The name of the joint that it follows.
        multiplier: The factor for that joint's position.
        offset: The offset added afterwards.
    """

    joint: str
    multiplier: float
    offset: float


@dataclass(frozen=True)
class Joint:
    """A joint between two links.

    Attributes:
        name: Its name.
        kind: revolute, continuous, prismatic, fixed, floating or planar.
        parent: Its parent link.
        child: The link that it moves.
        origin: The pose of the child in the parent at position 0.
        axis: The unit axis of its rotation or translation, in the child's frame.
        limits: The minimum and maximum position; None if it rotates without limits, or is fixed.
        soft_limits: The limits of its safety controller, if any.
        mimic: The joint that it follows, if any.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: Pose
    axis: Vector
    limits: tuple[float, float] | None
    soft_limits: tuple[float | None, float | None]
    mimic: Mimic | None

    @property
    def is_moved(self) -> bool:
        """Whether its position is a number."""
        return self.kind in ("revolute", "continuous", "prismatic")

    def pose(self, position: float) -> Pose:
        """Return the pose of the child in the parent, at a position."""
        x, y, z = self.axis
        if self.kind == "prismatic":
            moved = (x * position, y * position, z * position, 0.0, 0.0, 0.0, 1.0)
            return composed(self.origin, moved)
        if self.kind in ("revolute", "continuous"):
            sine, cosine = math.sin(position / 2), math.cos(position / 2)
            return composed(self.origin, (0.0, 0.0, 0.0, x * sine, y * sine, z * sine, cosine))
        return self.origin


@dataclass(frozen=True)
class Robot:
    """The joints of a robot, by name, in the order of its description."""

    joints: dict[str, Joint]

    @classmethod
    def of(cls, text: str) -> Robot:
        """Parse a URDF description.

        Raises:
            ValueError: It is not valid URDF; the text says why.
        """
        if is_lfs_pointer(text.encode(errors="replace")):
            raise ValueError(f"it is {LFS_POINTER}")
        if len(text) > MAX_BYTES:
            raise ValueError(f"it has {len(text)} characters; at most {MAX_BYTES} are allowed")
        if "<!ENTITY" in text:
            raise ValueError("it defines entities, which can grow without end")
        try:
            root = ET.fromstring(text)  # noqa: S314  # entities are refused above
        except ET.ParseError as error:
            raise ValueError(f"it is not XML: {error}") from None
        if root.tag != "robot":
            raise ValueError(f"its root is <{root.tag}>, not <robot>")
        links = [named(link) for link in root.findall("link")]
        if not links:
            raise ValueError("it has no links")
        joints: dict[str, Joint] = {}
        for element in root.findall("joint"):
            joint = joint_of(element)
            if joint.name in joints:
                raise ValueError(f"joint {joint.name!r} is defined twice")
            joints[joint.name] = joint
        refuse_what_is_no_tree(links, joints)
        return cls(joints)

    def position(self, name: str, positions: dict[str, float]) -> float | None:
        """Return a joint's position: its own, or that of the joint it follows, directly or not.

        Returns None if `positions` has none of these.
        """
        factor, offset = 1.0, 0.0
        for _ in self.joints:  # a chain of followers cannot be longer
            if name in positions:
                return positions[name] * factor + offset
            mimic = self.joints[name].mimic if name in self.joints else None
            if mimic is None:
                return None
            offset += factor * mimic.offset
            factor *= mimic.multiplier
            name = mimic.joint
        return None


def joint_of(element: ET.Element) -> Joint:
    """Return a joint."""
    name = named(element)
    kind = element.get("type", "")
    if kind not in KINDS:
        raise ValueError(f"joint {name!r} has the type {kind!r}; use one of {', '.join(KINDS)}")
    parent, child = (link_of(element, part, name) for part in ("parent", "child"))
    origin = element.find("origin")
    if origin is None:
        origin = ET.Element("origin")
    roll, pitch, yaw = vector(origin.get("rpy", "0 0 0"), name)
    axis = element.find("axis")
    x, y, z = vector("1 0 0" if axis is None else axis.get("xyz", "1 0 0"), name)
    length = math.hypot(x, y, z)
    if not length and kind in ("revolute", "continuous", "prismatic"):
        raise ValueError(f"joint {name!r} has an axis without length")
    length = length or 1.0
    safety = element.find("safety_controller")
    soft = {} if safety is None else safety.attrib
    return Joint(
        name,
        kind,
        parent,
        child,
        (*vector(origin.get("xyz", "0 0 0"), name), *from_angles(roll, pitch, yaw)),
        (x / length, y / length, z / length),
        limits_of(element, kind, name),
        (
            number(soft["soft_lower_limit"], name) if "soft_lower_limit" in soft else None,
            number(soft["soft_upper_limit"], name) if "soft_upper_limit" in soft else None,
        ),
        mimic_of(element, name),
    )


def limits_of(element: ET.Element, kind: str, name: str) -> tuple[float, float] | None:
    """Return the limits of a joint: some kinds need them."""
    if kind not in ("revolute", "prismatic"):
        return None
    limit = element.find("limit")
    if limit is None:
        raise ValueError(f'Limits must be specified for joint "{name}" of type "{kind}"')
    return number(limit.get("lower", "0"), name), number(limit.get("upper", "0"), name)


def mimic_of(element: ET.Element, name: str) -> Mimic | None:
    """Return what a joint follows."""
    mimic = element.find("mimic")
    if mimic is None:
        return None
    if not mimic.get("joint"):
        raise ValueError(f"joint {name!r} mimics no joint: 'joint' is missing")
    return Mimic(
        mimic.get("joint", ""),
        number(mimic.get("multiplier", "1"), name),
        number(mimic.get("offset", "0"), name),
    )


def refuse_what_is_no_tree(links: list[str], joints: dict[str, Joint]) -> None:
    """Raise unless every link except one is the child of exactly one joint."""
    parents: dict[str, str] = {}
    for joint in joints.values():
        for link in (joint.parent, joint.child):
            if link not in links:
                raise ValueError(f"joint {joint.name!r} names link {link!r}, which does not exist")
        if joint.child in parents:
            raise ValueError(f"link {joint.child!r} is the child of two joints")
        parents[joint.child] = joint.parent
    roots = [link for link in links if link not in parents]
    if not roots:
        raise ValueError("its links form a loop, so there is no root")
    if len(roots) > 1:
        raise ValueError(f"it has two roots, {roots[0]!r} and {roots[1]!r}")
    for link in links:
        seen = set()
        while link in parents and link not in seen:
            seen.add(link)
            link = parents[link]  # noqa: PLW2901  # on the way to the root
        if link in seen:
            raise ValueError(f"its links form a loop at {link!r}")


def named(element: ET.Element) -> str:
    """Return the name of a link or joint."""
    name = element.get("name")
    if not name:
        raise ValueError(f"a <{element.tag}> has no name")
    return name


def link_of(element: ET.Element, part: str, name: str) -> str:
    """Return the parent or the child of a joint."""
    found = element.find(part)
    if found is None or not found.get("link"):
        raise ValueError(f"joint {name!r} has no {part} link")
    return found.get("link", "")


def vector(text: str, name: str) -> Vector:
    """Return three numbers."""
    words = text.split()
    if len(words) != 3:
        raise ValueError(f"joint {name!r}: {text!r} is not three numbers")
    x, y, z = (number(word, name) for word in words)
    return x, y, z


def number(text: str, name: str) -> float:
    """Parse a finite number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"joint {name!r}: {text!r} is not a number")
    return value
