"""Messages of mavros_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.interfaces.geographic_msgs.msg import GeoPoint
from aionode.interfaces.geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from aionode.interfaces.rcl_interfaces.msg import ParameterValue
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
    int16,
    int32,
    int64,
    uint8,
    uint16,
    uint32,
    uint64,
)

__all__ = [
    "GPSINPUT",
    "GPSRAW",
    "GPSRTK",
    "RTCM",
    "ADSBVehicle",
    "ActuatorControl",
    "Altitude",
    "AttitudeTarget",
    "CamIMUStamp",
    "CameraImageCaptured",
    "CellularStatus",
    "CommandCode",
    "CompanionProcessStatus",
    "DebugValue",
    "ESCInfo",
    "ESCInfoItem",
    "ESCStatus",
    "ESCStatusItem",
    "ESCTelemetry",
    "ESCTelemetryItem",
    "EstimatorStatus",
    "ExtendedState",
    "FileEntry",
    "GimbalDeviceAttitudeStatus",
    "GimbalDeviceInformation",
    "GimbalDeviceSetAttitude",
    "GimbalManagerInformation",
    "GimbalManagerSetAttitude",
    "GimbalManagerSetPitchyaw",
    "GimbalManagerStatus",
    "GlobalPositionTarget",
    "HilActuatorControls",
    "HilControls",
    "HilGPS",
    "HilSensor",
    "HilStateQuaternion",
    "HomePosition",
    "LandingTarget",
    "LogData",
    "LogEntry",
    "MagnetometerReporter",
    "ManualControl",
    "Mavlink",
    "MountControl",
    "NavControllerOutput",
    "OnboardComputerStatus",
    "OpenDroneIDBasicID",
    "OpenDroneIDOperatorID",
    "OpenDroneIDSelfID",
    "OpenDroneIDSystem",
    "OpenDroneIDSystemUpdate",
    "OpticalFlow",
    "OpticalFlowRad",
    "OverrideRCIn",
    "Param",
    "ParamEvent",
    "ParamValue",
    "PlayTuneV2",
    "PositionTarget",
    "RCIn",
    "RCOut",
    "RTKBaseline",
    "RadioStatus",
    "State",
    "StatusEvent",
    "StatusText",
    "SysStatus",
    "TerrainReport",
    "Thrust",
    "TimesyncStatus",
    "Trajectory",
    "Tunnel",
    "VehicleInfo",
    "VfrHud",
    "Vibration",
    "Waypoint",
    "WaypointList",
    "WaypointReached",
    "WheelOdomStamped",
]


class ADSBVehicle(Message, typename="mavros_msgs/msg/ADSBVehicle"):
    """ADSBVehicle, as MAVROS defines it."""

    ALT_PRESSURE_QNH: ClassVar[uint8] = 0
    ALT_GEOMETRIC: ClassVar[uint8] = 1
    EMITTER_NO_INFO: ClassVar[uint8] = 0
    EMITTER_LIGHT: ClassVar[uint8] = 1
    EMITTER_SMALL: ClassVar[uint8] = 2
    EMITTER_LARGE: ClassVar[uint8] = 3
    EMITTER_HIGH_VORTEX_LARGE: ClassVar[uint8] = 4
    EMITTER_HEAVY: ClassVar[uint8] = 5
    EMITTER_HIGHLY_MANUV: ClassVar[uint8] = 6
    EMITTER_ROTOCRAFT: ClassVar[uint8] = 7
    EMITTER_UNASSIGNED: ClassVar[uint8] = 8
    EMITTER_GLIDER: ClassVar[uint8] = 9
    EMITTER_LIGHTER_AIR: ClassVar[uint8] = 10
    EMITTER_PARACHUTE: ClassVar[uint8] = 11
    EMITTER_ULTRA_LIGHT: ClassVar[uint8] = 12
    EMITTER_UNASSIGNED2: ClassVar[uint8] = 13
    EMITTER_UAV: ClassVar[uint8] = 14
    EMITTER_SPACE: ClassVar[uint8] = 15
    EMITTER_UNASSGINED3: ClassVar[uint8] = 16
    EMITTER_EMERGENCY_SURFACE: ClassVar[uint8] = 17
    EMITTER_SERVICE_SURFACE: ClassVar[uint8] = 18
    EMITTER_POINT_OBSTACLE: ClassVar[uint8] = 19
    FLAG_VALID_COORDS: ClassVar[uint16] = 1
    FLAG_VALID_ALTITUDE: ClassVar[uint16] = 2
    FLAG_VALID_HEADING: ClassVar[uint16] = 4
    FLAG_VALID_VELOCITY: ClassVar[uint16] = 8
    FLAG_VALID_CALLSIGN: ClassVar[uint16] = 16
    FLAG_VALID_SQUAWK: ClassVar[uint16] = 32
    FLAG_SIMULATED: ClassVar[uint16] = 64
    FLAG_VERTICAL_VELOCITY_VALID: ClassVar[uint16] = 128
    FLAG_BARO_VALID: ClassVar[uint16] = 256
    FLAG_SOURCE_UAT: ClassVar[uint16] = 32768

    header: Header = DEFAULT
    icao_address: uint32 = 0
    callsign: str = ""
    latitude: float64 = 0.0
    longitude: float64 = 0.0
    altitude: float32 = 0.0
    heading: float32 = 0.0
    hor_velocity: float32 = 0.0
    ver_velocity: float32 = 0.0
    altitude_type: uint8 = 0
    emitter_type: uint8 = 0
    tslc: Duration = DEFAULT
    flags: uint16 = 0
    squawk: uint16 = 0


class ActuatorControl(Message, typename="mavros_msgs/msg/ActuatorControl"):
    """ActuatorControl, as MAVROS defines it."""

    PX4_MIX_FLIGHT_CONTROL: ClassVar[uint8] = 0
    PX4_MIX_FLIGHT_CONTROL_VTOL_ALT: ClassVar[uint8] = 1
    PX4_MIX_PAYLOAD: ClassVar[uint8] = 2
    PX4_MIX_MANUAL_PASSTHROUGH: ClassVar[uint8] = 3

    header: Header = DEFAULT
    group_mix: uint8 = 0
    controls: Annotated[Floats, Array[float32, 8]] = DEFAULT


class Altitude(Message, typename="mavros_msgs/msg/Altitude"):
    """Altitude, as MAVROS defines it."""

    header: Header = DEFAULT
    monotonic: float32 = 0.0
    amsl: float32 = 0.0
    local: float32 = 0.0
    relative: float32 = 0.0
    terrain: float32 = 0.0
    bottom_clearance: float32 = 0.0


class AttitudeTarget(Message, typename="mavros_msgs/msg/AttitudeTarget"):
    """AttitudeTarget, as MAVROS defines it."""

    IGNORE_ROLL_RATE: ClassVar[uint8] = 1
    IGNORE_PITCH_RATE: ClassVar[uint8] = 2
    IGNORE_YAW_RATE: ClassVar[uint8] = 4
    IGNORE_THRUST: ClassVar[uint8] = 64
    IGNORE_ATTITUDE: ClassVar[uint8] = 128

    header: Header = DEFAULT
    type_mask: uint8 = 0
    orientation: Quaternion = DEFAULT
    body_rate: Vector3 = DEFAULT
    thrust: float32 = 0.0


class CamIMUStamp(Message, typename="mavros_msgs/msg/CamIMUStamp"):
    """CamIMUStamp, as MAVROS defines it."""

    frame_stamp: Time = DEFAULT
    frame_seq_id: int32 = 0


class CameraImageCaptured(Message, typename="mavros_msgs/msg/CameraImageCaptured"):
    """CameraImageCaptured, as MAVROS defines it."""

    header: Header = DEFAULT
    orientation: Quaternion = DEFAULT
    geo: GeoPoint = DEFAULT
    relative_alt: float32 = 0.0
    image_index: int32 = 0
    capture_result: int8 = 0
    file_url: str = ""


class CellularStatus(Message, typename="mavros_msgs/msg/CellularStatus"):
    """CellularStatus, as MAVROS defines it."""

    status: uint8 = 0
    failure_reason: uint8 = 0
    type: uint8 = 0
    quality: uint8 = 0
    mcc: uint16 = 0
    mnc: uint16 = 0
    lac: uint16 = 0


class CommandCode(Message, typename="mavros_msgs/msg/CommandCode"):
    """CommandCode, as MAVROS defines it."""

    AIRFRAME_CONFIGURATION: ClassVar[uint16] = 2520
    ARM_AUTHORIZATION_REQUEST: ClassVar[uint16] = 3001
    CAMERA_TRACK_POINT: ClassVar[uint16] = 2004
    CAMERA_TRACK_RECTANGLE: ClassVar[uint16] = 2005
    CAMERA_STOP_TRACKING: ClassVar[uint16] = 2010
    CAN_FORWARD: ClassVar[uint16] = 32000
    COMPONENT_ARM_DISARM: ClassVar[uint16] = 400
    CONDITION_DELAY: ClassVar[uint16] = 112
    CONDITION_CHANGE_ALT: ClassVar[uint16] = 113
    CONDITION_DISTANCE: ClassVar[uint16] = 114
    CONDITION_YAW: ClassVar[uint16] = 115
    CONDITION_LAST: ClassVar[uint16] = 159
    CONTROL_HIGH_LATENCY: ClassVar[uint16] = 2600
    DO_FOLLOW: ClassVar[uint16] = 32
    DO_FOLLOW_REPOSITION: ClassVar[uint16] = 33
    DO_SET_MODE: ClassVar[uint16] = 176
    DO_JUMP: ClassVar[uint16] = 177
    DO_CHANGE_SPEED: ClassVar[uint16] = 178
    DO_SET_HOME: ClassVar[uint16] = 179
    DO_SET_PARAMETER: ClassVar[uint16] = 180
    DO_SET_RELAY: ClassVar[uint16] = 181
    DO_REPEAT_RELAY: ClassVar[uint16] = 182
    DO_SET_SERVO: ClassVar[uint16] = 183
    DO_REPEAT_SERVO: ClassVar[uint16] = 184
    DO_FLIGHTTERMINATION: ClassVar[uint16] = 185
    DO_CHANGE_ALTITUDE: ClassVar[uint16] = 186
    DO_RETURN_PATH_START: ClassVar[uint16] = 188
    DO_LAND_START: ClassVar[uint16] = 189
    DO_RALLY_LAND: ClassVar[uint16] = 190
    DO_GO_AROUND: ClassVar[uint16] = 191
    DO_REPOSITION: ClassVar[uint16] = 192
    DO_PAUSE_CONTINUE: ClassVar[uint16] = 193
    DO_SET_REVERSE: ClassVar[uint16] = 194
    DO_SET_ROI_LOCATION: ClassVar[uint16] = 195
    DO_SET_ROI_WPNEXT_OFFSET: ClassVar[uint16] = 196
    DO_SET_ROI_NONE: ClassVar[uint16] = 197
    DO_SET_ROI_SYSID: ClassVar[uint16] = 198
    DO_CONTROL_VIDEO: ClassVar[uint16] = 200
    DO_SET_ROI: ClassVar[uint16] = 201
    DO_DIGICAM_CONFIGURE: ClassVar[uint16] = 202
    DO_DIGICAM_CONTROL: ClassVar[uint16] = 203
    DO_MOUNT_CONFIGURE: ClassVar[uint16] = 204
    DO_MOUNT_CONTROL: ClassVar[uint16] = 205
    DO_SET_CAM_TRIGG_DIST: ClassVar[uint16] = 206
    DO_FENCE_ENABLE: ClassVar[uint16] = 207
    DO_PARACHUTE: ClassVar[uint16] = 208
    DO_MOTOR_TEST: ClassVar[uint16] = 209
    DO_INVERTED_FLIGHT: ClassVar[uint16] = 210
    DO_GRIPPER: ClassVar[uint16] = 211
    DO_AUTOTUNE_ENABLE: ClassVar[uint16] = 212
    DO_SET_CAM_TRIGG_INTERVAL: ClassVar[uint16] = 214
    DO_MOUNT_CONTROL_QUAT: ClassVar[uint16] = 220
    DO_GUIDED_MASTER: ClassVar[uint16] = 221
    DO_GUIDED_LIMITS: ClassVar[uint16] = 222
    DO_ENGINE_CONTROL: ClassVar[uint16] = 223
    DO_SET_MISSION_CURRENT: ClassVar[uint16] = 224
    DO_LAST: ClassVar[uint16] = 240
    DO_JUMP_TAG: ClassVar[uint16] = 601
    DO_GIMBAL_MANAGER_PITCHYAW: ClassVar[uint16] = 1000
    DO_GIMBAL_MANAGER_CONFIGURE: ClassVar[uint16] = 1001
    DO_TRIGGER_CONTROL: ClassVar[uint16] = 2003
    DO_VTOL_TRANSITION: ClassVar[uint16] = 3000
    DO_SET_SAFETY_SWITCH_STATE: ClassVar[uint16] = 5300
    DO_ADSB_OUT_IDENT: ClassVar[uint16] = 10001
    DO_WINCH: ClassVar[uint16] = 42600
    EXTERNAL_POSITION_ESTIMATE: ClassVar[uint16] = 43003
    FIXED_MAG_CAL_YAW: ClassVar[uint16] = 42006
    GET_HOME_POSITION: ClassVar[uint16] = 410
    GET_MESSAGE_INTERVAL: ClassVar[uint16] = 510
    IMAGE_START_CAPTURE: ClassVar[uint16] = 2000
    IMAGE_STOP_CAPTURE: ClassVar[uint16] = 2001
    JUMP_TAG: ClassVar[uint16] = 600
    LOGGING_START: ClassVar[uint16] = 2510
    LOGGING_STOP: ClassVar[uint16] = 2511
    MISSION_START: ClassVar[uint16] = 300
    NAV_WAYPOINT: ClassVar[uint16] = 16
    NAV_LOITER_UNLIM: ClassVar[uint16] = 17
    NAV_LOITER_TURNS: ClassVar[uint16] = 18
    NAV_LOITER_TIME: ClassVar[uint16] = 19
    NAV_RETURN_TO_LAUNCH: ClassVar[uint16] = 20
    NAV_LAND: ClassVar[uint16] = 21
    NAV_TAKEOFF: ClassVar[uint16] = 22
    NAV_LAND_LOCAL: ClassVar[uint16] = 23
    NAV_TAKEOFF_LOCAL: ClassVar[uint16] = 24
    NAV_FOLLOW: ClassVar[uint16] = 25
    NAV_CONTINUE_AND_CHANGE_ALT: ClassVar[uint16] = 30
    NAV_LOITER_TO_ALT: ClassVar[uint16] = 31
    NAV_ROI: ClassVar[uint16] = 80
    NAV_PATHPLANNING: ClassVar[uint16] = 81
    NAV_SPLINE_WAYPOINT: ClassVar[uint16] = 82
    NAV_VTOL_TAKEOFF: ClassVar[uint16] = 84
    NAV_VTOL_LAND: ClassVar[uint16] = 85
    NAV_GUIDED_ENABLE: ClassVar[uint16] = 92
    NAV_DELAY: ClassVar[uint16] = 93
    NAV_PAYLOAD_PLACE: ClassVar[uint16] = 94
    NAV_LAST: ClassVar[uint16] = 95
    NAV_SET_YAW_SPEED: ClassVar[uint16] = 213
    NAV_FENCE_RETURN_POINT: ClassVar[uint16] = 5000
    NAV_FENCE_POLYGON_VERTEX_INCLUSION: ClassVar[uint16] = 5001
    NAV_FENCE_POLYGON_VERTEX_EXCLUSION: ClassVar[uint16] = 5002
    NAV_FENCE_CIRCLE_INCLUSION: ClassVar[uint16] = 5003
    NAV_FENCE_CIRCLE_EXCLUSION: ClassVar[uint16] = 5004
    NAV_RALLY_POINT: ClassVar[uint16] = 5100
    OBLIQUE_SURVEY: ClassVar[uint16] = 260
    OVERRIDE_GOTO: ClassVar[uint16] = 252
    PANORAMA_CREATE: ClassVar[uint16] = 2800
    PAYLOAD_PREPARE_DEPLOY: ClassVar[uint16] = 30001
    PAYLOAD_CONTROL_DEPLOY: ClassVar[uint16] = 30002
    PREFLIGHT_CALIBRATION: ClassVar[uint16] = 241
    PREFLIGHT_SET_SENSOR_OFFSETS: ClassVar[uint16] = 242
    PREFLIGHT_UAVCAN: ClassVar[uint16] = 243
    PREFLIGHT_STORAGE: ClassVar[uint16] = 245
    PREFLIGHT_REBOOT_SHUTDOWN: ClassVar[uint16] = 246
    REQUEST_MESSAGE: ClassVar[uint16] = 512
    REQUEST_PROTOCOL_VERSION: ClassVar[uint16] = 519
    REQUEST_AUTOPILOT_CAPABILITIES: ClassVar[uint16] = 520
    REQUEST_CAMERA_INFORMATION: ClassVar[uint16] = 521
    REQUEST_CAMERA_SETTINGS: ClassVar[uint16] = 522
    REQUEST_STORAGE_INFORMATION: ClassVar[uint16] = 525
    REQUEST_CAMERA_CAPTURE_STATUS: ClassVar[uint16] = 527
    REQUEST_FLIGHT_INFORMATION: ClassVar[uint16] = 528
    REQUEST_VIDEO_STREAM_INFORMATION: ClassVar[uint16] = 2504
    REQUEST_VIDEO_STREAM_STATUS: ClassVar[uint16] = 2505
    RESET_CAMERA_SETTINGS: ClassVar[uint16] = 529
    RUN_PREARM_CHECKS: ClassVar[uint16] = 401
    SET_MESSAGE_INTERVAL: ClassVar[uint16] = 511
    SET_CAMERA_MODE: ClassVar[uint16] = 530
    SET_CAMERA_ZOOM: ClassVar[uint16] = 531
    SET_CAMERA_FOCUS: ClassVar[uint16] = 532
    SET_STORAGE_USAGE: ClassVar[uint16] = 533
    SET_CAMERA_SOURCE: ClassVar[uint16] = 534
    SET_GUIDED_SUBMODE_STANDARD: ClassVar[uint16] = 4000
    SET_GUIDED_SUBMODE_CIRCLE: ClassVar[uint16] = 4001
    START_RX_PAIR: ClassVar[uint16] = 500
    STORAGE_FORMAT: ClassVar[uint16] = 526
    UAVCAN_GET_NODE_INFO: ClassVar[uint16] = 5200
    VIDEO_START_CAPTURE: ClassVar[uint16] = 2500
    VIDEO_STOP_CAPTURE: ClassVar[uint16] = 2501
    VIDEO_START_STREAMING: ClassVar[uint16] = 2502
    VIDEO_STOP_STREAMING: ClassVar[uint16] = 2503


class CompanionProcessStatus(Message, typename="mavros_msgs/msg/CompanionProcessStatus"):
    """CompanionProcessStatus, as MAVROS defines it."""

    MAV_STATE_UNINIT: ClassVar[uint8] = 0
    MAV_STATE_BOOT: ClassVar[uint8] = 1
    MAV_STATE_CALIBRATING: ClassVar[uint8] = 2
    MAV_STATE_STANDBY: ClassVar[uint8] = 3
    MAV_STATE_ACTIVE: ClassVar[uint8] = 4
    MAV_STATE_CRITICAL: ClassVar[uint8] = 5
    MAV_STATE_EMERGENCY: ClassVar[uint8] = 6
    MAV_STATE_POWEROFF: ClassVar[uint8] = 7
    MAV_STATE_FLIGHT_TERMINATION: ClassVar[uint8] = 8
    MAV_COMP_ID_OBSTACLE_AVOIDANCE: ClassVar[uint8] = 196
    MAV_COMP_ID_VISUAL_INERTIAL_ODOMETRY: ClassVar[uint8] = 197

    header: Header = DEFAULT
    state: uint8 = 0
    component: uint8 = 0


class DebugValue(Message, typename="mavros_msgs/msg/DebugValue"):
    """DebugValue, as MAVROS defines it."""

    TYPE_DEBUG: ClassVar[uint8] = 0
    TYPE_DEBUG_VECT: ClassVar[uint8] = 1
    TYPE_DEBUG_FLOAT_ARRAY: ClassVar[uint8] = 2
    TYPE_NAMED_VALUE_FLOAT: ClassVar[uint8] = 3
    TYPE_NAMED_VALUE_INT: ClassVar[uint8] = 4

    header: Header = DEFAULT
    index: int32 = 0
    array_id: int32 = 0
    name: str = ""
    value_float: float32 = 0.0
    value_int: int32 = 0
    data: Annotated[Floats, Sequence[float32]] = DEFAULT
    type: uint8 = 0


class ESCInfoItem(Message, typename="mavros_msgs/msg/ESCInfoItem"):
    """ESCInfoItem, as MAVROS defines it."""

    header: Header = DEFAULT
    failure_flags: uint16 = 0
    error_count: uint32 = 0
    temperature: int32 = 0


class ESCInfo(Message, typename="mavros_msgs/msg/ESCInfo"):
    """ESCInfo, as MAVROS defines it."""

    header: Header = DEFAULT
    counter: uint16 = 0
    count: uint8 = 0
    connection_type: uint8 = 0
    info: uint8 = 0
    esc_info: Annotated[list[ESCInfoItem], Sequence[ESCInfoItem]] = DEFAULT


class ESCStatusItem(Message, typename="mavros_msgs/msg/ESCStatusItem"):
    """ESCStatusItem, as MAVROS defines it."""

    header: Header = DEFAULT
    rpm: int32 = 0
    voltage: float32 = 0.0
    current: float32 = 0.0


class ESCStatus(Message, typename="mavros_msgs/msg/ESCStatus"):
    """ESCStatus, as MAVROS defines it."""

    header: Header = DEFAULT
    esc_status: Annotated[list[ESCStatusItem], Sequence[ESCStatusItem]] = DEFAULT


class ESCTelemetryItem(Message, typename="mavros_msgs/msg/ESCTelemetryItem"):
    """ESCTelemetryItem, as MAVROS defines it."""

    header: Header = DEFAULT
    temperature: float32 = 0.0
    voltage: float32 = 0.0
    current: float32 = 0.0
    totalcurrent: float32 = 0.0
    rpm: int32 = 0
    count: uint16 = 0


class ESCTelemetry(Message, typename="mavros_msgs/msg/ESCTelemetry"):
    """ESCTelemetry, as MAVROS defines it."""

    header: Header = DEFAULT
    esc_telemetry: Annotated[list[ESCTelemetryItem], Sequence[ESCTelemetryItem]] = DEFAULT


class EstimatorStatus(Message, typename="mavros_msgs/msg/EstimatorStatus"):
    """EstimatorStatus, as MAVROS defines it."""

    header: Header = DEFAULT
    attitude_status_flag: bool = False
    velocity_horiz_status_flag: bool = False
    velocity_vert_status_flag: bool = False
    pos_horiz_rel_status_flag: bool = False
    pos_horiz_abs_status_flag: bool = False
    pos_vert_abs_status_flag: bool = False
    pos_vert_agl_status_flag: bool = False
    const_pos_mode_status_flag: bool = False
    pred_pos_horiz_rel_status_flag: bool = False
    pred_pos_horiz_abs_status_flag: bool = False
    gps_glitch_status_flag: bool = False
    accel_error_status_flag: bool = False


class ExtendedState(Message, typename="mavros_msgs/msg/ExtendedState"):
    """ExtendedState, as MAVROS defines it."""

    VTOL_STATE_UNDEFINED: ClassVar[uint8] = 0
    VTOL_STATE_TRANSITION_TO_FW: ClassVar[uint8] = 1
    VTOL_STATE_TRANSITION_TO_MC: ClassVar[uint8] = 2
    VTOL_STATE_MC: ClassVar[uint8] = 3
    VTOL_STATE_FW: ClassVar[uint8] = 4
    LANDED_STATE_UNDEFINED: ClassVar[uint8] = 0
    LANDED_STATE_ON_GROUND: ClassVar[uint8] = 1
    LANDED_STATE_IN_AIR: ClassVar[uint8] = 2
    LANDED_STATE_TAKEOFF: ClassVar[uint8] = 3
    LANDED_STATE_LANDING: ClassVar[uint8] = 4

    header: Header = DEFAULT
    vtol_state: uint8 = 0
    landed_state: uint8 = 0


class FileEntry(Message, typename="mavros_msgs/msg/FileEntry"):
    """FileEntry, as MAVROS defines it."""

    TYPE_FILE: ClassVar[uint8] = 0
    TYPE_DIRECTORY: ClassVar[uint8] = 1

    name: str = ""
    type: uint8 = 0
    size: uint64 = 0


class GPSINPUT(Message, typename="mavros_msgs/msg/GPSINPUT"):
    """GPSINPUT, as MAVROS defines it."""

    GPS_FIX_TYPE_NO_GPS: ClassVar[uint8] = 0
    GPS_FIX_TYPE_NO_FIX: ClassVar[uint8] = 1
    GPS_FIX_TYPE_2D_FIX: ClassVar[uint8] = 2
    GPS_FIX_TYPE_3D_FIX: ClassVar[uint8] = 3
    GPS_FIX_TYPE_DGPS: ClassVar[uint8] = 4
    GPS_FIX_TYPE_RTK_FLOATR: ClassVar[uint8] = 5
    GPS_FIX_TYPE_RTK_FIXEDR: ClassVar[uint8] = 6
    GPS_FIX_TYPE_STATIC: ClassVar[uint8] = 7
    GPS_FIX_TYPE_PPP: ClassVar[uint8] = 8

    header: Header = DEFAULT
    fix_type: uint8 = 0
    gps_id: uint8 = 0
    ignore_flags: uint16 = 0
    time_week_ms: uint32 = 0
    time_week: uint16 = 0
    lat: int32 = 0
    lon: int32 = 0
    alt: float32 = 0.0
    hdop: float32 = 0.0
    vdop: float32 = 0.0
    vn: float32 = 0.0
    ve: float32 = 0.0
    vd: float32 = 0.0
    speed_accuracy: float32 = 0.0
    horiz_accuracy: float32 = 0.0
    vert_accuracy: float32 = 0.0
    satellites_visible: uint8 = 0
    yaw: uint16 = 0


class GPSRAW(Message, typename="mavros_msgs/msg/GPSRAW"):
    """GPSRAW, as MAVROS defines it."""

    GPS_FIX_TYPE_NO_GPS: ClassVar[uint8] = 0
    GPS_FIX_TYPE_NO_FIX: ClassVar[uint8] = 1
    GPS_FIX_TYPE_2D_FIX: ClassVar[uint8] = 2
    GPS_FIX_TYPE_3D_FIX: ClassVar[uint8] = 3
    GPS_FIX_TYPE_DGPS: ClassVar[uint8] = 4
    GPS_FIX_TYPE_RTK_FLOAT: ClassVar[uint8] = 5
    GPS_FIX_TYPE_RTK_FIXED: ClassVar[uint8] = 6
    GPS_FIX_TYPE_STATIC: ClassVar[uint8] = 7
    GPS_FIX_TYPE_PPP: ClassVar[uint8] = 8

    header: Header = DEFAULT
    fix_type: uint8 = 0
    lat: int32 = 0
    lon: int32 = 0
    alt: int32 = 0
    eph: uint16 = 0
    epv: uint16 = 0
    vel: uint16 = 0
    cog: uint16 = 0
    satellites_visible: uint8 = 0
    alt_ellipsoid: int32 = 0
    h_acc: uint32 = 0
    v_acc: uint32 = 0
    vel_acc: uint32 = 0
    hdg_acc: int32 = 0
    yaw: uint16 = 0
    dgps_numch: uint8 = 0
    dgps_age: uint32 = 0


class GPSRTK(Message, typename="mavros_msgs/msg/GPSRTK"):
    """GPSRTK, as MAVROS defines it."""

    header: Header = DEFAULT
    rtk_receiver_id: uint8 = 0
    wn: int16 = 0
    tow: uint32 = 0
    rtk_health: uint8 = 0
    rtk_rate: uint8 = 0
    nsats: uint8 = 0
    baseline_a: int32 = 0
    baseline_b: int32 = 0
    baseline_c: int32 = 0
    accuracy: uint32 = 0
    iar_num_hypotheses: int32 = 0


class GimbalDeviceAttitudeStatus(Message, typename="mavros_msgs/msg/GimbalDeviceAttitudeStatus"):
    """GimbalDeviceAttitudeStatus, as MAVROS defines it."""

    FLAGS_RETRACT: ClassVar[uint16] = 1
    FLAGS_NEUTRAL: ClassVar[uint16] = 2
    FLAGS_ROLL_LOCK: ClassVar[uint16] = 4
    FLAGS_PITCH_LOCK: ClassVar[uint16] = 8
    FLAGS_YAW_LOCK: ClassVar[uint16] = 16
    ERROR_FLAGS_AT_ROLL_LIMIT: ClassVar[uint32] = 1
    ERROR_FLAGS_AT_PITCH_LIMIT: ClassVar[uint32] = 2
    ERROR_FLAGS_AT_YAW_LIMIT: ClassVar[uint32] = 4
    ERROR_FLAGS_ENCODER_ERROR: ClassVar[uint32] = 8
    ERROR_FLAGS_POWER_ERROR: ClassVar[uint32] = 16
    ERROR_FLAGS_MOTOR_ERROR: ClassVar[uint32] = 32
    ERROR_FLAGS_SOFTWARE_ERROR: ClassVar[uint32] = 64
    ERROR_FLAGS_COMMS_ERROR: ClassVar[uint32] = 128
    ERROR_FLAGS_CALIBRATION_RUNNING: ClassVar[uint32] = 256

    header: Header = DEFAULT
    target_system: uint8 = 0
    target_component: uint8 = 0
    flags: uint16 = 0
    q: Quaternion = DEFAULT
    angular_velocity_x: float32 = 0.0
    angular_velocity_y: float32 = 0.0
    angular_velocity_z: float32 = 0.0
    failure_flags: uint32 = 0


class GimbalDeviceInformation(Message, typename="mavros_msgs/msg/GimbalDeviceInformation"):
    """GimbalDeviceInformation, as MAVROS defines it."""

    CAP_FLAGS_HAS_RETRACT: ClassVar[uint32] = 1
    CAP_FLAGS_HAS_NEUTRAL: ClassVar[uint32] = 2
    CAP_FLAGS_HAS_ROLL_AXIS: ClassVar[uint32] = 4
    CAP_FLAGS_HAS_ROLL_FOLLOW: ClassVar[uint32] = 8
    CAP_FLAGS_HAS_ROLL_LOCK: ClassVar[uint32] = 16
    CAP_FLAGS_HAS_PITCH_AXIS: ClassVar[uint32] = 32
    CAP_FLAGS_HAS_PITCH_FOLLOW: ClassVar[uint32] = 64
    CAP_FLAGS_HAS_PITCH_LOCK: ClassVar[uint32] = 128
    CAP_FLAGS_HAS_YAW_AXIS: ClassVar[uint32] = 256
    CAP_FLAGS_HAS_YAW_FOLLOW: ClassVar[uint32] = 512
    CAP_FLAGS_HAS_YAW_LOCK: ClassVar[uint32] = 1024
    CAP_FLAGS_SUPPORTS_INFINITE_YAW: ClassVar[uint32] = 2048

    header: Header = DEFAULT
    vendor_name: str = ""
    model_name: str = ""
    custom_name: str = ""
    firmware_version: uint32 = 0
    hardware_version: uint32 = 0
    uid: uint64 = 0
    cap_flags: uint32 = 0
    custom_cap_flags: uint16 = 0
    roll_min: float32 = 0.0
    roll_max: float32 = 0.0
    pitch_min: float32 = 0.0
    pitch_max: float32 = 0.0
    yaw_min: float32 = 0.0
    yaw_max: float32 = 0.0


class GimbalDeviceSetAttitude(Message, typename="mavros_msgs/msg/GimbalDeviceSetAttitude"):
    """GimbalDeviceSetAttitude, as MAVROS defines it."""

    FLAGS_RETRACT: ClassVar[uint16] = 1
    FLAGS_NEUTRAL: ClassVar[uint16] = 2
    FLAGS_ROLL_LOCK: ClassVar[uint16] = 4
    FLAGS_PITCH_LOCK: ClassVar[uint16] = 8
    FLAGS_YAW_LOCK: ClassVar[uint16] = 16

    target_system: uint8 = 0
    target_component: uint8 = 0
    flags: uint16 = 0
    q: Quaternion = DEFAULT
    angular_velocity_x: float32 = 0.0
    angular_velocity_y: float32 = 0.0
    angular_velocity_z: float32 = 0.0


class GimbalManagerInformation(Message, typename="mavros_msgs/msg/GimbalManagerInformation"):
    """GimbalManagerInformation, as MAVROS defines it."""

    CAP_FLAGS_HAS_RETRACT: ClassVar[uint32] = 1
    CAP_FLAGS_HAS_NEUTRAL: ClassVar[uint32] = 2
    CAP_FLAGS_HAS_ROLL_AXIS: ClassVar[uint32] = 4
    CAP_FLAGS_HAS_ROLL_FOLLOW: ClassVar[uint32] = 8
    CAP_FLAGS_HAS_ROLL_LOCK: ClassVar[uint32] = 16
    CAP_FLAGS_HAS_PITCH_AXIS: ClassVar[uint32] = 32
    CAP_FLAGS_HAS_PITCH_FOLLOW: ClassVar[uint32] = 64
    CAP_FLAGS_HAS_PITCH_LOCK: ClassVar[uint32] = 128
    CAP_FLAGS_HAS_YAW_AXIS: ClassVar[uint32] = 256
    CAP_FLAGS_HAS_YAW_FOLLOW: ClassVar[uint32] = 512
    CAP_FLAGS_HAS_YAW_LOCK: ClassVar[uint32] = 1024
    CAP_FLAGS_SUPPORTS_INFINITE_YAW: ClassVar[uint32] = 2048
    CAP_FLAGS_CAN_POINT_LOCATION_LOCAL: ClassVar[uint32] = 65536
    CAP_FLAGS_CAN_POINT_LOCATION_GLOBAL: ClassVar[uint32] = 131072

    header: Header = DEFAULT
    cap_flags: uint32 = 0
    gimbal_device_id: uint8 = 0
    roll_min: float32 = 0.0
    roll_max: float32 = 0.0
    pitch_min: float32 = 0.0
    pitch_max: float32 = 0.0
    yaw_min: float32 = 0.0
    yaw_max: float32 = 0.0


class GimbalManagerSetAttitude(Message, typename="mavros_msgs/msg/GimbalManagerSetAttitude"):
    """GimbalManagerSetAttitude, as MAVROS defines it."""

    GIMBAL_MANAGER_FLAGS_RETRACT: ClassVar[uint32] = 1
    GIMBAL_MANAGER_FLAGS_NEUTRAL: ClassVar[uint32] = 2
    GIMBAL_MANAGER_FLAGS_ROLL_LOCK: ClassVar[uint32] = 4
    GIMBAL_MANAGER_FLAGS_PITCH_LOCK: ClassVar[uint32] = 8
    GIMBAL_MANAGER_FLAGS_YAW_LOCK: ClassVar[uint32] = 16

    target_system: uint8 = 0
    target_component: uint8 = 0
    flags: uint32 = 0
    gimbal_device_id: uint8 = 0
    q: Quaternion = DEFAULT
    angular_velocity_x: float32 = 0.0
    angular_velocity_y: float32 = 0.0
    angular_velocity_z: float32 = 0.0


class GimbalManagerSetPitchyaw(Message, typename="mavros_msgs/msg/GimbalManagerSetPitchyaw"):
    """GimbalManagerSetPitchyaw, as MAVROS defines it."""

    GIMBAL_MANAGER_FLAGS_RETRACT: ClassVar[uint32] = 1
    GIMBAL_MANAGER_FLAGS_NEUTRAL: ClassVar[uint32] = 2
    GIMBAL_MANAGER_FLAGS_ROLL_LOCK: ClassVar[uint32] = 4
    GIMBAL_MANAGER_FLAGS_PITCH_LOCK: ClassVar[uint32] = 8
    GIMBAL_MANAGER_FLAGS_YAW_LOCK: ClassVar[uint32] = 16

    target_system: uint8 = 0
    target_component: uint8 = 0
    flags: uint32 = 0
    gimbal_device_id: uint8 = 0
    pitch: float32 = 0.0
    yaw: float32 = 0.0
    pitch_rate: float32 = 0.0
    yaw_rate: float32 = 0.0


class GimbalManagerStatus(Message, typename="mavros_msgs/msg/GimbalManagerStatus"):
    """GimbalManagerStatus, as MAVROS defines it."""

    GIMBAL_MANAGER_FLAGS_RETRACT: ClassVar[uint32] = 1
    GIMBAL_MANAGER_FLAGS_NEUTRAL: ClassVar[uint32] = 2
    GIMBAL_MANAGER_FLAGS_ROLL_LOCK: ClassVar[uint32] = 4
    GIMBAL_MANAGER_FLAGS_PITCH_LOCK: ClassVar[uint32] = 8
    GIMBAL_MANAGER_FLAGS_YAW_LOCK: ClassVar[uint32] = 16

    header: Header = DEFAULT
    flags: uint32 = 0
    gimbal_device_id: uint8 = 0
    sysid_primary: uint8 = 0
    compid_primary: uint8 = 0
    sysid_secondary: uint8 = 0
    compid_secondary: uint8 = 0


class GlobalPositionTarget(Message, typename="mavros_msgs/msg/GlobalPositionTarget"):
    """GlobalPositionTarget, as MAVROS defines it."""

    FRAME_GLOBAL_INT: ClassVar[uint8] = 5
    FRAME_GLOBAL_REL_ALT: ClassVar[uint8] = 6
    FRAME_GLOBAL_TERRAIN_ALT: ClassVar[uint8] = 11
    IGNORE_LATITUDE: ClassVar[uint16] = 1
    IGNORE_LONGITUDE: ClassVar[uint16] = 2
    IGNORE_ALTITUDE: ClassVar[uint16] = 4
    IGNORE_VX: ClassVar[uint16] = 8
    IGNORE_VY: ClassVar[uint16] = 16
    IGNORE_VZ: ClassVar[uint16] = 32
    IGNORE_AFX: ClassVar[uint16] = 64
    IGNORE_AFY: ClassVar[uint16] = 128
    IGNORE_AFZ: ClassVar[uint16] = 256
    FORCE: ClassVar[uint16] = 512
    IGNORE_YAW: ClassVar[uint16] = 1024
    IGNORE_YAW_RATE: ClassVar[uint16] = 2048

    header: Header = DEFAULT
    coordinate_frame: uint8 = 0
    type_mask: uint16 = 0
    latitude: float64 = 0.0
    longitude: float64 = 0.0
    altitude: float32 = 0.0
    velocity: Vector3 = DEFAULT
    acceleration_or_force: Vector3 = DEFAULT
    yaw: float32 = 0.0
    yaw_rate: float32 = 0.0


class HilActuatorControls(Message, typename="mavros_msgs/msg/HilActuatorControls"):
    """HilActuatorControls, as MAVROS defines it."""

    header: Header = DEFAULT
    controls: Annotated[Floats, Array[float32, 16]] = DEFAULT
    mode: uint8 = 0
    flags: uint64 = 0


class HilControls(Message, typename="mavros_msgs/msg/HilControls"):
    """HilControls, as MAVROS defines it."""

    header: Header = DEFAULT
    roll_ailerons: float32 = 0.0
    pitch_elevator: float32 = 0.0
    yaw_rudder: float32 = 0.0
    throttle: float32 = 0.0
    aux1: float32 = 0.0
    aux2: float32 = 0.0
    aux3: float32 = 0.0
    aux4: float32 = 0.0
    mode: uint8 = 0
    nav_mode: uint8 = 0


class HilGPS(Message, typename="mavros_msgs/msg/HilGPS"):
    """HilGPS, as MAVROS defines it."""

    header: Header = DEFAULT
    fix_type: uint8 = 0
    geo: GeoPoint = DEFAULT
    eph: uint16 = 0
    epv: uint16 = 0
    vel: uint16 = 0
    vn: int16 = 0
    ve: int16 = 0
    vd: int16 = 0
    cog: uint16 = 0
    satellites_visible: uint8 = 0


class HilSensor(Message, typename="mavros_msgs/msg/HilSensor"):
    """HilSensor, as MAVROS defines it."""

    header: Header = DEFAULT
    acc: Vector3 = DEFAULT
    gyro: Vector3 = DEFAULT
    mag: Vector3 = DEFAULT
    abs_pressure: float32 = 0.0
    diff_pressure: float32 = 0.0
    pressure_alt: float32 = 0.0
    temperature: float32 = 0.0
    fields_updated: uint32 = 0


class HilStateQuaternion(Message, typename="mavros_msgs/msg/HilStateQuaternion"):
    """HilStateQuaternion, as MAVROS defines it."""

    header: Header = DEFAULT
    orientation: Quaternion = DEFAULT
    angular_velocity: Vector3 = DEFAULT
    linear_acceleration: Vector3 = DEFAULT
    linear_velocity: Vector3 = DEFAULT
    geo: GeoPoint = DEFAULT
    ind_airspeed: float32 = 0.0
    true_airspeed: float32 = 0.0


class HomePosition(Message, typename="mavros_msgs/msg/HomePosition"):
    """HomePosition, as MAVROS defines it."""

    header: Header = DEFAULT
    geo: GeoPoint = DEFAULT
    position: Point = DEFAULT
    orientation: Quaternion = DEFAULT
    approach: Vector3 = DEFAULT


class LandingTarget(Message, typename="mavros_msgs/msg/LandingTarget"):
    """LandingTarget, as MAVROS defines it."""

    GLOBAL: ClassVar[uint8] = 0
    LOCAL_NED: ClassVar[uint8] = 2
    MISSION: ClassVar[uint8] = 3
    GLOBAL_RELATIVE_ALT: ClassVar[uint8] = 4
    LOCAL_ENU: ClassVar[uint8] = 5
    GLOBAL_INT: ClassVar[uint8] = 6
    GLOBAL_RELATIVE_ALT_INT: ClassVar[uint8] = 7
    LOCAL_OFFSET_NED: ClassVar[uint8] = 8
    BODY_NED: ClassVar[uint8] = 9
    BODY_OFFSET_NED: ClassVar[uint8] = 10
    GLOBAL_TERRAIN_ALT: ClassVar[uint8] = 11
    GLOBAL_TERRAIN_ALT_INT: ClassVar[uint8] = 12
    LIGHT_BEACON: ClassVar[uint8] = 0
    RADIO_BEACON: ClassVar[uint8] = 1
    VISION_FIDUCIAL: ClassVar[uint8] = 2
    VISION_OTHER: ClassVar[uint8] = 3

    header: Header = DEFAULT
    target_num: uint8 = 0
    frame: uint8 = 0
    angle: Annotated[Floats, Array[float32, 2]] = DEFAULT
    distance: float32 = 0.0
    size: Annotated[Floats, Array[float32, 2]] = DEFAULT
    pose: Pose = DEFAULT
    type: uint8 = 0


class LogData(Message, typename="mavros_msgs/msg/LogData"):
    """LogData, as MAVROS defines it."""

    header: Header = DEFAULT
    id: uint16 = 0
    offset: uint32 = 0
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class LogEntry(Message, typename="mavros_msgs/msg/LogEntry"):
    """LogEntry, as MAVROS defines it."""

    header: Header = DEFAULT
    id: uint16 = 0
    num_logs: uint16 = 0
    last_log_num: uint16 = 0
    time_utc: Time = DEFAULT
    size: uint32 = 0


class MagnetometerReporter(Message, typename="mavros_msgs/msg/MagnetometerReporter"):
    """MagnetometerReporter, as MAVROS defines it."""

    header: Header = DEFAULT
    report: uint8 = 0
    confidence: float32 = 0.0
    compass_id: uint8 = 0
    cal_mask: uint8 = 0
    cal_status: uint8 = 0
    autosaved: uint8 = 0
    fitness: float32 = 0.0
    ofs_x: float32 = 0.0
    ofs_y: float32 = 0.0
    ofs_z: float32 = 0.0
    diag_x: float32 = 0.0
    diag_y: float32 = 0.0
    diag_z: float32 = 0.0
    offdiag_x: float32 = 0.0
    offdiag_y: float32 = 0.0
    offdiag_z: float32 = 0.0
    orientation_confidence: float32 = 0.0
    old_orientation: uint8 = 0
    new_orientation: uint8 = 0
    scale_factor: float32 = 0.0


class ManualControl(Message, typename="mavros_msgs/msg/ManualControl"):
    """ManualControl, as MAVROS defines it."""

    header: Header = DEFAULT
    x: float32 = 0.0
    y: float32 = 0.0
    z: float32 = 0.0
    r: float32 = 0.0
    buttons: uint16 = 0
    buttons2: uint16 = 0
    enabled_extensions: uint8 = 0
    s: float32 = 0.0
    t: float32 = 0.0
    aux1: float32 = 0.0
    aux2: float32 = 0.0
    aux3: float32 = 0.0
    aux4: float32 = 0.0
    aux5: float32 = 0.0
    aux6: float32 = 0.0


class Mavlink(Message, typename="mavros_msgs/msg/Mavlink"):
    """Mavlink, as MAVROS defines it."""

    FRAMING_OK: ClassVar[uint8] = 1
    FRAMING_BAD_CRC: ClassVar[uint8] = 2
    FRAMING_BAD_SIGNATURE: ClassVar[uint8] = 3
    MAVLINK_V10: ClassVar[uint8] = 254
    MAVLINK_V20: ClassVar[uint8] = 253

    header: Header = DEFAULT
    framing_status: uint8 = 0
    magic: uint8 = 0
    len: uint8 = 0
    incompat_flags: uint8 = 0
    compat_flags: uint8 = 0
    seq: uint8 = 0
    sysid: uint8 = 0
    compid: uint8 = 0
    msgid: uint32 = 0
    checksum: uint16 = 0
    payload64: Annotated[Ints, Sequence[uint64, 33]] = DEFAULT
    signature: Annotated[Bytes, Sequence[uint8, 13]] = DEFAULT


class MountControl(Message, typename="mavros_msgs/msg/MountControl"):
    """MountControl, as MAVROS defines it."""

    MAV_MOUNT_MODE_RETRACT: ClassVar[uint8] = 0
    MAV_MOUNT_MODE_NEUTRAL: ClassVar[uint8] = 1
    MAV_MOUNT_MODE_MAVLINK_TARGETING: ClassVar[uint8] = 2
    MAV_MOUNT_MODE_RC_TARGETING: ClassVar[uint8] = 3
    MAV_MOUNT_MODE_GPS_POINT: ClassVar[uint8] = 4

    header: Header = DEFAULT
    mode: uint8 = 0
    pitch: float32 = 0.0
    roll: float32 = 0.0
    yaw: float32 = 0.0
    altitude: float32 = 0.0
    latitude: float32 = 0.0
    longitude: float32 = 0.0


class NavControllerOutput(Message, typename="mavros_msgs/msg/NavControllerOutput"):
    """NavControllerOutput, as MAVROS defines it."""

    header: Header = DEFAULT
    nav_roll: float32 = 0.0
    nav_pitch: float32 = 0.0
    nav_bearing: int16 = 0
    target_bearing: int16 = 0
    wp_dist: uint16 = 0
    alt_error: float32 = 0.0
    aspd_error: float32 = 0.0
    xtrack_error: float32 = 0.0


class OnboardComputerStatus(Message, typename="mavros_msgs/msg/OnboardComputerStatus"):
    """OnboardComputerStatus, as MAVROS defines it."""

    header: Header = DEFAULT
    component: uint8 = 0
    uptime: uint32 = 0
    type: uint8 = 0
    cpu_cores: Annotated[Ints, Array[uint8, 8]] = DEFAULT
    cpu_combined: Annotated[Ints, Array[uint8, 10]] = DEFAULT
    gpu_cores: Annotated[Ints, Array[uint8, 4]] = DEFAULT
    gpu_combined: Annotated[Ints, Array[uint8, 10]] = DEFAULT
    temperature_board: int8 = 0
    temperature_core: Annotated[Ints, Array[int8, 8]] = DEFAULT
    fan_speed: Annotated[Ints, Array[int16, 4]] = DEFAULT
    ram_usage: uint32 = 0
    ram_total: uint32 = 0
    storage_type: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    storage_usage: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    storage_total: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    link_type: Annotated[Ints, Array[uint32, 6]] = DEFAULT
    link_tx_rate: Annotated[Ints, Array[uint32, 6]] = DEFAULT
    link_rx_rate: Annotated[Ints, Array[uint32, 6]] = DEFAULT
    link_tx_max: Annotated[Ints, Array[uint32, 6]] = DEFAULT
    link_rx_max: Annotated[Ints, Array[uint32, 6]] = DEFAULT


class OpenDroneIDBasicID(Message, typename="mavros_msgs/msg/OpenDroneIDBasicID"):
    """OpenDroneIDBasicID, as MAVROS defines it."""

    ID_TYPE_NONE: ClassVar[uint8] = 0
    ID_TYPE_SERIAL_NUMBER: ClassVar[uint8] = 1
    ID_TYPE_CAA_REGISTRATION_ID: ClassVar[uint8] = 2
    ID_TYPE_UTM_ASSIGNED_UUID: ClassVar[uint8] = 3
    ID_TYPE_SPECIFIC_SESSION_ID: ClassVar[uint8] = 4
    UA_TYPE_NONE: ClassVar[uint8] = 0
    UA_TYPE_AEROPLANE: ClassVar[uint8] = 1
    UA_TYPE_HELICOPTER_OR_MULTIROTOR: ClassVar[uint8] = 2
    UA_TYPE_GYROPLANE: ClassVar[uint8] = 3
    UA_TYPE_HYBRID_LIFT: ClassVar[uint8] = 4
    UA_TYPE_ORNITHOPTER: ClassVar[uint8] = 5
    UA_TYPE_GLIDER: ClassVar[uint8] = 6
    UA_TYPE_KITE: ClassVar[uint8] = 7
    UA_TYPE_FREE_BALLOON: ClassVar[uint8] = 8
    UA_TYPE_CAPTIVE_BALLOON: ClassVar[uint8] = 9
    UA_TYPE_AIRSHIP: ClassVar[uint8] = 10
    UA_TYPE_FREE_FALL_PARACHUTE: ClassVar[uint8] = 11
    UA_TYPE_ROCKET: ClassVar[uint8] = 12
    UA_TYPE_TETHERED_POWERED_AIRCRAFT: ClassVar[uint8] = 13
    UA_TYPE_GROUND_OBSTACLE: ClassVar[uint8] = 14
    UA_TYPE_OTHER: ClassVar[uint8] = 15

    header: Header = DEFAULT
    id_or_mac: str = ""
    id_type: uint8 = 0
    ua_type: uint8 = 0
    uas_id: str = ""


class OpenDroneIDOperatorID(Message, typename="mavros_msgs/msg/OpenDroneIDOperatorID"):
    """OpenDroneIDOperatorID, as MAVROS defines it."""

    ID_TYPE_CAA: ClassVar[uint8] = 0

    header: Header = DEFAULT
    id_or_mac: str = ""
    operator_id_type: uint8 = 0
    operator_id: str = ""


class OpenDroneIDSelfID(Message, typename="mavros_msgs/msg/OpenDroneIDSelfID"):
    """OpenDroneIDSelfID, as MAVROS defines it."""

    DESC_TYPE_TEXT: ClassVar[uint8] = 0
    DESC_TYPE_EMERGENCY: ClassVar[uint8] = 1
    DESC_TYPE_EXTENDED_STATUS: ClassVar[uint8] = 2

    header: Header = DEFAULT
    id_or_mac: str = ""
    description_type: uint8 = 0
    description: str = ""


class OpenDroneIDSystem(Message, typename="mavros_msgs/msg/OpenDroneIDSystem"):
    """OpenDroneIDSystem, as MAVROS defines it."""

    LOCATION_TYPE_TAKEOFF: ClassVar[uint8] = 0
    LOCATION_TYPE_LIVE_GNSS: ClassVar[uint8] = 1
    LOCATION_TYPE_FIXED: ClassVar[uint8] = 2
    CLASSIFICATION_TYPE_UNDECLARED: ClassVar[uint8] = 0
    CLASSIFICATION_TYPE_EU: ClassVar[uint8] = 1

    header: Header = DEFAULT
    id_or_mac: str = ""
    operator_location_type: uint8 = 0
    classification_type: uint8 = 0
    operator_latitude: int32 = 0
    operator_longitude: int32 = 0
    area_count: uint16 = 0
    area_radius: uint16 = 0
    area_ceiling: float32 = 0.0
    area_floor: float32 = 0.0
    category_eu: uint8 = 0
    class_eu: uint8 = 0
    operator_altitude_geo: float32 = 0.0


class OpenDroneIDSystemUpdate(Message, typename="mavros_msgs/msg/OpenDroneIDSystemUpdate"):
    """OpenDroneIDSystemUpdate, as MAVROS defines it."""

    header: Header = DEFAULT
    operator_latitude: int32 = 0
    operator_longitude: int32 = 0
    operator_altitude_geo: float32 = 0.0


class OpticalFlow(Message, typename="mavros_msgs/msg/OpticalFlow"):
    """OpticalFlow, as MAVROS defines it."""

    header: Header = DEFAULT
    flow: Vector3 = DEFAULT
    flow_comp_m: Vector3 = DEFAULT
    quality: uint8 = 0
    ground_distance: float32 = 0.0
    flow_rate: Vector3 = DEFAULT


class OpticalFlowRad(Message, typename="mavros_msgs/msg/OpticalFlowRad"):
    """OpticalFlowRad, as MAVROS defines it."""

    header: Header = DEFAULT
    integration_time_us: uint32 = 0
    integrated_x: float32 = 0.0
    integrated_y: float32 = 0.0
    integrated_xgyro: float32 = 0.0
    integrated_ygyro: float32 = 0.0
    integrated_zgyro: float32 = 0.0
    temperature: int16 = 0
    quality: uint8 = 0
    time_delta_distance_us: uint32 = 0
    distance: float32 = 0.0


class OverrideRCIn(Message, typename="mavros_msgs/msg/OverrideRCIn"):
    """OverrideRCIn, as MAVROS defines it."""

    CHAN_RELEASE: ClassVar[uint16] = 0
    CHAN_NOCHANGE: ClassVar[uint16] = 65535

    channels: Annotated[Ints, Array[uint16, 18]] = DEFAULT


class ParamValue(Message, typename="mavros_msgs/msg/ParamValue"):
    """ParamValue, as MAVROS defines it."""

    integer: int64 = 0
    real: float64 = 0.0


class Param(Message, typename="mavros_msgs/msg/Param"):
    """Param, as MAVROS defines it."""

    header: Header = DEFAULT
    param_id: str = ""
    value: ParamValue = DEFAULT
    param_index: uint16 = 0
    param_count: uint16 = 0


class ParamEvent(Message, typename="mavros_msgs/msg/ParamEvent"):
    """ParamEvent, as MAVROS defines it."""

    header: Header = DEFAULT
    param_id: str = ""
    value: ParameterValue = DEFAULT
    param_index: uint16 = 0
    param_count: uint16 = 0


class PlayTuneV2(Message, typename="mavros_msgs/msg/PlayTuneV2"):
    """PlayTuneV2, as MAVROS defines it."""

    QBASIC1_1: ClassVar[uint8] = 1
    MML_MODERN: ClassVar[uint8] = 2

    format: uint8 = 0
    tune: str = ""


class PositionTarget(Message, typename="mavros_msgs/msg/PositionTarget"):
    """PositionTarget, as MAVROS defines it."""

    FRAME_LOCAL_NED: ClassVar[uint8] = 1
    FRAME_LOCAL_OFFSET_NED: ClassVar[uint8] = 7
    FRAME_BODY_NED: ClassVar[uint8] = 8
    FRAME_BODY_OFFSET_NED: ClassVar[uint8] = 9
    IGNORE_PX: ClassVar[uint16] = 1
    IGNORE_PY: ClassVar[uint16] = 2
    IGNORE_PZ: ClassVar[uint16] = 4
    IGNORE_VX: ClassVar[uint16] = 8
    IGNORE_VY: ClassVar[uint16] = 16
    IGNORE_VZ: ClassVar[uint16] = 32
    IGNORE_AFX: ClassVar[uint16] = 64
    IGNORE_AFY: ClassVar[uint16] = 128
    IGNORE_AFZ: ClassVar[uint16] = 256
    FORCE: ClassVar[uint16] = 512
    IGNORE_YAW: ClassVar[uint16] = 1024
    IGNORE_YAW_RATE: ClassVar[uint16] = 2048

    header: Header = DEFAULT
    coordinate_frame: uint8 = 0
    type_mask: uint16 = 0
    position: Point = DEFAULT
    velocity: Vector3 = DEFAULT
    acceleration_or_force: Vector3 = DEFAULT
    yaw: float32 = 0.0
    yaw_rate: float32 = 0.0


class RCIn(Message, typename="mavros_msgs/msg/RCIn"):
    """RCIn, as MAVROS defines it."""

    header: Header = DEFAULT
    rssi: uint8 = 0
    channels: Annotated[Ints, Sequence[uint16]] = DEFAULT


class RCOut(Message, typename="mavros_msgs/msg/RCOut"):
    """RCOut, as MAVROS defines it."""

    header: Header = DEFAULT
    channels: Annotated[Ints, Sequence[uint16]] = DEFAULT


class RTCM(Message, typename="mavros_msgs/msg/RTCM"):
    """RTCM, as MAVROS defines it."""

    header: Header = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class RTKBaseline(Message, typename="mavros_msgs/msg/RTKBaseline"):
    """RTKBaseline, as MAVROS defines it."""

    RTK_BASELINE_COORDINATE_SYSTEM_ECEF: ClassVar[uint8] = 0
    RTK_BASELINE_COORDINATE_SYSTEM_NED: ClassVar[uint8] = 1

    header: Header = DEFAULT
    time_last_baseline_ms: uint32 = 0
    rtk_receiver_id: uint8 = 0
    wn: uint16 = 0
    tow: uint32 = 0
    rtk_health: uint8 = 0
    rtk_rate: uint8 = 0
    nsats: uint8 = 0
    baseline_coords_type: uint8 = 0
    baseline_a_mm: int32 = 0
    baseline_b_mm: int32 = 0
    baseline_c_mm: int32 = 0
    accuracy: uint32 = 0
    iar_num_hypotheses: int32 = 0


class RadioStatus(Message, typename="mavros_msgs/msg/RadioStatus"):
    """RadioStatus, as MAVROS defines it."""

    header: Header = DEFAULT
    rssi: uint8 = 0
    remrssi: uint8 = 0
    txbuf: uint8 = 0
    noise: uint8 = 0
    remnoise: uint8 = 0
    rxerrors: uint16 = 0
    fixed: uint16 = 0
    rssi_dbm: float32 = 0.0
    remrssi_dbm: float32 = 0.0


class State(Message, typename="mavros_msgs/msg/State"):
    """State, as MAVROS defines it."""

    MODE_APM_PLANE_MANUAL: ClassVar[str] = "MANUAL"
    MODE_APM_PLANE_CIRCLE: ClassVar[str] = "CIRCLE"
    MODE_APM_PLANE_STABILIZE: ClassVar[str] = "STABILIZE"
    MODE_APM_PLANE_TRAINING: ClassVar[str] = "TRAINING"
    MODE_APM_PLANE_ACRO: ClassVar[str] = "ACRO"
    MODE_APM_PLANE_FBWA: ClassVar[str] = "FBWA"
    MODE_APM_PLANE_FBWB: ClassVar[str] = "FBWB"
    MODE_APM_PLANE_CRUISE: ClassVar[str] = "CRUISE"
    MODE_APM_PLANE_AUTOTUNE: ClassVar[str] = "AUTOTUNE"
    MODE_APM_PLANE_AUTO: ClassVar[str] = "AUTO"
    MODE_APM_PLANE_RTL: ClassVar[str] = "RTL"
    MODE_APM_PLANE_LOITER: ClassVar[str] = "LOITER"
    MODE_APM_PLANE_LAND: ClassVar[str] = "LAND"
    MODE_APM_PLANE_GUIDED: ClassVar[str] = "GUIDED"
    MODE_APM_PLANE_INITIALISING: ClassVar[str] = "INITIALISING"
    MODE_APM_PLANE_QSTABILIZE: ClassVar[str] = "QSTABILIZE"
    MODE_APM_PLANE_QHOVER: ClassVar[str] = "QHOVER"
    MODE_APM_PLANE_QLOITER: ClassVar[str] = "QLOITER"
    MODE_APM_PLANE_QLAND: ClassVar[str] = "QLAND"
    MODE_APM_PLANE_QRTL: ClassVar[str] = "QRTL"
    MODE_APM_COPTER_STABILIZE: ClassVar[str] = "STABILIZE"
    MODE_APM_COPTER_ACRO: ClassVar[str] = "ACRO"
    MODE_APM_COPTER_ALT_HOLD: ClassVar[str] = "ALT_HOLD"
    MODE_APM_COPTER_AUTO: ClassVar[str] = "AUTO"
    MODE_APM_COPTER_GUIDED: ClassVar[str] = "GUIDED"
    MODE_APM_COPTER_LOITER: ClassVar[str] = "LOITER"
    MODE_APM_COPTER_RTL: ClassVar[str] = "RTL"
    MODE_APM_COPTER_CIRCLE: ClassVar[str] = "CIRCLE"
    MODE_APM_COPTER_POSITION: ClassVar[str] = "POSITION"
    MODE_APM_COPTER_LAND: ClassVar[str] = "LAND"
    MODE_APM_COPTER_OF_LOITER: ClassVar[str] = "OF_LOITER"
    MODE_APM_COPTER_DRIFT: ClassVar[str] = "DRIFT"
    MODE_APM_COPTER_SPORT: ClassVar[str] = "SPORT"
    MODE_APM_COPTER_FLIP: ClassVar[str] = "FLIP"
    MODE_APM_COPTER_AUTOTUNE: ClassVar[str] = "AUTOTUNE"
    MODE_APM_COPTER_POSHOLD: ClassVar[str] = "POSHOLD"
    MODE_APM_COPTER_BRAKE: ClassVar[str] = "BRAKE"
    MODE_APM_COPTER_THROW: ClassVar[str] = "THROW"
    MODE_APM_COPTER_AVOID_ADSB: ClassVar[str] = "AVOID_ADSB"
    MODE_APM_COPTER_GUIDED_NOGPS: ClassVar[str] = "GUIDED_NOGPS"
    MODE_APM_ROVER_MANUAL: ClassVar[str] = "MANUAL"
    MODE_APM_ROVER_LEARNING: ClassVar[str] = "LEARNING"
    MODE_APM_ROVER_STEERING: ClassVar[str] = "STEERING"
    MODE_APM_ROVER_HOLD: ClassVar[str] = "HOLD"
    MODE_APM_ROVER_AUTO: ClassVar[str] = "AUTO"
    MODE_APM_ROVER_RTL: ClassVar[str] = "RTL"
    MODE_APM_ROVER_GUIDED: ClassVar[str] = "GUIDED"
    MODE_APM_ROVER_INITIALISING: ClassVar[str] = "INITIALISING"
    MODE_PX4_MANUAL: ClassVar[str] = "MANUAL"
    MODE_PX4_ACRO: ClassVar[str] = "ACRO"
    MODE_PX4_ALTITUDE: ClassVar[str] = "ALTCTL"
    MODE_PX4_POSITION: ClassVar[str] = "POSCTL"
    MODE_PX4_OFFBOARD: ClassVar[str] = "OFFBOARD"
    MODE_PX4_STABILIZED: ClassVar[str] = "STABILIZED"
    MODE_PX4_RATTITUDE: ClassVar[str] = "RATTITUDE"
    MODE_PX4_MISSION: ClassVar[str] = "AUTO.MISSION"
    MODE_PX4_LOITER: ClassVar[str] = "AUTO.LOITER"
    MODE_PX4_RTL: ClassVar[str] = "AUTO.RTL"
    MODE_PX4_LAND: ClassVar[str] = "AUTO.LAND"
    MODE_PX4_RTGS: ClassVar[str] = "AUTO.RTGS"
    MODE_PX4_READY: ClassVar[str] = "AUTO.READY"
    MODE_PX4_TAKEOFF: ClassVar[str] = "AUTO.TAKEOFF"

    header: Header = DEFAULT
    connected: bool = False
    armed: bool = False
    guided: bool = False
    manual_input: bool = False
    mode: str = ""
    system_status: uint8 = 0


class StatusEvent(Message, typename="mavros_msgs/msg/StatusEvent"):
    """StatusEvent, as MAVROS defines it."""

    EMERGENCY: ClassVar[uint8] = 0
    ALERT: ClassVar[uint8] = 1
    CRITICAL: ClassVar[uint8] = 2
    ERROR: ClassVar[uint8] = 3
    WARNING: ClassVar[uint8] = 4
    NOTICE: ClassVar[uint8] = 5
    INFO: ClassVar[uint8] = 6
    DEBUG: ClassVar[uint8] = 7

    header: Header = DEFAULT
    severity: uint8 = 0
    px4_id: uint32 = 0
    arguments: Annotated[Ints, Array[uint8, 40]] = DEFAULT
    sequence: uint16 = 0


class StatusText(Message, typename="mavros_msgs/msg/StatusText"):
    """StatusText, as MAVROS defines it."""

    EMERGENCY: ClassVar[uint8] = 0
    ALERT: ClassVar[uint8] = 1
    CRITICAL: ClassVar[uint8] = 2
    ERROR: ClassVar[uint8] = 3
    WARNING: ClassVar[uint8] = 4
    NOTICE: ClassVar[uint8] = 5
    INFO: ClassVar[uint8] = 6
    DEBUG: ClassVar[uint8] = 7

    header: Header = DEFAULT
    severity: uint8 = 0
    text: str = ""


class SysStatus(Message, typename="mavros_msgs/msg/SysStatus"):
    """SysStatus, as MAVROS defines it."""

    header: Header = DEFAULT
    sensors_present: uint32 = 0
    sensors_enabled: uint32 = 0
    sensors_health: uint32 = 0
    load: uint16 = 0
    voltage_battery: uint16 = 0
    current_battery: int16 = 0
    battery_remaining: int8 = 0
    drop_rate_comm: uint16 = 0
    errors_comm: uint16 = 0
    errors_count1: uint16 = 0
    errors_count2: uint16 = 0
    errors_count3: uint16 = 0
    errors_count4: uint16 = 0


class TerrainReport(Message, typename="mavros_msgs/msg/TerrainReport"):
    """TerrainReport, as MAVROS defines it."""

    header: Header = DEFAULT
    latitude: float64 = 0.0
    longitude: float64 = 0.0
    spacing: uint16 = 0
    terrain_height: float32 = 0.0
    current_height: float32 = 0.0
    pending: uint16 = 0
    loaded: uint16 = 0


class Thrust(Message, typename="mavros_msgs/msg/Thrust"):
    """Thrust, as MAVROS defines it."""

    header: Header = DEFAULT
    thrust: float32 = 0.0


class TimesyncStatus(Message, typename="mavros_msgs/msg/TimesyncStatus"):
    """TimesyncStatus, as MAVROS defines it."""

    header: Header = DEFAULT
    remote_timestamp_ns: uint64 = 0
    observed_offset_ns: int64 = 0
    estimated_offset_ns: int64 = 0
    round_trip_time_ms: float32 = 0.0


class Trajectory(Message, typename="mavros_msgs/msg/Trajectory"):
    """Trajectory, as MAVROS defines it."""

    MAV_TRAJECTORY_REPRESENTATION_WAYPOINTS: ClassVar[uint8] = 0
    MAV_TRAJECTORY_REPRESENTATION_BEZIER: ClassVar[uint8] = 1

    header: Header = DEFAULT
    type: uint8 = 0
    point_1: PositionTarget = DEFAULT
    point_2: PositionTarget = DEFAULT
    point_3: PositionTarget = DEFAULT
    point_4: PositionTarget = DEFAULT
    point_5: PositionTarget = DEFAULT
    point_valid: Annotated[Ints, Array[uint8, 5]] = DEFAULT
    command: Annotated[Ints, Array[uint16, 5]] = DEFAULT
    time_horizon: Annotated[Floats, Array[float32, 5]] = DEFAULT


class Tunnel(Message, typename="mavros_msgs/msg/Tunnel"):
    """Tunnel, as MAVROS defines it."""

    PAYLOAD_TYPE_UNKNOWN: ClassVar[uint16] = 0
    PAYLOAD_TYPE_STORM32_RESERVED0: ClassVar[uint16] = 200
    PAYLOAD_TYPE_STORM32_RESERVED1: ClassVar[uint16] = 201
    PAYLOAD_TYPE_STORM32_RESERVED2: ClassVar[uint16] = 202
    PAYLOAD_TYPE_STORM32_RESERVED3: ClassVar[uint16] = 203
    PAYLOAD_TYPE_STORM32_RESERVED4: ClassVar[uint16] = 204
    PAYLOAD_TYPE_STORM32_RESERVED5: ClassVar[uint16] = 205
    PAYLOAD_TYPE_STORM32_RESERVED6: ClassVar[uint16] = 206
    PAYLOAD_TYPE_STORM32_RESERVED7: ClassVar[uint16] = 207
    PAYLOAD_TYPE_STORM32_RESERVED8: ClassVar[uint16] = 208
    PAYLOAD_TYPE_STORM32_RESERVED9: ClassVar[uint16] = 209

    target_system: uint8 = 0
    target_component: uint8 = 0
    payload_type: uint16 = 0
    payload_length: uint8 = 0
    payload: Annotated[Ints, Array[uint8, 128]] = DEFAULT


class VehicleInfo(Message, typename="mavros_msgs/msg/VehicleInfo"):
    """VehicleInfo, as MAVROS defines it."""

    HAVE_INFO_HEARTBEAT: ClassVar[uint8] = 1
    HAVE_INFO_AUTOPILOT_VERSION: ClassVar[uint8] = 2

    header: Header = DEFAULT
    available_info: uint8 = 0
    sysid: uint8 = 0
    compid: uint8 = 0
    autopilot: uint8 = 0
    type: uint8 = 0
    system_status: uint8 = 0
    base_mode: uint8 = 0
    custom_mode: uint32 = 0
    mode: str = ""
    mode_id: uint32 = 0
    capabilities: uint64 = 0
    flight_sw_version: uint32 = 0
    middleware_sw_version: uint32 = 0
    os_sw_version: uint32 = 0
    board_version: uint32 = 0
    flight_custom_version: str = ""
    vendor_id: uint16 = 0
    product_id: uint16 = 0
    uid: uint64 = 0


class VfrHud(Message, typename="mavros_msgs/msg/VfrHud"):
    """VfrHud, as MAVROS defines it."""

    header: Header = DEFAULT
    airspeed: float32 = 0.0
    groundspeed: float32 = 0.0
    heading: int16 = 0
    throttle: float32 = 0.0
    altitude: float32 = 0.0
    climb: float32 = 0.0


class Vibration(Message, typename="mavros_msgs/msg/Vibration"):
    """Vibration, as MAVROS defines it."""

    header: Header = DEFAULT
    vibration: Vector3 = DEFAULT
    clipping: Annotated[Floats, Array[float32, 3]] = DEFAULT


class Waypoint(Message, typename="mavros_msgs/msg/Waypoint"):
    """Waypoint, as MAVROS defines it."""

    FRAME_GLOBAL: ClassVar[uint8] = 0
    FRAME_LOCAL_NED: ClassVar[uint8] = 1
    FRAME_MISSION: ClassVar[uint8] = 2
    FRAME_GLOBAL_REL_ALT: ClassVar[uint8] = 3
    FRAME_LOCAL_ENU: ClassVar[uint8] = 4
    FRAME_GLOBAL_INT: ClassVar[uint8] = 5
    FRAME_GLOBAL_RELATIVE_ALT_INT: ClassVar[uint8] = 6
    FRAME_LOCAL_OFFSET_NED: ClassVar[uint8] = 7
    FRAME_BODY_NED: ClassVar[uint8] = 8
    FRAME_BODY_OFFSET_NED: ClassVar[uint8] = 9
    FRAME_GLOBAL_TERRAIN_ALT: ClassVar[uint8] = 10
    FRAME_GLOBAL_TERRAIN_ALT_INT: ClassVar[uint8] = 11
    FRAME_BODY_FRD: ClassVar[uint8] = 12
    FRAME_RESERVED_13: ClassVar[uint8] = 13
    FRAME_RESERVED_14: ClassVar[uint8] = 14
    FRAME_RESERVED_15: ClassVar[uint8] = 15
    FRAME_RESERVED_16: ClassVar[uint8] = 16
    FRAME_RESERVED_17: ClassVar[uint8] = 17
    FRAME_RESERVED_18: ClassVar[uint8] = 18
    FRAME_RESERVED_19: ClassVar[uint8] = 19
    FRAME_LOCAL_FRD: ClassVar[uint8] = 20
    FRAME_LOCAL_FLU: ClassVar[uint8] = 21

    frame: uint8 = 0
    command: uint16 = 0
    is_current: bool = False
    autocontinue: bool = False
    param1: float32 = 0.0
    param2: float32 = 0.0
    param3: float32 = 0.0
    param4: float32 = 0.0
    x_lat: float64 = 0.0
    y_long: float64 = 0.0
    z_alt: float64 = 0.0


class WaypointList(Message, typename="mavros_msgs/msg/WaypointList"):
    """WaypointList, as MAVROS defines it."""

    current_seq: uint16 = 0
    waypoints: Annotated[list[Waypoint], Sequence[Waypoint]] = DEFAULT


class WaypointReached(Message, typename="mavros_msgs/msg/WaypointReached"):
    """WaypointReached, as MAVROS defines it."""

    header: Header = DEFAULT
    wp_seq: uint16 = 0


class WheelOdomStamped(Message, typename="mavros_msgs/msg/WheelOdomStamped"):
    """WheelOdomStamped, as MAVROS defines it."""

    header: Header = DEFAULT
    data: Annotated[Floats, Sequence[float64]] = DEFAULT
