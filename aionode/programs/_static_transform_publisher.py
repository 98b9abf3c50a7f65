"""``tf2_ros static_transform_publisher``: publishes one transform that never changes."""

from __future__ import annotations

import math
import random
import string
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import aionode
from aionode import Node, Parameter
from aionode.arguments import remove_ros_args
from aionode.errors import CommandError
from aionode.interfaces.geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor
from aionode.tf import StaticTransformBroadcaster
from aionode.tf.apply import given_transform

__all__ = ["Given", "StaticTransformPublisher", "main"]

USAGE: Final = """\
usage: static_transform_publisher [--x X] [--y Y] [--z Z] [--qx QX] [--qy QY] [--qz QZ] [--qw QW]
                                  [--roll ROLL] [--pitch PITCH] [--yaw YAW]
                                  --frame-id FRAME_ID --child-frame-id CHILD_FRAME_ID

Publishes a transform that never changes; without a translation and rotation, the identity.
Translations are in metres. The rotation is a quaternion, or roll, pitch and yaw in radians.

required arguments:
  --frame-id FRAME_ID              parent frame
  --child-frame-id CHILD_FRAME_ID  child frame

optional arguments:
  --x X  --y Y  --z Z                    translation
  --qx QX  --qy QY  --qz QZ  --qw QW     rotation as a quaternion
  --roll ROLL  --pitch PITCH  --yaw YAW  rotation as Euler angles
"""

TRANSLATION: Final = ("x", "y", "z")
QUATERNION: Final = ("qx", "qy", "qz", "qw")
ANGLES: Final = ("roll", "pitch", "yaw")
FRAMES: Final = ("frame-id", "child-frame-id")
OLD_STYLES: Final = {
    8: (*TRANSLATION, "yaw", "pitch", "roll", *FRAMES),
    9: (*TRANSLATION, *QUATERNION, *FRAMES),
}
"""The meaning of positional values, by their number."""

DEFAULTS: Final[dict[str, float | str]] = {
    **dict.fromkeys(("translation.x", "translation.y", "translation.z"), 0.0),
    **dict.fromkeys(("rotation.x", "rotation.y", "rotation.z"), 0.0),
    "rotation.w": 1.0,
    "frame_id": "/frame",
    "child_frame_id": "/child",
}
"""The parameters, which define the transform of a node in a container."""

LENGTH_TOLERANCE: Final = 0.01
"""Tolerance for the squared length of a quaternion; tf2 ignores others."""


@dataclass
class Given:
    """The parsed arguments.

    Attributes:
        translation: x, y and z in metres.
        rotation: x, y, z and w of the quaternion.
        frame_id: The parent frame.
        child_frame_id: The child frame.
        is_old_style: Whether values are positional instead of options.
    """

    translation: tuple[float, ...]
    rotation: tuple[float, ...]
    frame_id: str
    child_frame_id: str
    is_old_style: bool = False

    @classmethod
    def of(cls, args: Sequence[str]) -> Given:
        """Parse arguments in either style.

        Raises:
            ValueError: They are invalid.
        """
        options, others = separated(args)
        values = options
        if len(others) in OLD_STYLES:
            if options:
                raise ValueError("Cannot specify both new-style (flags) and old-style (arguments)")
            values = dict(zip(OLD_STYLES[len(others)], others, strict=True))
        elif others:
            raise ValueError("Extra unparsed arguments on command-line")
        dashes = "" if others else "--"
        numbers = {
            name: number(dashes + name, text) for name, text in values.items() if name not in FRAMES
        }
        if not numbers.keys().isdisjoint(QUATERNION) and not numbers.keys().isdisjoint(ANGLES):
            raise ValueError("Cannot specify both quaternion and Euler rotations")
        frame_id, child_frame_id = (values.get(name, "") for name in FRAMES)
        if not frame_id:
            raise ValueError("Frame id must not be empty")
        if not child_frame_id:
            raise ValueError("Child frame id must not be empty")
        translation, rotation = given_transform(numbers)
        return cls(translation, rotation, frame_id, child_frame_id, bool(others))

    def parameters(self) -> list[Parameter]:
        """Return the transform as the parameters of `DEFAULTS`."""
        values = *self.translation, *self.rotation, self.frame_id, self.child_frame_id
        return [Parameter(name, value=value) for name, value in zip(DEFAULTS, values, strict=True)]


