"""Messages of vision_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import Pose, PoseWithCovariance, Vector3
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, Sequence, float32, float64, int32, uint16

__all__ = [
    "BoundingBox2D",
    "BoundingBox2DArray",
    "BoundingBox3D",
    "BoundingBox3DArray",
    "Classification",
    "Detection2D",
    "Detection2DArray",
    "Detection3D",
    "Detection3DArray",
    "LabelInfo",
    "ObjectHypothesis",
    "ObjectHypothesisWithPose",
    "Point2D",
    "Pose2D",
    "VisionClass",
    "VisionInfo",
]


class Point2D(Message, typename="vision_msgs/msg/Point2D"):
    """A point of an image, in pixels."""

    x: float64 = 0.0
    y: float64 = 0.0


class Pose2D(Message, typename="vision_msgs/msg/Pose2D"):
    """A place in an image, in pixels, and an angle, in radians."""

    position: Point2D = DEFAULT
    theta: float64 = 0.0


class BoundingBox2D(Message, typename="vision_msgs/msg/BoundingBox2D"):
    """A rectangle in an image by its center and size, in pixels; it may be turned."""

    center: Pose2D = DEFAULT
    size_x: float64 = 0.0
    size_y: float64 = 0.0


class BoundingBox2DArray(Message, typename="vision_msgs/msg/BoundingBox2DArray"):
    """Rectangles of one image."""

    header: Header = DEFAULT
    boxes: Annotated[list[BoundingBox2D], Sequence[BoundingBox2D]] = DEFAULT


class BoundingBox3D(Message, typename="vision_msgs/msg/BoundingBox3D"):
    """A box in space by the pose of its center, and its size in meters."""

    center: Pose = DEFAULT
    size: Vector3 = DEFAULT


class BoundingBox3DArray(Message, typename="vision_msgs/msg/BoundingBox3DArray"):
    """Boxes of one frame and time."""

    header: Header = DEFAULT
    boxes: Annotated[list[BoundingBox3D], Sequence[BoundingBox3D]] = DEFAULT


class ObjectHypothesis(Message, typename="vision_msgs/msg/ObjectHypothesis"):
    """What an object may be, and how likely that is."""

    class_id: str = ""
    score: float64 = 0.0


class Classification(Message, typename="vision_msgs/msg/Classification"):
    """What an image as a whole may show."""

    header: Header = DEFAULT
    results: Annotated[list[ObjectHypothesis], Sequence[ObjectHypothesis]] = DEFAULT


class ObjectHypothesisWithPose(Message, typename="vision_msgs/msg/ObjectHypothesisWithPose"):
    """What an object may be, how likely that is, and where it is then."""

    hypothesis: ObjectHypothesis = DEFAULT
    pose: PoseWithCovariance = DEFAULT


class Detection2D(Message, typename="vision_msgs/msg/Detection2D"):
    """An object in an image: what it may be, its rectangle, and an id for tracking."""

    header: Header = DEFAULT
    results: Annotated[list[ObjectHypothesisWithPose], Sequence[ObjectHypothesisWithPose]] = DEFAULT
    bbox: BoundingBox2D = DEFAULT
    id: str = ""


class Detection2DArray(Message, typename="vision_msgs/msg/Detection2DArray"):
    """The objects of one image."""

    header: Header = DEFAULT
    detections: Annotated[list[Detection2D], Sequence[Detection2D]] = DEFAULT


class Detection3D(Message, typename="vision_msgs/msg/Detection3D"):
    """An object in space: what it may be, its box, and an id for tracking."""

    header: Header = DEFAULT
    results: Annotated[list[ObjectHypothesisWithPose], Sequence[ObjectHypothesisWithPose]] = DEFAULT
    bbox: BoundingBox3D = DEFAULT
    id: str = ""


class Detection3DArray(Message, typename="vision_msgs/msg/Detection3DArray"):
    """The objects of one frame and time."""

    header: Header = DEFAULT
    detections: Annotated[list[Detection3D], Sequence[Detection3D]] = DEFAULT


class VisionClass(Message, typename="vision_msgs/msg/VisionClass"):
    """The name of a class of objects, which a number stands for."""

    class_id: uint16 = 0
    class_name: str = ""


class LabelInfo(Message, typename="vision_msgs/msg/LabelInfo"):
    """The names of the classes whose numbers are the pixels of a label image."""

    header: Header = DEFAULT
    class_map: Annotated[list[VisionClass], Sequence[VisionClass]] = DEFAULT
    threshold: float32 = 0.0


class VisionInfo(Message, typename="vision_msgs/msg/VisionInfo"):
    """How objects are recognized, and where the names of their classes are found."""

    header: Header = DEFAULT
    method: str = ""
    database_location: str = ""
    database_version: int32 = 0
