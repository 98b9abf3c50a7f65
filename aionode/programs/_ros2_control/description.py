"""The hardware components in the ``<ros2_control>`` tags of a robot description."""

from __future__ import annotations

import math
from collections.abc import MutableMapping
from dataclasses import dataclass, field
from typing import Final
from xml.etree import ElementTree as ET

from aionode.programs._urdf import Mimic, Robot, named

__all__ = ["Description", "HardwareComponent", "Interface", "Part"]


FOLLOWED: Final = ("position", "velocity", "acceleration", "effort")
"""The states in which a joint follows the one that it mimics."""


@dataclass(frozen=True)
class Interface:
    """A value of a joint, sensor or GPIO that controllers read or write.

    Attributes:
        name: Its full name, such as ``wheel/velocity``.
        data_type: ``double`` or ``bool``.
        initial: Its value at the start, NaN if none is given.
        least: Its minimum value.
        greatest: Its maximum value.
    """

    name: str
    data_type: str
    initial: float
    least: float = -math.inf
    greatest: float = math.inf


@dataclass(frozen=True)
class Part:
    """A joint, sensor or GPIO.

    Attributes:
        name: Its name.
        kind: ``joint``, ``sensor`` or ``gpio``.
        commands: The interfaces that controllers write.
        states: The interfaces that controllers read.
        mimic: The joint that it follows, if any.
    """

    name: str
    kind: str
    commands: list[Interface]
    states: list[Interface]
    mimic: Mimic | None

    def follow(self, states: MutableMapping[str, float]) -> None:
        """Update the states of a joint that mimics another one; other parts stay unchanged."""
        if self.mimic is None:
            return
        for each in self.states:
            kind = each.name.rpartition("/")[2]
            source = f"{self.mimic.joint}/{kind}"
            if kind in FOLLOWED and source in states:
                offset = self.mimic.offset if kind == "position" else 0.0
                states[each.name] = offset + self.mimic.multiplier * states[source]


@dataclass(frozen=True)
class HardwareComponent:
    """A ``<ros2_control>`` tag.

    Attributes:
        name: Its name.
        kind: ``system``, ``actuator`` or ``sensor``.
        plugin: The class that drives it.
        parameters: The parameters of that class.
        parts: Its joints, sensors and GPIOs.
    """

    name: str
    kind: str
    plugin: str
    parameters: dict[str, str]
    parts: list[Part]

    @property
    def commands(self) -> list[Interface]:
        """Its command interfaces."""
        return [each for part in self.parts for each in part.commands]

    @property
    def states(self) -> list[Interface]:
        """Its state interfaces."""
        return [each for part in self.parts for each in part.states]


@dataclass(frozen=True)
class Description:
    """A robot description.

    Attributes:
        robot: Its links and joints.
        components: Its hardware components.
    """

    robot: Robot
    components: list[HardwareComponent] = field(default_factory=list)

    @classmethod
    def of(cls, text: str) -> Description:
        """Parse a robot description.

        Raises:
            ValueError: It is not a URDF, or has no ``<ros2_control>`` that can be used.
        """
        robot = Robot.of(text)
        root = ET.fromstring(text)  # noqa: S314  # `Robot.of` has refused what could grow
        ranges = {named(joint): ranges_of(joint) for joint in root.findall("joint")}
        components = [component_of(tag, robot, ranges) for tag in root.findall("ros2_control")]
        if not components:
            raise ValueError("it has no <ros2_control>, so there is nothing to control")
        names = [component.name for component in components]
        if len(set(names)) < len(names):
            raise ValueError(f"two <ros2_control> have the same name: {', '.join(names)}")
        return cls(robot, components)


def component_of(
    tag: ET.Element, robot: Robot, ranges: dict[str, dict[str, tuple[float, float]]]
) -> HardwareComponent:
    """Return the component of a tag."""
    name = named(tag)
    hardware = tag.find("hardware")
    plugin = None if hardware is None else hardware.findtext("plugin")
    if hardware is None or not plugin:
        raise ValueError(f"<ros2_control name={name!r}> has no <plugin> in its <hardware>")
    parts = [
        part_of(each, robot, ranges.get(each.get("name", ""), {}))
        for each in tag
        if each.tag in ("joint", "sensor", "gpio")
    ]
    return HardwareComponent(
        name, tag.get("type", "system"), plugin.strip(), parameters_of(hardware), parts
    )


def part_of(tag: ET.Element, robot: Robot, ranges: dict[str, tuple[float, float]]) -> Part:
    """Return a joint, sensor or GPIO."""
    name = named(tag)
    joint = robot.joints.get(name)
    if tag.tag == "joint" and joint is None:
        raise ValueError(f"<ros2_control> has joint {name!r}, which the robot does not have")
    mimic = None if joint is None or tag.get("mimic") == "false" else joint.mimic
    given = parameters_of(tag)
    if "mimic" in given:  # as in Humble
        mimic = Mimic(given["mimic"], float(given.get("multiplier", 1)), 0.0)
    return Part(
        name,
        tag.tag,
        [interface_of(each, name, ranges) for each in tag.findall("command_interface")],
        [interface_of(each, name, {}) for each in tag.findall("state_interface")],
        mimic,
    )


def interface_of(tag: ET.Element, part: str, ranges: dict[str, tuple[float, float]]) -> Interface:
    """Return an interface; its own range takes precedence over the joint's limits."""
    kind = named(tag)
    name = f"{part}/{kind}"
    given = parameters_of(tag)
    least, greatest = ranges.get(kind, (-math.inf, math.inf))
    return Interface(
        name,
        tag.get("data_type", "double"),
        value_of(given.get("initial_value", "nan"), name),
        value_of(given["min"], name) if "min" in given else least,
        value_of(given["max"], name) if "max" in given else greatest,
    )


def ranges_of(joint: ET.Element) -> dict[str, tuple[float, float]]:
    """Return the ranges of a joint's values according to its limits."""
    limit = joint.find("limit")
    if limit is None:
        return {}
    name = named(joint)
    found = {}
    if joint.get("type") in ("revolute", "prismatic"):
        lower, upper = (value_of(limit.get(key, "0"), name) for key in ("lower", "upper"))
        found["position"] = (lower, upper)
    for key in ("velocity", "effort"):
        if key in limit.attrib:
            greatest = value_of(limit.attrib[key], name)
            found[key] = (-greatest, greatest)
    return found


def parameters_of(tag: ET.Element) -> dict[str, str]:
    """Return the ``<param>`` tags in a tag, and its ``<min>`` and ``<max>``."""
    return {
        each.get("name", "") if each.tag == "param" else each.tag: (each.text or "").strip()
        for each in tag
        if each.tag in ("param", "min", "max")
    }


def value_of(text: str, name: str) -> float:
    """Parse the value of an interface."""
    if text.lower() in ("true", "false"):
        return float(text.lower() == "true")
    try:
        return float(text or "nan")
    except ValueError:
        raise ValueError(f"{name}: {text!r} is not a number") from None
