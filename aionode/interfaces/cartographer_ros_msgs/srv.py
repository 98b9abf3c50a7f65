"""Services of cartographer_ros_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.cartographer_ros_msgs.msg import (
    SensorTopics,
    StatusResponse,
    SubmapTexture,
    TrajectoryOptions,
)
from aionode.message import DEFAULT, Message, Sequence, ServiceType, int32

__all__ = ["FinishTrajectory", "StartTrajectory", "SubmapQuery", "WriteState"]


class FinishTrajectory(ServiceType, typename="cartographer_ros_msgs/srv/FinishTrajectory"):
    """FinishTrajectory, as Cartographer defines it."""

    class Request(Message):
        """The request of FinishTrajectory."""

        trajectory_id: int32 = 0

    class Response(Message):
        """The response of FinishTrajectory."""

        status: StatusResponse = DEFAULT


class StartTrajectory(ServiceType, typename="cartographer_ros_msgs/srv/StartTrajectory"):
    """StartTrajectory, as Cartographer defines it."""

    class Request(Message):
        """The request of StartTrajectory."""

        options: TrajectoryOptions = DEFAULT
        topics: SensorTopics = DEFAULT

    class Response(Message):
        """The response of StartTrajectory."""

        status: StatusResponse = DEFAULT
        trajectory_id: int32 = 0


class SubmapQuery(ServiceType, typename="cartographer_ros_msgs/srv/SubmapQuery"):
    """SubmapQuery, as Cartographer defines it."""

    class Request(Message):
        """The request of SubmapQuery."""

        trajectory_id: int32 = 0
        submap_index: int32 = 0

    class Response(Message):
        """The response of SubmapQuery."""

        status: StatusResponse = DEFAULT
        submap_version: int32 = 0
        textures: Annotated[list[SubmapTexture], Sequence[SubmapTexture]] = DEFAULT


class WriteState(ServiceType, typename="cartographer_ros_msgs/srv/WriteState"):
    """WriteState, as Cartographer defines it."""

    class Request(Message):
        """The request of WriteState."""

        filename: str = ""

    class Response(Message):
        """The response of WriteState."""

        status: StatusResponse = DEFAULT
