"""Messages of foxglove_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.interfaces.geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from aionode.message import (
    DEFAULT,
    Array,
    Bytes,
    Floats,
    Ints,
    Message,
    Sequence,
    float64,
    uint8,
    uint32,
)

__all__ = [
    "ArrowPrimitive",
    "CameraCalibration",
    "CircleAnnotation",
    "Color",
    "CompressedAudio",
    "CompressedImage",
    "CompressedPointCloud",
    "CompressedVideo",
    "CubePrimitive",
    "CylinderPrimitive",
    "Event",
    "FrameTransform",
    "FrameTransforms",
    "GeoJSON",
    "Grid",
    "ImageAnnotations",
    "JointState",
    "JointStates",
    "KeyValuePair",
    "LaserScan",
    "LinePrimitive",
    "LocationFix",
    "LocationFixes",
    "Log",
    "ModelPrimitive",
    "Odometry",
    "PackedElementField",
    "Point2",
    "PointCloud",
    "PointsAnnotation",
    "PoseInFrame",
    "PosesInFrame",
    "RawAudio",
    "RawImage",
    "SceneEntity",
    "SceneEntityDeletion",
    "SceneUpdate",
    "SpherePrimitive",
    "TextAnnotation",
    "TextPrimitive",
    "TriangleListPrimitive",
    "Vector2",
    "VoxelGrid",
]


class Color(Message, typename="foxglove_msgs/msg/Color"):
    """Color, as Foxglove defines it."""

    r: float64 = 0.0
    g: float64 = 0.0
    b: float64 = 0.0
    a: float64 = 0.0


class ArrowPrimitive(Message, typename="foxglove_msgs/msg/ArrowPrimitive"):
    """ArrowPrimitive, as Foxglove defines it."""

    pose: Pose = DEFAULT
    shaft_length: float64 = 0.0
    shaft_diameter: float64 = 0.0
    head_length: float64 = 0.0
    head_diameter: float64 = 0.0
    color: Color = DEFAULT


class CameraCalibration(Message, typename="foxglove_msgs/msg/CameraCalibration"):
    """CameraCalibration, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    width: uint32 = 0
    height: uint32 = 0
    distortion_model: str = ""
    d: Annotated[Floats, Sequence[float64]] = DEFAULT
    k: Annotated[Floats, Array[float64, 9]] = DEFAULT
    r: Annotated[Floats, Array[float64, 9]] = DEFAULT
    p: Annotated[Floats, Array[float64, 12]] = DEFAULT


class Point2(Message, typename="foxglove_msgs/msg/Point2"):
    """Point2, as Foxglove defines it."""

    x: float64 = 0.0
    y: float64 = 0.0


class KeyValuePair(Message, typename="foxglove_msgs/msg/KeyValuePair"):
    """KeyValuePair, as Foxglove defines it."""

    key: str = ""
    value: str = ""


class CircleAnnotation(Message, typename="foxglove_msgs/msg/CircleAnnotation"):
    """CircleAnnotation, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    position: Point2 = DEFAULT
    diameter: float64 = 0.0
    thickness: float64 = 0.0
    fill_color: Color = DEFAULT
    outline_color: Color = DEFAULT
    metadata: Annotated[list[KeyValuePair], Sequence[KeyValuePair]] = DEFAULT


class CompressedAudio(Message, typename="foxglove_msgs/msg/CompressedAudio"):
    """CompressedAudio, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    format: str = ""


class CompressedImage(Message, typename="foxglove_msgs/msg/CompressedImage"):
    """CompressedImage, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    format: str = ""


class CompressedPointCloud(Message, typename="foxglove_msgs/msg/CompressedPointCloud"):
    """CompressedPointCloud, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    pose: Pose = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    format: str = ""


