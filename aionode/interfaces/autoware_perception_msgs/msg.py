"""Messages of autoware_perception_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.interfaces.geometry_msgs.msg import (
    AccelWithCovariance,
    Polygon,
    Pose,
    PoseWithCovariance,
    TwistWithCovariance,
    Vector3,
)
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.message import DEFAULT, Message, Sequence, float32, int64, uint8

__all__ = [
    "DetectedObject",
    "DetectedObjectKinematics",
    "DetectedObjects",
    "ObjectClassification",
    "PredictedObject",
    "PredictedObjectKinematics",
    "PredictedObjects",
    "PredictedPath",
    "PredictedTrafficLightState",
    "Shape",
    "TrackedObject",
    "TrackedObjectKinematics",
    "TrackedObjects",
    "TrafficLightElement",
    "TrafficLightGroup",
    "TrafficLightGroupArray",
    "TrafficSignal",
    "TrafficSignalArray",
    "TrafficSignalElement",
]


class ObjectClassification(Message, typename="autoware_perception_msgs/msg/ObjectClassification"):
    """ObjectClassification, as Autoware defines it."""

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


class DetectedObjectKinematics(
    Message, typename="autoware_perception_msgs/msg/DetectedObjectKinematics"
):
    """DetectedObjectKinematics, as Autoware defines it."""

    UNAVAILABLE: ClassVar[uint8] = 0
    SIGN_UNKNOWN: ClassVar[uint8] = 1
    AVAILABLE: ClassVar[uint8] = 2

    pose_with_covariance: PoseWithCovariance = DEFAULT
    has_position_covariance: bool = False
    orientation_availability: uint8 = 0
    twist_with_covariance: TwistWithCovariance = DEFAULT
    has_twist: bool = False
    has_twist_covariance: bool = False


class Shape(Message, typename="autoware_perception_msgs/msg/Shape"):
    """Shape, as Autoware defines it."""

    BOUNDING_BOX: ClassVar[uint8] = 0
    CYLINDER: ClassVar[uint8] = 1
    POLYGON: ClassVar[uint8] = 2

    type: uint8 = 0
    footprint: Polygon = DEFAULT
    dimensions: Vector3 = DEFAULT


class DetectedObject(Message, typename="autoware_perception_msgs/msg/DetectedObject"):
    """DetectedObject, as Autoware defines it."""

    existence_probability: float32 = 0.0
    classification: Annotated[list[ObjectClassification], Sequence[ObjectClassification]] = DEFAULT
    kinematics: DetectedObjectKinematics = DEFAULT
    shape: Shape = DEFAULT


class DetectedObjects(Message, typename="autoware_perception_msgs/msg/DetectedObjects"):
    """DetectedObjects, as Autoware defines it."""

    header: Header = DEFAULT
    objects: Annotated[list[DetectedObject], Sequence[DetectedObject]] = DEFAULT


class PredictedPath(Message, typename="autoware_perception_msgs/msg/PredictedPath"):
    """PredictedPath, as Autoware defines it."""

    path: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
    time_step: Duration = DEFAULT
    confidence: float32 = 0.0


class PredictedObjectKinematics(
    Message, typename="autoware_perception_msgs/msg/PredictedObjectKinematics"
):
    """PredictedObjectKinematics, as Autoware defines it."""

    initial_pose_with_covariance: PoseWithCovariance = DEFAULT
    initial_twist_with_covariance: TwistWithCovariance = DEFAULT
    initial_acceleration_with_covariance: AccelWithCovariance = DEFAULT
    predicted_paths: Annotated[list[PredictedPath], Sequence[PredictedPath]] = DEFAULT


class PredictedObject(Message, typename="autoware_perception_msgs/msg/PredictedObject"):
    """PredictedObject, as Autoware defines it."""

    object_id: UUID = DEFAULT
    existence_probability: float32 = 0.0
    classification: Annotated[list[ObjectClassification], Sequence[ObjectClassification]] = DEFAULT
    kinematics: PredictedObjectKinematics = DEFAULT
    shape: Shape = DEFAULT


class PredictedObjects(Message, typename="autoware_perception_msgs/msg/PredictedObjects"):
    """PredictedObjects, as Autoware defines it."""

    header: Header = DEFAULT
    objects: Annotated[list[PredictedObject], Sequence[PredictedObject]] = DEFAULT


class TrafficLightElement(Message, typename="autoware_perception_msgs/msg/TrafficLightElement"):
    """TrafficLightElement, as Autoware defines it."""

    UNKNOWN: ClassVar[uint8] = 0
    RED: ClassVar[uint8] = 1
    AMBER: ClassVar[uint8] = 2
    GREEN: ClassVar[uint8] = 3
    WHITE: ClassVar[uint8] = 4
    CIRCLE: ClassVar[uint8] = 1
    LEFT_ARROW: ClassVar[uint8] = 2
    RIGHT_ARROW: ClassVar[uint8] = 3
    UP_ARROW: ClassVar[uint8] = 4
    UP_LEFT_ARROW: ClassVar[uint8] = 5
    UP_RIGHT_ARROW: ClassVar[uint8] = 6
    DOWN_ARROW: ClassVar[uint8] = 7
    DOWN_LEFT_ARROW: ClassVar[uint8] = 8
    DOWN_RIGHT_ARROW: ClassVar[uint8] = 9
    CROSS: ClassVar[uint8] = 10
    SOLID_OFF: ClassVar[uint8] = 1
    SOLID_ON: ClassVar[uint8] = 2
    FLASHING: ClassVar[uint8] = 3

    color: uint8 = 0
    shape: uint8 = 0
    status: uint8 = 0
    confidence: float32 = 0.0


class PredictedTrafficLightState(
    Message, typename="autoware_perception_msgs/msg/PredictedTrafficLightState"
):
    """PredictedTrafficLightState, as Autoware defines it."""

    INFORMATION_SOURCE_V2N: ClassVar[str] = "V2N"
    INFORMATION_SOURCE_V2I: ClassVar[str] = "V2I"
    INFORMATION_SOURCE_V2V: ClassVar[str] = "V2V"
    INFORMATION_SOURCE_LOCAL_PERCEPTION: ClassVar[str] = "LOCAL_PERCEPTION"
    INFORMATION_SOURCE_MANUAL_OVERRIDE: ClassVar[str] = "MANUAL_OVERRIDE"
    INFORMATION_SOURCE_SIMULATION: ClassVar[str] = "SIMULATION"
    INFORMATION_SOURCE_INTERNAL_ESTIMATION: ClassVar[str] = "INTERNAL_ESTIMATION"

    predicted_stamp: Time = DEFAULT
    simultaneous_elements: Annotated[list[TrafficLightElement], Sequence[TrafficLightElement]] = (
        DEFAULT
    )
    reliability: float32 = 0.0
    information_source: str = ""


class TrackedObjectKinematics(
    Message, typename="autoware_perception_msgs/msg/TrackedObjectKinematics"
):
    """TrackedObjectKinematics, as Autoware defines it."""

    UNAVAILABLE: ClassVar[uint8] = 0
    SIGN_UNKNOWN: ClassVar[uint8] = 1
    AVAILABLE: ClassVar[uint8] = 2

    pose_with_covariance: PoseWithCovariance = DEFAULT
    twist_with_covariance: TwistWithCovariance = DEFAULT
    acceleration_with_covariance: AccelWithCovariance = DEFAULT
    orientation_availability: uint8 = 0
    is_stationary: bool = False


class TrackedObject(Message, typename="autoware_perception_msgs/msg/TrackedObject"):
    """TrackedObject, as Autoware defines it."""

    object_id: UUID = DEFAULT
    existence_probability: float32 = 0.0
    classification: Annotated[list[ObjectClassification], Sequence[ObjectClassification]] = DEFAULT
    kinematics: TrackedObjectKinematics = DEFAULT
    shape: Shape = DEFAULT


class TrackedObjects(Message, typename="autoware_perception_msgs/msg/TrackedObjects"):
    """TrackedObjects, as Autoware defines it."""

    header: Header = DEFAULT
    objects: Annotated[list[TrackedObject], Sequence[TrackedObject]] = DEFAULT


class TrafficLightGroup(Message, typename="autoware_perception_msgs/msg/TrafficLightGroup"):
    """TrafficLightGroup, as Autoware defines it."""

    traffic_light_group_id: int64 = 0
    elements: Annotated[list[TrafficLightElement], Sequence[TrafficLightElement]] = DEFAULT
    predictions: Annotated[
        list[PredictedTrafficLightState], Sequence[PredictedTrafficLightState]
    ] = DEFAULT


class TrafficLightGroupArray(
    Message, typename="autoware_perception_msgs/msg/TrafficLightGroupArray"
):
    """TrafficLightGroupArray, as Autoware defines it."""

    stamp: Time = DEFAULT
    traffic_light_groups: Annotated[list[TrafficLightGroup], Sequence[TrafficLightGroup]] = DEFAULT


class TrafficSignalElement(Message, typename="autoware_perception_msgs/msg/TrafficSignalElement"):
    """TrafficSignalElement, as Autoware defines it."""

    UNKNOWN: ClassVar[uint8] = 0
    RED: ClassVar[uint8] = 1
    AMBER: ClassVar[uint8] = 2
    GREEN: ClassVar[uint8] = 3
    WHITE: ClassVar[uint8] = 4
    CIRCLE: ClassVar[uint8] = 1
    LEFT_ARROW: ClassVar[uint8] = 2
    RIGHT_ARROW: ClassVar[uint8] = 3
    UP_ARROW: ClassVar[uint8] = 4
    UP_LEFT_ARROW: ClassVar[uint8] = 5
    UP_RIGHT_ARROW: ClassVar[uint8] = 6
    DOWN_ARROW: ClassVar[uint8] = 7
    DOWN_LEFT_ARROW: ClassVar[uint8] = 8
    DOWN_RIGHT_ARROW: ClassVar[uint8] = 9
    CROSS: ClassVar[uint8] = 10
    SOLID_OFF: ClassVar[uint8] = 1
    SOLID_ON: ClassVar[uint8] = 2
    FLASHING: ClassVar[uint8] = 3

    color: uint8 = 0
    shape: uint8 = 0
    status: uint8 = 0
    confidence: float32 = 0.0


class TrafficSignal(Message, typename="autoware_perception_msgs/msg/TrafficSignal"):
    """TrafficSignal, as Autoware defines it."""

    traffic_signal_id: int64 = 0
    elements: Annotated[list[TrafficSignalElement], Sequence[TrafficSignalElement]] = DEFAULT


class TrafficSignalArray(Message, typename="autoware_perception_msgs/msg/TrafficSignalArray"):
    """TrafficSignalArray, as Autoware defines it."""

    stamp: Time = DEFAULT
    signals: Annotated[list[TrafficSignal], Sequence[TrafficSignal]] = DEFAULT
