"""``twist_mux``: of several sources of twists, the one with the highest priority wins."""

from __future__ import annotations

from typing import Any

import aionode
from aionode.errors import CommandError
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor
from aionode.programs._command_mux.mux import CommandMux

__all__ = ["TwistMux", "main"]


class TwistMux(CommandMux):
    """Publishes the twists of the source with the highest priority on `cmd_vel_out`.

    Raises:
        CommandError: A parameter is missing or invalid.
    """

    def __init__(self) -> None:
        super().__init__("twist_mux", "Twist mux")
        if not self.has_parameter("use_stamped"):
            # Humble's twist_mux, 4.3, only knows Twist; since 4.4 TwistStamped is the default.
            is_stamped = self.context.ros_distro != "humble"
            self.declare_parameter("use_stamped", is_stamped, ParameterDescriptor())
        is_stamped = self.get_parameter("use_stamped").value
        if type(is_stamped) is not bool:
            raise CommandError(
                f"parameter 'use_stamped' is {is_stamped!r}; its type has to be bool"
            )
        kind: Any = TwistStamped if is_stamped else Twist
        self.connect(kind, "cmd_vel_out")


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(TwistMux)
