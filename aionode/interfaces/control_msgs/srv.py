"""Services of control_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Floats, Message, Sequence, ServiceType, float64

__all__ = ["QueryCalibrationState", "QueryTrajectoryState", "SetOdometry"]


class QueryCalibrationState(ServiceType, typename="control_msgs/srv/QueryCalibrationState"):
    """QueryCalibrationState, as ros-controls defines it."""

    class Request(Message):
        """The request of QueryCalibrationState."""

    class Response(Message):
        """The response of QueryCalibrationState."""

        is_calibrated: bool = False


class QueryTrajectoryState(ServiceType, typename="control_msgs/srv/QueryTrajectoryState"):
    """QueryTrajectoryState, as ros-controls defines it."""

    class Request(Message):
        """The request of QueryTrajectoryState."""

        time: Time = DEFAULT

    class Response(Message):
        """The response of QueryTrajectoryState."""

        success: bool = False
        message: str = ""
        name: Annotated[list[str], Sequence[str]] = DEFAULT
        position: Annotated[Floats, Sequence[float64]] = DEFAULT
        velocity: Annotated[Floats, Sequence[float64]] = DEFAULT
        acceleration: Annotated[Floats, Sequence[float64]] = DEFAULT


class SetOdometry(ServiceType, typename="control_msgs/srv/SetOdometry"):
    """SetOdometry, as ros-controls defines it."""

    class Request(Message):
        """The request of SetOdometry."""

        x: float64 = 0.0
        y: float64 = 0.0
        z: float64 = 0.0
        roll: float64 = 0.0
        pitch: float64 = 0.0
        yaw: float64 = 0.0

    class Response(Message):
        """The response of SetOdometry."""

        success: bool = False
        message: str = ""