def separated(args: Sequence[str]) -> tuple[dict[str, str], list[str]]:
    """Separate the values of options, by name, from all other arguments."""
    options: dict[str, str] = {}
    others = []
    rest = list(args)
    while rest:
        word = rest.pop(0)
        name = word.removeprefix("--")
        if word == name or name not in {*TRANSLATION, *QUATERNION, *ANGLES, *FRAMES}:
            others.append(word)
        elif not rest:
            raise ValueError(f"Not enough arguments for {word}")
        else:
            options[name] = rest.pop(0)
    return options, others


def number(name: str, text: str) -> float:
    """Parse a number in an argument."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"Failed to parse {name} argument as float")
    return value


class StaticTransformPublisher(Node):
    """Publishes one transform on /tf_static, defined by its read-only parameters.

    Args:
        given: The transform; by default that of the parameters.

    Raises:
        CommandError: Parent and child are the same frame.
    """

    def __init__(self, given: Given | None = None) -> None:
        letters = random.choices(string.ascii_letters + string.digits, k=16)  # noqa: S311  # a name
        super().__init__(
            f"static_transform_publisher_{''.join(letters)}",
            parameter_overrides=[] if given is None else given.parameters(),
        )
        values = {
            name: self.declare_parameter(name, value, ParameterDescriptor(read_only=True)).value
            for name, value in DEFAULTS.items()
        }
        if given is None:
            given = Given(
                tuple(values[f"translation.{axis}"] for axis in "xyz"),
                tuple(values[f"rotation.{axis}"] for axis in "xyzw"),
                values["frame_id"],
                values["child_frame_id"],
            )
        log = self.get_logger()
        if given.is_old_style:
            log.warning("Old-style arguments are deprecated; see --help for new-style arguments")
        if given.frame_id == given.child_frame_id:
            raise CommandError(
                f"cannot publish static transform from '{given.frame_id}' to "
                f"'{given.child_frame_id}': child_frame_id cannot equal frame_id"
            )
        length = math.hypot(*given.rotation)
        if abs(length**2 - 1.0) > LENGTH_TOLERANCE:
            log.warning(
                f"The quaternion has the length {length:g}; listeners ignore this transform, as "
                "they accept only rotations of length 1"
            )
        self._publish(given)
        translation = ", ".join(f"'{value:f}'" for value in given.translation)
        rotation = ", ".join(f"'{value:f}'" for value in given.rotation)
        log.info(
            f"Spinning until stopped - publishing transform\ntranslation: ({translation})\n"
            f"rotation: ({rotation})\nfrom '{given.frame_id}' to '{given.child_frame_id}'"
        )

    def _publish(self, given: Given) -> None:
        """Publish the transform, which is kept for late subscriptions."""
        x, y, z = given.translation
        qx, qy, qz, qw = given.rotation
        stamped = TransformStamped(
            child_frame_id=given.child_frame_id,
            transform=Transform(
                translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw)
            ),
        )
        stamped.header.frame_id = given.frame_id
        stamped.header.stamp = self.get_clock().now().to_msg()
        StaticTransformBroadcaster(self).sendTransform(stamped)


def main() -> None:
    """Publish the transform given by the arguments, until Ctrl-C.

    Raises:
        SystemExit: With status 1 if they are invalid.
    """
    args = remove_ros_args(sys.argv)[1:]
    if not {"-h", "--help"}.isdisjoint(args):
        sys.stdout.write(USAGE)
        return
    try:
        given = Given.of(args)
    except ValueError as error:
        sys.stderr.write(f"error parsing command line arguments: {error}\n{USAGE}")
        raise SystemExit(1) from None
    aionode.run(lambda: StaticTransformPublisher(given))
