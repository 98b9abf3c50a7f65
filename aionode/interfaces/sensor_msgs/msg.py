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


class JointState(Message, typename="sensor_msgs/msg/JointState"):
    """Where the joints of a robot are. The lists correspond by index; each may be empty.

    Attributes:
        header: When it was measured.
        name: Names of the joints.
        position: In rad, or in m for a joint that slides.
        velocity: In rad/s or m/s.
        effort: In N·m or N.
    """

    header: Header = DEFAULT
    name: Annotated[list[str], Sequence[str]] = DEFAULT
    position: Annotated[Floats, Sequence[float64]] = DEFAULT
    velocity: Annotated[Floats, Sequence[float64]] = DEFAULT
    effort: Annotated[Floats, Sequence[float64]] = DEFAULT


class BatteryState(Message, typename="sensor_msgs/msg/BatteryState"):
    """How full and how healthy a battery is. NaN stands for what is not measured.

    Attributes:
        voltage: In V.
        temperature: In °C.
        current: In A, negative while discharging.
        charge: What is in it, in Ah.
        capacity: What it holds when full, in Ah.
        design_capacity: What it held when new, in Ah.
        percentage: How full it is, from 0 to 1.
        power_supply_status: What it is doing, one of the constants.
        power_supply_health: How well it is, one of the constants.
        power_supply_technology: How it is made, one of the constants.
        present: Whether there is a battery.
        cell_voltage: Of each cell, in V.
        cell_temperature: Of each cell, in °C.
        location: Where it sits, such as a slot.
        serial_number: As printed on it.
    """

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


class MultiDOFJointState(Message, typename="sensor_msgs/msg/MultiDOFJointState"):
    """Where joints are that move along or about several axes; in m, rad, N and N·m."""

    header: Header = DEFAULT
    joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
    transforms: Annotated[list[Transform], Sequence[Transform]] = DEFAULT
    twist: Annotated[list[Twist], Sequence[Twist]] = DEFAULT
    wrench: Annotated[list[Wrench], Sequence[Wrench]] = DEFAULT


class PointField(Message, typename="sensor_msgs/msg/PointField"):
    """One value of each point of a PointCloud2.

    Attributes:
        name: Such as ``x`` or ``intensity``.
        offset: Where it begins in a point, in bytes.
        datatype: Type of number, one of the constants.
        count: How many numbers there are.
    """

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
    """Points in space, each with any values, packed as the sensor sends them.

    Attributes:
        header: When they were measured, and their frame.
        height: Number of rows; 1 if the points have no order.
        width: Number of points in a row.
        fields: What a point consists of; coordinates are called x, y and z, in m.
        is_bigendian: Whether numbers have the highest byte first.
        point_step: Number of bytes from one point to the next.
        row_step: Number of bytes from one row to the next.
        data: All points, `row_step` times `height` bytes.
        is_dense: Whether every point is valid.
    """

    header: Header = DEFAULT
    height: uint32 = 0
    width: uint32 = 0
    fields: Annotated[list[PointField], Sequence[PointField]] = DEFAULT
    is_bigendian: bool = False
    point_step: uint32 = 0
    row_step: uint32 = 0
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    is_dense: bool = False


class RegionOfInterest(Message, typename="sensor_msgs/msg/RegionOfInterest"):
    """A rectangle of an image, in pixels; all zeros mean the whole image."""

    x_offset: uint32 = 0
    y_offset: uint32 = 0
    height: uint32 = 0
    width: uint32 = 0
    do_rectify: bool = False


class CameraInfo(Message, typename="sensor_msgs/msg/CameraInfo"):
    """How a camera maps space to its image; goes with each Image of the same stamp.

    Attributes:
        header: Time of the image, and the optical frame: x right, y down, z forward.
        height: Of the image it was calibrated with, in pixels.
        width: Of the image it was calibrated with, in pixels.
        distortion_model: Such as ``plumb_bob``; says what `d` means.
        d: Coefficients of the distortion.
        k: Intrinsic matrix, 3 by 3 row by row; focal lengths and center in pixels.
        r: Rotation that makes the images of a stereo pair parallel, 3 by 3.
        p: Projection of a point to the rectified image, 3 by 4, in pixels.
        binning_x: Pixels combined along x; 0 means 1.
        binning_y: Pixels combined along y; 0 means 1.
        roi: The part of the image that is sent; all zeros mean the whole.
    """

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
    """One value for each point of a PointCloud, such as its intensity."""

    name: str = ""
    values: Annotated[Floats, Sequence[float32]] = DEFAULT