class CompressedVideo(Message, typename="foxglove_msgs/msg/CompressedVideo"):
    """CompressedVideo, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    format: str = ""


class CubePrimitive(Message, typename="foxglove_msgs/msg/CubePrimitive"):
    """CubePrimitive, as Foxglove defines it."""

    pose: Pose = DEFAULT
    size: Vector3 = DEFAULT
    color: Color = DEFAULT


class CylinderPrimitive(Message, typename="foxglove_msgs/msg/CylinderPrimitive"):
    """CylinderPrimitive, as Foxglove defines it."""

    pose: Pose = DEFAULT
    size: Vector3 = DEFAULT
    bottom_scale: float64 = 0.0
    top_scale: float64 = 0.0
    color: Color = DEFAULT


class Event(Message, typename="foxglove_msgs/msg/Event"):
    """Event, as Foxglove defines it."""

    start_time: Time = DEFAULT
    end_time: Time = DEFAULT
    metadata: Annotated[list[KeyValuePair], Sequence[KeyValuePair]] = DEFAULT


class FrameTransform(Message, typename="foxglove_msgs/msg/FrameTransform"):
    """FrameTransform, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    parent_frame_id: str = ""
    child_frame_id: str = ""
    translation: Vector3 = DEFAULT
    rotation: Quaternion = DEFAULT


class FrameTransforms(Message, typename="foxglove_msgs/msg/FrameTransforms"):
    """FrameTransforms, as Foxglove defines it."""

    transforms: Annotated[list[FrameTransform], Sequence[FrameTransform]] = DEFAULT


class GeoJSON(Message, typename="foxglove_msgs/msg/GeoJSON"):
    """GeoJSON, as Foxglove defines it."""

    geojson: str = ""


class Vector2(Message, typename="foxglove_msgs/msg/Vector2"):
    """Vector2, as Foxglove defines it."""

    x: float64 = 0.0
    y: float64 = 0.0


class PackedElementField(Message, typename="foxglove_msgs/msg/PackedElementField"):
    """PackedElementField, as Foxglove defines it."""

    UNKNOWN: ClassVar[uint8] = 0
    UINT8: ClassVar[uint8] = 1
    INT8: ClassVar[uint8] = 2
    UINT16: ClassVar[uint8] = 3
    INT16: ClassVar[uint8] = 4
    UINT32: ClassVar[uint8] = 5
    INT32: ClassVar[uint8] = 6
    FLOAT32: ClassVar[uint8] = 7
    FLOAT64: ClassVar[uint8] = 8

    name: str = ""
    offset: uint32 = 0
    type: uint8 = 0


class Grid(Message, typename="foxglove_msgs/msg/Grid"):
    """Grid, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    pose: Pose = DEFAULT
    column_count: uint32 = 0
    cell_size: Vector2 = DEFAULT
    row_stride: uint32 = 0
    cell_stride: uint32 = 0
    fields: Annotated[list[PackedElementField], Sequence[PackedElementField]] = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class PointsAnnotation(Message, typename="foxglove_msgs/msg/PointsAnnotation"):
    """PointsAnnotation, as Foxglove defines it."""

    UNKNOWN: ClassVar[uint8] = 0
    POINTS: ClassVar[uint8] = 1
    LINE_LOOP: ClassVar[uint8] = 2
    LINE_STRIP: ClassVar[uint8] = 3
    LINE_LIST: ClassVar[uint8] = 4

    timestamp: Time = DEFAULT
    type: uint8 = 0
    points: Annotated[list[Point2], Sequence[Point2]] = DEFAULT
    outline_color: Color = DEFAULT
    outline_colors: Annotated[list[Color], Sequence[Color]] = DEFAULT
    fill_color: Color = DEFAULT
    thickness: float64 = 0.0
    metadata: Annotated[list[KeyValuePair], Sequence[KeyValuePair]] = DEFAULT


class TextAnnotation(Message, typename="foxglove_msgs/msg/TextAnnotation"):
    """TextAnnotation, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    position: Point2 = DEFAULT
    text: str = ""
    font_size: float64 = 0.0
    text_color: Color = DEFAULT
    background_color: Color = DEFAULT
    metadata: Annotated[list[KeyValuePair], Sequence[KeyValuePair]] = DEFAULT


class ImageAnnotations(Message, typename="foxglove_msgs/msg/ImageAnnotations"):
    """ImageAnnotations, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    circles: Annotated[list[CircleAnnotation], Sequence[CircleAnnotation]] = DEFAULT
    points: Annotated[list[PointsAnnotation], Sequence[PointsAnnotation]] = DEFAULT
    texts: Annotated[list[TextAnnotation], Sequence[TextAnnotation]] = DEFAULT
    metadata: Annotated[list[KeyValuePair], Sequence[KeyValuePair]] = DEFAULT


class JointState(Message, typename="foxglove_msgs/msg/JointState"):
    """JointState, as Foxglove defines it."""

    name: str = ""
    position: float64 = 0.0
    velocity: float64 = 0.0
    acceleration: float64 = 0.0
    effort: float64 = 0.0


class JointStates(Message, typename="foxglove_msgs/msg/JointStates"):
    """JointStates, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    joints: Annotated[list[JointState], Sequence[JointState]] = DEFAULT


