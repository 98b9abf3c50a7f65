"""``joint_state_publisher``: publishes the states of all joints, even unmeasured ones."""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from typing import Any

import aionode
from aionode import DurabilityPolicy, Node, QoSProfile
from aionode._process.bounded_files import read_file
from aionode.arguments import remove_ros_args
from aionode.errors import CommandError
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.logging import get_logger
from aionode.programs._urdf import Joint, Mimic, Robot

__all__ = ["JointStatePublisher", "main"]

DEFAULTS: dict[str, Any] = {
    "publish_default_efforts": False,
    "publish_default_positions": True,
    "publish_default_velocities": False,
    "rate": 10,
    "source_list": [],
    "use_mimic_tags": True,
    "use_smallest_joint_limits": True,
    "delta": 0.0,
}


@dataclass
class State:
    """The state of a joint that follows no other one.

    Attributes:
        least: Its minimum position.
        greatest: Its maximum position.
        is_endless: Whether it rotates without limits.
        position: Its position; None if unknown.
        velocity: Its velocity; None if unknown.
        effort: Its effort; None if unknown.
        is_rising: The direction in which `delta` moves it.
    """

    least: float
    greatest: float
    is_endless: bool
    position: float | None
    velocity: float | None
    effort: float | None
    is_rising: bool = True

    def move(self, delta: float) -> None:
        """Move it by a step, to and fro between its limits, or around."""
        if self.position is None:
            return
        self.position += delta if self.is_rising else -delta
        if self.position > self.greatest:
            self.position = self.least if self.is_endless else self.greatest
            self.is_rising = self.is_endless
        elif self.position < self.least:
            self.position = self.least
            self.is_rising = True


