"""``aionode teleop``: drive a robot from the keyboard."""

from __future__ import annotations

import sys

import click

from aionode.cli._support.exit import become

__all__ = ["teleop_command"]

PROGRAM = "teleop_twist_keyboard"


@click.command()
@click.option("--topic", metavar="TOPIC", default="cmd_vel", help="Topic of the commands.")
@click.option(
    "--stamped", is_flag=True, help="Publish TwistStamped, as expected by bases since Jazzy."
)
@click.option("--speed", type=float, default=0.5, help="Initial speed, in m/s.")
@click.option("--turn", type=float, default=1.0, help="Initial turning speed, in rad/s.")
def teleop_command(topic: str, stamped: bool, speed: float, turn: float) -> None:
    """Drive a robot from the keyboard, as teleop_twist_keyboard does.

    The command of a key holds until the next key. Ctrl-C, or closing the terminal, stops the robot.
    """
    become(
        [
            *(sys.executable, "-m", "aionode.programs", PROGRAM, PROGRAM, "--ros-args"),
            *("-r", f"cmd_vel:={topic}", "-p", f"stamped:={str(stamped).lower()}"),
            *("-p", f"speed:={speed}", "-p", f"turn:={turn}"),
        ]
    )