class LaserScan(Message, typename="foxglove_msgs/msg/LaserScan"):
    """LaserScan, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    pose: Pose = DEFAULT
    start_angle: float64 = 0.0
    end_angle: float64 = 0.0
    ranges: Annotated[Floats, Sequence[float64]] = DEFAULT
    intensities: Annotated[Floats, Sequence[float64]] = DEFAULT


class LinePrimitive(Message, typename="foxglove_msgs/msg/LinePrimitive"):
    """LinePrimitive, as Foxglove defines it."""

    LINE_STRIP: ClassVar[uint8] = 0
    LINE_LOOP: ClassVar[uint8] = 1
    LINE_LIST: ClassVar[uint8] = 2

    type: uint8 = 0
    pose: Pose = DEFAULT
    thickness: float64 = 0.0
    scale_invariant: bool = False
    points: Annotated[list[Point], Sequence[Point]] = DEFAULT
    color: Color = DEFAULT
    colors: Annotated[list[Color], Sequence[Color]] = DEFAULT
    indices: Annotated[Ints, Sequence[uint32]] = DEFAULT


class LocationFix(Message, typename="foxglove_msgs/msg/LocationFix"):
    """LocationFix, as Foxglove defines it."""

    UNKNOWN: ClassVar[uint8] = 0
    APPROXIMATED: ClassVar[uint8] = 1
    DIAGONAL_KNOWN: ClassVar[uint8] = 2
    KNOWN: ClassVar[uint8] = 3

    timestamp: Time = DEFAULT
    frame_id: str = ""
    latitude: float64 = 0.0
    longitude: float64 = 0.0
    altitude: float64 = 0.0
    position_covariance: Annotated[Floats, Array[float64, 9]] = DEFAULT
    position_covariance_type: uint8 = 0
    heading: float64 = 0.0
    velocity: Vector3 = DEFAULT
    color: Color = DEFAULT
    metadata: Annotated[list[KeyValuePair], Sequence[KeyValuePair]] = DEFAULT


class LocationFixes(Message, typename="foxglove_msgs/msg/LocationFixes"):
    """LocationFixes, as Foxglove defines it."""

    fixes: Annotated[list[LocationFix], Sequence[LocationFix]] = DEFAULT


class Log(Message, typename="foxglove_msgs/msg/Log"):
    """Log, as Foxglove defines it."""

    UNKNOWN: ClassVar[uint8] = 0
    DEBUG: ClassVar[uint8] = 1
    INFO: ClassVar[uint8] = 2
    WARNING: ClassVar[uint8] = 3
    ERROR: ClassVar[uint8] = 4
    FATAL: ClassVar[uint8] = 5

    timestamp: Time = DEFAULT
    level: uint8 = 0
    message: str = ""
    name: str = ""
    file: str = ""
    line: uint32 = 0


class ModelPrimitive(Message, typename="foxglove_msgs/msg/ModelPrimitive"):
    """ModelPrimitive, as Foxglove defines it."""

    pose: Pose = DEFAULT
    scale: Vector3 = DEFAULT
    color: Color = DEFAULT
    override_color: bool = False
    url: str = ""
    media_type: str = ""
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class Odometry(Message, typename="foxglove_msgs/msg/Odometry"):
    """Odometry, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    body_frame_id: str = ""
    pose: Pose = DEFAULT
    linear_velocity: Vector3 = DEFAULT
    angular_velocity: Vector3 = DEFAULT
    pose_covariance: Annotated[Floats, Array[float64, 36]] = DEFAULT
    velocity_covariance: Annotated[Floats, Array[float64, 36]] = DEFAULT
    metadata: Annotated[list[KeyValuePair], Sequence[KeyValuePair]] = DEFAULT


class PointCloud(Message, typename="foxglove_msgs/msg/PointCloud"):
    """PointCloud, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    pose: Pose = DEFAULT
    point_stride: uint32 = 0
    fields: Annotated[list[PackedElementField], Sequence[PackedElementField]] = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class PoseInFrame(Message, typename="foxglove_msgs/msg/PoseInFrame"):
    """PoseInFrame, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    pose: Pose = DEFAULT


