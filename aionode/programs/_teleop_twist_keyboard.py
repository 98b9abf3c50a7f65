"""``teleop_twist_keyboard``: drives a base by keys; the wheels stop when the terminal is lost."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Final

import aionode
from aionode import Node
from aionode.errors import CommandError, LeaseExpiredError
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor
from aionode.programs._leased_twists import LeasedTwists
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["Keys", "Teleop", "main", "terminal"]

HELP: Final = """
Keys move the robot; each is in effect until the next one. A US keyboard layout works best.
---------------------------
Moving around:
   u    i    o
   j    k    l
   m    ,    .

For Holonomic mode (strafing), hold down the shift key:
---------------------------
   U    I    O
   J    K    L
   M    <    >

t : up (+z)
b : down (-z)

anything else : stop

q/z : increase/decrease max speeds by 10%
w/x : increase/decrease only linear speed by 10%
e/c : increase/decrease only angular speed by 10%

CTRL-C to quit
"""

MOVES: Final[dict[str, tuple[int, int, int, int]]] = {
    "i": (1, 0, 0, 0), "o": (1, 0, 0, -1), "j": (0, 0, 0, 1), "l": (0, 0, 0, -1),
    "u": (1, 0, 0, 1), ",": (-1, 0, 0, 0), ".": (-1, 0, 0, 1), "m": (-1, 0, 0, -1),
    "O": (1, -1, 0, 0), "I": (1, 0, 0, 0), "J": (0, 1, 0, 0), "L": (0, -1, 0, 0),
    "U": (1, 1, 0, 0), "<": (-1, 0, 0, 0), ">": (-1, -1, 0, 0), "M": (-1, 1, 0, 0),
    "t": (0, 0, 1, 0), "b": (0, 0, -1, 0),
}  # fmt: skip
"""The direction of each key: along x, y and z, and around z."""

FACTORS: Final[dict[str, tuple[float, float]]] = {
    "q": (1.1, 1.1), "z": (0.9, 0.9), "w": (1.1, 1.0), "x": (0.9, 1.0), "e": (1.0, 1.1),
    "c": (1.0, 0.9),
}  # fmt: skip
"""The factors of each key for the linear and the angular speed."""

HELP_AFTER: Final = 15
"""The number of speed changes after which the help, which has scrolled away, is shown again."""

REPEAT_SEC: Final = 0.1
"""Interval at which the current command is published."""


class Keys:
    """The command set by the keys.

    Args:
        speed: The linear speed, in m/s.
        turn: The angular speed, in rad/s.
    """

    def __init__(self, speed: float = 0.5, turn: float = 1.0) -> None:
        self.speed = speed
        self.turn = turn
        self.move: tuple[int, int, int, int] = (0, 0, 0, 0)

    @property
    def twist(self) -> Twist | None:
        """The command; None while the robot should stand still."""
        if not any(self.move):
            return None
        x, y, z, around = self.move
        linear = Vector3(x=x * self.speed, y=y * self.speed, z=z * self.speed)
        return Twist(linear=linear, angular=Vector3(z=around * self.turn))

    def press(self, key: str) -> str | None:
        """Handle a key; return the speeds if it has changed them."""
        if key not in FACTORS:
            self.move = MOVES.get(key, (0, 0, 0, 0))
            return None
        speed, turn = FACTORS[key]
        self.speed *= speed
        self.turn *= turn
        return str(self)

    def __str__(self) -> str:
        return f"currently:\tspeed {self.speed}\tturn {self.turn} "


class Teleop(Node):
    """Publishes on `cmd_vel` the command of the keys, repeatedly, under a lease.

    While the robot stands still nothing is published, so that others may command it.

    Args:
        show: Called with texts for the user.

    Raises:
        CommandError: A frame was given for commands without a header.
    """

    def __init__(self, show: Callable[[str], object]) -> None:
        super().__init__("teleop_twist_keyboard")
        fixed = ParameterDescriptor(read_only=True)
        is_stamped = self.declare_parameter("stamped", False, fixed).value
        frame_id = self.declare_parameter("frame_id", "", fixed).value
        if frame_id and not is_stamped:
            raise CommandError("'frame_id' can only be set when 'stamped' is True")
        self.keys = Keys(
            self.declare_parameter("speed", 0.5, fixed).value,
            self.declare_parameter("turn", 1.0, fixed).value,
        )
        self.twists = LeasedTwists(
            self, lambda: self.keys.twist, self.on_expired, is_stamped=is_stamped, frame_id=frame_id
        )
        self.show = show
        self.changes = 0
        create_wall_timer(self, REPEAT_SEC, self.twists.repeat)

    def press(self, key: str) -> None:
        """Handle a key, and publish its command at once."""
        text = self.keys.press(key)
        if text is not None:
            self.changes += 1
            self.show(f"{text}\n{HELP if self.changes % HELP_AFTER == 0 else ''}")
        elif self.keys.twist is None and not self.twists.is_leased:
            # The end of a lease is itself a stop; this also ends commands of others.
            self.twists.stop()
        self.twists.repeat()

    def on_expired(self, error: LeaseExpiredError) -> None:
        """Stand still until the next key."""
        self.keys.move = (0, 0, 0, 0)
        self.show(f"stopped: {error}; press a key to continue\n")


@contextmanager
def terminal(press: Callable[[str], object], end: Callable[[], object]) -> Iterator[None]:
    """Read single keys from the terminal within the block, without showing them.

    Ctrl-C remains a signal; Ctrl-Z, Ctrl-Backslash and Ctrl-S are keys, as in the original: each
    would otherwise freeze or end the program while the robot moves.

    Args:
        press: Called with each key.
        end: Called when the terminal is lost.

    Raises:
        CommandError: There is no terminal.
    """
    number = sys.stdin.fileno()
    if not os.isatty(number):
        raise CommandError(
            "keys are read from a terminal, but stdin is not one: start the program in its "
            "own terminal, in a launch file with prefix='xterm -e'"
        )
    loop = asyncio.get_running_loop()
    import termios  # not on Windows

    before = termios.tcgetattr(number)
    mode = termios.tcgetattr(number)
    mode[0] &= ~(termios.IXON | termios.IXOFF)  # the flags of the input
    mode[3] &= ~(termios.ECHO | termios.ICANON | termios.IEXTEN)  # the local flags
    for name in ("VQUIT", "VSUSP", "VDSUSP", "VSTATUS"):  # some systems lack the last ones
        if hasattr(termios, name):
            mode[6][getattr(termios, name)] = os.fpathconf(number, "PC_VDISABLE")

    def read() -> None:
        try:
            data = os.read(number, 1000)
        except OSError:
            data = b""
        for key in data.decode(errors="replace"):
            press(key)
        if not data:
            loop.remove_reader(number)
            end()

    termios.tcsetattr(number, termios.TCSAFLUSH, mode)
    loop.add_reader(number, read)
    try:
        yield
    finally:
        loop.remove_reader(number)
        with suppress(termios.error):  # the terminal is lost
            termios.tcsetattr(number, termios.TCSADRAIN, before)


def show(text: str) -> None:
    """Write a text to the terminal, if it still exists."""
    with suppress(OSError):  # the terminal is lost, and the program is about to end
        sys.stdout.write(text)
        sys.stdout.flush()


async def drive_by_keys() -> None:
    """Drive until Ctrl-C, or until the terminal is lost."""
    async with Teleop(show) as node, asyncio.TaskGroup() as tasks:
        driving = tasks.create_task(node.twists.drive())
        with terminal(node.press, driving.cancel):
            show(f"{HELP}\n{node.keys}\n")  # from here on keys are handled
            await asyncio.wait([driving])


def main() -> None:
    """Drive until Ctrl-C, or until the terminal is lost."""
    aionode.run(drive_by_keys)