class JointStatePublisher(Node):
    """Publishes `joint_states` for all movable joints of a published description.

    Args:
        file: A file with the description, instead of waiting for it.

    Raises:
        CommandError: There is no such file, it is not a URDF, or a parameter is invalid.
    """

    def __init__(self, file: str | None = None) -> None:
        super().__init__(
            "joint_state_publisher", automatically_declare_parameters_from_overrides=True
        )
        self.values = {name: self.given(name, value) for name, value in DEFAULTS.items()}
        self.joints: list[str] = []
        self.states: dict[str, State] = {}
        self.followers: dict[str, Mimic] = {}
        self.given_followers = self._given_followers()
        self.zeros = {
            name: self.number(f"zeros.{name}", parameter.value)
            for name, parameter in self.get_parameters_by_prefix("zeros").items()
        }
        if file is not None:
            try:
                self.use(read_file(file).decode())
            except (OSError, ValueError) as error:
                raise CommandError(f"{file}: {error}") from None
        else:
            self.get_logger().info(
                "Waiting for robot_description to be published on the robot_description topic..."
            )
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(String, "robot_description", self.on_description, latched)
        for source in self.values["source_list"]:
            self.create_subscription(JointState, source, self.on_source, 10)
        self.publisher = self.create_publisher(JointState, "joint_states", 10)
        rate = self.values["rate"]
        if not isinstance(rate, int | float) or not 0 < rate < math.inf:
            raise CommandError(f"rate is {rate!r}; use a number above 0")
        self.create_timer(1.0 / rate, self.publish)

    def given(self, name: str, default: Any) -> Any:
        """Return the value of a parameter, which is read at the start only, as in the original.

        Raises:
            CommandError: It has another type than the default.
        """
        if not self.has_parameter(name):
            is_dynamic = default == []  # the type of its elements is unknown
            descriptor = ParameterDescriptor(dynamic_typing=is_dynamic)
            return self.declare_parameter(name, default, descriptor).value
        value = self.get_parameter(name).value
        kinds = (int, float) if type(default) in (int, float) else (type(default),)
        if type(value) not in kinds or (default == [] and not all(type(x) is str for x in value)):
            fits = {bool: "true or false", list: "a list of topics"}.get(type(default), "a number")
            raise CommandError(f"{name} is {value!r}; use {fits}")
        return value

    def _given_followers(self) -> dict[str, Mimic]:
        """Return the joints that follow others according to parameters.

        Raises:
            CommandError: They are not as documented.
        """
        parts: dict[str, dict[str, Any]] = {}
        for name, parameter in self.get_parameters_by_prefix("dependent_joints").items():
            joint, _, part = name.rpartition(".")
            if not joint:
                raise CommandError(f"Invalid dependent_joint name '{name}'")
            if part not in ("parent", "factor", "offset"):
                raise CommandError(
                    f"Invalid dependent_joint name '{part}' (allowed values are 'parent', "
                    "'factor', 'offset')"
                )
            parts.setdefault(joint, {})[part] = parameter.value
        if any("parent" not in given for given in parts.values()):
            raise CommandError("All dependent_joints must at least have a parent")
        return {
            joint: Mimic(
                str(given["parent"]),
                self.number(f"dependent_joints.{joint}.factor", given.get("factor", 1.0)),
                self.number(f"dependent_joints.{joint}.offset", given.get("offset", 0.0)),
            )
            for joint, given in parts.items()
        }

    @staticmethod
    def number(name: str, value: Any) -> float:
        """Return the value of a parameter as a number.

        Raises:
            CommandError: It is not a number.
        """
        if type(value) not in (int, float) or not math.isfinite(value):
            raise CommandError(f"{name} is {value!r}; use a number")
        return float(value)

    def use(self, text: str) -> None:
        """Use a description.

        Raises:
            ValueError: It is not a URDF.
        """
        robot = Robot.of(text)
        moved = [joint for joint in robot.joints.values() if joint.is_moved]
        followers = {
            joint.name: joint.mimic
            for joint in moved
            if joint.mimic is not None and self.values["use_mimic_tags"]
        } | {name: given for name, given in self.given_followers.items() if name in robot.joints}
        for name in followers:
            leader(name, followers)  # refuses joints that follow each other
        self.joints = [joint.name for joint in moved]
        self.followers = followers
        self.states = {
            joint.name: self.state(joint) for joint in moved if joint.name not in followers
        }

    def state(self, joint: Joint) -> State:
        """Return the initial state of a joint: at zero, or in its middle if it cannot be there."""
        least, greatest = joint.limits or (-math.pi, math.pi)
        if self.values["use_smallest_joint_limits"]:
            soft_least, soft_greatest = joint.soft_limits
            least = least if soft_least is None else max(least, soft_least)
            greatest = greatest if soft_greatest is None else min(greatest, soft_greatest)
        zero = (least + greatest) / 2 if least > 0 or greatest < 0 else 0.0
        zero = self.zeros.get(joint.name, zero)
        return State(
            least,
            greatest,
            joint.kind == "continuous",
            zero if self.values["publish_default_positions"] else None,
            0.0 if self.values["publish_default_velocities"] else None,
            0.0 if self.values["publish_default_efforts"] else None,
        )

    def on_description(self, msg: String) -> None:
        """Handle a published description."""
        try:
            self.use(msg.data)
        except ValueError as error:
            self.get_logger().warning(f"robot_description is not used: {error}")

    def on_source(self, msg: JointState) -> None:
        """Adopt the joint states of another topic, as far as it has them."""
        for part in ("position", "velocity", "effort"):
            values = getattr(msg, part).tolist()
            for name, value in zip(msg.name, values, strict=False):
                if name in self.states:
                    setattr(self.states[name], part, value)

    def publish(self) -> None:
        """Publish the states of all joints."""
        if not self.joints:
            return
        delta = self.values["delta"]
        if delta > 0:
            for state in self.states.values():
                state.move(delta)
        msg = JointState(header=Header(stamp=self.get_clock().now().to_msg()), name=self.joints)
        led = [leader(name, self.followers) for name in self.joints]
        states = [(self.states.get(mimic.joint), mimic) for mimic in led]
        for part in ("position", "velocity", "effort"):
            known = any(getattr(state, part) is not None for state in self.states.values())
            if known or (part == "position" and self.followers):
                setattr(msg, part, [part_of(part, state, mimic) for state, mimic in states])
        self.publisher.publish(msg)


def leader(name: str, followers: dict[str, Mimic]) -> Mimic:
    """Return the joint that a joint ultimately follows, itself if none, and how.

    Raises:
        ValueError: It follows itself.
    """
    factor, offset = 1.0, 0.0
    chain = [name]
    while chain[-1] in followers:
        mimic = followers[chain[-1]]
        offset += factor * mimic.offset
        factor *= mimic.multiplier
        chain.append(mimic.joint)
        if mimic.joint in chain[:-1]:
            raise ValueError(f"Found an infinite recursive mimic chain: {chain}")
    return Mimic(chain[-1], factor, offset)


def part_of(part: str, state: State | None, mimic: Mimic) -> float:
    """Return a value of a joint that follows another one; 0 if unknown."""
    value: float | None = None if state is None else getattr(state, part)
    if value is None:
        return 0.0
    if part == "position":
        return value * mimic.multiplier + mimic.offset
    return value * mimic.multiplier if part == "velocity" else value


def main() -> None:
    """Run the node until Ctrl-C; it also replaces the one with a window."""
    if sys.argv[0] == "joint_state_publisher_gui":
        get_logger("joint_state_publisher").warning(
            "the window with the sliders is not available: joints stay at zero, or where the "
            "topics of the parameter 'source_list' put them"
        )
    parser = argparse.ArgumentParser(prog="joint_state_publisher")
    parser.add_argument("description_file", help="Robot description file to use", nargs="?")
    file = parser.parse_args(remove_ros_args(sys.argv)[1:]).description_file
    aionode.run(lambda: JointStatePublisher(file))
