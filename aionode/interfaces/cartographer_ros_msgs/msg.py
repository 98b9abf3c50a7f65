"""Messages of cartographer_ros_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import Pose
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Bytes, Message, Sequence, float64, int32, uint8

__all__ = [
    "LandmarkEntry",
    "LandmarkList",
    "SensorTopics",
    "StatusCode",
    "StatusResponse",
    "SubmapEntry",
    "SubmapList",
    "SubmapTexture",
    "TrajectoryOptions",
]


class LandmarkEntry(Message, typename="cartographer_ros_msgs/msg/LandmarkEntry"):
    """LandmarkEntry, as Cartographer defines it."""

    id: str = ""
    tracking_from_landmark_transform: Pose = DEFAULT
    translation_weight: float64 = 0.0
    rotation_weight: float64 = 0.0


class LandmarkList(Message, typename="cartographer_ros_msgs/msg/LandmarkList"):
    """LandmarkList, as Cartographer defines it."""

    header: Header = DEFAULT
    landmark: Annotated[list[LandmarkEntry], Sequence[LandmarkEntry]] = DEFAULT


class SensorTopics(Message, typename="cartographer_ros_msgs/msg/SensorTopics"):
    """SensorTopics, as Cartographer defines it."""

    laser_scan_topic: str = ""
    multi_echo_laser_scan_topic: str = ""
    point_cloud2_topic: str = ""
    imu_topic: str = ""
    odometry_topic: str = ""
    nav_sat_fix_topic: str = ""
    landmark_topic: str = ""


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


class TrajectoryOptions(Message, typename="cartographer_ros_msgs/msg/TrajectoryOptions"):
    """TrajectoryOptions, as Cartographer defines it."""

    tracking_frame: str = ""
    published_frame: str = ""
    odom_frame: str = ""
    provide_odom_frame: bool = False
    use_odometry: bool = False
    use_nav_sat: bool = False
    use_landmarks: bool = False
    publish_frame_projected_to_2d: bool = False
    num_laser_scans: int32 = 0
    num_multi_echo_laser_scans: int32 = 0
    num_subdivisions_per_laser_scan: int32 = 0
    num_point_clouds: int32 = 0
    rangefinder_sampling_ratio: float64 = 0.0
    odometry_sampling_ratio: float64 = 0.0
    fixed_frame_pose_sampling_ratio: float64 = 0.0
    imu_sampling_ratio: float64 = 0.0
    landmarks_sampling_ratio: float64 = 0.0
    trajectory_builder_options_proto: str = ""
