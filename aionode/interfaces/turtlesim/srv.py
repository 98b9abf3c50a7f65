"""Services of turtlesim.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType, float32, uint8

__all__ = ["Kill", "SetPen", "Spawn", "TeleportAbsolute", "TeleportRelative"]


class Kill(ServiceType, typename="turtlesim/srv/Kill"):
    """Removes a turtle by its name."""

    class Request(Message):
        """The request of Kill."""

        name: str = ""

    class Response(Message):
        """The response of Kill."""


class SetPen(ServiceType, typename="turtlesim/srv/SetPen"):
    """Sets color and width, in pixels, of the line that a turtle draws; `off` is 1 for no line."""

    class Request(Message):
        """The request of SetPen."""

        r: uint8 = 0
        g: uint8 = 0
        b: uint8 = 0
        width: uint8 = 0
        off: uint8 = 0

    class Response(Message):
        """The response of SetPen."""


class Spawn(ServiceType, typename="turtlesim/srv/Spawn"):
    """Adds a turtle, under the name given or a new one, and returns that name."""

    class Request(Message):
        """The request of Spawn."""

        x: float32 = 0.0
        y: float32 = 0.0
        theta: float32 = 0.0
        name: str = ""

    class Response(Message):
        """The response of Spawn."""

        name: str = ""


class TeleportAbsolute(ServiceType, typename="turtlesim/srv/TeleportAbsolute"):
    """Puts a turtle to a place, in units of the window and radians."""

    class Request(Message):
        """The request of TeleportAbsolute."""

        x: float32 = 0.0
        y: float32 = 0.0
        theta: float32 = 0.0

    class Response(Message):
        """The response of TeleportAbsolute."""


class TeleportRelative(ServiceType, typename="turtlesim/srv/TeleportRelative"):
    """Moves a turtle forward, in units of the window, after a turn in radians."""

    class Request(Message):
        """The request of TeleportRelative."""

        linear: float32 = 0.0
        angular: float32 = 0.0

    class Response(Message):
        """The response of TeleportRelative."""
