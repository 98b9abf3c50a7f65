"""``aionode teleop``: drives a robot by keys."""

from __future__ import annotations

import sys

import click

from aionode.cli._support.exit import become

__all__ = ["teleop_command"]

PROGRAM = "teleop_twist_keyboard"


@click.command()
@click.option("--topic", metavar="TOPIC", default="cmd_vel", help="Where commands are published.")
@click.option("--stamped", is_flag=True, help="Publish TwistStamped, as bases do since Jazzy.")
@click.option("--speed", type=float, default=0.5, help="At the beginning, in m/s.")
@click.option("--turn", type=float, default=1.0, help="At the beginning, in rad/s.")
def teleop_command(topic: str, stamped: bool, speed: float, turn: float) -> None:
    """Drive a robot by the keys of this terminal, as teleop_twist_keyboard does.

    The command of a key stands until the next one. Ctrl-C stops the robot, and so does the end of
    the terminal.
    """
    become(
        [
            *(sys.executable, "-m", "aionode.programs", PROGRAM, PROGRAM, "--ros-args"),
            *("-r", f"cmd_vel:={topic}", "-p", f"stamped:={str(stamped).lower()}"),
            *("-p", f"speed:={speed}", "-p", f"turn:={turn}"),
        ]
    )
