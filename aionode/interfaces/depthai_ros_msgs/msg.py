"""Messages of depthai_ros_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import Point, Pose2D
from aionode.interfaces.sensor_msgs.msg import Imu, MagneticField
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.vision_msgs.msg import (
    BoundingBox2D,
    ObjectHypothesis,
    ObjectHypothesisWithPose,
)
from aionode.message import DEFAULT, Message, Sequence, float32, int32, uint8, uint32

__all__ = [
    "AutoFocusCtrl",
    "HandLandmark",
    "HandLandmarkArray",
    "ImuWithMagneticField",
    "SpatialDetection",
    "SpatialDetectionArray",
    "TrackDetection2D",
    "TrackDetection2DArray",
    "TrackedFeature",
    "TrackedFeatures",
]


class AutoFocusCtrl(Message, typename="depthai_ros_msgs/msg/AutoFocusCtrl"):
    """AutoFocusCtrl, as DepthAI defines it."""

    AF_MODE_AUTO: ClassVar[uint8] = 0
    AF_MODE_MACRO: ClassVar[uint8] = 1
    AF_MODE_CONTINUOUS_VIDEO: ClassVar[uint8] = 2
    AF_MODE_CONTINUOUS_PICTURE: ClassVar[uint8] = 3
    AF_MODE_EDOF: ClassVar[uint8] = 4

    auto_focus_mode: uint8 = 0
    trigger_auto_focus: bool = False


class HandLandmark(Message, typename="depthai_ros_msgs/msg/HandLandmark"):
    """HandLandmark, as DepthAI defines it."""

    label: str = ""
    lm_score: float32 = 0.0
    landmark: Annotated[list[Pose2D], Sequence[Pose2D]] = DEFAULT
    position: Point = DEFAULT
    is_spatial: bool = False


class HandLandmarkArray(Message, typename="depthai_ros_msgs/msg/HandLandmarkArray"):
    """HandLandmarkArray, as DepthAI defines it."""

    header: Header = DEFAULT
    landmarks: Annotated[list[HandLandmark], Sequence[HandLandmark]] = DEFAULT


class ImuWithMagneticField(Message, typename="depthai_ros_msgs/msg/ImuWithMagneticField"):
    """ImuWithMagneticField, as DepthAI defines it."""

    header: Header = DEFAULT
    imu: Imu = DEFAULT
    field: MagneticField = DEFAULT


class SpatialDetection(Message, typename="depthai_ros_msgs/msg/SpatialDetection"):
    """SpatialDetection, as DepthAI defines it."""

    results: Annotated[list[ObjectHypothesis], Sequence[ObjectHypothesis]] = DEFAULT
    bbox: BoundingBox2D = DEFAULT
    position: Point = DEFAULT
    is_tracking: bool = False
    tracking_id: str = ""


class SpatialDetectionArray(Message, typename="depthai_ros_msgs/msg/SpatialDetectionArray"):
    """SpatialDetectionArray, as DepthAI defines it."""

    header: Header = DEFAULT
    detections: Annotated[list[SpatialDetection], Sequence[SpatialDetection]] = DEFAULT


class TrackDetection2D(Message, typename="depthai_ros_msgs/msg/TrackDetection2D"):
    """TrackDetection2D, as DepthAI defines it."""

    results: Annotated[list[ObjectHypothesisWithPose], Sequence[ObjectHypothesisWithPose]] = DEFAULT
    bbox: BoundingBox2D = DEFAULT
    is_tracking: bool = False
    tracking_id: str = ""
    tracking_age: int32 = 0
    tracking_status: int32 = 0


class TrackDetection2DArray(Message, typename="depthai_ros_msgs/msg/TrackDetection2DArray"):
    """TrackDetection2DArray, as DepthAI defines it."""

    header: Header = DEFAULT
    detections: Annotated[list[TrackDetection2D], Sequence[TrackDetection2D]] = DEFAULT


class TrackedFeature(Message, typename="depthai_ros_msgs/msg/TrackedFeature"):
    """TrackedFeature, as DepthAI defines it."""

    header: Header = DEFAULT
    position: Point = DEFAULT
    id: uint32 = 0
    age: uint32 = 0
    harris_score: float32 = 0.0
    tracking_error: float32 = 0.0


class TrackedFeatures(Message, typename="depthai_ros_msgs/msg/TrackedFeatures"):
    """TrackedFeatures, as DepthAI defines it."""

    header: Header = DEFAULT
    features: Annotated[list[TrackedFeature], Sequence[TrackedFeature]] = DEFAULT
