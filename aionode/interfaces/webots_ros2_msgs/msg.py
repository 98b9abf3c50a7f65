"""Messages of webots_ros2_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import PoseStamped
from aionode.interfaces.std_msgs.msg import ColorRGBA, Header
from aionode.interfaces.vision_msgs.msg import BoundingBox2D
from aionode.message import DEFAULT, Message, Sequence, float32, float64, int32

__all__ = [
    "BoolStamped",
    "CameraRecognitionObject",
    "CameraRecognitionObjects",
    "FloatStamped",
    "PenInkProperties",
    "StringStamped",
    "UrdfRobot",
]


class BoolStamped(Message, typename="webots_ros2_msgs/msg/BoolStamped"):
    """BoolStamped, as webots_ros2 defines it."""

    header: Header = DEFAULT
    data: bool = False


class CameraRecognitionObject(Message, typename="webots_ros2_msgs/msg/CameraRecognitionObject"):
    """CameraRecognitionObject, as webots_ros2 defines it."""

    id: int32 = 0
    pose: PoseStamped = DEFAULT
    bbox: BoundingBox2D = DEFAULT
    colors: Annotated[list[ColorRGBA], Sequence[ColorRGBA]] = DEFAULT
    model: str = ""


class CameraRecognitionObjects(Message, typename="webots_ros2_msgs/msg/CameraRecognitionObjects"):
    """CameraRecognitionObjects, as webots_ros2 defines it."""

    header: Header = DEFAULT
    objects: Annotated[list[CameraRecognitionObject], Sequence[CameraRecognitionObject]] = DEFAULT


class FloatStamped(Message, typename="webots_ros2_msgs/msg/FloatStamped"):
    """FloatStamped, as webots_ros2 defines it."""

    header: Header = DEFAULT
    data: float64 = 0.0


class PenInkProperties(Message, typename="webots_ros2_msgs/msg/PenInkProperties"):
    """PenInkProperties, as webots_ros2 defines it."""

    color: int32 = 0
    density: float32 = 0.0


class StringStamped(Message, typename="webots_ros2_msgs/msg/StringStamped"):
    """StringStamped, as webots_ros2 defines it."""

    header: Header = DEFAULT
    data: str = ""


class UrdfRobot(Message, typename="webots_ros2_msgs/msg/UrdfRobot"):
    """UrdfRobot, as webots_ros2 defines it."""

    name: str = ""
    urdf_path: str = ""
    robot_description: str = ""
    relative_path_prefix: str = ""
    translation: str = ""
    rotation: str = ""
    normal: bool = False
    box_collision: bool = False
    init_pos: str = ""
