"""``tf2_ros tf2_echo``: prints a transform repeatedly."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable, Sequence
from typing import Final

import aionode
from aionode import Node
from aionode.arguments import remove_ros_args
from aionode.interfaces.geometry_msgs.msg import TransformStamped
from aionode.programs._wall_timer import create_wall_timer
from aionode.tf import Buffer, TransformException, rotation_matrix
from aionode.tf.apply import angles_of

__all__ = ["Echo", "main", "text_of"]

USAGE: Final = """\
Usage: tf2_echo source_frame target_frame [echo_rate]

This will echo the transform from the coordinate frame of the source_frame
to the coordinate frame of the target_frame.
Note: This is the transform to get data from target_frame into the source_frame.
Default echo rate is 1 if echo_rate is not given.
"""

WAITING_SEC: Final = 1.0
"""Shortest interval at which it prints that it is waiting."""


def text_of(transform: TransformStamped) -> str:
    """Return a transform as printed."""

    def row(numbers: Sequence[float]) -> str:
        return ", ".join(f"{number:.3f}" for number in numbers)

    stamp = transform.header.stamp
    place, rotation = transform.transform.translation, transform.transform.rotation
    translation = place.x, place.y, place.z
    matrix = rotation_matrix(rotation)
    angles = angles_of(matrix)
    lines = [
        f"At time {stamp.sec}.{stamp.nanosec}",
        f"- Translation: [{row(translation)}]",
        f"- Rotation: in Quaternion [{row((rotation.x, rotation.y, rotation.z, rotation.w))}]",
        f"- Rotation: in RPY (radian) [{row(angles)}]",
        f"- Rotation: in RPY (degree) [{row([math.degrees(angle) for angle in angles])}]",
        "- Matrix:",
    ]
    rows = [[*turn, shift] for turn, shift in zip(matrix, translation, strict=True)]
    lines += [
        "".join(f" {number:6.3f}" for number in numbers)
        for numbers in [*rows, [0.0, 0.0, 0.0, 1.0]]
    ]
    return "\n".join(lines) + "\n"


class Echo(Node):
    """Shows the transform that expresses in one frame what is given in another.

    Args:
        frames: The frame to express things in, and the frame that they are in.
        rate: How often, in Hz.
        show: Called with each text.
    """

    def __init__(self, frames: tuple[str, str], rate: float, show: Callable[[str], object]) -> None:
        super().__init__("tf2_echo")
        self.frames = frames
        self.show = show
        self.buffer = Buffer(self)
        self.has_begun = False
        self.tick()
        create_wall_timer(self, 1.0 / rate, self.tick)

    def tick(self) -> None:
        """Show the transform, or wait for the first one."""
        into, out_of = self.frames
        if not self.has_begun:
            can, why = self.buffer.can_transform_core(into, out_of, aionode.Time())
            if not can:
                self.get_logger().info(
                    f"Waiting for transform {into} ->  {out_of}: {why}",
                    throttle_duration_sec=WAITING_SEC,
                )
                return
            self.has_begun = True
        try:
            self.show(text_of(self.buffer.lookup_transform(into, out_of)))
        except TransformException as error:
            now = self.get_clock().now().nanoseconds / 1e9
            self.show(
                f"Failure at {now:.3f}\nException thrown:{error}\n"
                f"The current list of frames is:\n{self.buffer.all_frames_as_string()}\n"
            )


def show(text: str) -> None:
    """Write a text to stdout."""
    sys.stdout.write(text)
    sys.stdout.flush()


def main() -> None:
    """Print the transform named by the arguments until Ctrl-C.

    Raises:
        SystemExit: With status 1: there are too few or too many arguments; 2: the rate is not a
            number; 3: it only begins with one.
    """
    words = remove_ros_args(sys.argv)[1:]
    if len(words) not in (2, 3):
        sys.stdout.write(USAGE)
        raise SystemExit(1)
    given = words[2] if len(words) == 3 else "1.0"
    try:
        rate = float(given)
    except ValueError:
        rate = 0.0
    if not 0.0 < rate < math.inf:
        sys.stderr.write(
            f"Failed to convert rate argument '{given}' to a floating-point number above 0\n"
        )
        raise SystemExit(3 if re.match(r"[-+]?\.?\d", given) else 2)
    aionode.run(lambda: Echo((words[0], words[1]), rate, show))
