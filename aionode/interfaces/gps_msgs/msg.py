"""Messages of gps_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import (
    DEFAULT,
    Array,
    Floats,
    Ints,
    Message,
    Sequence,
    float64,
    int16,
    int32,
    uint8,
    uint16,
)

__all__ = ["GPSFix", "GPSStatus"]


class GPSStatus(Message, typename="gps_msgs/msg/GPSStatus"):
    """GPSStatus, as gps_umd defines it."""

    STATUS_NO_FIX: ClassVar[int16] = -1
    STATUS_FIX: ClassVar[int16] = 0
    STATUS_SBAS_FIX: ClassVar[int16] = 1
    STATUS_GBAS_FIX: ClassVar[int16] = 2
    STATUS_DGPS_FIX: ClassVar[int16] = 18
    STATUS_RTK_FIX: ClassVar[int16] = 19
    STATUS_RTK_FLOAT: ClassVar[int16] = 20
    STATUS_WAAS_FIX: ClassVar[int16] = 33
    SOURCE_NONE: ClassVar[uint16] = 0
    SOURCE_GPS: ClassVar[uint16] = 1
    SOURCE_POINTS: ClassVar[uint16] = 2
    SOURCE_DOPPLER: ClassVar[uint16] = 4
    SOURCE_ALTIMETER: ClassVar[uint16] = 8
    SOURCE_MAGNETIC: ClassVar[uint16] = 16
    SOURCE_GYRO: ClassVar[uint16] = 32
    SOURCE_ACCEL: ClassVar[uint16] = 64

    header: Header = DEFAULT
    satellites_used: uint16 = 0
    satellite_used_prn: Annotated[Ints, Sequence[int32]] = DEFAULT
    satellites_visible: uint16 = 0
    satellite_visible_prn: Annotated[Ints, Sequence[int32]] = DEFAULT
    satellite_visible_z: Annotated[Ints, Sequence[int32]] = DEFAULT
    satellite_visible_azimuth: Annotated[Ints, Sequence[int32]] = DEFAULT
    satellite_visible_snr: Annotated[Ints, Sequence[int32]] = DEFAULT
    status: int16 = 0
    motion_source: uint16 = 0
    orientation_source: uint16 = 0
    position_source: uint16 = 0


class GPSFix(Message, typename="gps_msgs/msg/GPSFix"):
    """GPSFix, as gps_umd defines it."""

    COVARIANCE_TYPE_UNKNOWN: ClassVar[uint8] = 0
    COVARIANCE_TYPE_APPROXIMATED: ClassVar[uint8] = 1
    COVARIANCE_TYPE_DIAGONAL_KNOWN: ClassVar[uint8] = 2
    COVARIANCE_TYPE_KNOWN: ClassVar[uint8] = 3

    header: Header = DEFAULT
    status: GPSStatus = DEFAULT
    latitude: float64 = 0.0
    longitude: float64 = 0.0
    altitude: float64 = 0.0
    track: float64 = 0.0
    speed: float64 = 0.0
    climb: float64 = 0.0
    pitch: float64 = 0.0
    roll: float64 = 0.0
    dip: float64 = 0.0
    time: float64 = 0.0
    gdop: float64 = 0.0
    pdop: float64 = 0.0
    hdop: float64 = 0.0
    vdop: float64 = 0.0
    tdop: float64 = 0.0
    err: float64 = 0.0
    err_horz: float64 = 0.0
    err_vert: float64 = 0.0
    err_track: float64 = 0.0
    err_speed: float64 = 0.0
    err_climb: float64 = 0.0
    err_time: float64 = 0.0
    err_pitch: float64 = 0.0
    err_roll: float64 = 0.0
    err_dip: float64 = 0.0
    position_covariance: Annotated[Floats, Array[float64, 9]] = DEFAULT
    position_covariance_type: uint8 = 0
