"""Services of cartographer_ros_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.cartographer_ros_msgs.msg import (
    MetricFamily,
    StatusResponse,
    SubmapTexture,
    TrajectoryStates,
)
from aionode.interfaces.geometry_msgs.msg import Pose, PoseStamped
from aionode.message import DEFAULT, Message, Sequence, ServiceType, int32

__all__ = [
    "FinishTrajectory",
    "GetTrajectoryStates",
    "ReadMetrics",
    "StartTrajectory",
    "SubmapQuery",
    "TrajectoryQuery",
    "WriteState",
]


class FinishTrajectory(ServiceType, typename="cartographer_ros_msgs/srv/FinishTrajectory"):
    """FinishTrajectory, as Cartographer defines it."""

    class Request(Message):
        """The request of FinishTrajectory."""

        trajectory_id: int32 = 0

    class Response(Message):
        """The response of FinishTrajectory."""

        status: StatusResponse = DEFAULT


class GetTrajectoryStates(ServiceType, typename="cartographer_ros_msgs/srv/GetTrajectoryStates"):
    """GetTrajectoryStates, as Cartographer defines it."""

    class Request(Message):
        """The request of GetTrajectoryStates."""

    class Response(Message):
        """The response of GetTrajectoryStates."""

        status: StatusResponse = DEFAULT
        trajectory_states: TrajectoryStates = DEFAULT


class ReadMetrics(ServiceType, typename="cartographer_ros_msgs/srv/ReadMetrics"):
    """ReadMetrics, as Cartographer defines it."""

    class Request(Message):
        """The request of ReadMetrics."""

    class Response(Message):
        """The response of ReadMetrics."""

        status: StatusResponse = DEFAULT
        metric_families: Annotated[list[MetricFamily], Sequence[MetricFamily]] = DEFAULT
        timestamp: Time = DEFAULT


class StartTrajectory(ServiceType, typename="cartographer_ros_msgs/srv/StartTrajectory"):
    """StartTrajectory, as Cartographer defines it."""

    class Request(Message):
        """The request of StartTrajectory."""

        configuration_directory: str = ""
        configuration_basename: str = ""
        use_initial_pose: bool = False
        initial_pose: Pose = DEFAULT
        relative_to_trajectory_id: int32 = 0

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


class TrajectoryQuery(ServiceType, typename="cartographer_ros_msgs/srv/TrajectoryQuery"):
    """TrajectoryQuery, as Cartographer defines it."""

    class Request(Message):
        """The request of TrajectoryQuery."""

        trajectory_id: int32 = 0

    class Response(Message):
        """The response of TrajectoryQuery."""

        status: StatusResponse = DEFAULT
        trajectory: Annotated[list[PoseStamped], Sequence[PoseStamped]] = DEFAULT


class WriteState(ServiceType, typename="cartographer_ros_msgs/srv/WriteState"):
    """WriteState, as Cartographer defines it."""

    class Request(Message):
        """The request of WriteState."""

        filename: str = ""
        include_unfinished_submaps: bool = False

    class Response(Message):
        """The response of WriteState."""

        status: StatusResponse = DEFAULT