class CompressedImage(Message, typename="sensor_msgs/msg/CompressedImage"):
    """An image in a file format: `format` says which, such as ``jpeg`` or ``png``."""

    header: Header = DEFAULT
    format: str = ""
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class FluidPressure(Message, typename="sensor_msgs/msg/FluidPressure"):
    """Pressure of air or water in Pa; `variance` in Pa², 0 if unknown."""

    header: Header = DEFAULT
    fluid_pressure: float64 = 0.0
    variance: float64 = 0.0


class Illuminance(Message, typename="sensor_msgs/msg/Illuminance"):
    """Brightness as people see it, in lux; `variance` in lux², 0 if unknown."""

    header: Header = DEFAULT
    illuminance: float64 = 0.0
    variance: float64 = 0.0


class Image(Message, typename="sensor_msgs/msg/Image"):
    """An image without compression.

    Attributes:
        header: When it was exposed, and the optical frame of the camera.
        height: Number of rows.
        width: Number of pixels in a row.
        encoding: What a pixel is, such as ``rgb8``, ``mono16`` or ``32FC1``.
        is_bigendian: 1 if numbers of several bytes have the highest first.
        step: Number of bytes in a row.
        data: All rows, `step` times `height` bytes.
    """

    header: Header = DEFAULT
    height: uint32 = 0
    width: uint32 = 0
    encoding: str = ""
    is_bigendian: uint8 = 0
    step: uint32 = 0
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class Imu(Message, typename="sensor_msgs/msg/Imu"):
    """What an inertial measurement unit measured.

    A covariance of zeros is unknown; -1 as its first element says that nothing was measured.

    Attributes:
        header: When it was measured, and the frame of the unit.
        orientation: Estimated rotation, as a unit quaternion.
        orientation_covariance: 3 by 3 about x, y and z, in rad².
        angular_velocity: In rad/s.
        angular_velocity_covariance: 3 by 3, in (rad/s)².
        linear_acceleration: In m/s², gravity included.
        linear_acceleration_covariance: 3 by 3, in (m/s²)².
    """

    header: Header = DEFAULT
    orientation: Quaternion = DEFAULT
    orientation_covariance: Annotated[Floats, Array[float64, 9]] = DEFAULT
    angular_velocity: Vector3 = DEFAULT
    angular_velocity_covariance: Annotated[Floats, Array[float64, 9]] = DEFAULT
    linear_acceleration: Vector3 = DEFAULT
    linear_acceleration_covariance: Annotated[Floats, Array[float64, 9]] = DEFAULT


class Joy(Message, typename="sensor_msgs/msg/Joy"):
    """The state of a joystick: each axis from -1 to 1, each button 1 while it is down."""

    header: Header = DEFAULT
    axes: Annotated[Floats, Sequence[float32]] = DEFAULT
    buttons: Annotated[Ints, Sequence[int32]] = DEFAULT


class JoyFeedback(Message, typename="sensor_msgs/msg/JoyFeedback"):
    """What a joystick should let its user feel; `intensity` from 0 to 1, or in Hz for a buzzer."""

    TYPE_LED: ClassVar[uint8] = 0
    TYPE_RUMBLE: ClassVar[uint8] = 1
    TYPE_BUZZER: ClassVar[uint8] = 2

    type: uint8 = 0
    id: uint8 = 0
    intensity: float32 = 0.0


class JoyFeedbackArray(Message, typename="sensor_msgs/msg/JoyFeedbackArray"):
    """Several feedbacks for a joystick at once."""

    array: Annotated[list[JoyFeedback], Sequence[JoyFeedback]] = DEFAULT


