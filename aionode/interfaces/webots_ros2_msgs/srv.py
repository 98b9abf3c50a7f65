"""Services of webots_ros2_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.webots_ros2_msgs.msg import UrdfRobot
from aionode.message import DEFAULT, Message, ServiceType, int64

__all__ = ["EmitterSendString", "GetBool", "SetString", "SpawnNodeFromString", "SpawnUrdfRobot"]


class EmitterSendString(ServiceType, typename="webots_ros2_msgs/srv/EmitterSendString"):
    """EmitterSendString, as webots_ros2 defines it."""

    class Request(Message):
        """The request of EmitterSendString."""

        value: str = ""

    class Response(Message):
        """The response of EmitterSendString."""

        result: int64 = 0


class GetBool(ServiceType, typename="webots_ros2_msgs/srv/GetBool"):
    """GetBool, as webots_ros2 defines it."""

    class Request(Message):
        """The request of GetBool."""

        ask: bool = False

    class Response(Message):
        """The response of GetBool."""

        value: bool = False


class SetString(ServiceType, typename="webots_ros2_msgs/srv/SetString"):
    """SetString, as webots_ros2 defines it."""

    class Request(Message):
        """The request of SetString."""

        value: str = ""

    class Response(Message):
        """The response of SetString."""

        success: bool = False


class SpawnNodeFromString(ServiceType, typename="webots_ros2_msgs/srv/SpawnNodeFromString"):
    """SpawnNodeFromString, as webots_ros2 defines it."""

    class Request(Message):
        """The request of SpawnNodeFromString."""

        data: str = ""

    class Response(Message):
        """The response of SpawnNodeFromString."""

        success: bool = False


class SpawnUrdfRobot(ServiceType, typename="webots_ros2_msgs/srv/SpawnUrdfRobot"):
    """SpawnUrdfRobot, as webots_ros2 defines it."""

    class Request(Message):
        """The request of SpawnUrdfRobot."""

        robot: UrdfRobot = DEFAULT

    class Response(Message):
        """The response of SpawnUrdfRobot."""

        success: bool = False
