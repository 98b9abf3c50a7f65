"""``ackermann_mux``: as ``twist_mux``, for cars, which are given a speed and a steering angle."""

from __future__ import annotations

import aionode
from aionode.interfaces.ackermann_msgs.msg import AckermannDriveStamped
from aionode.programs._command_mux.mux import CommandMux

__all__ = ["AckermannMux", "main"]


class AckermannMux(CommandMux):
    """Publishes the commands of the source with the highest priority on `ackermann_cmd`.

    Raises:
        CommandError: A parameter is missing or invalid.
    """

    def __init__(self) -> None:
        super().__init__("ackermann_mux", "Ackermann mux")
        self.connect(AckermannDriveStamped, "ackermann_cmd")


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(AckermannMux)