class LaserEcho(Message, typename="sensor_msgs/msg/LaserEcho"):
    """All echoes of one ray, in m or as intensities."""

    echoes: Annotated[Floats, Sequence[float32]] = DEFAULT


class LaserScan(Message, typename="sensor_msgs/msg/LaserScan"):
    """One turn of a laser scanner in a plane.

    Attributes:
        header: When the first ray was measured, and the frame whose z axis the scanner turns about.
        angle_min: Angle of the first ray, in rad; 0 is along x.
        angle_max: Angle of the last ray, in rad.
        angle_increment: Angle from one ray to the next, in rad.
        time_increment: Time from one ray to the next, in s.
        scan_time: Time from one scan to the next, in s.
        range_min: Shorter ranges are not valid, in m.
        range_max: Longer ranges are not valid, in m.
        ranges: Distance along each ray, in m; infinity or NaN where there is none.
        intensities: Strength of each echo, in the device's own unit; may be empty.
    """

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
    """Strength and direction of the magnetic field, in T; covariance 3 by 3, in T²."""

    header: Header = DEFAULT
    magnetic_field: Vector3 = DEFAULT
    magnetic_field_covariance: Annotated[Floats, Array[float64, 9]] = DEFAULT


class MultiEchoLaserScan(Message, typename="sensor_msgs/msg/MultiEchoLaserScan"):
    """One turn of a laser scanner that gets several echoes of a ray.

    Attributes:
        header: When the first ray was measured, and the frame whose z axis the scanner turns about.
        angle_min: Angle of the first ray, in rad; 0 is along x.
        angle_max: Angle of the last ray, in rad.
        angle_increment: Angle from one ray to the next, in rad.
        time_increment: Time from one ray to the next, in s.
        scan_time: Time from one scan to the next, in s.
        range_min: Shorter ranges are not valid, in m.
        range_max: Longer ranges are not valid, in m.
        ranges: Distances along each ray, in m.
        intensities: Strength of each echo, in the device's own unit; may be empty.
    """

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
    """Whether there is a fix, and the sum of the satellite systems that are used."""

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
    """A position on Earth by satellite, on the WGS 84 ellipsoid.

    Attributes:
        header: When it was measured, and the frame of the antenna.
        status: Whether there is a fix, and by which satellites.
        latitude: In degrees, north is positive.
        longitude: In degrees, east is positive.
        altitude: In m above the ellipsoid; NaN if unknown.
        position_covariance: 3 by 3 over east, north and up, in m².
        position_covariance_type: How it is known, one of the constants.
    """

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
    """Points in space, in m, with further values each; new code uses PointCloud2."""

    header: Header = DEFAULT
    points: Annotated[list[Point32], Sequence[Point32]] = DEFAULT
    channels: Annotated[list[ChannelFloat32], Sequence[ChannelFloat32]] = DEFAULT


class Range(Message, typename="sensor_msgs/msg/Range"):
    """One distance, from an ultrasonic or infrared sensor.

    Attributes:
        header: When it was measured, and the frame whose x axis points forward.
        radiation_type: One of the constants.
        field_of_view: Angle of the cone in which things are seen, in rad.
        min_range: Shorter ranges are not valid, in m.
        max_range: Longer ranges are not valid, in m.
        range: The distance, in m; plus or minus infinity if nothing was seen, or something too
            close.
        variance: In m², 0 if unknown. ROS 2 Humble does not have this field.
    """

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
    """Humidity of the air, from 0 to 1; `variance` is 0 if unknown."""

    header: Header = DEFAULT
    relative_humidity: float64 = 0.0
    variance: float64 = 0.0


class Temperature(Message, typename="sensor_msgs/msg/Temperature"):
    """Temperature in °C; `variance` in °C², 0 if unknown."""

    header: Header = DEFAULT
    temperature: float64 = 0.0
    variance: float64 = 0.0


class TimeReference(Message, typename="sensor_msgs/msg/TimeReference"):
    """What another clock showed: `time_ref`, by `source`, at the time of the header."""

    header: Header = DEFAULT
    time_ref: Time = DEFAULT
    source: str = ""
