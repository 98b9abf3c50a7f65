"""Messages of rmf_obstacle_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.geometry_msgs.msg import Pose, Vector3
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Ints, Message, Sequence, float64, int8, int32

__all__ = ["BoundingBox3D", "Obstacle", "Obstacles"]


class BoundingBox3D(Message, typename="rmf_obstacle_msgs/msg/BoundingBox3D"):
    """BoundingBox3D, as Open-RMF defines it."""

    center: Pose = DEFAULT
    size: Vector3 = DEFAULT


class Obstacle(Message, typename="rmf_obstacle_msgs/msg/Obstacle"):
    """Obstacle, as Open-RMF defines it."""

    ACTION_ADD: ClassVar[int32] = 1
    ACTION_DELETE: ClassVar[int32] = 2
    ACTION_DELETEALL: ClassVar[int32] = 3

    header: Header = DEFAULT
    id: int32 = 0
    source: str = ""
    level_name: str = ""
    classification: str = ""
    bbox: BoundingBox3D = DEFAULT
    data_resolution: float64 = 0.0
    data: Annotated[Ints, Sequence[int8]] = DEFAULT
    lifetime: Duration = DEFAULT
    action: int32 = 0


class Obstacles(Message, typename="rmf_obstacle_msgs/msg/Obstacles"):
    """Obstacles, as Open-RMF defines it."""

    header: Header = DEFAULT
    obstacles: Annotated[list[Obstacle], Sequence[Obstacle]] = DEFAULT
