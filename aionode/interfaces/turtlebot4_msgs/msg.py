"""Messages of turtlebot4_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.message import DEFAULT, Array, Bools, Message, float64, int32, uint8, uint32

__all__ = ["UserButton", "UserDisplay", "UserLed"]


class UserButton(Message, typename="turtlebot4_msgs/msg/UserButton"):
    """UserButton, as TurtleBot 4 defines it."""

    button: Annotated[Bools, Array[bool, 4]] = DEFAULT


class UserDisplay(Message, typename="turtlebot4_msgs/msg/UserDisplay"):
    """UserDisplay, as TurtleBot 4 defines it."""

    ip: str = ""
    battery: str = ""
    entries: Annotated[list[str], Array[str, 5]] = DEFAULT
    selected_entry: int32 = 0


class UserLed(Message, typename="turtlebot4_msgs/msg/UserLed"):
    """UserLed, as TurtleBot 4 defines it."""

    USER_LED_1: ClassVar[uint8] = 0
    USER_LED_2: ClassVar[uint8] = 1
    COLOR_OFF: ClassVar[uint8] = 0
    COLOR_GREEN: ClassVar[uint8] = 1
    COLOR_RED: ClassVar[uint8] = 2
    COLOR_YELLOW: ClassVar[uint8] = 3

    led: uint8 = 0
    color: uint8 = 0
    blink_period: uint32 = 0
    duty_cycle: float64 = 0.0
