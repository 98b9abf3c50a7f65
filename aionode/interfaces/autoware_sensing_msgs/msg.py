"""Messages of autoware_sensing_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import Point, Quaternion, Vector3
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.message import (
    DEFAULT,
    Array,
    Bytes,
    Floats,
    Ints,
    Message,
    Sequence,
    float32,
    uint8,
    uint16,
    uint32,
)

__all__ = [
    "ConcatenatedPointCloudInfo",
    "GnssInsOrientation",
    "GnssInsOrientationStamped",
    "RadarClassification",
    "RadarFieldInfo",
    "RadarInfo",
    "RadarObject",
    "RadarObjects",
    "SourcePointCloudInfo",
]


class SourcePointCloudInfo(Message, typename="autoware_sensing_msgs/msg/SourcePointCloudInfo"):
    """SourcePointCloudInfo, as Autoware defines it."""

    STATUS_OK: ClassVar[uint8] = 0
    STATUS_TIMEOUT: ClassVar[uint8] = 1
    STATUS_INVALID: ClassVar[uint8] = 2

    header: Header = DEFAULT
    topic: str = ""
    status: uint8 = 0
    idx_begin: uint32 = 0
    length: uint32 = 0


class ConcatenatedPointCloudInfo(
    Message, typename="autoware_sensing_msgs/msg/ConcatenatedPointCloudInfo"
):
    """ConcatenatedPointCloudInfo, as Autoware defines it."""

    STRATEGY_NAIVE: ClassVar[uint8] = 0
    STRATEGY_ADVANCED: ClassVar[uint8] = 1

    header: Header = DEFAULT
    concatenation_success: bool = False
    matching_strategy: uint8 = 0
    matching_strategy_config: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    source_info: Annotated[list[SourcePointCloudInfo], Sequence[SourcePointCloudInfo]] = DEFAULT


class GnssInsOrientation(Message, typename="autoware_sensing_msgs/msg/GnssInsOrientation"):
    """GnssInsOrientation, as Autoware defines it."""

    orientation: Quaternion = DEFAULT
    rmse_rotation_x: float32 = 0.0
    rmse_rotation_y: float32 = 0.0
    rmse_rotation_z: float32 = 0.0


class GnssInsOrientationStamped(
    Message, typename="autoware_sensing_msgs/msg/GnssInsOrientationStamped"
):
    """GnssInsOrientationStamped, as Autoware defines it."""

    header: Header = DEFAULT
    orientation: GnssInsOrientation = DEFAULT


class RadarClassification(Message, typename="autoware_sensing_msgs/msg/RadarClassification"):
    """RadarClassification, as Autoware defines it."""

    UNKNOWN: ClassVar[uint8] = 0
    CAR: ClassVar[uint8] = 1
    TRUCK: ClassVar[uint8] = 2
    BUS: ClassVar[uint8] = 3
    TRAILER: ClassVar[uint8] = 4
    MOTORCYCLE: ClassVar[uint8] = 5
    BICYCLE: ClassVar[uint8] = 6
    PEDESTRIAN: ClassVar[uint8] = 7
    ANIMAL: ClassVar[uint8] = 8
    HAZARD: ClassVar[uint8] = 9
    OVER_DRIVABLE: ClassVar[uint8] = 10
    UNDER_DRIVABLE: ClassVar[uint8] = 11

    label: uint8 = 0
    probability: float32 = 0.0


class RadarFieldInfo(Message, typename="autoware_sensing_msgs/msg/RadarFieldInfo"):
    """RadarFieldInfo, as Autoware defines it."""

    field_name: String = DEFAULT
    min_value_available: bool = False
    max_value_available: bool = False
    resolution_available: bool = False
    min_value: float32 = 0.0
    max_value: float32 = 0.0
    resolution: float32 = 0.0


class RadarInfo(Message, typename="autoware_sensing_msgs/msg/RadarInfo"):
    """RadarInfo, as Autoware defines it."""

    header: Header = DEFAULT
    object_fields_info: Annotated[list[RadarFieldInfo], Sequence[RadarFieldInfo]] = DEFAULT
    detection_fields_info: Annotated[list[RadarFieldInfo], Sequence[RadarFieldInfo]] = DEFAULT
    available_classes: Annotated[Ints, Sequence[uint32]] = DEFAULT
    absolute_dynamics: bool = False


class RadarObject(Message, typename="autoware_sensing_msgs/msg/RadarObject"):
    """RadarObject, as Autoware defines it."""

    INVALID_COV_VALUE: ClassVar[float32] = -1.0
    MEASUREMENT_STATUS_INVALID: ClassVar[uint8] = 0
    MEASUREMENT_STATUS_MEASURED: ClassVar[uint8] = 1
    MEASUREMENT_STATUS_PREDICTED: ClassVar[uint8] = 2
    MEASUREMENT_STATUS_NEW: ClassVar[uint8] = 3
    MEASUREMENT_STATUS_UNKNOWN: ClassVar[uint8] = 4
    MOVEMENT_STATUS_INVALID: ClassVar[uint8] = 0
    MOVEMENT_STATUS_DYNAMIC: ClassVar[uint8] = 1
    MOVEMENT_STATUS_STATIC: ClassVar[uint8] = 2
    MOVEMENT_STATUS_UNKNOWN: ClassVar[uint8] = 3

    object_id: uint32 = 0
    age: uint16 = 0
    measurement_status: uint8 = 0
    movement_status: uint8 = 0
    position: Point = DEFAULT
    velocity: Vector3 = DEFAULT
    acceleration: Vector3 = DEFAULT
    size: Vector3 = DEFAULT
    position_covariance: Annotated[Floats, Array[float32, 6]] = DEFAULT
    velocity_covariance: Annotated[Floats, Array[float32, 6]] = DEFAULT
    acceleration_covariance: Annotated[Floats, Array[float32, 6]] = DEFAULT
    size_covariance: Annotated[Floats, Array[float32, 6]] = DEFAULT
    orientation: float32 = 0.0
    orientation_std: float32 = 0.0
    orientation_rate: float32 = 0.0
    orientation_rate_std: float32 = 0.0
    existence_probability: float32 = 0.0
    classifications: Annotated[list[RadarClassification], Sequence[RadarClassification]] = DEFAULT


class RadarObjects(Message, typename="autoware_sensing_msgs/msg/RadarObjects"):
    """RadarObjects, as Autoware defines it."""

    header: Header = DEFAULT
    objects: Annotated[list[RadarObject], Sequence[RadarObject]] = DEFAULT
