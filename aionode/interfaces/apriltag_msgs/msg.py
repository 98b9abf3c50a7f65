"""Messages of apriltag_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Array, Floats, Message, Sequence, float32, float64, int32

__all__ = ["AprilTagDetection", "AprilTagDetectionArray", "Point"]


class Point(Message, typename="apriltag_msgs/msg/Point"):
    """Point, as apriltag_ros defines it."""

    x: float64 = 0.0
    y: float64 = 0.0


class AprilTagDetection(Message, typename="apriltag_msgs/msg/AprilTagDetection"):
    """AprilTagDetection, as apriltag_ros defines it."""

    family: str = ""
    id: int32 = 0
    hamming: int32 = 0
    goodness: float32 = 0.0
    decision_margin: float32 = 0.0
    centre: Point = DEFAULT
    corners: Annotated[list[Point], Array[Point, 4]] = DEFAULT
    homography: Annotated[Floats, Array[float64, 9]] = DEFAULT


class AprilTagDetectionArray(Message, typename="apriltag_msgs/msg/AprilTagDetectionArray"):
    """AprilTagDetectionArray, as apriltag_ros defines it."""

    header: Header = DEFAULT
    detections: Annotated[list[AprilTagDetection], Sequence[AprilTagDetection]] = DEFAULT
