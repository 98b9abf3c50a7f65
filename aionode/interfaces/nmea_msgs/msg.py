"""Messages of nmea_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import (
    DEFAULT,
    Bytes,
    Message,
    Sequence,
    float32,
    float64,
    int8,
    uint8,
    uint16,
    uint32,
)

__all__ = [
    "Gpgga",
    "Gpgsa",
    "Gpgst",
    "Gpgsv",
    "GpgsvSatellite",
    "Gprmc",
    "Gpvtg",
    "Gpzda",
    "Sentence",
]


class Gpgga(Message, typename="nmea_msgs/msg/Gpgga"):
    """Gpgga, as nmea_msgs defines it."""

    header: Header = DEFAULT
    message_id: str = ""
    utc_seconds: float64 = 0.0
    lat: float64 = 0.0
    lon: float64 = 0.0
    lat_dir: str = ""
    lon_dir: str = ""
    gps_qual: uint32 = 0
    num_sats: uint32 = 0
    hdop: float32 = 0.0
    alt: float32 = 0.0
    altitude_units: str = ""
    undulation: float32 = 0.0
    undulation_units: str = ""
    diff_age: uint32 = 0
    station_id: str = ""


class Gpgsa(Message, typename="nmea_msgs/msg/Gpgsa"):
    """Gpgsa, as nmea_msgs defines it."""

    header: Header = DEFAULT
    message_id: str = ""
    auto_manual_mode: str = ""
    fix_mode: uint8 = 0
    sv_ids: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    pdop: float32 = 0.0
    hdop: float32 = 0.0
    vdop: float32 = 0.0


class Gpgst(Message, typename="nmea_msgs/msg/Gpgst"):
    """Gpgst, as nmea_msgs defines it."""

    header: Header = DEFAULT
    message_id: str = ""
    utc_seconds: float64 = 0.0
    rms: float32 = 0.0
    semi_major_dev: float32 = 0.0
    semi_minor_dev: float32 = 0.0
    orientation: float32 = 0.0
    lat_dev: float32 = 0.0
    lon_dev: float32 = 0.0
    alt_dev: float32 = 0.0


class GpgsvSatellite(Message, typename="nmea_msgs/msg/GpgsvSatellite"):
    """GpgsvSatellite, as nmea_msgs defines it."""

    prn: uint8 = 0
    elevation: uint8 = 0
    azimuth: uint16 = 0
    snr: int8 = 0


class Gpgsv(Message, typename="nmea_msgs/msg/Gpgsv"):
    """Gpgsv, as nmea_msgs defines it."""

    header: Header = DEFAULT
    message_id: str = ""
    n_msgs: uint8 = 0
    msg_number: uint8 = 0
    n_satellites: uint8 = 0
    satellites: Annotated[list[GpgsvSatellite], Sequence[GpgsvSatellite]] = DEFAULT


class Gprmc(Message, typename="nmea_msgs/msg/Gprmc"):
    """Gprmc, as nmea_msgs defines it."""

    header: Header = DEFAULT
    message_id: str = ""
    utc_seconds: float64 = 0.0
    position_status: str = ""
    lat: float64 = 0.0
    lon: float64 = 0.0
    lat_dir: str = ""
    lon_dir: str = ""
    speed: float32 = 0.0
    track: float32 = 0.0
    date: str = ""
    mag_var: float32 = 0.0
    mag_var_direction: str = ""
    mode_indicator: str = ""


class Gpvtg(Message, typename="nmea_msgs/msg/Gpvtg"):
    """Gpvtg, as nmea_msgs defines it."""

    header: Header = DEFAULT
    message_id: str = ""
    track_t: float32 = 0.0
    track_t_ref: str = ""
    track_m: float32 = 0.0
    track_m_ref: str = ""
    speed_n: float32 = 0.0
    speed_n_unit: str = ""
    speed_k: float32 = 0.0
    speed_k_unit: str = ""
    mode_indicator: str = ""


class Gpzda(Message, typename="nmea_msgs/msg/Gpzda"):
    """Gpzda, as nmea_msgs defines it."""

    header: Header = DEFAULT
    message_id: str = ""
    utc_seconds: uint32 = 0
    day: uint8 = 0
    month: uint8 = 0
    year: uint16 = 0
    hour_offset_gmt: int8 = 0
    minute_offset_gmt: uint8 = 0


class Sentence(Message, typename="nmea_msgs/msg/Sentence"):
    """Sentence, as nmea_msgs defines it."""

    header: Header = DEFAULT
    sentence: str = ""
