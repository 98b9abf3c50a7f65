"""Messages of aruco_opencv_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import Pose
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, Sequence, uint16

__all__ = ["ArucoDetection", "BoardPose", "MarkerPose"]


class MarkerPose(Message, typename="aruco_opencv_msgs/msg/MarkerPose"):
    """MarkerPose, as aruco_opencv defines it."""

    marker_id: uint16 = 0
    pose: Pose = DEFAULT


class BoardPose(Message, typename="aruco_opencv_msgs/msg/BoardPose"):
    """BoardPose, as aruco_opencv defines it."""

    board_name: str = ""
    pose: Pose = DEFAULT


class ArucoDetection(Message, typename="aruco_opencv_msgs/msg/ArucoDetection"):
    """ArucoDetection, as aruco_opencv defines it."""

    header: Header = DEFAULT
    markers: Annotated[list[MarkerPose], Sequence[MarkerPose]] = DEFAULT
    boards: Annotated[list[BoardPose], Sequence[BoardPose]] = DEFAULT
