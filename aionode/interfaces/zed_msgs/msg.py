"""Messages of zed_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import Point32, Polygon, Transform
from aionode.interfaces.shape_msgs.msg import Mesh, Plane
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import (
    DEFAULT,
    Array,
    Floats,
    Ints,
    Message,
    Sequence,
    float32,
    int8,
    int16,
    int32,
    uint8,
    uint32,
    uint64,
)

__all__ = [
    "BoundingBox2Df",
    "BoundingBox2Di",
    "BoundingBox3D",
    "DepthInfoStamped",
    "GnssFusionStatus",
    "HealthStatusStamped",
    "Heartbeat",
    "Keypoint2Df",
    "Keypoint2Di",
    "Keypoint3D",
    "MagHeadingStatus",
    "Object",
    "ObjectsStamped",
    "PlaneStamped",
    "PosTrackStatus",
    "Skeleton2D",
    "Skeleton3D",
    "SvoStatus",
]


class Keypoint2Df(Message, typename="zed_msgs/msg/Keypoint2Df"):
    """Keypoint2Df, as ZED defines it."""

    kp: Annotated[Floats, Array[float32, 2]] = DEFAULT


class BoundingBox2Df(Message, typename="zed_msgs/msg/BoundingBox2Df"):
    """BoundingBox2Df, as ZED defines it."""

    corners: Annotated[list[Keypoint2Df], Array[Keypoint2Df, 4]] = DEFAULT


class Keypoint2Di(Message, typename="zed_msgs/msg/Keypoint2Di"):
    """Keypoint2Di, as ZED defines it."""

    kp: Annotated[Ints, Array[uint32, 2]] = DEFAULT


class BoundingBox2Di(Message, typename="zed_msgs/msg/BoundingBox2Di"):
    """BoundingBox2Di, as ZED defines it."""

    corners: Annotated[list[Keypoint2Di], Array[Keypoint2Di, 4]] = DEFAULT


class Keypoint3D(Message, typename="zed_msgs/msg/Keypoint3D"):
    """Keypoint3D, as ZED defines it."""

    kp: Annotated[Floats, Array[float32, 3]] = DEFAULT


class BoundingBox3D(Message, typename="zed_msgs/msg/BoundingBox3D"):
    """BoundingBox3D, as ZED defines it."""

    corners: Annotated[list[Keypoint3D], Array[Keypoint3D, 8]] = DEFAULT


class DepthInfoStamped(Message, typename="zed_msgs/msg/DepthInfoStamped"):
    """DepthInfoStamped, as ZED defines it."""

    header: Header = DEFAULT
    min_depth: float32 = 0.0
    max_depth: float32 = 0.0


class GnssFusionStatus(Message, typename="zed_msgs/msg/GnssFusionStatus"):
    """GnssFusionStatus, as ZED defines it."""

    OK: ClassVar[uint8] = 0
    OFF: ClassVar[uint8] = 1
    CALIBRATION_IN_PROGRESS: ClassVar[uint8] = 2
    RECALIBRATION_IN_PROGRESS: ClassVar[uint8] = 3

    gnss_fusion_status: uint8 = 0


class HealthStatusStamped(Message, typename="zed_msgs/msg/HealthStatusStamped"):
    """HealthStatusStamped, as ZED defines it."""

    header: Header = DEFAULT
    serial_number: uint32 = 0
    camera_name: str = ""
    low_image_quality: bool = False
    low_lighting: bool = False
    low_depth_reliability: bool = False
    low_motion_sensors_reliability: bool = False
    scene_illuminance: int32 = 0


class Heartbeat(Message, typename="zed_msgs/msg/Heartbeat"):
    """Heartbeat, as ZED defines it."""

    beat_count: uint64 = 0
    node_ns: str = ""
    node_name: str = ""
    full_name: str = ""
    camera_sn: uint32 = 0
    svo_mode: bool = False
    simul_mode: bool = False


class MagHeadingStatus(Message, typename="zed_msgs/msg/MagHeadingStatus"):
    """MagHeadingStatus, as ZED defines it."""

    GOOD: ClassVar[uint8] = 0
    OK: ClassVar[uint8] = 1
    NOT_GOOD: ClassVar[uint8] = 2
    NOT_CALIBRATED: ClassVar[uint8] = 3
    MAG_NOT_AVAILABLE: ClassVar[uint8] = 4

    status: uint8 = 0


class Skeleton2D(Message, typename="zed_msgs/msg/Skeleton2D"):
    """Skeleton2D, as ZED defines it."""

    keypoints: Annotated[list[Keypoint2Df], Array[Keypoint2Df, 70]] = DEFAULT


class Skeleton3D(Message, typename="zed_msgs/msg/Skeleton3D"):
    """Skeleton3D, as ZED defines it."""

    keypoints: Annotated[list[Keypoint3D], Array[Keypoint3D, 70]] = DEFAULT


class Object(Message, typename="zed_msgs/msg/Object"):
    """Object, as ZED defines it."""

    label: str = ""
    label_id: int16 = 0
    sublabel: str = ""
    confidence: float32 = 0.0
    position: Annotated[Floats, Array[float32, 3]] = DEFAULT
    position_covariance: Annotated[Floats, Array[float32, 6]] = DEFAULT
    velocity: Annotated[Floats, Array[float32, 3]] = DEFAULT
    tracking_available: bool = False
    tracking_state: int8 = 0
    action_state: int8 = 0
    bounding_box_2d: BoundingBox2Di = DEFAULT
    bounding_box_3d: BoundingBox3D = DEFAULT
    dimensions_3d: Annotated[Floats, Array[float32, 3]] = DEFAULT
    skeleton_available: bool = False
    body_format: int8 = 0
    head_bounding_box_2d: BoundingBox2Df = DEFAULT
    head_bounding_box_3d: BoundingBox3D = DEFAULT
    head_position: Annotated[Floats, Array[float32, 3]] = DEFAULT
    skeleton_2d: Skeleton2D = DEFAULT
    skeleton_3d: Skeleton3D = DEFAULT


class ObjectsStamped(Message, typename="zed_msgs/msg/ObjectsStamped"):
    """ObjectsStamped, as ZED defines it."""

    header: Header = DEFAULT
    objects: Annotated[list[Object], Sequence[Object]] = DEFAULT


class PlaneStamped(Message, typename="zed_msgs/msg/PlaneStamped"):
    """PlaneStamped, as ZED defines it."""

    header: Header = DEFAULT
    mesh: Mesh = DEFAULT
    coefficients: Plane = DEFAULT
    normal: Point32 = DEFAULT
    center: Point32 = DEFAULT
    pose: Transform = DEFAULT
    extents: Annotated[Floats, Array[float32, 2]] = DEFAULT
    bounds: Polygon = DEFAULT


class PosTrackStatus(Message, typename="zed_msgs/msg/PosTrackStatus"):
    """PosTrackStatus, as ZED defines it."""

    OK: ClassVar[uint8] = 0
    UNAVAILABLE: ClassVar[uint8] = 1
    INSUFFICIENT_FEATURES: ClassVar[uint8] = 2
    LOOP_CLOSED: ClassVar[uint8] = 1
    SEARCHING: ClassVar[uint8] = 2
    OFF: ClassVar[uint8] = 3
    INITIALIZING: ClassVar[uint8] = 4
    KNOWN_MAP: ClassVar[uint8] = 5
    MAP_UPDATE: ClassVar[uint8] = 6
    LOST: ClassVar[uint8] = 7
    NOT_ENOUGH_MEMORY_FOR_TRACKING: ClassVar[uint8] = 8

    odometry_status: uint8 = 0
    spatial_memory_status: uint8 = 0
    status: uint8 = 0


class SvoStatus(Message, typename="zed_msgs/msg/SvoStatus"):
    """SvoStatus, as ZED defines it."""

    STATUS_PLAYING: ClassVar[uint8] = 0
    STATUS_PAUSED: ClassVar[uint8] = 1
    STATUS_END: ClassVar[uint8] = 2

    file_name: str = ""
    status: uint8 = 0
    frame_ts: uint64 = 0
    frame_id: uint32 = 0
    total_frames: uint32 = 0
    loop_active: bool = False
    loop_count: uint32 = 0
    real_time_mode: bool = False
