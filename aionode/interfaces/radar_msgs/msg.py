"""Messages of radar_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import Point, Vector3
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.message import DEFAULT, Array, Floats, Message, Sequence, float32, uint16

__all__ = ["RadarReturn", "RadarScan", "RadarTrack", "RadarTracks"]


class RadarReturn(Message, typename="radar_msgs/msg/RadarReturn"):
    """RadarReturn, as radar_msgs defines it."""

    range: float32 = 0.0
    azimuth: float32 = 0.0
    elevation: float32 = 0.0
    doppler_velocity: float32 = 0.0
    amplitude: float32 = 0.0


class RadarScan(Message, typename="radar_msgs/msg/RadarScan"):
    """RadarScan, as radar_msgs defines it."""

    header: Header = DEFAULT
    returns: Annotated[list[RadarReturn], Sequence[RadarReturn]] = DEFAULT


class RadarTrack(Message, typename="radar_msgs/msg/RadarTrack"):
    """RadarTrack, as radar_msgs defines it."""

    NO_CLASSIFICATION: ClassVar[uint16] = 0
    STATIC: ClassVar[uint16] = 1
    DYNAMIC: ClassVar[uint16] = 2

    uuid: UUID = DEFAULT
    position: Point = DEFAULT
    velocity: Vector3 = DEFAULT
    acceleration: Vector3 = DEFAULT
    size: Vector3 = DEFAULT
    classification: uint16 = 0
    position_covariance: Annotated[Floats, Array[float32, 6]] = DEFAULT
    velocity_covariance: Annotated[Floats, Array[float32, 6]] = DEFAULT
    acceleration_covariance: Annotated[Floats, Array[float32, 6]] = DEFAULT
    size_covariance: Annotated[Floats, Array[float32, 6]] = DEFAULT


class RadarTracks(Message, typename="radar_msgs/msg/RadarTracks"):
    """RadarTracks, as radar_msgs defines it."""

    header: Header = DEFAULT
    tracks: Annotated[list[RadarTrack], Sequence[RadarTrack]] = DEFAULT
