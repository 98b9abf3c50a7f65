"""Services of autoware_planning_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.autoware_common_msgs.msg import ResponseStatus
from aionode.interfaces.autoware_planning_msgs.msg import LaneletPrimitive, LaneletSegment
from aionode.interfaces.geometry_msgs.msg import Pose
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.message import DEFAULT, Message, Sequence, ServiceType

__all__ = ["ClearRoute", "SetLaneletRoute", "SetPreferredPrimitive", "SetWaypointRoute"]


class ClearRoute(ServiceType, typename="autoware_planning_msgs/srv/ClearRoute"):
    """ClearRoute, as Autoware defines it."""

    class Request(Message):
        """The request of ClearRoute."""

    class Response(Message):
        """The response of ClearRoute."""

        status: ResponseStatus = DEFAULT


class SetLaneletRoute(ServiceType, typename="autoware_planning_msgs/srv/SetLaneletRoute"):
    """SetLaneletRoute, as Autoware defines it."""

    class Request(Message):
        """The request of SetLaneletRoute."""

        header: Header = DEFAULT
        goal_pose: Pose = DEFAULT
        segments: Annotated[list[LaneletSegment], Sequence[LaneletSegment]] = DEFAULT
        uuid: UUID = DEFAULT
        allow_modification: bool = False

    class Response(Message):
        """The response of SetLaneletRoute."""

        status: ResponseStatus = DEFAULT


class SetPreferredPrimitive(
    ServiceType, typename="autoware_planning_msgs/srv/SetPreferredPrimitive"
):
    """SetPreferredPrimitive, as Autoware defines it."""

    class Request(Message):
        """The request of SetPreferredPrimitive."""

        preferred_primitives: Annotated[list[LaneletPrimitive], Sequence[LaneletPrimitive]] = (
            DEFAULT
        )
        reset: bool = False
        uuid: UUID = DEFAULT

    class Response(Message):
        """The response of SetPreferredPrimitive."""

        status: ResponseStatus = DEFAULT


class SetWaypointRoute(ServiceType, typename="autoware_planning_msgs/srv/SetWaypointRoute"):
    """SetWaypointRoute, as Autoware defines it."""

    class Request(Message):
        """The request of SetWaypointRoute."""

        header: Header = DEFAULT
        goal_pose: Pose = DEFAULT
        waypoints: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
        uuid: UUID = DEFAULT
        allow_modification: bool = False

    class Response(Message):
        """The response of SetWaypointRoute."""

        status: ResponseStatus = DEFAULT
