"""Services of ros_gz_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.geometry_msgs.msg import Pose
from aionode.interfaces.ros_gz_interfaces.msg import Entity, EntityFactory, WorldControl
from aionode.message import DEFAULT, Message, ServiceType

__all__ = ["ControlWorld", "DeleteEntity", "SetEntityPose", "SpawnEntity"]


class ControlWorld(ServiceType, typename="ros_gz_interfaces/srv/ControlWorld"):
    """ControlWorld, as ros_gz defines it."""

    class Request(Message):
        """The request of ControlWorld."""

        world_control: WorldControl = DEFAULT

    class Response(Message):
        """The response of ControlWorld."""

        success: bool = False


class DeleteEntity(ServiceType, typename="ros_gz_interfaces/srv/DeleteEntity"):
    """DeleteEntity, as ros_gz defines it."""

    class Request(Message):
        """The request of DeleteEntity."""

        entity: Entity = DEFAULT

    class Response(Message):
        """The response of DeleteEntity."""

        success: bool = False


class SetEntityPose(ServiceType, typename="ros_gz_interfaces/srv/SetEntityPose"):
    """SetEntityPose, as ros_gz defines it."""

    class Request(Message):
        """The request of SetEntityPose."""

        entity: Entity = DEFAULT
        pose: Pose = DEFAULT

    class Response(Message):
        """The response of SetEntityPose."""

        success: bool = False


class SpawnEntity(ServiceType, typename="ros_gz_interfaces/srv/SpawnEntity"):
    """SpawnEntity, as ros_gz defines it."""

    class Request(Message):
        """The request of SpawnEntity."""

        entity_factory: EntityFactory = DEFAULT

    class Response(Message):
        """The response of SpawnEntity."""

        success: bool = False