class PosesInFrame(Message, typename="foxglove_msgs/msg/PosesInFrame"):
    """PosesInFrame, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT


class RawAudio(Message, typename="foxglove_msgs/msg/RawAudio"):
    """RawAudio, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    format: str = ""
    sample_rate: uint32 = 0
    number_of_channels: uint32 = 0


class RawImage(Message, typename="foxglove_msgs/msg/RawImage"):
    """RawImage, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    width: uint32 = 0
    height: uint32 = 0
    encoding: str = ""
    step: uint32 = 0
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class SpherePrimitive(Message, typename="foxglove_msgs/msg/SpherePrimitive"):
    """SpherePrimitive, as Foxglove defines it."""

    pose: Pose = DEFAULT
    size: Vector3 = DEFAULT
    color: Color = DEFAULT


class TriangleListPrimitive(Message, typename="foxglove_msgs/msg/TriangleListPrimitive"):
    """TriangleListPrimitive, as Foxglove defines it."""

    pose: Pose = DEFAULT
    points: Annotated[list[Point], Sequence[Point]] = DEFAULT
    color: Color = DEFAULT
    colors: Annotated[list[Color], Sequence[Color]] = DEFAULT
    indices: Annotated[Ints, Sequence[uint32]] = DEFAULT


class TextPrimitive(Message, typename="foxglove_msgs/msg/TextPrimitive"):
    """TextPrimitive, as Foxglove defines it."""

    pose: Pose = DEFAULT
    billboard: bool = False
    font_size: float64 = 0.0
    scale_invariant: bool = False
    color: Color = DEFAULT
    text: str = ""


class SceneEntity(Message, typename="foxglove_msgs/msg/SceneEntity"):
    """SceneEntity, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    id: str = ""
    lifetime: Duration = DEFAULT
    frame_locked: bool = False
    metadata: Annotated[list[KeyValuePair], Sequence[KeyValuePair]] = DEFAULT
    arrows: Annotated[list[ArrowPrimitive], Sequence[ArrowPrimitive]] = DEFAULT
    cubes: Annotated[list[CubePrimitive], Sequence[CubePrimitive]] = DEFAULT
    spheres: Annotated[list[SpherePrimitive], Sequence[SpherePrimitive]] = DEFAULT
    cylinders: Annotated[list[CylinderPrimitive], Sequence[CylinderPrimitive]] = DEFAULT
    lines: Annotated[list[LinePrimitive], Sequence[LinePrimitive]] = DEFAULT
    triangles: Annotated[list[TriangleListPrimitive], Sequence[TriangleListPrimitive]] = DEFAULT
    texts: Annotated[list[TextPrimitive], Sequence[TextPrimitive]] = DEFAULT
    models: Annotated[list[ModelPrimitive], Sequence[ModelPrimitive]] = DEFAULT


class SceneEntityDeletion(Message, typename="foxglove_msgs/msg/SceneEntityDeletion"):
    """SceneEntityDeletion, as Foxglove defines it."""

    MATCHING_ID: ClassVar[uint8] = 0
    ALL: ClassVar[uint8] = 1

    timestamp: Time = DEFAULT
    type: uint8 = 0
    id: str = ""


class SceneUpdate(Message, typename="foxglove_msgs/msg/SceneUpdate"):
    """SceneUpdate, as Foxglove defines it."""

    deletions: Annotated[list[SceneEntityDeletion], Sequence[SceneEntityDeletion]] = DEFAULT
    entities: Annotated[list[SceneEntity], Sequence[SceneEntity]] = DEFAULT


class VoxelGrid(Message, typename="foxglove_msgs/msg/VoxelGrid"):
    """VoxelGrid, as Foxglove defines it."""

    timestamp: Time = DEFAULT
    frame_id: str = ""
    pose: Pose = DEFAULT
    row_count: uint32 = 0
    column_count: uint32 = 0
    cell_size: Vector3 = DEFAULT
    slice_stride: uint32 = 0
    row_stride: uint32 = 0
    cell_stride: uint32 = 0
    fields: Annotated[list[PackedElementField], Sequence[PackedElementField]] = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
