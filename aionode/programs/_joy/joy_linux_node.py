"""``joy_linux joy_linux_node``: `joy_node` with the parameters of this package."""

from __future__ import annotations

import math
import re

import aionode
from aionode.errors import CommandError
from aionode.programs._joy.joy_node import JoyNode

__all__ = ["JoyLinuxNode", "main"]


class JoyLinuxNode(JoyNode):
    """Publishes a joystick on `joy` while it is plugged in."""

    def chosen(self) -> tuple[int, str, float]:
        """Return the number of the joystick, its name, and how long changes are collected.

        Raises:
            CommandError: A parameter is invalid.
        """
        device = self.declare_parameter("dev", "/dev/input/js0").value
        name = self.declare_parameter("dev_name", "").value
        coalesce_sec = self.declare_parameter("coalesce_interval", 0.001).value
        number = re.search(r"(\d+)$", device)
        if number is None:
            raise CommandError(f"dev is {device!r}; use a joystick such as /dev/input/js0")
        if not 0.0 <= coalesce_sec < math.inf:
            raise CommandError("coalesce_interval must be 0 or more, in seconds")
        return int(number[1]), name, coalesce_sec


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(JoyLinuxNode)
