"""Messages of octomap_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import Pose
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Ints, Message, Sequence, float64, int8

__all__ = ["Octomap", "OctomapWithPose"]


class Octomap(Message, typename="octomap_msgs/msg/Octomap"):
    """Octomap, as OctoMap defines it."""

    header: Header = DEFAULT
    binary: bool = False
    id: str = ""
    resolution: float64 = 0.0
    data: Annotated[Ints, Sequence[int8]] = DEFAULT


class OctomapWithPose(Message, typename="octomap_msgs/msg/OctomapWithPose"):
    """OctomapWithPose, as OctoMap defines it."""

    header: Header = DEFAULT
    origin: Pose = DEFAULT
    octomap: Octomap = DEFAULT
