"""Messages of sensor_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.geometry_msgs.msg import (
    Point32,
    Quaternion,
    Transform,
    Twist,
    Vector3,
    Wrench,
)
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import (
    DEFAULT,
    Array,
    Bytes,
    Floats,
    Ints,
    Message,
    Sequence,
    float32,
    float64,
    int8,
    int32,
    uint8,
    uint16,
    uint32,
)

__all__ = [
    "BatteryState",
    "CameraInfo",
    "ChannelFloat32",
    "CompressedImage",
    "FluidPressure",
    "Illuminance",
    "Image",
    "Imu",
    "JointState",
    "Joy",
    "JoyFeedback",
    "JoyFeedbackArray",
    "LaserEcho",
    "LaserScan",
    "MagneticField",
    "MultiDOFJointState",
    "MultiEchoLaserScan",
    "NavSatFix",
    "NavSatStatus",
    "PointCloud",
    "PointCloud2",
    "PointField",
    "Range",
    "RegionOfInterest",
    "RelativeHumidity",
    "Temperature",
    "TimeReference",
]


class BatteryState(Message, typename="sensor_msgs/msg/BatteryState"):
    """BatteryState."""

    POWER_SUPPLY_STATUS_UNKNOWN: ClassVar[uint8] = 0
    POWER_SUPPLY_STATUS_CHARGING: ClassVar[uint8] = 1
    POWER_SUPPLY_STATUS_DISCHARGING: ClassVar[uint8] = 2
    POWER_SUPPLY_STATUS_NOT_CHARGING: ClassVar[uint8] = 3
    POWER_SUPPLY_STATUS_FULL: ClassVar[uint8] = 4
    POWER_SUPPLY_HEALTH_UNKNOWN: ClassVar[uint8] = 0
    POWER_SUPPLY_HEALTH_GOOD: ClassVar[uint8] = 1
    POWER_SUPPLY_HEALTH_OVERHEAT: ClassVar[uint8] = 2
    POWER_SUPPLY_HEALTH_DEAD: ClassVar[uint8] = 3
    POWER_SUPPLY_HEALTH_OVERVOLTAGE: ClassVar[uint8] = 4
    POWER_SUPPLY_HEALTH_UNSPEC_FAILURE: ClassVar[uint8] = 5
    POWER_SUPPLY_HEALTH_COLD: ClassVar[uint8] = 6
    POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE: ClassVar[uint8] = 7
    POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE: ClassVar[uint8] = 8
    POWER_SUPPLY_TECHNOLOGY_UNKNOWN: ClassVar[uint8] = 0
    POWER_SUPPLY_TECHNOLOGY_NIMH: ClassVar[uint8] = 1
    POWER_SUPPLY_TECHNOLOGY_LION: ClassVar[uint8] = 2
    POWER_SUPPLY_TECHNOLOGY_LIPO: ClassVar[uint8] = 3
    POWER_SUPPLY_TECHNOLOGY_LIFE: ClassVar[uint8] = 4
    POWER_SUPPLY_TECHNOLOGY_NICD: ClassVar[uint8] = 5
    POWER_SUPPLY_TECHNOLOGY_LIMN: ClassVar[uint8] = 6
    POWER_SUPPLY_TECHNOLOGY_TERNARY: ClassVar[uint8] = 7
    POWER_SUPPLY_TECHNOLOGY_VRLA: ClassVar[uint8] = 8

    header: Header = DEFAULT
    voltage: float32 = 0.0
    temperature: float32 = 0.0
    current: float32 = 0.0
    charge: float32 = 0.0
    capacity: float32 = 0.0
    design_capacity: float32 = 0.0
    percentage: float32 = 0.0
    power_supply_status: uint8 = 0
    power_supply_health: uint8 = 0
    power_supply_technology: uint8 = 0
    present: bool = False
    cell_voltage: Annotated[Floats, Sequence[float32]] = DEFAULT
    cell_temperature: Annotated[Floats, Sequence[float32]] = DEFAULT
    location: str = ""
    serial_number: str = ""


class RegionOfInterest(Message, typename="sensor_msgs/msg/RegionOfInterest"):
    """RegionOfInterest."""

    x_offset: uint32 = 0
    y_offset: uint32 = 0
    height: uint32 = 0
    width: uint32 = 0
    do_rectify: bool = False


class CameraInfo(Message, typename="sensor_msgs/msg/CameraInfo"):
    """CameraInfo."""

    header: Header = DEFAULT
    height: uint32 = 0
    width: uint32 = 0
    distortion_model: str = ""
    d: Annotated[Floats, Sequence[float64]] = DEFAULT
    k: Annotated[Floats, Array[float64, 9]] = DEFAULT
    r: Annotated[Floats, Array[float64, 9]] = DEFAULT
    p: Annotated[Floats, Array[float64, 12]] = DEFAULT
    binning_x: uint32 = 0
    binning_y: uint32 = 0
    roi: RegionOfInterest = DEFAULT


class ChannelFloat32(Message, typename="sensor_msgs/msg/ChannelFloat32"):
    """ChannelFloat32."""

    name: str = ""
    values: Annotated[Floats, Sequence[float32]] = DEFAULT


class CompressedImage(Message, typename="sensor_msgs/msg/CompressedImage"):
    """CompressedImage."""

    header: Header = DEFAULT
    format: str = ""
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class FluidPressure(Message, typename="sensor_msgs/msg/FluidPressure"):
    """FluidPressure."""

    header: Header = DEFAULT
    fluid_pressure: float64 = 0.0
    variance: float64 = 0.0


class Illuminance(Message, typename="sensor_msgs/msg/Illuminance"):
    """Illuminance."""

    header: Header = DEFAULT
    illuminance: float64 = 0.0
    variance: float64 = 0.0


class Image(Message, typename="sensor_msgs/msg/Image"):
    """Image."""

    header: Header = DEFAULT
    height: uint32 = 0
    width: uint32 = 0
    encoding: str = ""
    is_bigendian: uint8 = 0
    step: uint32 = 0
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class Imu(Message, typename="sensor_msgs/msg/Imu"):
    """Imu."""

    header: Header = DEFAULT
    orientation: Quaternion = DEFAULT
    orientation_covariance: Annotated[Floats, Array[float64, 9]] = DEFAULT
    angular_velocity: Vector3 = DEFAULT
    angular_velocity_covariance: Annotated[Floats, Array[float64, 9]] = DEFAULT
    linear_acceleration: Vector3 = DEFAULT
    linear_acceleration_covariance: Annotated[Floats, Array[float64, 9]] = DEFAULT


class JointState(Message, typename="sensor_msgs/msg/JointState"):
    """JointState."""

    header: Header = DEFAULT
    name: Annotated[list[str], Sequence[str]] = DEFAULT
    position: Annotated[Floats, Sequence[float64]] = DEFAULT
    velocity: Annotated[Floats, Sequence[float64]] = DEFAULT
    effort: Annotated[Floats, Sequence[float64]] = DEFAULT


class Joy(Message, typename="sensor_msgs/msg/Joy"):
    """Joy."""

    header: Header = DEFAULT
    axes: Annotated[Floats, Sequence[float32]] = DEFAULT
    buttons: Annotated[Ints, Sequence[int32]] = DEFAULT


class JoyFeedback(Message, typename="sensor_msgs/msg/JoyFeedback"):
    """JoyFeedback."""

    TYPE_LED: ClassVar[uint8] = 0
    TYPE_RUMBLE: ClassVar[uint8] = 1
    TYPE_BUZZER: ClassVar[uint8] = 2

    type: uint8 = 0
    id: uint8 = 0
    intensity: float32 = 0.0


class JoyFeedbackArray(Message, typename="sensor_msgs/msg/JoyFeedbackArray"):
    """JoyFeedbackArray."""

    array: Annotated[list[JoyFeedback], Sequence[JoyFeedback]] = DEFAULT


class LaserEcho(Message, typename="sensor_msgs/msg/LaserEcho"):
    """LaserEcho."""

    echoes: Annotated[Floats, Sequence[float32]] = DEFAULT


class LaserScan(Message, typename="sensor_msgs/msg/LaserScan"):
    """LaserScan."""

    header: Header = DEFAULT
    angle_min: float32 = 0.0
    angle_max: float32 = 0.0
    angle_increment: float32 = 0.0
    time_increment: float32 = 0.0
    scan_time: float32 = 0.0
    range_min: float32 = 0.0
    range_max: float32 = 0.0
    ranges: Annotated[Floats, Sequence[float32]] = DEFAULT
    intensities: Annotated[Floats, Sequence[float32]] = DEFAULT


class MagneticField(Message, typename="sensor_msgs/msg/MagneticField"):
    """MagneticField."""

    header: Header = DEFAULT
    magnetic_field: Vector3 = DEFAULT
    magnetic_field_covariance: Annotated[Floats, Array[float64, 9]] = DEFAULT


class MultiDOFJointState(Message, typename="sensor_msgs/msg/MultiDOFJointState"):
    """MultiDOFJointState."""

    header: Header = DEFAULT
    joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
    transforms: Annotated[list[Transform], Sequence[Transform]] = DEFAULT
    twist: Annotated[list[Twist], Sequence[Twist]] = DEFAULT
    wrench: Annotated[list[Wrench], Sequence[Wrench]] = DEFAULT


class MultiEchoLaserScan(Message, typename="sensor_msgs/msg/MultiEchoLaserScan"):
    """MultiEchoLaserScan."""

    header: Header = DEFAULT
    angle_min: float32 = 0.0
    angle_max: float32 = 0.0
    angle_increment: float32 = 0.0
    time_increment: float32 = 0.0
    scan_time: float32 = 0.0
    range_min: float32 = 0.0
    range_max: float32 = 0.0
    ranges: Annotated[list[LaserEcho], Sequence[LaserEcho]] = DEFAULT
    intensities: Annotated[list[LaserEcho], Sequence[LaserEcho]] = DEFAULT


class NavSatStatus(Message, typename="sensor_msgs/msg/NavSatStatus"):
    """NavSatStatus."""

    STATUS_UNKNOWN: ClassVar[int8] = -2
    STATUS_NO_FIX: ClassVar[int8] = -1
    STATUS_FIX: ClassVar[int8] = 0
    STATUS_SBAS_FIX: ClassVar[int8] = 1
    STATUS_GBAS_FIX: ClassVar[int8] = 2
    SERVICE_UNKNOWN: ClassVar[uint16] = 0
    SERVICE_GPS: ClassVar[uint16] = 1
    SERVICE_GLONASS: ClassVar[uint16] = 2
    SERVICE_COMPASS: ClassVar[uint16] = 4
    SERVICE_GALILEO: ClassVar[uint16] = 8

    status: int8 = -2
    service: uint16 = 0


class NavSatFix(Message, typename="sensor_msgs/msg/NavSatFix"):
    """NavSatFix."""

    COVARIANCE_TYPE_UNKNOWN: ClassVar[uint8] = 0
    COVARIANCE_TYPE_APPROXIMATED: ClassVar[uint8] = 1
    COVARIANCE_TYPE_DIAGONAL_KNOWN: ClassVar[uint8] = 2
    COVARIANCE_TYPE_KNOWN: ClassVar[uint8] = 3

    header: Header = DEFAULT
    status: NavSatStatus = DEFAULT
    latitude: float64 = 0.0
    longitude: float64 = 0.0
    altitude: float64 = 0.0
    position_covariance: Annotated[Floats, Array[float64, 9]] = DEFAULT
    position_covariance_type: uint8 = 0


class PointCloud(Message, typename="sensor_msgs/msg/PointCloud"):
    """PointCloud."""

    header: Header = DEFAULT
    points: Annotated[list[Point32], Sequence[Point32]] = DEFAULT
    channels: Annotated[list[ChannelFloat32], Sequence[ChannelFloat32]] = DEFAULT


class PointField(Message, typename="sensor_msgs/msg/PointField"):
    """PointField."""

    INT8: ClassVar[uint8] = 1
    UINT8: ClassVar[uint8] = 2
    INT16: ClassVar[uint8] = 3
    UINT16: ClassVar[uint8] = 4
    INT32: ClassVar[uint8] = 5
    UINT32: ClassVar[uint8] = 6
    FLOAT32: ClassVar[uint8] = 7
    FLOAT64: ClassVar[uint8] = 8

    name: str = ""
    offset: uint32 = 0
    datatype: uint8 = 0
    count: uint32 = 0


class PointCloud2(Message, typename="sensor_msgs/msg/PointCloud2"):
    """PointCloud2."""

    header: Header = DEFAULT
    height: uint32 = 0
    width: uint32 = 0
    fields: Annotated[list[PointField], Sequence[PointField]] = DEFAULT
    is_bigendian: bool = False
    point_step: uint32 = 0
    row_step: uint32 = 0
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    is_dense: bool = False


class Range(Message, typename="sensor_msgs/msg/Range"):
    """Range."""

    ULTRASOUND: ClassVar[uint8] = 0
    INFRARED: ClassVar[uint8] = 1

    header: Header = DEFAULT
    radiation_type: uint8 = 0
    field_of_view: float32 = 0.0
    min_range: float32 = 0.0
    max_range: float32 = 0.0
    range: float32 = 0.0
    variance: float32 = 0.0


class RelativeHumidity(Message, typename="sensor_msgs/msg/RelativeHumidity"):
    """RelativeHumidity."""

    header: Header = DEFAULT
    relative_humidity: float64 = 0.0
    variance: float64 = 0.0


class Temperature(Message, typename="sensor_msgs/msg/Temperature"):
    """Temperature."""

    header: Header = DEFAULT
    temperature: float64 = 0.0
    variance: float64 = 0.0


class TimeReference(Message, typename="sensor_msgs/msg/TimeReference"):
    """TimeReference."""

    header: Header = DEFAULT
    time_ref: Time = DEFAULT
    source: str = ""
