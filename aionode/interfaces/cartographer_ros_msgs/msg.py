"""Messages of cartographer_ros_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import Pose
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import (
    DEFAULT,
    Bytes,
    Ints,
    Message,
    Sequence,
    float32,
    float64,
    int32,
    uint8,
    uint32,
)

__all__ = [
    "BagfileProgress",
    "HistogramBucket",
    "LandmarkEntry",
    "LandmarkList",
    "Metric",
    "MetricFamily",
    "MetricLabel",
    "StatusCode",
    "StatusResponse",
    "SubmapEntry",
    "SubmapList",
    "SubmapTexture",
    "TrajectoryStates",
]


class BagfileProgress(Message, typename="cartographer_ros_msgs/msg/BagfileProgress"):
    """BagfileProgress, as Cartographer defines it."""

    current_bagfile_name: str = ""
    current_bagfile_id: uint32 = 0
    total_bagfiles: uint32 = 0
    total_messages: uint32 = 0
    processed_messages: uint32 = 0
    total_seconds: float32 = 0.0
    processed_seconds: float32 = 0.0


class HistogramBucket(Message, typename="cartographer_ros_msgs/msg/HistogramBucket"):
    """HistogramBucket, as Cartographer defines it."""

    bucket_boundary: float64 = 0.0
    count: float64 = 0.0


class LandmarkEntry(Message, typename="cartographer_ros_msgs/msg/LandmarkEntry"):
    """LandmarkEntry, as Cartographer defines it."""

    id: str = ""
    tracking_from_landmark_transform: Pose = DEFAULT
    translation_weight: float64 = 0.0
    rotation_weight: float64 = 0.0


class LandmarkList(Message, typename="cartographer_ros_msgs/msg/LandmarkList"):
    """LandmarkList, as Cartographer defines it."""

    header: Header = DEFAULT
    landmarks: Annotated[list[LandmarkEntry], Sequence[LandmarkEntry]] = DEFAULT


class MetricLabel(Message, typename="cartographer_ros_msgs/msg/MetricLabel"):
    """MetricLabel, as Cartographer defines it."""

    key: str = ""
    value: str = ""


class Metric(Message, typename="cartographer_ros_msgs/msg/Metric"):
    """Metric, as Cartographer defines it."""

    TYPE_COUNTER: ClassVar[uint8] = 0
    TYPE_GAUGE: ClassVar[uint8] = 1
    TYPE_HISTOGRAM: ClassVar[uint8] = 2

    type: uint8 = 0
    labels: Annotated[list[MetricLabel], Sequence[MetricLabel]] = DEFAULT
    value: float64 = 0.0
    counts_by_bucket: Annotated[list[HistogramBucket], Sequence[HistogramBucket]] = DEFAULT


class MetricFamily(Message, typename="cartographer_ros_msgs/msg/MetricFamily"):
    """MetricFamily, as Cartographer defines it."""

    name: str = ""
    description: str = ""
    metrics: Annotated[list[Metric], Sequence[Metric]] = DEFAULT


class StatusCode(Message, typename="cartographer_ros_msgs/msg/StatusCode"):
    """StatusCode, as Cartographer defines it."""

    OK: ClassVar[uint8] = 0
    CANCELLED: ClassVar[uint8] = 1
    UNKNOWN: ClassVar[uint8] = 2
    INVALID_ARGUMENT: ClassVar[uint8] = 3
    DEADLINE_EXCEEDED: ClassVar[uint8] = 4
    NOT_FOUND: ClassVar[uint8] = 5
    ALREADY_EXISTS: ClassVar[uint8] = 6
    PERMISSION_DENIED: ClassVar[uint8] = 7
    RESOURCE_EXHAUSTED: ClassVar[uint8] = 8
    FAILED_PRECONDITION: ClassVar[uint8] = 9
    ABORTED: ClassVar[uint8] = 10
    OUT_OF_RANGE: ClassVar[uint8] = 11
    UNIMPLEMENTED: ClassVar[uint8] = 12
    INTERNAL: ClassVar[uint8] = 13
    UNAVAILABLE: ClassVar[uint8] = 14
    DATA_LOSS: ClassVar[uint8] = 15


class StatusResponse(Message, typename="cartographer_ros_msgs/msg/StatusResponse"):
    """StatusResponse, as Cartographer defines it."""

    code: uint8 = 0
    message: str = ""


class SubmapEntry(Message, typename="cartographer_ros_msgs/msg/SubmapEntry"):
    """SubmapEntry, as Cartographer defines it."""

    trajectory_id: int32 = 0
    submap_index: int32 = 0
    submap_version: int32 = 0
    pose: Pose = DEFAULT
    is_frozen: bool = False


class SubmapList(Message, typename="cartographer_ros_msgs/msg/SubmapList"):
    """SubmapList, as Cartographer defines it."""

    header: Header = DEFAULT
    submap: Annotated[list[SubmapEntry], Sequence[SubmapEntry]] = DEFAULT


class SubmapTexture(Message, typename="cartographer_ros_msgs/msg/SubmapTexture"):
    """SubmapTexture, as Cartographer defines it."""

    cells: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    width: int32 = 0
    height: int32 = 0
    resolution: float64 = 0.0
    slice_pose: Pose = DEFAULT


class TrajectoryStates(Message, typename="cartographer_ros_msgs/msg/TrajectoryStates"):
    """TrajectoryStates, as Cartographer defines it."""

    ACTIVE: ClassVar[uint8] = 0
    FINISHED: ClassVar[uint8] = 1
    FROZEN: ClassVar[uint8] = 2
    DELETED: ClassVar[uint8] = 3

    header: Header = DEFAULT
    trajectory_id: Annotated[Ints, Sequence[int32]] = DEFAULT
    trajectory_state: Annotated[Bytes, Sequence[uint8]] = DEFAULT
