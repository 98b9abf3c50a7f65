"""Messages of rtabmap_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import Pose, PoseWithCovariance, Transform
from aionode.interfaces.sensor_msgs.msg import (
    CameraInfo,
    CompressedImage,
    Image,
    Imu,
    LaserScan,
    PointCloud2,
)
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import (
    DEFAULT,
    Array,
    Bytes,
    Floats,
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
    "GPS",
    "CameraModel",
    "CameraModels",
    "EnvSensor",
    "GlobalDescriptor",
    "Goal",
    "Info",
    "KeyPoint",
    "LandmarkDetection",
    "LandmarkDetections",
    "Link",
    "MapData",
    "MapGraph",
    "Node",
    "OdomInfo",
    "Path",
    "Point2f",
    "Point3f",
    "RGBDImage",
    "RGBDImages",
    "ScanDescriptor",
    "SensorData",
    "UserData",
]


class CameraModel(Message, typename="rtabmap_msgs/msg/CameraModel"):
    """CameraModel, as RTAB-Map defines it."""

    camera_info: CameraInfo = DEFAULT
    local_transform: Transform = DEFAULT


class CameraModels(Message, typename="rtabmap_msgs/msg/CameraModels"):
    """CameraModels, as RTAB-Map defines it."""

    models: Annotated[list[CameraModel], Sequence[CameraModel]] = DEFAULT


class EnvSensor(Message, typename="rtabmap_msgs/msg/EnvSensor"):
    """EnvSensor, as RTAB-Map defines it."""

    TYPE_UNDEFINED: ClassVar[int32] = 0
    TYPE_WIFI_SIGNAL_STRENGTH: ClassVar[int32] = 1
    TYPE_AMBIENT_TEMPERATURE: ClassVar[int32] = 2
    TYPE_AMBIENT_AIR_PRESSURE: ClassVar[int32] = 3
    TYPE_AMBIENT_LIGHT: ClassVar[int32] = 4
    TYPE_AMBIENT_RELATIVE_HUMIDITY: ClassVar[int32] = 5
    TYPE_CUSTOM1: ClassVar[int32] = 100
    TYPE_CUSTOM2: ClassVar[int32] = 101
    TYPE_CUSTOM3: ClassVar[int32] = 102
    TYPE_CUSTOM4: ClassVar[int32] = 103
    TYPE_CUSTOM5: ClassVar[int32] = 104
    TYPE_CUSTOM6: ClassVar[int32] = 105
    TYPE_CUSTOM7: ClassVar[int32] = 106
    TYPE_CUSTOM8: ClassVar[int32] = 107
    TYPE_CUSTOM9: ClassVar[int32] = 108

    header: Header = DEFAULT
    type: int32 = 0
    value: float64 = 0.0


class GPS(Message, typename="rtabmap_msgs/msg/GPS"):
    """GPS, as RTAB-Map defines it."""

    stamp: float64 = 0.0
    longitude: float64 = 0.0
    latitude: float64 = 0.0
    altitude: float64 = 0.0
    error: float64 = 0.0
    bearing: float64 = 0.0


class GlobalDescriptor(Message, typename="rtabmap_msgs/msg/GlobalDescriptor"):
    """GlobalDescriptor, as RTAB-Map defines it."""

    header: Header = DEFAULT
    type: int32 = 0
    info: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class Goal(Message, typename="rtabmap_msgs/msg/Goal"):
    """Goal, as RTAB-Map defines it."""

    header: Header = DEFAULT
    node_id: int32 = 0
    node_label: str = ""
    frame_id: str = ""


class Link(Message, typename="rtabmap_msgs/msg/Link"):
    """Link, as RTAB-Map defines it."""

    from_id: int32 = 0
    to_id: int32 = 0
    type: int32 = 0
    transform: Transform = DEFAULT
    information: Annotated[Floats, Array[float64, 36]] = DEFAULT


class MapGraph(Message, typename="rtabmap_msgs/msg/MapGraph"):
    """MapGraph, as RTAB-Map defines it."""

    header: Header = DEFAULT
    map_to_odom: Transform = DEFAULT
    poses_id: Annotated[Ints, Sequence[int32]] = DEFAULT
    poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
    links: Annotated[list[Link], Sequence[Link]] = DEFAULT


class Info(Message, typename="rtabmap_msgs/msg/Info"):
    """Info, as RTAB-Map defines it."""

    header: Header = DEFAULT
    ref_id: int32 = 0
    loop_closure_id: int32 = 0
    proximity_detection_id: int32 = 0
    landmark_id: int32 = 0
    loop_closure_transform: Transform = DEFAULT
    wm_state: Annotated[Ints, Sequence[int32]] = DEFAULT
    posterior_keys: Annotated[Ints, Sequence[int32]] = DEFAULT
    posterior_values: Annotated[Floats, Sequence[float32]] = DEFAULT
    likelihood_keys: Annotated[Ints, Sequence[int32]] = DEFAULT
    likelihood_values: Annotated[Floats, Sequence[float32]] = DEFAULT
    raw_likelihood_keys: Annotated[Ints, Sequence[int32]] = DEFAULT
    raw_likelihood_values: Annotated[Floats, Sequence[float32]] = DEFAULT
    weights_keys: Annotated[Ints, Sequence[int32]] = DEFAULT
    weights_values: Annotated[Ints, Sequence[int32]] = DEFAULT
    labels_keys: Annotated[Ints, Sequence[int32]] = DEFAULT
    labels_values: Annotated[list[str], Sequence[str]] = DEFAULT
    stats_keys: Annotated[list[str], Sequence[str]] = DEFAULT
    stats_values: Annotated[Floats, Sequence[float32]] = DEFAULT
    local_path: Annotated[Ints, Sequence[int32]] = DEFAULT
    current_goal_id: int32 = 0
    odom_cache: MapGraph = DEFAULT


class Point2f(Message, typename="rtabmap_msgs/msg/Point2f"):
    """Point2f, as RTAB-Map defines it."""

    x: float32 = 0.0
    y: float32 = 0.0


class KeyPoint(Message, typename="rtabmap_msgs/msg/KeyPoint"):
    """KeyPoint, as RTAB-Map defines it."""

    pt: Point2f = DEFAULT
    size: float32 = 0.0
    angle: float32 = 0.0
    response: float32 = 0.0
    octave: int32 = 0
    class_id: int32 = 0


class LandmarkDetection(Message, typename="rtabmap_msgs/msg/LandmarkDetection"):
    """LandmarkDetection, as RTAB-Map defines it."""

    header: Header = DEFAULT
    landmark_frame_id: str = ""
    id: int32 = 0
    size: float32 = 0.0
    pose: PoseWithCovariance = DEFAULT


class LandmarkDetections(Message, typename="rtabmap_msgs/msg/LandmarkDetections"):
    """LandmarkDetections, as RTAB-Map defines it."""

    header: Header = DEFAULT
    landmarks: Annotated[list[LandmarkDetection], Sequence[LandmarkDetection]] = DEFAULT


class Point3f(Message, typename="rtabmap_msgs/msg/Point3f"):
    """Point3f, as RTAB-Map defines it."""

    x: float32 = 0.0
    y: float32 = 0.0
    z: float32 = 0.0


class SensorData(Message, typename="rtabmap_msgs/msg/SensorData"):
    """SensorData, as RTAB-Map defines it."""

    header: Header = DEFAULT
    left: Image = DEFAULT
    right: Image = DEFAULT
    left_compressed: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    right_compressed: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    left_camera_info: Annotated[list[CameraInfo], Sequence[CameraInfo]] = DEFAULT
    right_camera_info: Annotated[list[CameraInfo], Sequence[CameraInfo]] = DEFAULT
    local_transform: Annotated[list[Transform], Sequence[Transform]] = DEFAULT
    laser_scan: PointCloud2 = DEFAULT
    laser_scan_compressed: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    laser_scan_max_pts: int32 = 0
    laser_scan_max_range: float32 = 0.0
    laser_scan_format: int32 = 0
    laser_scan_local_transform: Transform = DEFAULT
    user_data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    grid_ground: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    grid_obstacles: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    grid_empty_cells: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    grid_cell_size: float32 = 0.0
    grid_view_point: Point3f = DEFAULT
    key_points: Annotated[list[KeyPoint], Sequence[KeyPoint]] = DEFAULT
    points: Annotated[list[Point3f], Sequence[Point3f]] = DEFAULT
    descriptors: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    global_descriptors: Annotated[list[GlobalDescriptor], Sequence[GlobalDescriptor]] = DEFAULT
    env_sensors: Annotated[list[EnvSensor], Sequence[EnvSensor]] = DEFAULT
    imu: Imu = DEFAULT
    imu_local_transform: Transform = DEFAULT
    landmarks: Annotated[list[LandmarkDetection], Sequence[LandmarkDetection]] = DEFAULT
    ground_truth_pose: Pose = DEFAULT
    gps: GPS = DEFAULT


class Node(Message, typename="rtabmap_msgs/msg/Node"):
    """Node, as RTAB-Map defines it."""

    id: int32 = 0
    map_id: int32 = 0
    weight: int32 = 0
    stamp: float64 = 0.0
    label: str = ""
    pose: Pose = DEFAULT
    word_id_keys: Annotated[Ints, Sequence[int32]] = DEFAULT
    word_id_values: Annotated[Ints, Sequence[int32]] = DEFAULT
    word_kpts: Annotated[list[KeyPoint], Sequence[KeyPoint]] = DEFAULT
    word_pts: Annotated[list[Point3f], Sequence[Point3f]] = DEFAULT
    word_descriptors: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    data: SensorData = DEFAULT


class MapData(Message, typename="rtabmap_msgs/msg/MapData"):
    """MapData, as RTAB-Map defines it."""

    header: Header = DEFAULT
    graph: MapGraph = DEFAULT
    nodes: Annotated[list[Node], Sequence[Node]] = DEFAULT


class OdomInfo(Message, typename="rtabmap_msgs/msg/OdomInfo"):
    """OdomInfo, as RTAB-Map defines it."""

    header: Header = DEFAULT
    lost: bool = False
    matches: int32 = 0
    inliers: int32 = 0
    icp_inliers_ratio: float32 = 0.0
    icp_rotation: float32 = 0.0
    icp_translation: float32 = 0.0
    icp_structural_complexity: float32 = 0.0
    icp_structural_distribution: float32 = 0.0
    icp_correspondences: int32 = 0
    covariance: Annotated[Floats, Array[float64, 36]] = DEFAULT
    features: int32 = 0
    local_map_size: int32 = 0
    local_scan_map_size: int32 = 0
    local_key_frames: int32 = 0
    local_bundle_outliers: int32 = 0
    local_bundle_constraints: int32 = 0
    local_bundle_time: float32 = 0.0
    local_bundle_avg_inlier_distance: float32 = 0.0
    local_bundle_max_key_frames_for_inlier: int32 = 0
    key_frame_added: bool = False
    time_estimation: float32 = 0.0
    time_particle_filtering: float32 = 0.0
    stamp: float32 = 0.0
    interval: float32 = 0.0
    distance_travelled: float32 = 0.0
    memory_usage: int32 = 0
    gravity_roll_error: float32 = 0.0
    gravity_pitch_error: float32 = 0.0
    local_bundle_ids: Annotated[Ints, Sequence[int32]] = DEFAULT
    local_bundle_models: Annotated[list[CameraModels], Sequence[CameraModels]] = DEFAULT
    local_bundle_poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
    transform: Transform = DEFAULT
    transform_filtered: Transform = DEFAULT
    transform_ground_truth: Transform = DEFAULT
    guess: Transform = DEFAULT
    type: int32 = 0
    words_keys: Annotated[Ints, Sequence[int32]] = DEFAULT
    words_values: Annotated[list[KeyPoint], Sequence[KeyPoint]] = DEFAULT
    word_matches: Annotated[Ints, Sequence[int32]] = DEFAULT
    word_inliers: Annotated[Ints, Sequence[int32]] = DEFAULT
    local_map_keys: Annotated[Ints, Sequence[int32]] = DEFAULT
    local_map_values: Annotated[list[Point3f], Sequence[Point3f]] = DEFAULT
    local_scan_map: PointCloud2 = DEFAULT
    ref_corners: Annotated[list[Point2f], Sequence[Point2f]] = DEFAULT
    new_corners: Annotated[list[Point2f], Sequence[Point2f]] = DEFAULT
    corner_inliers: Annotated[Ints, Sequence[int32]] = DEFAULT


class Path(Message, typename="rtabmap_msgs/msg/Path"):
    """Path, as RTAB-Map defines it."""

    header: Header = DEFAULT
    node_ids: Annotated[Ints, Sequence[int32]] = DEFAULT
    poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT


class RGBDImage(Message, typename="rtabmap_msgs/msg/RGBDImage"):
    """RGBDImage, as RTAB-Map defines it."""

    header: Header = DEFAULT
    rgb_camera_info: CameraInfo = DEFAULT
    depth_camera_info: CameraInfo = DEFAULT
    rgb: Image = DEFAULT
    depth: Image = DEFAULT
    rgb_compressed: CompressedImage = DEFAULT
    depth_compressed: CompressedImage = DEFAULT
    key_points: Annotated[list[KeyPoint], Sequence[KeyPoint]] = DEFAULT
    points: Annotated[list[Point3f], Sequence[Point3f]] = DEFAULT
    descriptors: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    global_descriptor: GlobalDescriptor = DEFAULT


class RGBDImages(Message, typename="rtabmap_msgs/msg/RGBDImages"):
    """RGBDImages, as RTAB-Map defines it."""

    header: Header = DEFAULT
    rgbd_images: Annotated[list[RGBDImage], Sequence[RGBDImage]] = DEFAULT


class ScanDescriptor(Message, typename="rtabmap_msgs/msg/ScanDescriptor"):
    """ScanDescriptor, as RTAB-Map defines it."""

    header: Header = DEFAULT
    scan: LaserScan = DEFAULT
    scan_cloud: PointCloud2 = DEFAULT
    global_descriptor: GlobalDescriptor = DEFAULT


class UserData(Message, typename="rtabmap_msgs/msg/UserData"):
    """UserData, as RTAB-Map defines it."""

    header: Header = DEFAULT
    rows: uint32 = 0
    cols: uint32 = 0
    type: uint32 = 0
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
