"""Messages of px4_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.message import (
    DEFAULT,
    Array,
    Bools,
    Floats,
    Ints,
    Message,
    char,
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
    "ActionRequest",
    "ActuatorArmed",
    "ActuatorControlsStatus",
    "ActuatorMotors",
    "ActuatorOutputs",
    "ActuatorServos",
    "ActuatorServosTrim",
    "ActuatorTest",
    "AdcReport",
    "Airspeed",
    "AirspeedValidated",
    "AirspeedWind",
    "ArmingCheckReply",
    "ArmingCheckRequest",
    "AutotuneAttitudeControlStatus",
    "BatteryStatus",
    "Buffer128",
    "ButtonEvent",
    "CameraCapture",
    "CameraStatus",
    "CameraTrigger",
    "CanInterfaceStatus",
    "CellularStatus",
    "CollisionConstraints",
    "CollisionReport",
    "ConfigOverrides",
    "ControlAllocatorStatus",
    "Cpuload",
    "DatamanRequest",
    "DatamanResponse",
    "DebugArray",
    "DebugKeyValue",
    "DebugValue",
    "DebugVect",
    "DifferentialDriveSetpoint",
    "DifferentialPressure",
    "DistanceSensor",
    "Ekf2Timestamps",
    "EscReport",
    "EscStatus",
    "EstimatorAidSource1d",
    "EstimatorAidSource2d",
    "EstimatorAidSource3d",
    "EstimatorBias",
    "EstimatorBias3d",
    "EstimatorEventFlags",
    "EstimatorGpsStatus",
    "EstimatorInnovations",
    "EstimatorSelectorStatus",
    "EstimatorSensorBias",
    "EstimatorStates",
    "EstimatorStatus",
    "EstimatorStatusFlags",
    "Event",
    "FailsafeFlags",
    "FailureDetectorStatus",
    "FigureEightStatus",
    "FlightPhaseEstimation",
    "FollowTarget",
    "FollowTargetEstimator",
    "FollowTargetStatus",
    "GeneratorStatus",
    "GeofenceResult",
    "GeofenceStatus",
    "GimbalControls",
    "GimbalDeviceAttitudeStatus",
    "GimbalDeviceInformation",
    "GimbalDeviceSetAttitude",
    "GimbalManagerInformation",
    "GimbalManagerSetAttitude",
    "GimbalManagerSetManualControl",
    "GimbalManagerStatus",
    "GotoSetpoint",
    "GpioConfig",
    "GpioIn",
    "GpioOut",
    "GpioRequest",
    "GpsDump",
    "GpsInjectData",
    "Gripper",
    "HealthReport",
    "HeaterStatus",
    "HomePosition",
    "HoverThrustEstimate",
    "InputRc",
    "InternalCombustionEngineStatus",
    "IridiumsbdStatus",
    "IrlockReport",
    "LandingGear",
    "LandingGearWheel",
    "LandingTargetInnovations",
    "LandingTargetPose",
    "LaunchDetectionStatus",
    "LedControl",
    "LogMessage",
    "LoggerStatus",
    "MagWorkerData",
    "MagnetometerBiasEstimate",
    "ManualControlSetpoint",
    "ManualControlSwitches",
    "MavlinkLog",
    "MavlinkTunnel",
    "MessageFormatRequest",
    "MessageFormatResponse",
    "Mission",
    "MissionResult",
    "ModeCompleted",
    "MountOrientation",
    "NavigatorMissionItem",
    "NormalizedUnsignedSetpoint",
    "NpfgStatus",
    "ObstacleDistance",
    "OffboardControlMode",
    "OnboardComputerStatus",
    "OrbTest",
    "OrbTestLarge",
    "OrbTestMedium",
    "OrbitStatus",
    "ParameterResetRequest",
    "ParameterSetUsedRequest",
    "ParameterSetValueRequest",
    "ParameterSetValueResponse",
    "ParameterUpdate",
    "Ping",
    "PositionControllerLandingStatus",
    "PositionControllerStatus",
    "PositionSetpoint",
    "PositionSetpointTriplet",
    "PowerButtonState",
    "PowerMonitor",
    "PpsCapture",
    "PwmInput",
    "Px4ioStatus",
    "QshellReq",
    "QshellRetval",
    "RadioStatus",
    "RateCtrlStatus",
    "RcChannels",
    "RcParameterMap",
    "RegisterExtComponentReply",
    "RegisterExtComponentRequest",
    "Rpm",
    "RtlStatus",
    "RtlTimeEstimate",
    "SatelliteInfo",
    "SensorAccel",
    "SensorAccelFifo",
    "SensorAirflow",
    "SensorBaro",
    "SensorCombined",
    "SensorCorrection",
    "SensorGnssRelative",
    "SensorGps",
    "SensorGyro",
    "SensorGyroFft",
    "SensorGyroFifo",
    "SensorHygrometer",
    "SensorMag",
    "SensorOpticalFlow",
    "SensorPreflightMag",
    "SensorSelection",
    "SensorUwb",
    "SensorsStatus",
    "SensorsStatusImu",
    "SystemPower",
    "TakeoffStatus",
    "TaskStackInfo",
    "TecsStatus",
    "TelemetryStatus",
    "TiltrotorExtraControls",
    "TimesyncStatus",
    "TrajectoryBezier",
    "TrajectorySetpoint",
    "TrajectoryWaypoint",
    "TransponderReport",
    "TuneControl",
    "UavcanParameterRequest",
    "UavcanParameterValue",
    "UlogStream",
    "UlogStreamAck",
    "UnregisterExtComponent",
    "VehicleAcceleration",
    "VehicleAirData",
    "VehicleAngularAccelerationSetpoint",
    "VehicleAngularVelocity",
    "VehicleAttitude",
    "VehicleAttitudeSetpoint",
    "VehicleCommand",
    "VehicleCommandAck",
    "VehicleConstraints",
    "VehicleControlMode",
    "VehicleGlobalPosition",
    "VehicleImu",
    "VehicleImuStatus",
    "VehicleLandDetected",
    "VehicleLocalPosition",
    "VehicleLocalPositionSetpoint",
    "VehicleMagnetometer",
    "VehicleOdometry",
    "VehicleOpticalFlow",
    "VehicleOpticalFlowVel",
    "VehicleRatesSetpoint",
    "VehicleRoi",
    "VehicleStatus",
    "VehicleThrustSetpoint",
    "VehicleTorqueSetpoint",
    "VehicleTrajectoryBezier",
    "VehicleTrajectoryWaypoint",
    "VelocityLimits",
    "VtolVehicleStatus",
    "WheelEncoders",
    "Wind",
    "YawEstimatorStatus",
]


class ActionRequest(Message, typename="px4_msgs/msg/ActionRequest"):
    """ActionRequest, as PX4 1.15 defines it."""

    ACTION_DISARM: ClassVar[uint8] = 0
    ACTION_ARM: ClassVar[uint8] = 1
    ACTION_TOGGLE_ARMING: ClassVar[uint8] = 2
    ACTION_UNKILL: ClassVar[uint8] = 3
    ACTION_KILL: ClassVar[uint8] = 4
    ACTION_SWITCH_MODE: ClassVar[uint8] = 5
    ACTION_VTOL_TRANSITION_TO_MULTICOPTER: ClassVar[uint8] = 6
    ACTION_VTOL_TRANSITION_TO_FIXEDWING: ClassVar[uint8] = 7
    SOURCE_RC_STICK_GESTURE: ClassVar[uint8] = 0
    SOURCE_RC_SWITCH: ClassVar[uint8] = 1
    SOURCE_RC_BUTTON: ClassVar[uint8] = 2
    SOURCE_RC_MODE_SLOT: ClassVar[uint8] = 3

    timestamp: uint64 = 0
    action: uint8 = 0
    source: uint8 = 0
    mode: uint8 = 0


class ActuatorArmed(Message, typename="px4_msgs/msg/ActuatorArmed"):
    """ActuatorArmed, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    armed: bool = False
    prearmed: bool = False
    ready_to_arm: bool = False
    lockdown: bool = False
    manual_lockdown: bool = False
    force_failsafe: bool = False
    in_esc_calibration_mode: bool = False


class ActuatorControlsStatus(Message, typename="px4_msgs/msg/ActuatorControlsStatus"):
    """ActuatorControlsStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    control_power: Annotated[Floats, Array[float32, 3]] = DEFAULT


class ActuatorMotors(Message, typename="px4_msgs/msg/ActuatorMotors"):
    """ActuatorMotors, as PX4 1.15 defines it."""

    ACTUATOR_FUNCTION_MOTOR1: ClassVar[uint8] = 101
    NUM_CONTROLS: ClassVar[uint8] = 12

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    reversible_flags: uint16 = 0
    control: Annotated[Floats, Array[float32, 12]] = DEFAULT


class ActuatorOutputs(Message, typename="px4_msgs/msg/ActuatorOutputs"):
    """ActuatorOutputs, as PX4 1.15 defines it."""

    NUM_ACTUATOR_OUTPUTS: ClassVar[uint8] = 16
    NUM_ACTUATOR_OUTPUT_GROUPS: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    noutputs: uint32 = 0
    output: Annotated[Floats, Array[float32, 16]] = DEFAULT


class ActuatorServos(Message, typename="px4_msgs/msg/ActuatorServos"):
    """ActuatorServos, as PX4 1.15 defines it."""

    NUM_CONTROLS: ClassVar[uint8] = 8

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    control: Annotated[Floats, Array[float32, 8]] = DEFAULT


class ActuatorServosTrim(Message, typename="px4_msgs/msg/ActuatorServosTrim"):
    """ActuatorServosTrim, as PX4 1.15 defines it."""

    NUM_CONTROLS: ClassVar[uint8] = 8

    timestamp: uint64 = 0
    trim: Annotated[Floats, Array[float32, 8]] = DEFAULT


class ActuatorTest(Message, typename="px4_msgs/msg/ActuatorTest"):
    """ActuatorTest, as PX4 1.15 defines it."""

    ACTION_RELEASE_CONTROL: ClassVar[uint8] = 0
    ACTION_DO_CONTROL: ClassVar[uint8] = 1
    FUNCTION_MOTOR1: ClassVar[uint8] = 101
    MAX_NUM_MOTORS: ClassVar[uint8] = 12
    FUNCTION_SERVO1: ClassVar[uint8] = 201
    MAX_NUM_SERVOS: ClassVar[uint8] = 8
    ORB_QUEUE_LENGTH: ClassVar[uint8] = 16

    timestamp: uint64 = 0
    action: uint8 = 0
    function: uint16 = 0
    value: float32 = 0.0
    timeout_ms: uint32 = 0


class AdcReport(Message, typename="px4_msgs/msg/AdcReport"):
    """AdcReport, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    device_id: uint32 = 0
    channel_id: Annotated[Ints, Array[int16, 12]] = DEFAULT
    raw_data: Annotated[Ints, Array[int32, 12]] = DEFAULT
    resolution: uint32 = 0
    v_ref: float32 = 0.0


class Airspeed(Message, typename="px4_msgs/msg/Airspeed"):
    """Airspeed, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    indicated_airspeed_m_s: float32 = 0.0
    true_airspeed_m_s: float32 = 0.0
    air_temperature_celsius: float32 = 0.0
    confidence: float32 = 0.0


class AirspeedValidated(Message, typename="px4_msgs/msg/AirspeedValidated"):
    """AirspeedValidated, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    indicated_airspeed_m_s: float32 = 0.0
    calibrated_airspeed_m_s: float32 = 0.0
    true_airspeed_m_s: float32 = 0.0
    calibrated_ground_minus_wind_m_s: float32 = 0.0
    true_ground_minus_wind_m_s: float32 = 0.0
    airspeed_sensor_measurement_valid: bool = False
    selected_airspeed_index: int8 = 0


class AirspeedWind(Message, typename="px4_msgs/msg/AirspeedWind"):
    """AirspeedWind, as PX4 1.15 defines it."""

    SOURCE_AS_BETA_ONLY: ClassVar[uint8] = 0
    SOURCE_AS_SENSOR_1: ClassVar[uint8] = 1
    SOURCE_AS_SENSOR_2: ClassVar[uint8] = 2
    SOURCE_AS_SENSOR_3: ClassVar[uint8] = 3

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    windspeed_north: float32 = 0.0
    windspeed_east: float32 = 0.0
    variance_north: float32 = 0.0
    variance_east: float32 = 0.0
    tas_innov: float32 = 0.0
    tas_innov_var: float32 = 0.0
    tas_scale_raw: float32 = 0.0
    tas_scale_raw_var: float32 = 0.0
    tas_scale_validated: float32 = 0.0
    beta_innov: float32 = 0.0
    beta_innov_var: float32 = 0.0
    source: uint8 = 0


class Event(Message, typename="px4_msgs/msg/Event"):
    """Event, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 16

    timestamp: uint64 = 0
    id: uint32 = 0
    event_sequence: uint16 = 0
    arguments: Annotated[Ints, Array[uint8, 25]] = DEFAULT
    log_levels: uint8 = 0


class ArmingCheckReply(Message, typename="px4_msgs/msg/ArmingCheckReply"):
    """ArmingCheckReply, as PX4 1.15 defines it."""

    HEALTH_COMPONENT_INDEX_NONE: ClassVar[uint8] = 0
    HEALTH_COMPONENT_INDEX_AVOIDANCE: ClassVar[uint8] = 19
    ORB_QUEUE_LENGTH: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    request_id: uint8 = 0
    registration_id: uint8 = 0
    health_component_index: uint8 = 0
    health_component_is_present: bool = False
    health_component_warning: bool = False
    health_component_error: bool = False
    can_arm_and_run: bool = False
    num_events: uint8 = 0
    events: Annotated[list[Event], Array[Event, 5]] = DEFAULT
    mode_req_angular_velocity: bool = False
    mode_req_attitude: bool = False
    mode_req_local_alt: bool = False
    mode_req_local_position: bool = False
    mode_req_local_position_relaxed: bool = False
    mode_req_global_position: bool = False
    mode_req_mission: bool = False
    mode_req_home_position: bool = False
    mode_req_prevent_arming: bool = False
    mode_req_manual_control: bool = False


class ArmingCheckRequest(Message, typename="px4_msgs/msg/ArmingCheckRequest"):
    """ArmingCheckRequest, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    request_id: uint8 = 0


class AutotuneAttitudeControlStatus(Message, typename="px4_msgs/msg/AutotuneAttitudeControlStatus"):
    """AutotuneAttitudeControlStatus, as PX4 1.15 defines it."""

    STATE_IDLE: ClassVar[uint8] = 0
    STATE_INIT: ClassVar[uint8] = 1
    STATE_ROLL: ClassVar[uint8] = 2
    STATE_ROLL_PAUSE: ClassVar[uint8] = 3
    STATE_PITCH: ClassVar[uint8] = 4
    STATE_PITCH_PAUSE: ClassVar[uint8] = 5
    STATE_YAW: ClassVar[uint8] = 6
    STATE_YAW_PAUSE: ClassVar[uint8] = 7
    STATE_VERIFICATION: ClassVar[uint8] = 8
    STATE_APPLY: ClassVar[uint8] = 9
    STATE_TEST: ClassVar[uint8] = 10
    STATE_COMPLETE: ClassVar[uint8] = 11
    STATE_FAIL: ClassVar[uint8] = 12
    STATE_WAIT_FOR_DISARM: ClassVar[uint8] = 13

    timestamp: uint64 = 0
    coeff: Annotated[Floats, Array[float32, 5]] = DEFAULT
    coeff_var: Annotated[Floats, Array[float32, 5]] = DEFAULT
    fitness: float32 = 0.0
    innov: float32 = 0.0
    dt_model: float32 = 0.0
    kc: float32 = 0.0
    ki: float32 = 0.0
    kd: float32 = 0.0
    kff: float32 = 0.0
    att_p: float32 = 0.0
    rate_sp: Annotated[Floats, Array[float32, 3]] = DEFAULT
    u_filt: float32 = 0.0
    y_filt: float32 = 0.0
    state: uint8 = 0


class BatteryStatus(Message, typename="px4_msgs/msg/BatteryStatus"):
    """BatteryStatus, as PX4 1.15 defines it."""

    BATTERY_SOURCE_POWER_MODULE: ClassVar[uint8] = 0
    BATTERY_SOURCE_EXTERNAL: ClassVar[uint8] = 1
    BATTERY_SOURCE_ESCS: ClassVar[uint8] = 2
    BATTERY_WARNING_NONE: ClassVar[uint8] = 0
    BATTERY_WARNING_LOW: ClassVar[uint8] = 1
    BATTERY_WARNING_CRITICAL: ClassVar[uint8] = 2
    BATTERY_WARNING_EMERGENCY: ClassVar[uint8] = 3
    BATTERY_WARNING_FAILED: ClassVar[uint8] = 4
    BATTERY_STATE_UNHEALTHY: ClassVar[uint8] = 6
    BATTERY_STATE_CHARGING: ClassVar[uint8] = 7
    BATTERY_FAULT_DEEP_DISCHARGE: ClassVar[uint8] = 0
    BATTERY_FAULT_SPIKES: ClassVar[uint8] = 1
    BATTERY_FAULT_CELL_FAIL: ClassVar[uint8] = 2
    BATTERY_FAULT_OVER_CURRENT: ClassVar[uint8] = 3
    BATTERY_FAULT_OVER_TEMPERATURE: ClassVar[uint8] = 4
    BATTERY_FAULT_UNDER_TEMPERATURE: ClassVar[uint8] = 5
    BATTERY_FAULT_INCOMPATIBLE_VOLTAGE: ClassVar[uint8] = 6
    BATTERY_FAULT_INCOMPATIBLE_FIRMWARE: ClassVar[uint8] = 7
    BATTERY_FAULT_INCOMPATIBLE_MODEL: ClassVar[uint8] = 8
    BATTERY_FAULT_HARDWARE_FAILURE: ClassVar[uint8] = 9
    BATTERY_WARNING_OVER_TEMPERATURE: ClassVar[uint8] = 10
    BATTERY_FAULT_COUNT: ClassVar[uint8] = 11
    BATTERY_MODE_UNKNOWN: ClassVar[uint8] = 0
    BATTERY_MODE_AUTO_DISCHARGING: ClassVar[uint8] = 1
    BATTERY_MODE_HOT_SWAP: ClassVar[uint8] = 2
    BATTERY_MODE_COUNT: ClassVar[uint8] = 3
    MAX_INSTANCES: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    connected: bool = False
    voltage_v: float32 = 0.0
    voltage_filtered_v: float32 = 0.0
    current_a: float32 = 0.0
    current_filtered_a: float32 = 0.0
    current_average_a: float32 = 0.0
    discharged_mah: float32 = 0.0
    remaining: float32 = 0.0
    scale: float32 = 0.0
    time_remaining_s: float32 = 0.0
    temperature: float32 = 0.0
    cell_count: uint8 = 0
    source: uint8 = 0
    priority: uint8 = 0
    capacity: uint16 = 0
    cycle_count: uint16 = 0
    average_time_to_empty: uint16 = 0
    serial_number: uint16 = 0
    manufacture_date: uint16 = 0
    state_of_health: uint16 = 0
    max_error: uint16 = 0
    id: uint8 = 0
    interface_error: uint16 = 0
    voltage_cell_v: Annotated[Floats, Array[float32, 14]] = DEFAULT
    max_cell_voltage_delta: float32 = 0.0
    is_powering_off: bool = False
    is_required: bool = False
    faults: uint16 = 0
    custom_faults: uint32 = 0
    warning: uint8 = 0
    mode: uint8 = 0
    average_power: float32 = 0.0
    available_energy: float32 = 0.0
    full_charge_capacity_wh: float32 = 0.0
    remaining_capacity_wh: float32 = 0.0
    design_capacity: float32 = 0.0
    average_time_to_full: uint16 = 0
    over_discharge_count: uint16 = 0
    nominal_voltage: float32 = 0.0


class Buffer128(Message, typename="px4_msgs/msg/Buffer128"):
    """Buffer128, as PX4 1.15 defines it."""

    MAX_BUFLEN: ClassVar[uint32] = 128

    timestamp: uint64 = 0
    len: uint8 = 0
    data: Annotated[Ints, Array[uint8, 128]] = DEFAULT


class ButtonEvent(Message, typename="px4_msgs/msg/ButtonEvent"):
    """ButtonEvent, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    triggered: bool = False


class CameraCapture(Message, typename="px4_msgs/msg/CameraCapture"):
    """CameraCapture, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_utc: uint64 = 0
    seq: uint32 = 0
    lat: float64 = 0.0
    lon: float64 = 0.0
    alt: float32 = 0.0
    ground_distance: float32 = 0.0
    q: Annotated[Floats, Array[float32, 4]] = DEFAULT
    result: int8 = 0


class CameraStatus(Message, typename="px4_msgs/msg/CameraStatus"):
    """CameraStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    active_sys_id: uint8 = 0
    active_comp_id: uint8 = 0


class CameraTrigger(Message, typename="px4_msgs/msg/CameraTrigger"):
    """CameraTrigger, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint32] = 2

    timestamp: uint64 = 0
    timestamp_utc: uint64 = 0
    seq: uint32 = 0
    feedback: bool = False


class CanInterfaceStatus(Message, typename="px4_msgs/msg/CanInterfaceStatus"):
    """CanInterfaceStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    interface: uint8 = 0
    io_errors: uint64 = 0
    frames_tx: uint64 = 0
    frames_rx: uint64 = 0


class CellularStatus(Message, typename="px4_msgs/msg/CellularStatus"):
    """CellularStatus, as PX4 1.15 defines it."""

    CELLULAR_STATUS_FLAG_UNKNOWN: ClassVar[uint8] = 0
    CELLULAR_STATUS_FLAG_FAILED: ClassVar[uint8] = 1
    CELLULAR_STATUS_FLAG_INITIALIZING: ClassVar[uint8] = 2
    CELLULAR_STATUS_FLAG_LOCKED: ClassVar[uint8] = 3
    CELLULAR_STATUS_FLAG_DISABLED: ClassVar[uint8] = 4
    CELLULAR_STATUS_FLAG_DISABLING: ClassVar[uint8] = 5
    CELLULAR_STATUS_FLAG_ENABLING: ClassVar[uint8] = 6
    CELLULAR_STATUS_FLAG_ENABLED: ClassVar[uint8] = 7
    CELLULAR_STATUS_FLAG_SEARCHING: ClassVar[uint8] = 8
    CELLULAR_STATUS_FLAG_REGISTERED: ClassVar[uint8] = 9
    CELLULAR_STATUS_FLAG_DISCONNECTING: ClassVar[uint8] = 10
    CELLULAR_STATUS_FLAG_CONNECTING: ClassVar[uint8] = 11
    CELLULAR_STATUS_FLAG_CONNECTED: ClassVar[uint8] = 12
    CELLULAR_NETWORK_FAILED_REASON_NONE: ClassVar[uint8] = 0
    CELLULAR_NETWORK_FAILED_REASON_UNKNOWN: ClassVar[uint8] = 1
    CELLULAR_NETWORK_FAILED_REASON_SIM_MISSING: ClassVar[uint8] = 2
    CELLULAR_NETWORK_FAILED_REASON_SIM_ERROR: ClassVar[uint8] = 3

    timestamp: uint64 = 0
    status: uint16 = 0
    failure_reason: uint8 = 0
    type: uint8 = 0
    quality: uint8 = 0
    mcc: uint16 = 0
    mnc: uint16 = 0
    lac: uint16 = 0


class CollisionConstraints(Message, typename="px4_msgs/msg/CollisionConstraints"):
    """CollisionConstraints, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    original_setpoint: Annotated[Floats, Array[float32, 2]] = DEFAULT
    adapted_setpoint: Annotated[Floats, Array[float32, 2]] = DEFAULT


class CollisionReport(Message, typename="px4_msgs/msg/CollisionReport"):
    """CollisionReport, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    src: uint8 = 0
    id: uint32 = 0
    action: uint8 = 0
    threat_level: uint8 = 0
    time_to_minimum_delta: float32 = 0.0
    altitude_minimum_delta: float32 = 0.0
    horizontal_minimum_delta: float32 = 0.0


class ConfigOverrides(Message, typename="px4_msgs/msg/ConfigOverrides"):
    """ConfigOverrides, as PX4 1.15 defines it."""

    SOURCE_TYPE_MODE: ClassVar[int8] = 0
    SOURCE_TYPE_MODE_EXECUTOR: ClassVar[int8] = 1
    ORB_QUEUE_LENGTH: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    disable_auto_disarm: bool = False
    defer_failsafes: bool = False
    defer_failsafes_timeout_s: int16 = 0
    source_type: int8 = 0
    source_id: uint8 = 0


class ControlAllocatorStatus(Message, typename="px4_msgs/msg/ControlAllocatorStatus"):
    """ControlAllocatorStatus, as PX4 1.15 defines it."""

    ACTUATOR_SATURATION_OK: ClassVar[int8] = 0
    ACTUATOR_SATURATION_UPPER_DYN: ClassVar[int8] = 1
    ACTUATOR_SATURATION_UPPER: ClassVar[int8] = 2
    ACTUATOR_SATURATION_LOWER_DYN: ClassVar[int8] = -1
    ACTUATOR_SATURATION_LOWER: ClassVar[int8] = -2

    timestamp: uint64 = 0
    torque_setpoint_achieved: bool = False
    unallocated_torque: Annotated[Floats, Array[float32, 3]] = DEFAULT
    thrust_setpoint_achieved: bool = False
    unallocated_thrust: Annotated[Floats, Array[float32, 3]] = DEFAULT
    actuator_saturation: Annotated[Ints, Array[int8, 16]] = DEFAULT
    handled_motor_failure_mask: uint16 = 0


class Cpuload(Message, typename="px4_msgs/msg/Cpuload"):
    """Cpuload, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    load: float32 = 0.0
    ram_usage: float32 = 0.0


class DatamanRequest(Message, typename="px4_msgs/msg/DatamanRequest"):
    """DatamanRequest, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    client_id: uint8 = 0
    request_type: uint8 = 0
    item: uint8 = 0
    index: uint32 = 0
    data: Annotated[Ints, Array[uint8, 56]] = DEFAULT
    data_length: uint32 = 0


class DatamanResponse(Message, typename="px4_msgs/msg/DatamanResponse"):
    """DatamanResponse, as PX4 1.15 defines it."""

    STATUS_SUCCESS: ClassVar[uint8] = 0
    STATUS_FAILURE_ID_ERR: ClassVar[uint8] = 1
    STATUS_FAILURE_NO_DATA: ClassVar[uint8] = 2
    STATUS_FAILURE_READ_FAILED: ClassVar[uint8] = 3
    STATUS_FAILURE_WRITE_FAILED: ClassVar[uint8] = 4
    STATUS_FAILURE_CLEAR_FAILED: ClassVar[uint8] = 5

    timestamp: uint64 = 0
    client_id: uint8 = 0
    request_type: uint8 = 0
    item: uint8 = 0
    index: uint32 = 0
    data: Annotated[Ints, Array[uint8, 56]] = DEFAULT
    status: uint8 = 0


class DebugArray(Message, typename="px4_msgs/msg/DebugArray"):
    """DebugArray, as PX4 1.15 defines it."""

    ARRAY_SIZE: ClassVar[uint8] = 58

    timestamp: uint64 = 0
    id: uint16 = 0
    name: Annotated[Ints, Array[char, 10]] = DEFAULT
    data: Annotated[Floats, Array[float32, 58]] = DEFAULT


class DebugKeyValue(Message, typename="px4_msgs/msg/DebugKeyValue"):
    """DebugKeyValue, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    key: Annotated[Ints, Array[char, 10]] = DEFAULT
    value: float32 = 0.0


class DebugValue(Message, typename="px4_msgs/msg/DebugValue"):
    """DebugValue, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    ind: int8 = 0
    value: float32 = 0.0


class DebugVect(Message, typename="px4_msgs/msg/DebugVect"):
    """DebugVect, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    name: Annotated[Ints, Array[char, 10]] = DEFAULT
    x: float32 = 0.0
    y: float32 = 0.0
    z: float32 = 0.0


class DifferentialDriveSetpoint(Message, typename="px4_msgs/msg/DifferentialDriveSetpoint"):
    """DifferentialDriveSetpoint, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    speed: float32 = 0.0
    closed_loop_speed_control: bool = False
    yaw_rate: float32 = 0.0
    closed_loop_yaw_rate_control: bool = False


class DifferentialPressure(Message, typename="px4_msgs/msg/DifferentialPressure"):
    """DifferentialPressure, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    differential_pressure_pa: float32 = 0.0
    temperature: float32 = 0.0
    error_count: uint32 = 0


class DistanceSensor(Message, typename="px4_msgs/msg/DistanceSensor"):
    """DistanceSensor, as PX4 1.15 defines it."""

    MAV_DISTANCE_SENSOR_LASER: ClassVar[uint8] = 0
    MAV_DISTANCE_SENSOR_ULTRASOUND: ClassVar[uint8] = 1
    MAV_DISTANCE_SENSOR_INFRARED: ClassVar[uint8] = 2
    MAV_DISTANCE_SENSOR_RADAR: ClassVar[uint8] = 3
    ROTATION_YAW_0: ClassVar[uint8] = 0
    ROTATION_YAW_45: ClassVar[uint8] = 1
    ROTATION_YAW_90: ClassVar[uint8] = 2
    ROTATION_YAW_135: ClassVar[uint8] = 3
    ROTATION_YAW_180: ClassVar[uint8] = 4
    ROTATION_YAW_225: ClassVar[uint8] = 5
    ROTATION_YAW_270: ClassVar[uint8] = 6
    ROTATION_YAW_315: ClassVar[uint8] = 7
    ROTATION_FORWARD_FACING: ClassVar[uint8] = 0
    ROTATION_RIGHT_FACING: ClassVar[uint8] = 2
    ROTATION_BACKWARD_FACING: ClassVar[uint8] = 4
    ROTATION_LEFT_FACING: ClassVar[uint8] = 6
    ROTATION_UPWARD_FACING: ClassVar[uint8] = 24
    ROTATION_DOWNWARD_FACING: ClassVar[uint8] = 25
    ROTATION_CUSTOM: ClassVar[uint8] = 100

    timestamp: uint64 = 0
    device_id: uint32 = 0
    min_distance: float32 = 0.0
    max_distance: float32 = 0.0
    current_distance: float32 = 0.0
    variance: float32 = 0.0
    signal_quality: int8 = 0
    type: uint8 = 0
    h_fov: float32 = 0.0
    v_fov: float32 = 0.0
    q: Annotated[Floats, Array[float32, 4]] = DEFAULT
    orientation: uint8 = 0


class Ekf2Timestamps(Message, typename="px4_msgs/msg/Ekf2Timestamps"):
    """Ekf2Timestamps, as PX4 1.15 defines it."""

    RELATIVE_TIMESTAMP_INVALID: ClassVar[int16] = 32767

    timestamp: uint64 = 0
    airspeed_timestamp_rel: int16 = 0
    distance_sensor_timestamp_rel: int16 = 0
    optical_flow_timestamp_rel: int16 = 0
    vehicle_air_data_timestamp_rel: int16 = 0
    vehicle_magnetometer_timestamp_rel: int16 = 0
    visual_odometry_timestamp_rel: int16 = 0


class EscReport(Message, typename="px4_msgs/msg/EscReport"):
    """EscReport, as PX4 1.15 defines it."""

    FAILURE_OVER_CURRENT: ClassVar[uint8] = 0
    FAILURE_OVER_VOLTAGE: ClassVar[uint8] = 1
    FAILURE_MOTOR_OVER_TEMPERATURE: ClassVar[uint8] = 2
    FAILURE_OVER_RPM: ClassVar[uint8] = 3
    FAILURE_INCONSISTENT_CMD: ClassVar[uint8] = 4
    FAILURE_MOTOR_STUCK: ClassVar[uint8] = 5
    FAILURE_GENERIC: ClassVar[uint8] = 6
    FAILURE_MOTOR_WARN_TEMPERATURE: ClassVar[uint8] = 7
    FAILURE_WARN_ESC_TEMPERATURE: ClassVar[uint8] = 8
    FAILURE_OVER_ESC_TEMPERATURE: ClassVar[uint8] = 9
    ESC_FAILURE_COUNT: ClassVar[uint8] = 10

    timestamp: uint64 = 0
    esc_errorcount: uint32 = 0
    esc_rpm: int32 = 0
    esc_voltage: float32 = 0.0
    esc_current: float32 = 0.0
    esc_temperature: float32 = 0.0
    esc_address: uint8 = 0
    esc_cmdcount: uint8 = 0
    esc_state: uint8 = 0
    actuator_function: uint8 = 0
    failures: uint16 = 0
    esc_power: int8 = 0


class EscStatus(Message, typename="px4_msgs/msg/EscStatus"):
    """EscStatus, as PX4 1.15 defines it."""

    CONNECTED_ESC_MAX: ClassVar[uint8] = 8
    ESC_CONNECTION_TYPE_PPM: ClassVar[uint8] = 0
    ESC_CONNECTION_TYPE_SERIAL: ClassVar[uint8] = 1
    ESC_CONNECTION_TYPE_ONESHOT: ClassVar[uint8] = 2
    ESC_CONNECTION_TYPE_I2C: ClassVar[uint8] = 3
    ESC_CONNECTION_TYPE_CAN: ClassVar[uint8] = 4
    ESC_CONNECTION_TYPE_DSHOT: ClassVar[uint8] = 5

    timestamp: uint64 = 0
    counter: uint16 = 0
    esc_count: uint8 = 0
    esc_connectiontype: uint8 = 0
    esc_online_flags: uint8 = 0
    esc_armed_flags: uint8 = 0
    esc: Annotated[list[EscReport], Array[EscReport, 8]] = DEFAULT


class EstimatorAidSource1d(Message, typename="px4_msgs/msg/EstimatorAidSource1d"):
    """EstimatorAidSource1d, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    estimator_instance: uint8 = 0
    device_id: uint32 = 0
    time_last_fuse: uint64 = 0
    observation: float32 = 0.0
    observation_variance: float32 = 0.0
    innovation: float32 = 0.0
    innovation_variance: float32 = 0.0
    test_ratio: float32 = 0.0
    innovation_rejected: bool = False
    fused: bool = False


class EstimatorAidSource2d(Message, typename="px4_msgs/msg/EstimatorAidSource2d"):
    """EstimatorAidSource2d, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    estimator_instance: uint8 = 0
    device_id: uint32 = 0
    time_last_fuse: uint64 = 0
    observation: Annotated[Floats, Array[float32, 2]] = DEFAULT
    observation_variance: Annotated[Floats, Array[float32, 2]] = DEFAULT
    innovation: Annotated[Floats, Array[float32, 2]] = DEFAULT
    innovation_variance: Annotated[Floats, Array[float32, 2]] = DEFAULT
    test_ratio: Annotated[Floats, Array[float32, 2]] = DEFAULT
    innovation_rejected: bool = False
    fused: bool = False


class EstimatorAidSource3d(Message, typename="px4_msgs/msg/EstimatorAidSource3d"):
    """EstimatorAidSource3d, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    estimator_instance: uint8 = 0
    device_id: uint32 = 0
    time_last_fuse: uint64 = 0
    observation: Annotated[Floats, Array[float32, 3]] = DEFAULT
    observation_variance: Annotated[Floats, Array[float32, 3]] = DEFAULT
    innovation: Annotated[Floats, Array[float32, 3]] = DEFAULT
    innovation_variance: Annotated[Floats, Array[float32, 3]] = DEFAULT
    test_ratio: Annotated[Floats, Array[float32, 3]] = DEFAULT
    innovation_rejected: bool = False
    fused: bool = False


class EstimatorBias(Message, typename="px4_msgs/msg/EstimatorBias"):
    """EstimatorBias, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    bias: float32 = 0.0
    bias_var: float32 = 0.0
    innov: float32 = 0.0
    innov_var: float32 = 0.0
    innov_test_ratio: float32 = 0.0


class EstimatorBias3d(Message, typename="px4_msgs/msg/EstimatorBias3d"):
    """EstimatorBias3d, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    bias: Annotated[Floats, Array[float32, 3]] = DEFAULT
    bias_var: Annotated[Floats, Array[float32, 3]] = DEFAULT
    innov: Annotated[Floats, Array[float32, 3]] = DEFAULT
    innov_var: Annotated[Floats, Array[float32, 3]] = DEFAULT
    innov_test_ratio: Annotated[Floats, Array[float32, 3]] = DEFAULT


class EstimatorEventFlags(Message, typename="px4_msgs/msg/EstimatorEventFlags"):
    """EstimatorEventFlags, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    information_event_changes: uint32 = 0
    gps_checks_passed: bool = False
    reset_vel_to_gps: bool = False
    reset_vel_to_flow: bool = False
    reset_vel_to_vision: bool = False
    reset_vel_to_zero: bool = False
    reset_pos_to_last_known: bool = False
    reset_pos_to_gps: bool = False
    reset_pos_to_vision: bool = False
    starting_gps_fusion: bool = False
    starting_vision_pos_fusion: bool = False
    starting_vision_vel_fusion: bool = False
    starting_vision_yaw_fusion: bool = False
    yaw_aligned_to_imu_gps: bool = False
    reset_hgt_to_baro: bool = False
    reset_hgt_to_gps: bool = False
    reset_hgt_to_rng: bool = False
    reset_hgt_to_ev: bool = False
    warning_event_changes: uint32 = 0
    gps_quality_poor: bool = False
    gps_fusion_timout: bool = False
    gps_data_stopped: bool = False
    gps_data_stopped_using_alternate: bool = False
    height_sensor_timeout: bool = False
    stopping_navigation: bool = False
    invalid_accel_bias_cov_reset: bool = False
    bad_yaw_using_gps_course: bool = False
    stopping_mag_use: bool = False
    vision_data_stopped: bool = False
    emergency_yaw_reset_mag_stopped: bool = False
    emergency_yaw_reset_gps_yaw_stopped: bool = False


class EstimatorGpsStatus(Message, typename="px4_msgs/msg/EstimatorGpsStatus"):
    """EstimatorGpsStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    checks_passed: bool = False
    check_fail_gps_fix: bool = False
    check_fail_min_sat_count: bool = False
    check_fail_max_pdop: bool = False
    check_fail_max_horz_err: bool = False
    check_fail_max_vert_err: bool = False
    check_fail_max_spd_err: bool = False
    check_fail_max_horz_drift: bool = False
    check_fail_max_vert_drift: bool = False
    check_fail_max_horz_spd_err: bool = False
    check_fail_max_vert_spd_err: bool = False
    position_drift_rate_horizontal_m_s: float32 = 0.0
    position_drift_rate_vertical_m_s: float32 = 0.0
    filtered_horizontal_speed_m_s: float32 = 0.0


class EstimatorInnovations(Message, typename="px4_msgs/msg/EstimatorInnovations"):
    """EstimatorInnovations, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    gps_hvel: Annotated[Floats, Array[float32, 2]] = DEFAULT
    gps_vvel: float32 = 0.0
    gps_hpos: Annotated[Floats, Array[float32, 2]] = DEFAULT
    gps_vpos: float32 = 0.0
    ev_hvel: Annotated[Floats, Array[float32, 2]] = DEFAULT
    ev_vvel: float32 = 0.0
    ev_hpos: Annotated[Floats, Array[float32, 2]] = DEFAULT
    ev_vpos: float32 = 0.0
    rng_vpos: float32 = 0.0
    baro_vpos: float32 = 0.0
    aux_hvel: Annotated[Floats, Array[float32, 2]] = DEFAULT
    flow: Annotated[Floats, Array[float32, 2]] = DEFAULT
    terr_flow: Annotated[Floats, Array[float32, 2]] = DEFAULT
    heading: float32 = 0.0
    mag_field: Annotated[Floats, Array[float32, 3]] = DEFAULT
    gravity: Annotated[Floats, Array[float32, 3]] = DEFAULT
    drag: Annotated[Floats, Array[float32, 2]] = DEFAULT
    airspeed: float32 = 0.0
    beta: float32 = 0.0
    hagl: float32 = 0.0
    hagl_rate: float32 = 0.0


class EstimatorSelectorStatus(Message, typename="px4_msgs/msg/EstimatorSelectorStatus"):
    """EstimatorSelectorStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    primary_instance: uint8 = 0
    instances_available: uint8 = 0
    instance_changed_count: uint32 = 0
    last_instance_change: uint64 = 0
    accel_device_id: uint32 = 0
    baro_device_id: uint32 = 0
    gyro_device_id: uint32 = 0
    mag_device_id: uint32 = 0
    combined_test_ratio: Annotated[Floats, Array[float32, 9]] = DEFAULT
    relative_test_ratio: Annotated[Floats, Array[float32, 9]] = DEFAULT
    healthy: Annotated[Bools, Array[bool, 9]] = DEFAULT
    accumulated_gyro_error: Annotated[Floats, Array[float32, 4]] = DEFAULT
    accumulated_accel_error: Annotated[Floats, Array[float32, 4]] = DEFAULT
    gyro_fault_detected: bool = False
    accel_fault_detected: bool = False


class EstimatorSensorBias(Message, typename="px4_msgs/msg/EstimatorSensorBias"):
    """EstimatorSensorBias, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    gyro_device_id: uint32 = 0
    gyro_bias: Annotated[Floats, Array[float32, 3]] = DEFAULT
    gyro_bias_limit: float32 = 0.0
    gyro_bias_variance: Annotated[Floats, Array[float32, 3]] = DEFAULT
    gyro_bias_valid: bool = False
    gyro_bias_stable: bool = False
    accel_device_id: uint32 = 0
    accel_bias: Annotated[Floats, Array[float32, 3]] = DEFAULT
    accel_bias_limit: float32 = 0.0
    accel_bias_variance: Annotated[Floats, Array[float32, 3]] = DEFAULT
    accel_bias_valid: bool = False
    accel_bias_stable: bool = False
    mag_device_id: uint32 = 0
    mag_bias: Annotated[Floats, Array[float32, 3]] = DEFAULT
    mag_bias_limit: float32 = 0.0
    mag_bias_variance: Annotated[Floats, Array[float32, 3]] = DEFAULT
    mag_bias_valid: bool = False
    mag_bias_stable: bool = False


class EstimatorStates(Message, typename="px4_msgs/msg/EstimatorStates"):
    """EstimatorStates, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    states: Annotated[Floats, Array[float32, 24]] = DEFAULT
    n_states: uint8 = 0
    covariances: Annotated[Floats, Array[float32, 23]] = DEFAULT


class EstimatorStatus(Message, typename="px4_msgs/msg/EstimatorStatus"):
    """EstimatorStatus, as PX4 1.15 defines it."""

    GPS_CHECK_FAIL_GPS_FIX: ClassVar[uint8] = 0
    GPS_CHECK_FAIL_MIN_SAT_COUNT: ClassVar[uint8] = 1
    GPS_CHECK_FAIL_MAX_PDOP: ClassVar[uint8] = 2
    GPS_CHECK_FAIL_MAX_HORZ_ERR: ClassVar[uint8] = 3
    GPS_CHECK_FAIL_MAX_VERT_ERR: ClassVar[uint8] = 4
    GPS_CHECK_FAIL_MAX_SPD_ERR: ClassVar[uint8] = 5
    GPS_CHECK_FAIL_MAX_HORZ_DRIFT: ClassVar[uint8] = 6
    GPS_CHECK_FAIL_MAX_VERT_DRIFT: ClassVar[uint8] = 7
    GPS_CHECK_FAIL_MAX_HORZ_SPD_ERR: ClassVar[uint8] = 8
    GPS_CHECK_FAIL_MAX_VERT_SPD_ERR: ClassVar[uint8] = 9
    CS_TILT_ALIGN: ClassVar[uint8] = 0
    CS_YAW_ALIGN: ClassVar[uint8] = 1
    CS_GPS: ClassVar[uint8] = 2
    CS_OPT_FLOW: ClassVar[uint8] = 3
    CS_MAG_HDG: ClassVar[uint8] = 4
    CS_MAG_3D: ClassVar[uint8] = 5
    CS_MAG_DEC: ClassVar[uint8] = 6
    CS_IN_AIR: ClassVar[uint8] = 7
    CS_WIND: ClassVar[uint8] = 8
    CS_BARO_HGT: ClassVar[uint8] = 9
    CS_RNG_HGT: ClassVar[uint8] = 10
    CS_GPS_HGT: ClassVar[uint8] = 11
    CS_EV_POS: ClassVar[uint8] = 12
    CS_EV_YAW: ClassVar[uint8] = 13
    CS_EV_HGT: ClassVar[uint8] = 14
    CS_BETA: ClassVar[uint8] = 15
    CS_MAG_FIELD: ClassVar[uint8] = 16
    CS_FIXED_WING: ClassVar[uint8] = 17
    CS_MAG_FAULT: ClassVar[uint8] = 18
    CS_ASPD: ClassVar[uint8] = 19
    CS_GND_EFFECT: ClassVar[uint8] = 20
    CS_RNG_STUCK: ClassVar[uint8] = 21
    CS_GPS_YAW: ClassVar[uint8] = 22
    CS_MAG_ALIGNED: ClassVar[uint8] = 23
    CS_EV_VEL: ClassVar[uint8] = 24
    CS_SYNTHETIC_MAG_Z: ClassVar[uint8] = 25
    CS_VEHICLE_AT_REST: ClassVar[uint8] = 26
    CS_GPS_YAW_FAULT: ClassVar[uint8] = 27
    CS_RNG_FAULT: ClassVar[uint8] = 28

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    output_tracking_error: Annotated[Floats, Array[float32, 3]] = DEFAULT
    gps_check_fail_flags: uint16 = 0
    control_mode_flags: uint64 = 0
    filter_fault_flags: uint32 = 0
    pos_horiz_accuracy: float32 = 0.0
    pos_vert_accuracy: float32 = 0.0
    innovation_check_flags: uint16 = 0
    mag_test_ratio: float32 = 0.0
    vel_test_ratio: float32 = 0.0
    pos_test_ratio: float32 = 0.0
    hgt_test_ratio: float32 = 0.0
    tas_test_ratio: float32 = 0.0
    hagl_test_ratio: float32 = 0.0
    beta_test_ratio: float32 = 0.0
    solution_status_flags: uint16 = 0
    reset_count_vel_ne: uint8 = 0
    reset_count_vel_d: uint8 = 0
    reset_count_pos_ne: uint8 = 0
    reset_count_pod_d: uint8 = 0
    reset_count_quat: uint8 = 0
    time_slip: float32 = 0.0
    pre_flt_fail_innov_heading: bool = False
    pre_flt_fail_innov_vel_horiz: bool = False
    pre_flt_fail_innov_vel_vert: bool = False
    pre_flt_fail_innov_height: bool = False
    pre_flt_fail_mag_field_disturbed: bool = False
    accel_device_id: uint32 = 0
    gyro_device_id: uint32 = 0
    baro_device_id: uint32 = 0
    mag_device_id: uint32 = 0
    health_flags: uint8 = 0
    timeout_flags: uint8 = 0
    mag_inclination_deg: float32 = 0.0
    mag_inclination_ref_deg: float32 = 0.0
    mag_strength_gs: float32 = 0.0
    mag_strength_ref_gs: float32 = 0.0


class EstimatorStatusFlags(Message, typename="px4_msgs/msg/EstimatorStatusFlags"):
    """EstimatorStatusFlags, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    control_status_changes: uint32 = 0
    cs_tilt_align: bool = False
    cs_yaw_align: bool = False
    cs_gps: bool = False
    cs_opt_flow: bool = False
    cs_mag_hdg: bool = False
    cs_mag_3d: bool = False
    cs_mag_dec: bool = False
    cs_in_air: bool = False
    cs_wind: bool = False
    cs_baro_hgt: bool = False
    cs_rng_hgt: bool = False
    cs_gps_hgt: bool = False
    cs_ev_pos: bool = False
    cs_ev_yaw: bool = False
    cs_ev_hgt: bool = False
    cs_fuse_beta: bool = False
    cs_mag_field_disturbed: bool = False
    cs_fixed_wing: bool = False
    cs_mag_fault: bool = False
    cs_fuse_aspd: bool = False
    cs_gnd_effect: bool = False
    cs_rng_stuck: bool = False
    cs_gps_yaw: bool = False
    cs_mag_aligned_in_flight: bool = False
    cs_ev_vel: bool = False
    cs_synthetic_mag_z: bool = False
    cs_vehicle_at_rest: bool = False
    cs_gps_yaw_fault: bool = False
    cs_rng_fault: bool = False
    cs_inertial_dead_reckoning: bool = False
    cs_wind_dead_reckoning: bool = False
    cs_rng_kin_consistent: bool = False
    cs_fake_pos: bool = False
    cs_fake_hgt: bool = False
    cs_gravity_vector: bool = False
    cs_mag: bool = False
    cs_ev_yaw_fault: bool = False
    cs_mag_heading_consistent: bool = False
    cs_aux_gpos: bool = False
    fault_status_changes: uint32 = 0
    fs_bad_mag_x: bool = False
    fs_bad_mag_y: bool = False
    fs_bad_mag_z: bool = False
    fs_bad_hdg: bool = False
    fs_bad_mag_decl: bool = False
    fs_bad_airspeed: bool = False
    fs_bad_sideslip: bool = False
    fs_bad_optflow_x: bool = False
    fs_bad_optflow_y: bool = False
    fs_bad_acc_bias: bool = False
    fs_bad_acc_vertical: bool = False
    fs_bad_acc_clipping: bool = False
    innovation_fault_status_changes: uint32 = 0
    reject_hor_vel: bool = False
    reject_ver_vel: bool = False
    reject_hor_pos: bool = False
    reject_ver_pos: bool = False
    reject_yaw: bool = False
    reject_airspeed: bool = False
    reject_sideslip: bool = False
    reject_hagl: bool = False
    reject_optflow_x: bool = False
    reject_optflow_y: bool = False


class FailsafeFlags(Message, typename="px4_msgs/msg/FailsafeFlags"):
    """FailsafeFlags, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    mode_req_angular_velocity: uint32 = 0
    mode_req_attitude: uint32 = 0
    mode_req_local_alt: uint32 = 0
    mode_req_local_position: uint32 = 0
    mode_req_local_position_relaxed: uint32 = 0
    mode_req_global_position: uint32 = 0
    mode_req_mission: uint32 = 0
    mode_req_offboard_signal: uint32 = 0
    mode_req_home_position: uint32 = 0
    mode_req_wind_and_flight_time_compliance: uint32 = 0
    mode_req_prevent_arming: uint32 = 0
    mode_req_manual_control: uint32 = 0
    mode_req_other: uint32 = 0
    angular_velocity_invalid: bool = False
    attitude_invalid: bool = False
    local_altitude_invalid: bool = False
    local_position_invalid: bool = False
    local_position_invalid_relaxed: bool = False
    local_velocity_invalid: bool = False
    global_position_invalid: bool = False
    auto_mission_missing: bool = False
    offboard_control_signal_lost: bool = False
    home_position_invalid: bool = False
    manual_control_signal_lost: bool = False
    gcs_connection_lost: bool = False
    battery_warning: uint8 = 0
    battery_low_remaining_time: bool = False
    battery_unhealthy: bool = False
    geofence_breached: bool = False
    mission_failure: bool = False
    vtol_fixed_wing_system_failure: bool = False
    wind_limit_exceeded: bool = False
    flight_time_limit_exceeded: bool = False
    local_position_accuracy_low: bool = False
    fd_critical_failure: bool = False
    fd_esc_arming_failure: bool = False
    fd_imbalanced_prop: bool = False
    fd_motor_failure: bool = False


class FailureDetectorStatus(Message, typename="px4_msgs/msg/FailureDetectorStatus"):
    """FailureDetectorStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    fd_roll: bool = False
    fd_pitch: bool = False
    fd_alt: bool = False
    fd_ext: bool = False
    fd_arm_escs: bool = False
    fd_battery: bool = False
    fd_imbalanced_prop: bool = False
    fd_motor: bool = False
    imbalanced_prop_metric: float32 = 0.0
    motor_failure_mask: uint16 = 0


class FigureEightStatus(Message, typename="px4_msgs/msg/FigureEightStatus"):
    """FigureEightStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    major_radius: float32 = 0.0
    minor_radius: float32 = 0.0
    orientation: float32 = 0.0
    frame: uint8 = 0
    x: int32 = 0
    y: int32 = 0
    z: float32 = 0.0


class FlightPhaseEstimation(Message, typename="px4_msgs/msg/FlightPhaseEstimation"):
    """FlightPhaseEstimation, as PX4 1.15 defines it."""

    FLIGHT_PHASE_UNKNOWN: ClassVar[uint8] = 0
    FLIGHT_PHASE_LEVEL: ClassVar[uint8] = 1
    FLIGHT_PHASE_DESCEND: ClassVar[uint8] = 2
    FLIGHT_PHASE_CLIMB: ClassVar[uint8] = 3

    timestamp: uint64 = 0
    flight_phase: uint8 = 0


class FollowTarget(Message, typename="px4_msgs/msg/FollowTarget"):
    """FollowTarget, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    lat: float64 = 0.0
    lon: float64 = 0.0
    alt: float32 = 0.0
    vy: float32 = 0.0
    vx: float32 = 0.0
    vz: float32 = 0.0
    est_cap: uint8 = 0


class FollowTargetEstimator(Message, typename="px4_msgs/msg/FollowTargetEstimator"):
    """FollowTargetEstimator, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    last_filter_reset_timestamp: uint64 = 0
    valid: bool = False
    stale: bool = False
    lat_est: float64 = 0.0
    lon_est: float64 = 0.0
    alt_est: float32 = 0.0
    pos_est: Annotated[Floats, Array[float32, 3]] = DEFAULT
    vel_est: Annotated[Floats, Array[float32, 3]] = DEFAULT
    acc_est: Annotated[Floats, Array[float32, 3]] = DEFAULT
    prediction_count: uint64 = 0
    fusion_count: uint64 = 0


class FollowTargetStatus(Message, typename="px4_msgs/msg/FollowTargetStatus"):
    """FollowTargetStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    tracked_target_course: float32 = 0.0
    follow_angle: float32 = 0.0
    orbit_angle_setpoint: float32 = 0.0
    angular_rate_setpoint: float32 = 0.0
    desired_position_raw: Annotated[Floats, Array[float32, 3]] = DEFAULT
    in_emergency_ascent: bool = False
    gimbal_pitch: float32 = 0.0


class GeneratorStatus(Message, typename="px4_msgs/msg/GeneratorStatus"):
    """GeneratorStatus, as PX4 1.15 defines it."""

    STATUS_FLAG_OFF: ClassVar[uint64] = 1
    STATUS_FLAG_READY: ClassVar[uint64] = 2
    STATUS_FLAG_GENERATING: ClassVar[uint64] = 4
    STATUS_FLAG_CHARGING: ClassVar[uint64] = 8
    STATUS_FLAG_REDUCED_POWER: ClassVar[uint64] = 16
    STATUS_FLAG_MAXPOWER: ClassVar[uint64] = 32
    STATUS_FLAG_OVERTEMP_WARNING: ClassVar[uint64] = 64
    STATUS_FLAG_OVERTEMP_FAULT: ClassVar[uint64] = 128
    STATUS_FLAG_ELECTRONICS_OVERTEMP_WARNING: ClassVar[uint64] = 256
    STATUS_FLAG_ELECTRONICS_OVERTEMP_FAULT: ClassVar[uint64] = 512
    STATUS_FLAG_ELECTRONICS_FAULT: ClassVar[uint64] = 1024
    STATUS_FLAG_POWERSOURCE_FAULT: ClassVar[uint64] = 2048
    STATUS_FLAG_COMMUNICATION_WARNING: ClassVar[uint64] = 4096
    STATUS_FLAG_COOLING_WARNING: ClassVar[uint64] = 8192
    STATUS_FLAG_POWER_RAIL_FAULT: ClassVar[uint64] = 16384
    STATUS_FLAG_OVERCURRENT_FAULT: ClassVar[uint64] = 32768
    STATUS_FLAG_BATTERY_OVERCHARGE_CURRENT_FAULT: ClassVar[uint64] = 65536
    STATUS_FLAG_OVERVOLTAGE_FAULT: ClassVar[uint64] = 131072
    STATUS_FLAG_BATTERY_UNDERVOLT_FAULT: ClassVar[uint64] = 262144
    STATUS_FLAG_START_INHIBITED: ClassVar[uint64] = 524288
    STATUS_FLAG_MAINTENANCE_REQUIRED: ClassVar[uint64] = 1048576
    STATUS_FLAG_WARMING_UP: ClassVar[uint64] = 2097152
    STATUS_FLAG_IDLE: ClassVar[uint64] = 4194304

    timestamp: uint64 = 0
    status: uint64 = 0
    battery_current: float32 = 0.0
    load_current: float32 = 0.0
    power_generated: float32 = 0.0
    bus_voltage: float32 = 0.0
    bat_current_setpoint: float32 = 0.0
    runtime: uint32 = 0
    time_until_maintenance: int32 = 0
    generator_speed: uint16 = 0
    rectifier_temperature: int16 = 0
    generator_temperature: int16 = 0


class GeofenceResult(Message, typename="px4_msgs/msg/GeofenceResult"):
    """GeofenceResult, as PX4 1.15 defines it."""

    GF_ACTION_NONE: ClassVar[uint8] = 0
    GF_ACTION_WARN: ClassVar[uint8] = 1
    GF_ACTION_LOITER: ClassVar[uint8] = 2
    GF_ACTION_RTL: ClassVar[uint8] = 3
    GF_ACTION_TERMINATE: ClassVar[uint8] = 4
    GF_ACTION_LAND: ClassVar[uint8] = 5

    timestamp: uint64 = 0
    geofence_max_dist_triggered: bool = False
    geofence_max_alt_triggered: bool = False
    geofence_custom_fence_triggered: bool = False
    geofence_action: uint8 = 0


class GeofenceStatus(Message, typename="px4_msgs/msg/GeofenceStatus"):
    """GeofenceStatus, as PX4 1.15 defines it."""

    GF_STATUS_LOADING: ClassVar[uint8] = 0
    GF_STATUS_READY: ClassVar[uint8] = 1

    timestamp: uint64 = 0
    geofence_id: uint32 = 0
    status: uint8 = 0


class GimbalControls(Message, typename="px4_msgs/msg/GimbalControls"):
    """GimbalControls, as PX4 1.15 defines it."""

    INDEX_ROLL: ClassVar[uint8] = 0
    INDEX_PITCH: ClassVar[uint8] = 1
    INDEX_YAW: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    control: Annotated[Floats, Array[float32, 3]] = DEFAULT


class GimbalDeviceAttitudeStatus(Message, typename="px4_msgs/msg/GimbalDeviceAttitudeStatus"):
    """GimbalDeviceAttitudeStatus, as PX4 1.15 defines it."""

    DEVICE_FLAGS_RETRACT: ClassVar[uint16] = 1
    DEVICE_FLAGS_NEUTRAL: ClassVar[uint16] = 2
    DEVICE_FLAGS_ROLL_LOCK: ClassVar[uint16] = 4
    DEVICE_FLAGS_PITCH_LOCK: ClassVar[uint16] = 8
    DEVICE_FLAGS_YAW_LOCK: ClassVar[uint16] = 16

    timestamp: uint64 = 0
    target_system: uint8 = 0
    target_component: uint8 = 0
    device_flags: uint16 = 0
    q: Annotated[Floats, Array[float32, 4]] = DEFAULT
    angular_velocity_x: float32 = 0.0
    angular_velocity_y: float32 = 0.0
    angular_velocity_z: float32 = 0.0
    failure_flags: uint32 = 0
    received_from_mavlink: bool = False


class GimbalDeviceInformation(Message, typename="px4_msgs/msg/GimbalDeviceInformation"):
    """GimbalDeviceInformation, as PX4 1.15 defines it."""

    GIMBAL_DEVICE_CAP_FLAGS_HAS_RETRACT: ClassVar[uint32] = 1
    GIMBAL_DEVICE_CAP_FLAGS_HAS_NEUTRAL: ClassVar[uint32] = 2
    GIMBAL_DEVICE_CAP_FLAGS_HAS_ROLL_AXIS: ClassVar[uint32] = 4
    GIMBAL_DEVICE_CAP_FLAGS_HAS_ROLL_FOLLOW: ClassVar[uint32] = 8
    GIMBAL_DEVICE_CAP_FLAGS_HAS_ROLL_LOCK: ClassVar[uint32] = 16
    GIMBAL_DEVICE_CAP_FLAGS_HAS_PITCH_AXIS: ClassVar[uint32] = 32
    GIMBAL_DEVICE_CAP_FLAGS_HAS_PITCH_FOLLOW: ClassVar[uint32] = 64
    GIMBAL_DEVICE_CAP_FLAGS_HAS_PITCH_LOCK: ClassVar[uint32] = 128
    GIMBAL_DEVICE_CAP_FLAGS_HAS_YAW_AXIS: ClassVar[uint32] = 256
    GIMBAL_DEVICE_CAP_FLAGS_HAS_YAW_FOLLOW: ClassVar[uint32] = 512
    GIMBAL_DEVICE_CAP_FLAGS_HAS_YAW_LOCK: ClassVar[uint32] = 1024
    GIMBAL_DEVICE_CAP_FLAGS_SUPPORTS_INFINITE_YAW: ClassVar[uint32] = 2048

    timestamp: uint64 = 0
    vendor_name: Annotated[Ints, Array[uint8, 32]] = DEFAULT
    model_name: Annotated[Ints, Array[uint8, 32]] = DEFAULT
    custom_name: Annotated[Ints, Array[uint8, 32]] = DEFAULT
    firmware_version: uint32 = 0
    hardware_version: uint32 = 0
    uid: uint64 = 0
    cap_flags: uint16 = 0
    custom_cap_flags: uint16 = 0
    roll_min: float32 = 0.0
    roll_max: float32 = 0.0
    pitch_min: float32 = 0.0
    pitch_max: float32 = 0.0
    yaw_min: float32 = 0.0
    yaw_max: float32 = 0.0
    gimbal_device_compid: uint8 = 0


class GimbalDeviceSetAttitude(Message, typename="px4_msgs/msg/GimbalDeviceSetAttitude"):
    """GimbalDeviceSetAttitude, as PX4 1.15 defines it."""

    GIMBAL_DEVICE_FLAGS_RETRACT: ClassVar[uint32] = 1
    GIMBAL_DEVICE_FLAGS_NEUTRAL: ClassVar[uint32] = 2
    GIMBAL_DEVICE_FLAGS_ROLL_LOCK: ClassVar[uint32] = 4
    GIMBAL_DEVICE_FLAGS_PITCH_LOCK: ClassVar[uint32] = 8
    GIMBAL_DEVICE_FLAGS_YAW_LOCK: ClassVar[uint32] = 16

    timestamp: uint64 = 0
    target_system: uint8 = 0
    target_component: uint8 = 0
    flags: uint16 = 0
    q: Annotated[Floats, Array[float32, 4]] = DEFAULT
    angular_velocity_x: float32 = 0.0
    angular_velocity_y: float32 = 0.0
    angular_velocity_z: float32 = 0.0


class GimbalManagerInformation(Message, typename="px4_msgs/msg/GimbalManagerInformation"):
    """GimbalManagerInformation, as PX4 1.15 defines it."""

    GIMBAL_MANAGER_CAP_FLAGS_HAS_RETRACT: ClassVar[uint32] = 1
    GIMBAL_MANAGER_CAP_FLAGS_HAS_NEUTRAL: ClassVar[uint32] = 2
    GIMBAL_MANAGER_CAP_FLAGS_HAS_ROLL_AXIS: ClassVar[uint32] = 4
    GIMBAL_MANAGER_CAP_FLAGS_HAS_ROLL_FOLLOW: ClassVar[uint32] = 8
    GIMBAL_MANAGER_CAP_FLAGS_HAS_ROLL_LOCK: ClassVar[uint32] = 16
    GIMBAL_MANAGER_CAP_FLAGS_HAS_PITCH_AXIS: ClassVar[uint32] = 32
    GIMBAL_MANAGER_CAP_FLAGS_HAS_PITCH_FOLLOW: ClassVar[uint32] = 64
    GIMBAL_MANAGER_CAP_FLAGS_HAS_PITCH_LOCK: ClassVar[uint32] = 128
    GIMBAL_MANAGER_CAP_FLAGS_HAS_YAW_AXIS: ClassVar[uint32] = 256
    GIMBAL_MANAGER_CAP_FLAGS_HAS_YAW_FOLLOW: ClassVar[uint32] = 512
    GIMBAL_MANAGER_CAP_FLAGS_HAS_YAW_LOCK: ClassVar[uint32] = 1024
    GIMBAL_MANAGER_CAP_FLAGS_SUPPORTS_INFINITE_YAW: ClassVar[uint32] = 2048
    GIMBAL_MANAGER_CAP_FLAGS_CAN_POINT_LOCATION_LOCAL: ClassVar[uint32] = 65536
    GIMBAL_MANAGER_CAP_FLAGS_CAN_POINT_LOCATION_GLOBAL: ClassVar[uint32] = 131072

    timestamp: uint64 = 0
    cap_flags: uint32 = 0
    gimbal_device_id: uint8 = 0
    roll_min: float32 = 0.0
    roll_max: float32 = 0.0
    pitch_min: float32 = 0.0
    pitch_max: float32 = 0.0
    yaw_min: float32 = 0.0
    yaw_max: float32 = 0.0


class GimbalManagerSetAttitude(Message, typename="px4_msgs/msg/GimbalManagerSetAttitude"):
    """GimbalManagerSetAttitude, as PX4 1.15 defines it."""

    GIMBAL_MANAGER_FLAGS_RETRACT: ClassVar[uint32] = 1
    GIMBAL_MANAGER_FLAGS_NEUTRAL: ClassVar[uint32] = 2
    GIMBAL_MANAGER_FLAGS_ROLL_LOCK: ClassVar[uint32] = 4
    GIMBAL_MANAGER_FLAGS_PITCH_LOCK: ClassVar[uint32] = 8
    GIMBAL_MANAGER_FLAGS_YAW_LOCK: ClassVar[uint32] = 16

    timestamp: uint64 = 0
    origin_sysid: uint8 = 0
    origin_compid: uint8 = 0
    target_system: uint8 = 0
    target_component: uint8 = 0
    flags: uint32 = 0
    gimbal_device_id: uint8 = 0
    q: Annotated[Floats, Array[float32, 4]] = DEFAULT
    angular_velocity_x: float32 = 0.0
    angular_velocity_y: float32 = 0.0
    angular_velocity_z: float32 = 0.0


class GimbalManagerSetManualControl(Message, typename="px4_msgs/msg/GimbalManagerSetManualControl"):
    """GimbalManagerSetManualControl, as PX4 1.15 defines it."""

    GIMBAL_MANAGER_FLAGS_RETRACT: ClassVar[uint32] = 1
    GIMBAL_MANAGER_FLAGS_NEUTRAL: ClassVar[uint32] = 2
    GIMBAL_MANAGER_FLAGS_ROLL_LOCK: ClassVar[uint32] = 4
    GIMBAL_MANAGER_FLAGS_PITCH_LOCK: ClassVar[uint32] = 8
    GIMBAL_MANAGER_FLAGS_YAW_LOCK: ClassVar[uint32] = 16

    timestamp: uint64 = 0
    origin_sysid: uint8 = 0
    origin_compid: uint8 = 0
    target_system: uint8 = 0
    target_component: uint8 = 0
    flags: uint32 = 0
    gimbal_device_id: uint8 = 0
    pitch: float32 = 0.0
    yaw: float32 = 0.0
    pitch_rate: float32 = 0.0
    yaw_rate: float32 = 0.0


class GimbalManagerStatus(Message, typename="px4_msgs/msg/GimbalManagerStatus"):
    """GimbalManagerStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    flags: uint32 = 0
    gimbal_device_id: uint8 = 0
    primary_control_sysid: uint8 = 0
    primary_control_compid: uint8 = 0
    secondary_control_sysid: uint8 = 0
    secondary_control_compid: uint8 = 0


class GotoSetpoint(Message, typename="px4_msgs/msg/GotoSetpoint"):
    """GotoSetpoint, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    position: Annotated[Floats, Array[float32, 3]] = DEFAULT
    flag_control_heading: bool = False
    heading: float32 = 0.0
    flag_set_max_horizontal_speed: bool = False
    max_horizontal_speed: float32 = 0.0
    flag_set_max_vertical_speed: bool = False
    max_vertical_speed: float32 = 0.0
    flag_set_max_heading_rate: bool = False
    max_heading_rate: float32 = 0.0


class GpioConfig(Message, typename="px4_msgs/msg/GpioConfig"):
    """GpioConfig, as PX4 1.15 defines it."""

    INPUT: ClassVar[uint32] = 0
    OUTPUT: ClassVar[uint32] = 1
    PULLUP: ClassVar[uint32] = 16
    PULLDOWN: ClassVar[uint32] = 32
    OPENDRAIN: ClassVar[uint32] = 256
    INPUT_FLOATING: ClassVar[uint32] = 0
    INPUT_PULLUP: ClassVar[uint32] = 16
    INPUT_PULLDOWN: ClassVar[uint32] = 32
    OUTPUT_PUSHPULL: ClassVar[uint32] = 0
    OUTPUT_OPENDRAIN: ClassVar[uint32] = 256
    OUTPUT_OPENDRAIN_PULLUP: ClassVar[uint32] = 272

    timestamp: uint64 = 0
    device_id: uint32 = 0
    mask: uint32 = 0
    state: uint32 = 0
    config: uint32 = 0


class GpioIn(Message, typename="px4_msgs/msg/GpioIn"):
    """GpioIn, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    device_id: uint32 = 0
    state: uint32 = 0


class GpioOut(Message, typename="px4_msgs/msg/GpioOut"):
    """GpioOut, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    device_id: uint32 = 0
    mask: uint32 = 0
    state: uint32 = 0


class GpioRequest(Message, typename="px4_msgs/msg/GpioRequest"):
    """GpioRequest, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    device_id: uint32 = 0


class GpsDump(Message, typename="px4_msgs/msg/GpsDump"):
    """GpsDump, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 8

    timestamp: uint64 = 0
    instance: uint8 = 0
    len: uint8 = 0
    data: Annotated[Ints, Array[uint8, 79]] = DEFAULT


class GpsInjectData(Message, typename="px4_msgs/msg/GpsInjectData"):
    """GpsInjectData, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 8
    MAX_INSTANCES: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    device_id: uint32 = 0
    len: uint16 = 0
    flags: uint8 = 0
    data: Annotated[Ints, Array[uint8, 300]] = DEFAULT


class Gripper(Message, typename="px4_msgs/msg/Gripper"):
    """Gripper, as PX4 1.15 defines it."""

    COMMAND_GRAB: ClassVar[int8] = 0
    COMMAND_RELEASE: ClassVar[int8] = 1

    timestamp: uint64 = 0
    command: int8 = 0


class HealthReport(Message, typename="px4_msgs/msg/HealthReport"):
    """HealthReport, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    can_arm_mode_flags: uint64 = 0
    can_run_mode_flags: uint64 = 0
    health_is_present_flags: uint64 = 0
    health_warning_flags: uint64 = 0
    health_error_flags: uint64 = 0
    arming_check_warning_flags: uint64 = 0
    arming_check_error_flags: uint64 = 0


class HeaterStatus(Message, typename="px4_msgs/msg/HeaterStatus"):
    """HeaterStatus, as PX4 1.15 defines it."""

    MODE_GPIO: ClassVar[uint8] = 1
    MODE_PX4IO: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    device_id: uint32 = 0
    heater_on: bool = False
    temperature_target_met: bool = False
    temperature_sensor: float32 = 0.0
    temperature_target: float32 = 0.0
    controller_period_usec: uint32 = 0
    controller_time_on_usec: uint32 = 0
    proportional_value: float32 = 0.0
    integrator_value: float32 = 0.0
    feed_forward_value: float32 = 0.0
    mode: uint8 = 0


class HomePosition(Message, typename="px4_msgs/msg/HomePosition"):
    """HomePosition, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    lat: float64 = 0.0
    lon: float64 = 0.0
    alt: float32 = 0.0
    x: float32 = 0.0
    y: float32 = 0.0
    z: float32 = 0.0
    yaw: float32 = 0.0
    valid_alt: bool = False
    valid_hpos: bool = False
    valid_lpos: bool = False
    manual_home: bool = False
    update_count: uint32 = 0


class HoverThrustEstimate(Message, typename="px4_msgs/msg/HoverThrustEstimate"):
    """HoverThrustEstimate, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    hover_thrust: float32 = 0.0
    hover_thrust_var: float32 = 0.0
    accel_innov: float32 = 0.0
    accel_innov_var: float32 = 0.0
    accel_innov_test_ratio: float32 = 0.0
    accel_noise_var: float32 = 0.0
    valid: bool = False


class InputRc(Message, typename="px4_msgs/msg/InputRc"):
    """InputRc, as PX4 1.15 defines it."""

    RC_INPUT_SOURCE_UNKNOWN: ClassVar[uint8] = 0
    RC_INPUT_SOURCE_PX4FMU_PPM: ClassVar[uint8] = 1
    RC_INPUT_SOURCE_PX4IO_PPM: ClassVar[uint8] = 2
    RC_INPUT_SOURCE_PX4IO_SPEKTRUM: ClassVar[uint8] = 3
    RC_INPUT_SOURCE_PX4IO_SBUS: ClassVar[uint8] = 4
    RC_INPUT_SOURCE_PX4IO_ST24: ClassVar[uint8] = 5
    RC_INPUT_SOURCE_MAVLINK: ClassVar[uint8] = 6
    RC_INPUT_SOURCE_QURT: ClassVar[uint8] = 7
    RC_INPUT_SOURCE_PX4FMU_SPEKTRUM: ClassVar[uint8] = 8
    RC_INPUT_SOURCE_PX4FMU_SBUS: ClassVar[uint8] = 9
    RC_INPUT_SOURCE_PX4FMU_ST24: ClassVar[uint8] = 10
    RC_INPUT_SOURCE_PX4FMU_SUMD: ClassVar[uint8] = 11
    RC_INPUT_SOURCE_PX4FMU_DSM: ClassVar[uint8] = 12
    RC_INPUT_SOURCE_PX4IO_SUMD: ClassVar[uint8] = 13
    RC_INPUT_SOURCE_PX4FMU_CRSF: ClassVar[uint8] = 14
    RC_INPUT_SOURCE_PX4FMU_GHST: ClassVar[uint8] = 15
    RC_INPUT_MAX_CHANNELS: ClassVar[uint8] = 18
    RSSI_MAX: ClassVar[int8] = 100

    timestamp: uint64 = 0
    timestamp_last_signal: uint64 = 0
    channel_count: uint8 = 0
    rssi: int32 = 0
    rc_failsafe: bool = False
    rc_lost: bool = False
    rc_lost_frame_count: uint16 = 0
    rc_total_frame_count: uint16 = 0
    rc_ppm_frame_length: uint16 = 0
    input_source: uint8 = 0
    values: Annotated[Ints, Array[uint16, 18]] = DEFAULT
    link_quality: int8 = 0
    rssi_dbm: float32 = 0.0


class InternalCombustionEngineStatus(
    Message, typename="px4_msgs/msg/InternalCombustionEngineStatus"
):
    """InternalCombustionEngineStatus, as PX4 1.15 defines it."""

    STATE_STOPPED: ClassVar[uint8] = 0
    STATE_STARTING: ClassVar[uint8] = 1
    STATE_RUNNING: ClassVar[uint8] = 2
    STATE_FAULT: ClassVar[uint8] = 3
    FLAG_GENERAL_ERROR: ClassVar[uint32] = 1
    FLAG_CRANKSHAFT_SENSOR_ERROR_SUPPORTED: ClassVar[uint32] = 2
    FLAG_CRANKSHAFT_SENSOR_ERROR: ClassVar[uint32] = 4
    FLAG_TEMPERATURE_SUPPORTED: ClassVar[uint32] = 8
    FLAG_TEMPERATURE_BELOW_NOMINAL: ClassVar[uint32] = 16
    FLAG_TEMPERATURE_ABOVE_NOMINAL: ClassVar[uint32] = 32
    FLAG_TEMPERATURE_OVERHEATING: ClassVar[uint32] = 64
    FLAG_TEMPERATURE_EGT_ABOVE_NOMINAL: ClassVar[uint32] = 128
    FLAG_FUEL_PRESSURE_SUPPORTED: ClassVar[uint32] = 256
    FLAG_FUEL_PRESSURE_BELOW_NOMINAL: ClassVar[uint32] = 512
    FLAG_FUEL_PRESSURE_ABOVE_NOMINAL: ClassVar[uint32] = 1024
    FLAG_DETONATION_SUPPORTED: ClassVar[uint32] = 2048
    FLAG_DETONATION_OBSERVED: ClassVar[uint32] = 4096
    FLAG_MISFIRE_SUPPORTED: ClassVar[uint32] = 8192
    FLAG_MISFIRE_OBSERVED: ClassVar[uint32] = 16384
    FLAG_OIL_PRESSURE_SUPPORTED: ClassVar[uint32] = 32768
    FLAG_OIL_PRESSURE_BELOW_NOMINAL: ClassVar[uint32] = 65536
    FLAG_OIL_PRESSURE_ABOVE_NOMINAL: ClassVar[uint32] = 131072
    FLAG_DEBRIS_SUPPORTED: ClassVar[uint32] = 262144
    FLAG_DEBRIS_DETECTED: ClassVar[uint32] = 524288
    SPARK_PLUG_SINGLE: ClassVar[uint8] = 0
    SPARK_PLUG_FIRST_ACTIVE: ClassVar[uint8] = 1
    SPARK_PLUG_SECOND_ACTIVE: ClassVar[uint8] = 2
    SPARK_PLUG_BOTH_ACTIVE: ClassVar[uint8] = 3

    timestamp: uint64 = 0
    state: uint8 = 0
    flags: uint32 = 0
    engine_load_percent: uint8 = 0
    engine_speed_rpm: uint32 = 0
    spark_dwell_time_ms: float32 = 0.0
    atmospheric_pressure_kpa: float32 = 0.0
    intake_manifold_pressure_kpa: float32 = 0.0
    intake_manifold_temperature: float32 = 0.0
    coolant_temperature: float32 = 0.0
    oil_pressure: float32 = 0.0
    oil_temperature: float32 = 0.0
    fuel_pressure: float32 = 0.0
    fuel_consumption_rate_cm3pm: float32 = 0.0
    estimated_consumed_fuel_volume_cm3: float32 = 0.0
    throttle_position_percent: uint8 = 0
    ecu_index: uint8 = 0
    spark_plug_usage: uint8 = 0
    ignition_timing_deg: float32 = 0.0
    injection_time_ms: float32 = 0.0
    cylinder_head_temperature: float32 = 0.0
    exhaust_gas_temperature: float32 = 0.0
    lambda_coefficient: float32 = 0.0


class IridiumsbdStatus(Message, typename="px4_msgs/msg/IridiumsbdStatus"):
    """IridiumsbdStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    last_heartbeat: uint64 = 0
    tx_buf_write_index: uint16 = 0
    rx_buf_read_index: uint16 = 0
    rx_buf_end_index: uint16 = 0
    failed_sbd_sessions: uint16 = 0
    successful_sbd_sessions: uint16 = 0
    num_tx_buf_reset: uint16 = 0
    signal_quality: uint8 = 0
    state: uint8 = 0
    ring_pending: bool = False
    tx_buf_write_pending: bool = False
    tx_session_pending: bool = False
    rx_read_pending: bool = False
    rx_session_pending: bool = False


class IrlockReport(Message, typename="px4_msgs/msg/IrlockReport"):
    """IrlockReport, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    signature: uint16 = 0
    pos_x: float32 = 0.0
    pos_y: float32 = 0.0
    size_x: float32 = 0.0
    size_y: float32 = 0.0


class LandingGear(Message, typename="px4_msgs/msg/LandingGear"):
    """LandingGear, as PX4 1.15 defines it."""

    GEAR_UP: ClassVar[int8] = 1
    GEAR_DOWN: ClassVar[int8] = -1
    GEAR_KEEP: ClassVar[int8] = 0

    timestamp: uint64 = 0
    landing_gear: int8 = 0


class LandingGearWheel(Message, typename="px4_msgs/msg/LandingGearWheel"):
    """LandingGearWheel, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    normalized_wheel_setpoint: float32 = 0.0


class LandingTargetInnovations(Message, typename="px4_msgs/msg/LandingTargetInnovations"):
    """LandingTargetInnovations, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    innov_x: float32 = 0.0
    innov_y: float32 = 0.0
    innov_cov_x: float32 = 0.0
    innov_cov_y: float32 = 0.0


class LandingTargetPose(Message, typename="px4_msgs/msg/LandingTargetPose"):
    """LandingTargetPose, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    is_static: bool = False
    rel_pos_valid: bool = False
    rel_vel_valid: bool = False
    x_rel: float32 = 0.0
    y_rel: float32 = 0.0
    z_rel: float32 = 0.0
    vx_rel: float32 = 0.0
    vy_rel: float32 = 0.0
    cov_x_rel: float32 = 0.0
    cov_y_rel: float32 = 0.0
    cov_vx_rel: float32 = 0.0
    cov_vy_rel: float32 = 0.0
    abs_pos_valid: bool = False
    x_abs: float32 = 0.0
    y_abs: float32 = 0.0
    z_abs: float32 = 0.0


class LaunchDetectionStatus(Message, typename="px4_msgs/msg/LaunchDetectionStatus"):
    """LaunchDetectionStatus, as PX4 1.15 defines it."""

    STATE_WAITING_FOR_LAUNCH: ClassVar[uint8] = 0
    STATE_LAUNCH_DETECTED_DISABLED_MOTOR: ClassVar[uint8] = 1
    STATE_FLYING: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    launch_detection_state: uint8 = 0


class LedControl(Message, typename="px4_msgs/msg/LedControl"):
    """LedControl, as PX4 1.15 defines it."""

    COLOR_OFF: ClassVar[uint8] = 0
    COLOR_RED: ClassVar[uint8] = 1
    COLOR_GREEN: ClassVar[uint8] = 2
    COLOR_BLUE: ClassVar[uint8] = 3
    COLOR_YELLOW: ClassVar[uint8] = 4
    COLOR_PURPLE: ClassVar[uint8] = 5
    COLOR_AMBER: ClassVar[uint8] = 6
    COLOR_CYAN: ClassVar[uint8] = 7
    COLOR_WHITE: ClassVar[uint8] = 8
    MODE_OFF: ClassVar[uint8] = 0
    MODE_ON: ClassVar[uint8] = 1
    MODE_DISABLED: ClassVar[uint8] = 2
    MODE_BLINK_SLOW: ClassVar[uint8] = 3
    MODE_BLINK_NORMAL: ClassVar[uint8] = 4
    MODE_BLINK_FAST: ClassVar[uint8] = 5
    MODE_BREATHE: ClassVar[uint8] = 6
    MODE_FLASH: ClassVar[uint8] = 7
    MAX_PRIORITY: ClassVar[uint8] = 2
    ORB_QUEUE_LENGTH: ClassVar[uint8] = 8

    timestamp: uint64 = 0
    led_mask: uint8 = 0
    color: uint8 = 0
    mode: uint8 = 0
    num_blinks: uint8 = 0
    priority: uint8 = 0


class LogMessage(Message, typename="px4_msgs/msg/LogMessage"):
    """LogMessage, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    severity: uint8 = 0
    text: Annotated[Ints, Array[char, 127]] = DEFAULT


class LoggerStatus(Message, typename="px4_msgs/msg/LoggerStatus"):
    """LoggerStatus, as PX4 1.15 defines it."""

    LOGGER_TYPE_FULL: ClassVar[uint8] = 0
    LOGGER_TYPE_MISSION: ClassVar[uint8] = 1
    BACKEND_FILE: ClassVar[uint8] = 1
    BACKEND_MAVLINK: ClassVar[uint8] = 2
    BACKEND_ALL: ClassVar[uint8] = 3

    timestamp: uint64 = 0
    type: uint8 = 0
    backend: uint8 = 0
    total_written_kb: float32 = 0.0
    write_rate_kb_s: float32 = 0.0
    dropouts: uint32 = 0
    message_gaps: uint32 = 0
    buffer_used_bytes: uint32 = 0
    buffer_size_bytes: uint32 = 0
    num_messages: uint8 = 0


class MagWorkerData(Message, typename="px4_msgs/msg/MagWorkerData"):
    """MagWorkerData, as PX4 1.15 defines it."""

    MAX_MAGS: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    done_count: uint32 = 0
    calibration_points_perside: uint32 = 0
    calibration_interval_perside_us: uint64 = 0
    calibration_counter_total: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    side_data_collected: Annotated[Bools, Array[bool, 4]] = DEFAULT
    x: Annotated[Floats, Array[float32, 4]] = DEFAULT
    y: Annotated[Floats, Array[float32, 4]] = DEFAULT
    z: Annotated[Floats, Array[float32, 4]] = DEFAULT


class MagnetometerBiasEstimate(Message, typename="px4_msgs/msg/MagnetometerBiasEstimate"):
    """MagnetometerBiasEstimate, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    bias_x: Annotated[Floats, Array[float32, 4]] = DEFAULT
    bias_y: Annotated[Floats, Array[float32, 4]] = DEFAULT
    bias_z: Annotated[Floats, Array[float32, 4]] = DEFAULT
    valid: Annotated[Bools, Array[bool, 4]] = DEFAULT
    stable: Annotated[Bools, Array[bool, 4]] = DEFAULT


class ManualControlSetpoint(Message, typename="px4_msgs/msg/ManualControlSetpoint"):
    """ManualControlSetpoint, as PX4 1.15 defines it."""

    SOURCE_UNKNOWN: ClassVar[uint8] = 0
    SOURCE_RC: ClassVar[uint8] = 1
    SOURCE_MAVLINK_0: ClassVar[uint8] = 2
    SOURCE_MAVLINK_1: ClassVar[uint8] = 3
    SOURCE_MAVLINK_2: ClassVar[uint8] = 4
    SOURCE_MAVLINK_3: ClassVar[uint8] = 5
    SOURCE_MAVLINK_4: ClassVar[uint8] = 6
    SOURCE_MAVLINK_5: ClassVar[uint8] = 7

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    valid: bool = False
    data_source: uint8 = 0
    roll: float32 = 0.0
    pitch: float32 = 0.0
    yaw: float32 = 0.0
    throttle: float32 = 0.0
    flaps: float32 = 0.0
    aux1: float32 = 0.0
    aux2: float32 = 0.0
    aux3: float32 = 0.0
    aux4: float32 = 0.0
    aux5: float32 = 0.0
    aux6: float32 = 0.0
    sticks_moving: bool = False
    buttons: uint16 = 0


class ManualControlSwitches(Message, typename="px4_msgs/msg/ManualControlSwitches"):
    """ManualControlSwitches, as PX4 1.15 defines it."""

    SWITCH_POS_NONE: ClassVar[uint8] = 0
    SWITCH_POS_ON: ClassVar[uint8] = 1
    SWITCH_POS_MIDDLE: ClassVar[uint8] = 2
    SWITCH_POS_OFF: ClassVar[uint8] = 3
    MODE_SLOT_NONE: ClassVar[uint8] = 0
    MODE_SLOT_1: ClassVar[uint8] = 1
    MODE_SLOT_2: ClassVar[uint8] = 2
    MODE_SLOT_3: ClassVar[uint8] = 3
    MODE_SLOT_4: ClassVar[uint8] = 4
    MODE_SLOT_5: ClassVar[uint8] = 5
    MODE_SLOT_6: ClassVar[uint8] = 6
    MODE_SLOT_NUM: ClassVar[uint8] = 6

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    mode_slot: uint8 = 0
    arm_switch: uint8 = 0
    return_switch: uint8 = 0
    loiter_switch: uint8 = 0
    offboard_switch: uint8 = 0
    kill_switch: uint8 = 0
    gear_switch: uint8 = 0
    transition_switch: uint8 = 0
    photo_switch: uint8 = 0
    video_switch: uint8 = 0
    payload_power_switch: uint8 = 0
    engage_main_motor_switch: uint8 = 0
    switch_changes: uint32 = 0


class MavlinkLog(Message, typename="px4_msgs/msg/MavlinkLog"):
    """MavlinkLog, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 8

    timestamp: uint64 = 0
    text: Annotated[Ints, Array[char, 127]] = DEFAULT
    severity: uint8 = 0


class MavlinkTunnel(Message, typename="px4_msgs/msg/MavlinkTunnel"):
    """MavlinkTunnel, as PX4 1.15 defines it."""

    MAV_TUNNEL_PAYLOAD_TYPE_UNKNOWN: ClassVar[uint8] = 0
    MAV_TUNNEL_PAYLOAD_TYPE_STORM32_RESERVED0: ClassVar[uint8] = 200
    MAV_TUNNEL_PAYLOAD_TYPE_STORM32_RESERVED1: ClassVar[uint8] = 201
    MAV_TUNNEL_PAYLOAD_TYPE_STORM32_RESERVED2: ClassVar[uint8] = 202
    MAV_TUNNEL_PAYLOAD_TYPE_STORM32_RESERVED3: ClassVar[uint8] = 203
    MAV_TUNNEL_PAYLOAD_TYPE_STORM32_RESERVED4: ClassVar[uint8] = 204
    MAV_TUNNEL_PAYLOAD_TYPE_STORM32_RESERVED5: ClassVar[uint8] = 205
    MAV_TUNNEL_PAYLOAD_TYPE_STORM32_RESERVED6: ClassVar[uint8] = 206
    MAV_TUNNEL_PAYLOAD_TYPE_STORM32_RESERVED7: ClassVar[uint8] = 207
    MAV_TUNNEL_PAYLOAD_TYPE_STORM32_RESERVED8: ClassVar[uint8] = 208
    MAV_TUNNEL_PAYLOAD_TYPE_STORM32_RESERVED9: ClassVar[uint8] = 209

    timestamp: uint64 = 0
    payload_type: uint16 = 0
    target_system: uint8 = 0
    target_component: uint8 = 0
    payload_length: uint8 = 0
    payload: Annotated[Ints, Array[uint8, 128]] = DEFAULT


class MessageFormatRequest(Message, typename="px4_msgs/msg/MessageFormatRequest"):
    """MessageFormatRequest, as PX4 1.15 defines it."""

    LATEST_PROTOCOL_VERSION: ClassVar[uint16] = 1

    timestamp: uint64 = 0
    protocol_version: uint16 = 0
    topic_name: Annotated[Ints, Array[char, 50]] = DEFAULT


class MessageFormatResponse(Message, typename="px4_msgs/msg/MessageFormatResponse"):
    """MessageFormatResponse, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    protocol_version: uint16 = 0
    topic_name: Annotated[Ints, Array[char, 50]] = DEFAULT
    success: bool = False
    message_hash: uint32 = 0


class Mission(Message, typename="px4_msgs/msg/Mission"):
    """Mission, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    mission_dataman_id: uint8 = 0
    fence_dataman_id: uint8 = 0
    safepoint_dataman_id: uint8 = 0
    count: uint16 = 0
    current_seq: int32 = 0
    land_start_index: int32 = 0
    land_index: int32 = 0
    mission_id: uint32 = 0
    geofence_id: uint32 = 0
    safe_points_id: uint32 = 0


class MissionResult(Message, typename="px4_msgs/msg/MissionResult"):
    """MissionResult, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    mission_id: uint32 = 0
    geofence_id: uint32 = 0
    home_position_counter: uint32 = 0
    seq_reached: int32 = 0
    seq_current: uint16 = 0
    seq_total: uint16 = 0
    valid: bool = False
    warning: bool = False
    finished: bool = False
    failure: bool = False
    item_do_jump_changed: bool = False
    item_changed_index: uint16 = 0
    item_do_jump_remaining: uint16 = 0
    execution_mode: uint8 = 0


class ModeCompleted(Message, typename="px4_msgs/msg/ModeCompleted"):
    """ModeCompleted, as PX4 1.15 defines it."""

    RESULT_SUCCESS: ClassVar[uint8] = 0
    RESULT_FAILURE_OTHER: ClassVar[uint8] = 100

    timestamp: uint64 = 0
    result: uint8 = 0
    nav_state: uint8 = 0


class MountOrientation(Message, typename="px4_msgs/msg/MountOrientation"):
    """MountOrientation, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    attitude_euler_angle: Annotated[Floats, Array[float32, 3]] = DEFAULT


class NavigatorMissionItem(Message, typename="px4_msgs/msg/NavigatorMissionItem"):
    """NavigatorMissionItem, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    instance_count: uint32 = 0
    sequence_current: uint16 = 0
    nav_cmd: uint16 = 0
    latitude: float32 = 0.0
    longitude: float32 = 0.0
    time_inside: float32 = 0.0
    acceptance_radius: float32 = 0.0
    loiter_radius: float32 = 0.0
    yaw: float32 = 0.0
    altitude: float32 = 0.0
    frame: uint8 = 0
    origin: uint8 = 0
    loiter_exit_xtrack: bool = False
    force_heading: bool = False
    altitude_is_relative: bool = False
    autocontinue: bool = False
    vtol_back_transition: bool = False


class NormalizedUnsignedSetpoint(Message, typename="px4_msgs/msg/NormalizedUnsignedSetpoint"):
    """NormalizedUnsignedSetpoint, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    normalized_setpoint: float32 = 0.0


class NpfgStatus(Message, typename="px4_msgs/msg/NpfgStatus"):
    """NpfgStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    wind_est_valid: uint8 = 0
    lat_accel: float32 = 0.0
    lat_accel_ff: float32 = 0.0
    bearing_feas: float32 = 0.0
    bearing_feas_on_track: float32 = 0.0
    signed_track_error: float32 = 0.0
    track_error_bound: float32 = 0.0
    airspeed_ref: float32 = 0.0
    bearing: float32 = 0.0
    heading_ref: float32 = 0.0
    min_ground_speed_ref: float32 = 0.0
    adapted_period: float32 = 0.0
    p_gain: float32 = 0.0
    time_const: float32 = 0.0
    can_run_factor: float32 = 0.0


class ObstacleDistance(Message, typename="px4_msgs/msg/ObstacleDistance"):
    """ObstacleDistance, as PX4 1.15 defines it."""

    MAV_FRAME_GLOBAL: ClassVar[uint8] = 0
    MAV_FRAME_LOCAL_NED: ClassVar[uint8] = 1
    MAV_FRAME_BODY_FRD: ClassVar[uint8] = 12
    MAV_DISTANCE_SENSOR_LASER: ClassVar[uint8] = 0
    MAV_DISTANCE_SENSOR_ULTRASOUND: ClassVar[uint8] = 1
    MAV_DISTANCE_SENSOR_INFRARED: ClassVar[uint8] = 2
    MAV_DISTANCE_SENSOR_RADAR: ClassVar[uint8] = 3

    timestamp: uint64 = 0
    frame: uint8 = 0
    sensor_type: uint8 = 0
    distances: Annotated[Ints, Array[uint16, 72]] = DEFAULT
    increment: float32 = 0.0
    min_distance: uint16 = 0
    max_distance: uint16 = 0
    angle_offset: float32 = 0.0


class OffboardControlMode(Message, typename="px4_msgs/msg/OffboardControlMode"):
    """OffboardControlMode, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    position: bool = False
    velocity: bool = False
    acceleration: bool = False
    attitude: bool = False
    body_rate: bool = False
    thrust_and_torque: bool = False
    direct_actuator: bool = False


class OnboardComputerStatus(Message, typename="px4_msgs/msg/OnboardComputerStatus"):
    """OnboardComputerStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
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


class OrbTest(Message, typename="px4_msgs/msg/OrbTest"):
    """OrbTest, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    val: int32 = 0


class OrbTestLarge(Message, typename="px4_msgs/msg/OrbTestLarge"):
    """OrbTestLarge, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    val: int32 = 0
    junk: Annotated[Ints, Array[uint8, 512]] = DEFAULT


class OrbTestMedium(Message, typename="px4_msgs/msg/OrbTestMedium"):
    """OrbTestMedium, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 16

    timestamp: uint64 = 0
    val: int32 = 0
    junk: Annotated[Ints, Array[uint8, 64]] = DEFAULT


class OrbitStatus(Message, typename="px4_msgs/msg/OrbitStatus"):
    """OrbitStatus, as PX4 1.15 defines it."""

    ORBIT_YAW_BEHAVIOUR_HOLD_FRONT_TO_CIRCLE_CENTER: ClassVar[uint8] = 0
    ORBIT_YAW_BEHAVIOUR_HOLD_INITIAL_HEADING: ClassVar[uint8] = 1
    ORBIT_YAW_BEHAVIOUR_UNCONTROLLED: ClassVar[uint8] = 2
    ORBIT_YAW_BEHAVIOUR_HOLD_FRONT_TANGENT_TO_CIRCLE: ClassVar[uint8] = 3
    ORBIT_YAW_BEHAVIOUR_RC_CONTROLLED: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    radius: float32 = 0.0
    frame: uint8 = 0
    x: float64 = 0.0
    y: float64 = 0.0
    z: float32 = 0.0
    yaw_behaviour: uint8 = 0


class ParameterResetRequest(Message, typename="px4_msgs/msg/ParameterResetRequest"):
    """ParameterResetRequest, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    parameter_index: uint16 = 0
    reset_all: bool = False


class ParameterSetUsedRequest(Message, typename="px4_msgs/msg/ParameterSetUsedRequest"):
    """ParameterSetUsedRequest, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 64

    timestamp: uint64 = 0
    parameter_index: uint16 = 0


class ParameterSetValueRequest(Message, typename="px4_msgs/msg/ParameterSetValueRequest"):
    """ParameterSetValueRequest, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 32

    timestamp: uint64 = 0
    parameter_index: uint16 = 0
    int_value: int32 = 0
    float_value: float32 = 0.0


class ParameterSetValueResponse(Message, typename="px4_msgs/msg/ParameterSetValueResponse"):
    """ParameterSetValueResponse, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    request_timestamp: uint64 = 0
    parameter_index: uint16 = 0


class ParameterUpdate(Message, typename="px4_msgs/msg/ParameterUpdate"):
    """ParameterUpdate, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    instance: uint32 = 0
    get_count: uint32 = 0
    set_count: uint32 = 0
    find_count: uint32 = 0
    export_count: uint32 = 0
    active: uint16 = 0
    changed: uint16 = 0
    custom_default: uint16 = 0


class Ping(Message, typename="px4_msgs/msg/Ping"):
    """Ping, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    ping_time: uint64 = 0
    ping_sequence: uint32 = 0
    dropped_packets: uint32 = 0
    rtt_ms: float32 = 0.0
    system_id: uint8 = 0
    component_id: uint8 = 0


class PositionControllerLandingStatus(
    Message, typename="px4_msgs/msg/PositionControllerLandingStatus"
):
    """PositionControllerLandingStatus, as PX4 1.15 defines it."""

    NOT_ABORTED: ClassVar[uint8] = 0
    ABORTED_BY_OPERATOR: ClassVar[uint8] = 1
    TERRAIN_NOT_FOUND: ClassVar[uint8] = 2
    TERRAIN_TIMEOUT: ClassVar[uint8] = 3
    UNKNOWN_ABORT_CRITERION: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    lateral_touchdown_offset: float32 = 0.0
    flaring: bool = False
    abort_status: uint8 = 0


class PositionControllerStatus(Message, typename="px4_msgs/msg/PositionControllerStatus"):
    """PositionControllerStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    nav_roll: float32 = 0.0
    nav_pitch: float32 = 0.0
    nav_bearing: float32 = 0.0
    target_bearing: float32 = 0.0
    xtrack_error: float32 = 0.0
    wp_dist: float32 = 0.0
    acceptance_radius: float32 = 0.0
    yaw_acceptance: float32 = 0.0
    altitude_acceptance: float32 = 0.0
    type: uint8 = 0


class PositionSetpoint(Message, typename="px4_msgs/msg/PositionSetpoint"):
    """PositionSetpoint, as PX4 1.15 defines it."""

    SETPOINT_TYPE_POSITION: ClassVar[uint8] = 0
    SETPOINT_TYPE_VELOCITY: ClassVar[uint8] = 1
    SETPOINT_TYPE_LOITER: ClassVar[uint8] = 2
    SETPOINT_TYPE_TAKEOFF: ClassVar[uint8] = 3
    SETPOINT_TYPE_LAND: ClassVar[uint8] = 4
    SETPOINT_TYPE_IDLE: ClassVar[uint8] = 5
    LOITER_TYPE_ORBIT: ClassVar[uint8] = 0
    LOITER_TYPE_FIGUREEIGHT: ClassVar[uint8] = 1

    timestamp: uint64 = 0
    valid: bool = False
    type: uint8 = 0
    vx: float32 = 0.0
    vy: float32 = 0.0
    vz: float32 = 0.0
    lat: float64 = 0.0
    lon: float64 = 0.0
    alt: float32 = 0.0
    yaw: float32 = 0.0
    loiter_radius: float32 = 0.0
    loiter_minor_radius: float32 = 0.0
    loiter_direction_counter_clockwise: bool = False
    loiter_orientation: float32 = 0.0
    loiter_pattern: uint8 = 0
    acceptance_radius: float32 = 0.0
    cruising_speed: float32 = 0.0
    gliding_enabled: bool = False
    cruising_throttle: float32 = 0.0


class PositionSetpointTriplet(Message, typename="px4_msgs/msg/PositionSetpointTriplet"):
    """PositionSetpointTriplet, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    previous: PositionSetpoint = DEFAULT
    current: PositionSetpoint = DEFAULT
    next: PositionSetpoint = DEFAULT


class PowerButtonState(Message, typename="px4_msgs/msg/PowerButtonState"):
    """PowerButtonState, as PX4 1.15 defines it."""

    PWR_BUTTON_STATE_IDEL: ClassVar[uint8] = 0
    PWR_BUTTON_STATE_DOWN: ClassVar[uint8] = 1
    PWR_BUTTON_STATE_UP: ClassVar[uint8] = 2
    PWR_BUTTON_STATE_REQUEST_SHUTDOWN: ClassVar[uint8] = 3

    timestamp: uint64 = 0
    event: uint8 = 0


class PowerMonitor(Message, typename="px4_msgs/msg/PowerMonitor"):
    """PowerMonitor, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    voltage_v: float32 = 0.0
    current_a: float32 = 0.0
    power_w: float32 = 0.0
    rconf: int16 = 0
    rsv: int16 = 0
    rbv: int16 = 0
    rp: int16 = 0
    rc: int16 = 0
    rcal: int16 = 0
    me: int16 = 0
    al: int16 = 0


class PpsCapture(Message, typename="px4_msgs/msg/PpsCapture"):
    """PpsCapture, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    rtc_timestamp: uint64 = 0
    pps_rate_exceeded_counter: uint8 = 0


class PwmInput(Message, typename="px4_msgs/msg/PwmInput"):
    """PwmInput, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    error_count: uint64 = 0
    pulse_width: uint32 = 0
    period: uint32 = 0


class Px4ioStatus(Message, typename="px4_msgs/msg/Px4ioStatus"):
    """Px4ioStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    free_memory_bytes: uint16 = 0
    voltage_v: float32 = 0.0
    rssi_v: float32 = 0.0
    status_arm_sync: bool = False
    status_failsafe: bool = False
    status_fmu_initialized: bool = False
    status_fmu_ok: bool = False
    status_init_ok: bool = False
    status_outputs_armed: bool = False
    status_raw_pwm: bool = False
    status_rc_ok: bool = False
    status_rc_dsm: bool = False
    status_rc_ppm: bool = False
    status_rc_sbus: bool = False
    status_rc_st24: bool = False
    status_rc_sumd: bool = False
    status_safety_button_event: bool = False
    alarm_pwm_error: bool = False
    alarm_rc_lost: bool = False
    arming_failsafe_custom: bool = False
    arming_fmu_armed: bool = False
    arming_fmu_prearmed: bool = False
    arming_force_failsafe: bool = False
    arming_io_arm_ok: bool = False
    arming_lockdown: bool = False
    arming_termination_failsafe: bool = False
    pwm: Annotated[Ints, Array[uint16, 8]] = DEFAULT
    pwm_disarmed: Annotated[Ints, Array[uint16, 8]] = DEFAULT
    pwm_failsafe: Annotated[Ints, Array[uint16, 8]] = DEFAULT
    pwm_rate_hz: Annotated[Ints, Array[uint16, 8]] = DEFAULT
    raw_inputs: Annotated[Ints, Array[uint16, 18]] = DEFAULT


class QshellReq(Message, typename="px4_msgs/msg/QshellReq"):
    """QshellReq, as PX4 1.15 defines it."""

    MAX_STRLEN: ClassVar[uint32] = 100

    timestamp: uint64 = 0
    cmd: Annotated[Ints, Array[char, 100]] = DEFAULT
    strlen: uint32 = 0
    request_sequence: uint32 = 0


class QshellRetval(Message, typename="px4_msgs/msg/QshellRetval"):
    """QshellRetval, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    return_value: int32 = 0
    return_sequence: uint32 = 0


class RadioStatus(Message, typename="px4_msgs/msg/RadioStatus"):
    """RadioStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    rssi: uint8 = 0
    remote_rssi: uint8 = 0
    txbuf: uint8 = 0
    noise: uint8 = 0
    remote_noise: uint8 = 0
    rxerrors: uint16 = 0
    fix: uint16 = 0


class RateCtrlStatus(Message, typename="px4_msgs/msg/RateCtrlStatus"):
    """RateCtrlStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    rollspeed_integ: float32 = 0.0
    pitchspeed_integ: float32 = 0.0
    yawspeed_integ: float32 = 0.0
    wheel_rate_integ: float32 = 0.0


class RcChannels(Message, typename="px4_msgs/msg/RcChannels"):
    """RcChannels, as PX4 1.15 defines it."""

    FUNCTION_THROTTLE: ClassVar[uint8] = 0
    FUNCTION_ROLL: ClassVar[uint8] = 1
    FUNCTION_PITCH: ClassVar[uint8] = 2
    FUNCTION_YAW: ClassVar[uint8] = 3
    FUNCTION_RETURN: ClassVar[uint8] = 4
    FUNCTION_LOITER: ClassVar[uint8] = 5
    FUNCTION_OFFBOARD: ClassVar[uint8] = 6
    FUNCTION_FLAPS: ClassVar[uint8] = 7
    FUNCTION_AUX_1: ClassVar[uint8] = 8
    FUNCTION_AUX_2: ClassVar[uint8] = 9
    FUNCTION_AUX_3: ClassVar[uint8] = 10
    FUNCTION_AUX_4: ClassVar[uint8] = 11
    FUNCTION_AUX_5: ClassVar[uint8] = 12
    FUNCTION_AUX_6: ClassVar[uint8] = 13
    FUNCTION_PARAM_1: ClassVar[uint8] = 14
    FUNCTION_PARAM_2: ClassVar[uint8] = 15
    FUNCTION_PARAM_3_5: ClassVar[uint8] = 16
    FUNCTION_KILLSWITCH: ClassVar[uint8] = 17
    FUNCTION_TRANSITION: ClassVar[uint8] = 18
    FUNCTION_GEAR: ClassVar[uint8] = 19
    FUNCTION_ARMSWITCH: ClassVar[uint8] = 20
    FUNCTION_FLTBTN_SLOT_1: ClassVar[uint8] = 21
    FUNCTION_FLTBTN_SLOT_2: ClassVar[uint8] = 22
    FUNCTION_FLTBTN_SLOT_3: ClassVar[uint8] = 23
    FUNCTION_FLTBTN_SLOT_4: ClassVar[uint8] = 24
    FUNCTION_FLTBTN_SLOT_5: ClassVar[uint8] = 25
    FUNCTION_FLTBTN_SLOT_6: ClassVar[uint8] = 26
    FUNCTION_ENGAGE_MAIN_MOTOR: ClassVar[uint8] = 27
    FUNCTION_PAYLOAD_POWER: ClassVar[uint8] = 28
    FUNCTION_FLTBTN_SLOT_COUNT: ClassVar[uint8] = 6

    timestamp: uint64 = 0
    timestamp_last_valid: uint64 = 0
    channels: Annotated[Floats, Array[float32, 18]] = DEFAULT
    channel_count: uint8 = 0
    function: Annotated[Ints, Array[int8, 29]] = DEFAULT
    rssi: uint8 = 0
    signal_lost: bool = False
    frame_drop_count: uint32 = 0


class RcParameterMap(Message, typename="px4_msgs/msg/RcParameterMap"):
    """RcParameterMap, as PX4 1.15 defines it."""

    RC_PARAM_MAP_NCHAN: ClassVar[uint8] = 3
    PARAM_ID_LEN: ClassVar[uint8] = 16

    timestamp: uint64 = 0
    valid: Annotated[Bools, Array[bool, 3]] = DEFAULT
    param_index: Annotated[Ints, Array[int32, 3]] = DEFAULT
    param_id: Annotated[Ints, Array[char, 51]] = DEFAULT
    scale: Annotated[Floats, Array[float32, 3]] = DEFAULT
    value0: Annotated[Floats, Array[float32, 3]] = DEFAULT
    value_min: Annotated[Floats, Array[float32, 3]] = DEFAULT
    value_max: Annotated[Floats, Array[float32, 3]] = DEFAULT


class RegisterExtComponentReply(Message, typename="px4_msgs/msg/RegisterExtComponentReply"):
    """RegisterExtComponentReply, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    request_id: uint64 = 0
    name: Annotated[Ints, Array[char, 25]] = DEFAULT
    px4_ros2_api_version: uint16 = 0
    success: bool = False
    arming_check_id: int8 = 0
    mode_id: int8 = 0
    mode_executor_id: int8 = 0


class RegisterExtComponentRequest(Message, typename="px4_msgs/msg/RegisterExtComponentRequest"):
    """RegisterExtComponentRequest, as PX4 1.15 defines it."""

    LATEST_PX4_ROS2_API_VERSION: ClassVar[uint16] = 1
    ORB_QUEUE_LENGTH: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    request_id: uint64 = 0
    name: Annotated[Ints, Array[char, 25]] = DEFAULT
    px4_ros2_api_version: uint16 = 0
    register_arming_check: bool = False
    register_mode: bool = False
    register_mode_executor: bool = False
    enable_replace_internal_mode: bool = False
    replace_internal_mode: uint8 = 0
    activate_mode_immediately: bool = False


class Rpm(Message, typename="px4_msgs/msg/Rpm"):
    """Rpm, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    indicated_frequency_rpm: float32 = 0.0
    estimated_accurancy_rpm: float32 = 0.0


class RtlStatus(Message, typename="px4_msgs/msg/RtlStatus"):
    """RtlStatus, as PX4 1.15 defines it."""

    RTL_STATUS_TYPE_NONE: ClassVar[uint8] = 0
    RTL_STATUS_TYPE_DIRECT_SAFE_POINT: ClassVar[uint8] = 1
    RTL_STATUS_TYPE_DIRECT_MISSION_LAND: ClassVar[uint8] = 2
    RTL_STATUS_TYPE_FOLLOW_MISSION: ClassVar[uint8] = 3
    RTL_STATUS_TYPE_FOLLOW_MISSION_REVERSE: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    safe_points_id: uint32 = 0
    is_evaluation_pending: bool = False
    has_vtol_approach: bool = False
    rtl_type: uint8 = 0
    safe_point_index: uint8 = 0


class RtlTimeEstimate(Message, typename="px4_msgs/msg/RtlTimeEstimate"):
    """RtlTimeEstimate, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    valid: bool = False
    time_estimate: float32 = 0.0
    safe_time_estimate: float32 = 0.0


class SatelliteInfo(Message, typename="px4_msgs/msg/SatelliteInfo"):
    """SatelliteInfo, as PX4 1.15 defines it."""

    SAT_INFO_MAX_SATELLITES: ClassVar[uint8] = 20

    timestamp: uint64 = 0
    count: uint8 = 0
    svid: Annotated[Ints, Array[uint8, 20]] = DEFAULT
    used: Annotated[Ints, Array[uint8, 20]] = DEFAULT
    elevation: Annotated[Ints, Array[uint8, 20]] = DEFAULT
    azimuth: Annotated[Ints, Array[uint8, 20]] = DEFAULT
    snr: Annotated[Ints, Array[uint8, 20]] = DEFAULT
    prn: Annotated[Ints, Array[uint8, 20]] = DEFAULT


class SensorAccel(Message, typename="px4_msgs/msg/SensorAccel"):
    """SensorAccel, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 8

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    x: float32 = 0.0
    y: float32 = 0.0
    z: float32 = 0.0
    temperature: float32 = 0.0
    error_count: uint32 = 0
    clip_counter: Annotated[Ints, Array[uint8, 3]] = DEFAULT
    samples: uint8 = 0


class SensorAccelFifo(Message, typename="px4_msgs/msg/SensorAccelFifo"):
    """SensorAccelFifo, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    dt: float32 = 0.0
    scale: float32 = 0.0
    samples: uint8 = 0
    x: Annotated[Ints, Array[int16, 32]] = DEFAULT
    y: Annotated[Ints, Array[int16, 32]] = DEFAULT
    z: Annotated[Ints, Array[int16, 32]] = DEFAULT


class SensorAirflow(Message, typename="px4_msgs/msg/SensorAirflow"):
    """SensorAirflow, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    device_id: uint32 = 0
    speed: float32 = 0.0
    direction: float32 = 0.0
    status: uint8 = 0


class SensorBaro(Message, typename="px4_msgs/msg/SensorBaro"):
    """SensorBaro, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    pressure: float32 = 0.0
    temperature: float32 = 0.0
    error_count: uint32 = 0


class SensorCombined(Message, typename="px4_msgs/msg/SensorCombined"):
    """SensorCombined, as PX4 1.15 defines it."""

    RELATIVE_TIMESTAMP_INVALID: ClassVar[int32] = 2147483647
    CLIPPING_X: ClassVar[uint8] = 1
    CLIPPING_Y: ClassVar[uint8] = 2
    CLIPPING_Z: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    gyro_rad: Annotated[Floats, Array[float32, 3]] = DEFAULT
    gyro_integral_dt: uint32 = 0
    accelerometer_timestamp_relative: int32 = 0
    accelerometer_m_s2: Annotated[Floats, Array[float32, 3]] = DEFAULT
    accelerometer_integral_dt: uint32 = 0
    accelerometer_clipping: uint8 = 0
    gyro_clipping: uint8 = 0
    accel_calibration_count: uint8 = 0
    gyro_calibration_count: uint8 = 0


class SensorCorrection(Message, typename="px4_msgs/msg/SensorCorrection"):
    """SensorCorrection, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    accel_device_ids: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    accel_temperature: Annotated[Floats, Array[float32, 4]] = DEFAULT
    accel_offset_0: Annotated[Floats, Array[float32, 3]] = DEFAULT
    accel_offset_1: Annotated[Floats, Array[float32, 3]] = DEFAULT
    accel_offset_2: Annotated[Floats, Array[float32, 3]] = DEFAULT
    accel_offset_3: Annotated[Floats, Array[float32, 3]] = DEFAULT
    gyro_device_ids: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    gyro_temperature: Annotated[Floats, Array[float32, 4]] = DEFAULT
    gyro_offset_0: Annotated[Floats, Array[float32, 3]] = DEFAULT
    gyro_offset_1: Annotated[Floats, Array[float32, 3]] = DEFAULT
    gyro_offset_2: Annotated[Floats, Array[float32, 3]] = DEFAULT
    gyro_offset_3: Annotated[Floats, Array[float32, 3]] = DEFAULT
    mag_device_ids: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    mag_temperature: Annotated[Floats, Array[float32, 4]] = DEFAULT
    mag_offset_0: Annotated[Floats, Array[float32, 3]] = DEFAULT
    mag_offset_1: Annotated[Floats, Array[float32, 3]] = DEFAULT
    mag_offset_2: Annotated[Floats, Array[float32, 3]] = DEFAULT
    mag_offset_3: Annotated[Floats, Array[float32, 3]] = DEFAULT
    baro_device_ids: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    baro_temperature: Annotated[Floats, Array[float32, 4]] = DEFAULT
    baro_offset_0: float32 = 0.0
    baro_offset_1: float32 = 0.0
    baro_offset_2: float32 = 0.0
    baro_offset_3: float32 = 0.0


class SensorGnssRelative(Message, typename="px4_msgs/msg/SensorGnssRelative"):
    """SensorGnssRelative, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    time_utc_usec: uint64 = 0
    reference_station_id: uint16 = 0
    position: Annotated[Floats, Array[float32, 3]] = DEFAULT
    position_accuracy: Annotated[Floats, Array[float32, 3]] = DEFAULT
    heading: float32 = 0.0
    heading_accuracy: float32 = 0.0
    position_length: float32 = 0.0
    accuracy_length: float32 = 0.0
    gnss_fix_ok: bool = False
    differential_solution: bool = False
    relative_position_valid: bool = False
    carrier_solution_floating: bool = False
    carrier_solution_fixed: bool = False
    moving_base_mode: bool = False
    reference_position_miss: bool = False
    reference_observations_miss: bool = False
    heading_valid: bool = False
    relative_position_normalized: bool = False


class SensorGps(Message, typename="px4_msgs/msg/SensorGps"):
    """SensorGps, as PX4 1.15 defines it."""

    FIX_TYPE_NONE: ClassVar[uint8] = 1
    FIX_TYPE_2D: ClassVar[uint8] = 2
    FIX_TYPE_3D: ClassVar[uint8] = 3
    FIX_TYPE_RTCM_CODE_DIFFERENTIAL: ClassVar[uint8] = 4
    FIX_TYPE_RTK_FLOAT: ClassVar[uint8] = 5
    FIX_TYPE_RTK_FIXED: ClassVar[uint8] = 6
    FIX_TYPE_EXTRAPOLATED: ClassVar[uint8] = 8
    JAMMING_STATE_UNKNOWN: ClassVar[uint8] = 0
    JAMMING_STATE_OK: ClassVar[uint8] = 1
    JAMMING_STATE_WARNING: ClassVar[uint8] = 2
    JAMMING_STATE_CRITICAL: ClassVar[uint8] = 3
    SPOOFING_STATE_UNKNOWN: ClassVar[uint8] = 0
    SPOOFING_STATE_NONE: ClassVar[uint8] = 1
    SPOOFING_STATE_INDICATED: ClassVar[uint8] = 2
    SPOOFING_STATE_MULTIPLE: ClassVar[uint8] = 3
    RTCM_MSG_USED_UNKNOWN: ClassVar[uint8] = 0
    RTCM_MSG_USED_NOT_USED: ClassVar[uint8] = 1
    RTCM_MSG_USED_USED: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    latitude_deg: float64 = 0.0
    longitude_deg: float64 = 0.0
    altitude_msl_m: float64 = 0.0
    altitude_ellipsoid_m: float64 = 0.0
    s_variance_m_s: float32 = 0.0
    c_variance_rad: float32 = 0.0
    fix_type: uint8 = 0
    eph: float32 = 0.0
    epv: float32 = 0.0
    hdop: float32 = 0.0
    vdop: float32 = 0.0
    noise_per_ms: int32 = 0
    automatic_gain_control: uint16 = 0
    jamming_state: uint8 = 0
    jamming_indicator: int32 = 0
    spoofing_state: uint8 = 0
    vel_m_s: float32 = 0.0
    vel_n_m_s: float32 = 0.0
    vel_e_m_s: float32 = 0.0
    vel_d_m_s: float32 = 0.0
    cog_rad: float32 = 0.0
    vel_ned_valid: bool = False
    timestamp_time_relative: int32 = 0
    time_utc_usec: uint64 = 0
    satellites_used: uint8 = 0
    heading: float32 = 0.0
    heading_offset: float32 = 0.0
    heading_accuracy: float32 = 0.0
    rtcm_injection_rate: float32 = 0.0
    selected_rtcm_instance: uint8 = 0
    rtcm_crc_failed: bool = False
    rtcm_msg_used: uint8 = 0


class SensorGyro(Message, typename="px4_msgs/msg/SensorGyro"):
    """SensorGyro, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 8

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    x: float32 = 0.0
    y: float32 = 0.0
    z: float32 = 0.0
    temperature: float32 = 0.0
    error_count: uint32 = 0
    clip_counter: Annotated[Ints, Array[uint8, 3]] = DEFAULT
    samples: uint8 = 0


class SensorGyroFft(Message, typename="px4_msgs/msg/SensorGyroFft"):
    """SensorGyroFft, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    sensor_sample_rate_hz: float32 = 0.0
    resolution_hz: float32 = 0.0
    peak_frequencies_x: Annotated[Floats, Array[float32, 3]] = DEFAULT
    peak_frequencies_y: Annotated[Floats, Array[float32, 3]] = DEFAULT
    peak_frequencies_z: Annotated[Floats, Array[float32, 3]] = DEFAULT
    peak_snr_x: Annotated[Floats, Array[float32, 3]] = DEFAULT
    peak_snr_y: Annotated[Floats, Array[float32, 3]] = DEFAULT
    peak_snr_z: Annotated[Floats, Array[float32, 3]] = DEFAULT


class SensorGyroFifo(Message, typename="px4_msgs/msg/SensorGyroFifo"):
    """SensorGyroFifo, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    dt: float32 = 0.0
    scale: float32 = 0.0
    samples: uint8 = 0
    x: Annotated[Ints, Array[int16, 32]] = DEFAULT
    y: Annotated[Ints, Array[int16, 32]] = DEFAULT
    z: Annotated[Ints, Array[int16, 32]] = DEFAULT


class SensorHygrometer(Message, typename="px4_msgs/msg/SensorHygrometer"):
    """SensorHygrometer, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    temperature: float32 = 0.0
    humidity: float32 = 0.0


class SensorMag(Message, typename="px4_msgs/msg/SensorMag"):
    """SensorMag, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    x: float32 = 0.0
    y: float32 = 0.0
    z: float32 = 0.0
    temperature: float32 = 0.0
    error_count: uint32 = 0


class SensorOpticalFlow(Message, typename="px4_msgs/msg/SensorOpticalFlow"):
    """SensorOpticalFlow, as PX4 1.15 defines it."""

    MODE_UNKNOWN: ClassVar[uint8] = 0
    MODE_BRIGHT: ClassVar[uint8] = 1
    MODE_LOWLIGHT: ClassVar[uint8] = 2
    MODE_SUPER_LOWLIGHT: ClassVar[uint8] = 3

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    pixel_flow: Annotated[Floats, Array[float32, 2]] = DEFAULT
    delta_angle: Annotated[Floats, Array[float32, 3]] = DEFAULT
    delta_angle_available: bool = False
    distance_m: float32 = 0.0
    distance_available: bool = False
    integration_timespan_us: uint32 = 0
    quality: uint8 = 0
    error_count: uint32 = 0
    max_flow_rate: float32 = 0.0
    min_ground_distance: float32 = 0.0
    max_ground_distance: float32 = 0.0
    mode: uint8 = 0


class SensorPreflightMag(Message, typename="px4_msgs/msg/SensorPreflightMag"):
    """SensorPreflightMag, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    mag_inconsistency_angle: float32 = 0.0


class SensorSelection(Message, typename="px4_msgs/msg/SensorSelection"):
    """SensorSelection, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    accel_device_id: uint32 = 0
    gyro_device_id: uint32 = 0


class SensorUwb(Message, typename="px4_msgs/msg/SensorUwb"):
    """SensorUwb, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    sessionid: uint32 = 0
    time_offset: uint32 = 0
    counter: uint32 = 0
    mac: uint16 = 0
    mac_dest: uint16 = 0
    status: uint16 = 0
    nlos: uint8 = 0
    distance: float32 = 0.0
    aoa_azimuth_dev: float32 = 0.0
    aoa_elevation_dev: float32 = 0.0
    aoa_azimuth_resp: float32 = 0.0
    aoa_elevation_resp: float32 = 0.0
    aoa_azimuth_fom: uint8 = 0
    aoa_elevation_fom: uint8 = 0
    aoa_dest_azimuth_fom: uint8 = 0
    aoa_dest_elevation_fom: uint8 = 0
    orientation: uint8 = 0
    offset_x: float32 = 0.0
    offset_y: float32 = 0.0
    offset_z: float32 = 0.0


class SensorsStatus(Message, typename="px4_msgs/msg/SensorsStatus"):
    """SensorsStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    device_id_primary: uint32 = 0
    device_ids: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    inconsistency: Annotated[Floats, Array[float32, 4]] = DEFAULT
    healthy: Annotated[Bools, Array[bool, 4]] = DEFAULT
    priority: Annotated[Ints, Array[uint8, 4]] = DEFAULT
    enabled: Annotated[Bools, Array[bool, 4]] = DEFAULT
    external: Annotated[Bools, Array[bool, 4]] = DEFAULT


class SensorsStatusImu(Message, typename="px4_msgs/msg/SensorsStatusImu"):
    """SensorsStatusImu, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    accel_device_id_primary: uint32 = 0
    accel_device_ids: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    accel_inconsistency_m_s_s: Annotated[Floats, Array[float32, 4]] = DEFAULT
    accel_healthy: Annotated[Bools, Array[bool, 4]] = DEFAULT
    accel_priority: Annotated[Ints, Array[uint8, 4]] = DEFAULT
    gyro_device_id_primary: uint32 = 0
    gyro_device_ids: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    gyro_inconsistency_rad_s: Annotated[Floats, Array[float32, 4]] = DEFAULT
    gyro_healthy: Annotated[Bools, Array[bool, 4]] = DEFAULT
    gyro_priority: Annotated[Ints, Array[uint8, 4]] = DEFAULT


class SystemPower(Message, typename="px4_msgs/msg/SystemPower"):
    """SystemPower, as PX4 1.15 defines it."""

    BRICK1_VALID_SHIFTS: ClassVar[uint8] = 0
    BRICK1_VALID_MASK: ClassVar[uint8] = 1
    BRICK2_VALID_SHIFTS: ClassVar[uint8] = 1
    BRICK2_VALID_MASK: ClassVar[uint8] = 2
    BRICK3_VALID_SHIFTS: ClassVar[uint8] = 2
    BRICK3_VALID_MASK: ClassVar[uint8] = 4
    BRICK4_VALID_SHIFTS: ClassVar[uint8] = 3
    BRICK4_VALID_MASK: ClassVar[uint8] = 8

    timestamp: uint64 = 0
    voltage5v_v: float32 = 0.0
    voltage_payload_v: float32 = 0.0
    sensors3v3: Annotated[Floats, Array[float32, 4]] = DEFAULT
    sensors3v3_valid: uint8 = 0
    usb_connected: uint8 = 0
    brick_valid: uint8 = 0
    usb_valid: uint8 = 0
    servo_valid: uint8 = 0
    periph_5v_oc: uint8 = 0
    hipower_5v_oc: uint8 = 0
    comp_5v_valid: uint8 = 0
    can1_gps1_5v_valid: uint8 = 0
    payload_v_valid: uint8 = 0


class TakeoffStatus(Message, typename="px4_msgs/msg/TakeoffStatus"):
    """TakeoffStatus, as PX4 1.15 defines it."""

    TAKEOFF_STATE_UNINITIALIZED: ClassVar[uint8] = 0
    TAKEOFF_STATE_DISARMED: ClassVar[uint8] = 1
    TAKEOFF_STATE_SPOOLUP: ClassVar[uint8] = 2
    TAKEOFF_STATE_READY_FOR_TAKEOFF: ClassVar[uint8] = 3
    TAKEOFF_STATE_RAMPUP: ClassVar[uint8] = 4
    TAKEOFF_STATE_FLIGHT: ClassVar[uint8] = 5

    timestamp: uint64 = 0
    takeoff_state: uint8 = 0
    tilt_limit: float32 = 0.0


class TaskStackInfo(Message, typename="px4_msgs/msg/TaskStackInfo"):
    """TaskStackInfo, as PX4 1.15 defines it."""

    ORB_QUEUE_LENGTH: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    stack_free: uint16 = 0
    task_name: Annotated[Ints, Array[char, 24]] = DEFAULT


class TecsStatus(Message, typename="px4_msgs/msg/TecsStatus"):
    """TecsStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    altitude_sp: float32 = 0.0
    altitude_reference: float32 = 0.0
    height_rate_reference: float32 = 0.0
    height_rate_direct: float32 = 0.0
    height_rate_setpoint: float32 = 0.0
    height_rate: float32 = 0.0
    equivalent_airspeed_sp: float32 = 0.0
    true_airspeed_sp: float32 = 0.0
    true_airspeed_filtered: float32 = 0.0
    true_airspeed_derivative_sp: float32 = 0.0
    true_airspeed_derivative: float32 = 0.0
    true_airspeed_derivative_raw: float32 = 0.0
    total_energy_rate_sp: float32 = 0.0
    total_energy_rate: float32 = 0.0
    total_energy_balance_rate_sp: float32 = 0.0
    total_energy_balance_rate: float32 = 0.0
    throttle_integ: float32 = 0.0
    pitch_integ: float32 = 0.0
    throttle_sp: float32 = 0.0
    pitch_sp_rad: float32 = 0.0
    throttle_trim: float32 = 0.0
    underspeed_ratio: float32 = 0.0


class TelemetryStatus(Message, typename="px4_msgs/msg/TelemetryStatus"):
    """TelemetryStatus, as PX4 1.15 defines it."""

    LINK_TYPE_GENERIC: ClassVar[uint8] = 0
    LINK_TYPE_UBIQUITY_BULLET: ClassVar[uint8] = 1
    LINK_TYPE_WIRE: ClassVar[uint8] = 2
    LINK_TYPE_USB: ClassVar[uint8] = 3
    LINK_TYPE_IRIDIUM: ClassVar[uint8] = 4
    HEARTBEAT_TIMEOUT_US: ClassVar[uint64] = 2500000

    timestamp: uint64 = 0
    type: uint8 = 0
    mode: uint8 = 0
    flow_control: bool = False
    forwarding: bool = False
    mavlink_v2: bool = False
    ftp: bool = False
    streams: uint8 = 0
    data_rate: float32 = 0.0
    rate_multiplier: float32 = 0.0
    tx_rate_avg: float32 = 0.0
    tx_error_rate_avg: float32 = 0.0
    tx_message_count: uint32 = 0
    tx_buffer_overruns: uint32 = 0
    rx_rate_avg: float32 = 0.0
    rx_message_count: uint32 = 0
    rx_message_lost_count: uint32 = 0
    rx_buffer_overruns: uint32 = 0
    rx_parse_errors: uint32 = 0
    rx_packet_drop_count: uint32 = 0
    rx_message_lost_rate: float32 = 0.0
    heartbeat_type_antenna_tracker: bool = False
    heartbeat_type_gcs: bool = False
    heartbeat_type_onboard_controller: bool = False
    heartbeat_type_gimbal: bool = False
    heartbeat_type_adsb: bool = False
    heartbeat_type_camera: bool = False
    heartbeat_type_parachute: bool = False
    heartbeat_type_open_drone_id: bool = False
    heartbeat_component_telemetry_radio: bool = False
    heartbeat_component_log: bool = False
    heartbeat_component_osd: bool = False
    heartbeat_component_obstacle_avoidance: bool = False
    heartbeat_component_vio: bool = False
    heartbeat_component_pairing_manager: bool = False
    heartbeat_component_udp_bridge: bool = False
    heartbeat_component_uart_bridge: bool = False
    avoidance_system_healthy: bool = False
    open_drone_id_system_healthy: bool = False
    parachute_system_healthy: bool = False


class TiltrotorExtraControls(Message, typename="px4_msgs/msg/TiltrotorExtraControls"):
    """TiltrotorExtraControls, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    collective_tilt_normalized_setpoint: float32 = 0.0
    collective_thrust_normalized_setpoint: float32 = 0.0


class TimesyncStatus(Message, typename="px4_msgs/msg/TimesyncStatus"):
    """TimesyncStatus, as PX4 1.15 defines it."""

    SOURCE_PROTOCOL_UNKNOWN: ClassVar[uint8] = 0
    SOURCE_PROTOCOL_MAVLINK: ClassVar[uint8] = 1
    SOURCE_PROTOCOL_DDS: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    source_protocol: uint8 = 0
    remote_timestamp: uint64 = 0
    observed_offset: int64 = 0
    estimated_offset: int64 = 0
    round_trip_time: uint32 = 0


class TrajectoryBezier(Message, typename="px4_msgs/msg/TrajectoryBezier"):
    """TrajectoryBezier, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    position: Annotated[Floats, Array[float32, 3]] = DEFAULT
    yaw: float32 = 0.0
    delta: float32 = 0.0


class TrajectorySetpoint(Message, typename="px4_msgs/msg/TrajectorySetpoint"):
    """TrajectorySetpoint, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    position: Annotated[Floats, Array[float32, 3]] = DEFAULT
    velocity: Annotated[Floats, Array[float32, 3]] = DEFAULT
    acceleration: Annotated[Floats, Array[float32, 3]] = DEFAULT
    jerk: Annotated[Floats, Array[float32, 3]] = DEFAULT
    yaw: float32 = 0.0
    yawspeed: float32 = 0.0


class TrajectoryWaypoint(Message, typename="px4_msgs/msg/TrajectoryWaypoint"):
    """TrajectoryWaypoint, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    position: Annotated[Floats, Array[float32, 3]] = DEFAULT
    velocity: Annotated[Floats, Array[float32, 3]] = DEFAULT
    acceleration: Annotated[Floats, Array[float32, 3]] = DEFAULT
    yaw: float32 = 0.0
    yaw_speed: float32 = 0.0
    point_valid: bool = False
    type: uint8 = 0


class TransponderReport(Message, typename="px4_msgs/msg/TransponderReport"):
    """TransponderReport, as PX4 1.15 defines it."""

    PX4_ADSB_FLAGS_VALID_COORDS: ClassVar[uint16] = 1
    PX4_ADSB_FLAGS_VALID_ALTITUDE: ClassVar[uint16] = 2
    PX4_ADSB_FLAGS_VALID_HEADING: ClassVar[uint16] = 4
    PX4_ADSB_FLAGS_VALID_VELOCITY: ClassVar[uint16] = 8
    PX4_ADSB_FLAGS_VALID_CALLSIGN: ClassVar[uint16] = 16
    PX4_ADSB_FLAGS_VALID_SQUAWK: ClassVar[uint16] = 32
    PX4_ADSB_FLAGS_RETRANSLATE: ClassVar[uint16] = 256
    ADSB_EMITTER_TYPE_NO_INFO: ClassVar[uint16] = 0
    ADSB_EMITTER_TYPE_LIGHT: ClassVar[uint16] = 1
    ADSB_EMITTER_TYPE_SMALL: ClassVar[uint16] = 2
    ADSB_EMITTER_TYPE_LARGE: ClassVar[uint16] = 3
    ADSB_EMITTER_TYPE_HIGH_VORTEX_LARGE: ClassVar[uint16] = 4
    ADSB_EMITTER_TYPE_HEAVY: ClassVar[uint16] = 5
    ADSB_EMITTER_TYPE_HIGHLY_MANUV: ClassVar[uint16] = 6
    ADSB_EMITTER_TYPE_ROTOCRAFT: ClassVar[uint16] = 7
    ADSB_EMITTER_TYPE_UNASSIGNED: ClassVar[uint16] = 8
    ADSB_EMITTER_TYPE_GLIDER: ClassVar[uint16] = 9
    ADSB_EMITTER_TYPE_LIGHTER_AIR: ClassVar[uint16] = 10
    ADSB_EMITTER_TYPE_PARACHUTE: ClassVar[uint16] = 11
    ADSB_EMITTER_TYPE_ULTRA_LIGHT: ClassVar[uint16] = 12
    ADSB_EMITTER_TYPE_UNASSIGNED2: ClassVar[uint16] = 13
    ADSB_EMITTER_TYPE_UAV: ClassVar[uint16] = 14
    ADSB_EMITTER_TYPE_SPACE: ClassVar[uint16] = 15
    ADSB_EMITTER_TYPE_UNASSGINED3: ClassVar[uint16] = 16
    ADSB_EMITTER_TYPE_EMERGENCY_SURFACE: ClassVar[uint16] = 17
    ADSB_EMITTER_TYPE_SERVICE_SURFACE: ClassVar[uint16] = 18
    ADSB_EMITTER_TYPE_POINT_OBSTACLE: ClassVar[uint16] = 19
    ADSB_EMITTER_TYPE_ENUM_END: ClassVar[uint16] = 20
    ORB_QUEUE_LENGTH: ClassVar[uint8] = 16

    timestamp: uint64 = 0
    icao_address: uint32 = 0
    lat: float64 = 0.0
    lon: float64 = 0.0
    altitude_type: uint8 = 0
    altitude: float32 = 0.0
    heading: float32 = 0.0
    hor_velocity: float32 = 0.0
    ver_velocity: float32 = 0.0
    callsign: Annotated[Ints, Array[char, 9]] = DEFAULT
    emitter_type: uint8 = 0
    tslc: uint8 = 0
    flags: uint16 = 0
    squawk: uint16 = 0
    uas_id: Annotated[Ints, Array[uint8, 18]] = DEFAULT


class TuneControl(Message, typename="px4_msgs/msg/TuneControl"):
    """TuneControl, as PX4 1.15 defines it."""

    TUNE_ID_STOP: ClassVar[uint8] = 0
    TUNE_ID_STARTUP: ClassVar[uint8] = 1
    TUNE_ID_ERROR: ClassVar[uint8] = 2
    TUNE_ID_NOTIFY_POSITIVE: ClassVar[uint8] = 3
    TUNE_ID_NOTIFY_NEUTRAL: ClassVar[uint8] = 4
    TUNE_ID_NOTIFY_NEGATIVE: ClassVar[uint8] = 5
    TUNE_ID_ARMING_WARNING: ClassVar[uint8] = 6
    TUNE_ID_BATTERY_WARNING_SLOW: ClassVar[uint8] = 7
    TUNE_ID_BATTERY_WARNING_FAST: ClassVar[uint8] = 8
    TUNE_ID_GPS_WARNING: ClassVar[uint8] = 9
    TUNE_ID_ARMING_FAILURE: ClassVar[uint8] = 10
    TUNE_ID_PARACHUTE_RELEASE: ClassVar[uint8] = 11
    TUNE_ID_SINGLE_BEEP: ClassVar[uint8] = 12
    TUNE_ID_HOME_SET: ClassVar[uint8] = 13
    TUNE_ID_SD_INIT: ClassVar[uint8] = 14
    TUNE_ID_SD_ERROR: ClassVar[uint8] = 15
    TUNE_ID_PROG_PX4IO: ClassVar[uint8] = 16
    TUNE_ID_PROG_PX4IO_OK: ClassVar[uint8] = 17
    TUNE_ID_PROG_PX4IO_ERR: ClassVar[uint8] = 18
    TUNE_ID_POWER_OFF: ClassVar[uint8] = 19
    NUMBER_OF_TUNES: ClassVar[uint8] = 20
    VOLUME_LEVEL_MIN: ClassVar[uint8] = 0
    VOLUME_LEVEL_DEFAULT: ClassVar[uint8] = 20
    VOLUME_LEVEL_MAX: ClassVar[uint8] = 100
    ORB_QUEUE_LENGTH: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    tune_id: uint8 = 0
    tune_override: bool = False
    frequency: uint16 = 0
    duration: uint32 = 0
    silence: uint32 = 0
    volume: uint8 = 0


class UavcanParameterRequest(Message, typename="px4_msgs/msg/UavcanParameterRequest"):
    """UavcanParameterRequest, as PX4 1.15 defines it."""

    MESSAGE_TYPE_PARAM_REQUEST_READ: ClassVar[uint8] = 20
    MESSAGE_TYPE_PARAM_REQUEST_LIST: ClassVar[uint8] = 21
    MESSAGE_TYPE_PARAM_SET: ClassVar[uint8] = 23
    NODE_ID_ALL: ClassVar[uint8] = 0
    PARAM_TYPE_UINT8: ClassVar[uint8] = 1
    PARAM_TYPE_INT64: ClassVar[uint8] = 8
    PARAM_TYPE_REAL32: ClassVar[uint8] = 9
    ORB_QUEUE_LENGTH: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    message_type: uint8 = 0
    node_id: uint8 = 0
    param_id: Annotated[Ints, Array[char, 17]] = DEFAULT
    param_index: int16 = 0
    param_type: uint8 = 0
    int_value: int64 = 0
    real_value: float32 = 0.0


class UavcanParameterValue(Message, typename="px4_msgs/msg/UavcanParameterValue"):
    """UavcanParameterValue, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    node_id: uint8 = 0
    param_id: Annotated[Ints, Array[char, 17]] = DEFAULT
    param_index: int16 = 0
    param_count: uint16 = 0
    param_type: uint8 = 0
    int_value: int64 = 0
    real_value: float32 = 0.0


class UlogStream(Message, typename="px4_msgs/msg/UlogStream"):
    """UlogStream, as PX4 1.15 defines it."""

    FLAGS_NEED_ACK: ClassVar[uint8] = 1
    ORB_QUEUE_LENGTH: ClassVar[uint8] = 16

    timestamp: uint64 = 0
    length: uint8 = 0
    first_message_offset: uint8 = 0
    msg_sequence: uint16 = 0
    flags: uint8 = 0
    data: Annotated[Ints, Array[uint8, 249]] = DEFAULT


class UlogStreamAck(Message, typename="px4_msgs/msg/UlogStreamAck"):
    """UlogStreamAck, as PX4 1.15 defines it."""

    ACK_TIMEOUT: ClassVar[int32] = 50
    ACK_MAX_TRIES: ClassVar[int32] = 50

    timestamp: uint64 = 0
    msg_sequence: uint16 = 0


class UnregisterExtComponent(Message, typename="px4_msgs/msg/UnregisterExtComponent"):
    """UnregisterExtComponent, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    name: Annotated[Ints, Array[char, 25]] = DEFAULT
    arming_check_id: int8 = 0
    mode_id: int8 = 0
    mode_executor_id: int8 = 0


class VehicleAcceleration(Message, typename="px4_msgs/msg/VehicleAcceleration"):
    """VehicleAcceleration, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    xyz: Annotated[Floats, Array[float32, 3]] = DEFAULT


class VehicleAirData(Message, typename="px4_msgs/msg/VehicleAirData"):
    """VehicleAirData, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    baro_device_id: uint32 = 0
    baro_alt_meter: float32 = 0.0
    baro_temp_celcius: float32 = 0.0
    baro_pressure_pa: float32 = 0.0
    rho: float32 = 0.0
    eas2tas: float32 = 0.0
    calibration_count: uint8 = 0


class VehicleAngularAccelerationSetpoint(
    Message, typename="px4_msgs/msg/VehicleAngularAccelerationSetpoint"
):
    """VehicleAngularAccelerationSetpoint, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    xyz: Annotated[Floats, Array[float32, 3]] = DEFAULT


class VehicleAngularVelocity(Message, typename="px4_msgs/msg/VehicleAngularVelocity"):
    """VehicleAngularVelocity, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    xyz: Annotated[Floats, Array[float32, 3]] = DEFAULT
    xyz_derivative: Annotated[Floats, Array[float32, 3]] = DEFAULT


class VehicleAttitude(Message, typename="px4_msgs/msg/VehicleAttitude"):
    """VehicleAttitude, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    q: Annotated[Floats, Array[float32, 4]] = DEFAULT
    delta_q_reset: Annotated[Floats, Array[float32, 4]] = DEFAULT
    quat_reset_counter: uint8 = 0


class VehicleAttitudeSetpoint(Message, typename="px4_msgs/msg/VehicleAttitudeSetpoint"):
    """VehicleAttitudeSetpoint, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    roll_body: float32 = 0.0
    pitch_body: float32 = 0.0
    yaw_body: float32 = 0.0
    yaw_sp_move_rate: float32 = 0.0
    q_d: Annotated[Floats, Array[float32, 4]] = DEFAULT
    thrust_body: Annotated[Floats, Array[float32, 3]] = DEFAULT
    reset_integral: bool = False
    fw_control_yaw_wheel: bool = False


class VehicleCommand(Message, typename="px4_msgs/msg/VehicleCommand"):
    """VehicleCommand, as PX4 1.15 defines it."""

    VEHICLE_CMD_CUSTOM_0: ClassVar[uint16] = 0
    VEHICLE_CMD_CUSTOM_1: ClassVar[uint16] = 1
    VEHICLE_CMD_CUSTOM_2: ClassVar[uint16] = 2
    VEHICLE_CMD_NAV_WAYPOINT: ClassVar[uint16] = 16
    VEHICLE_CMD_NAV_LOITER_UNLIM: ClassVar[uint16] = 17
    VEHICLE_CMD_NAV_LOITER_TURNS: ClassVar[uint16] = 18
    VEHICLE_CMD_NAV_LOITER_TIME: ClassVar[uint16] = 19
    VEHICLE_CMD_NAV_RETURN_TO_LAUNCH: ClassVar[uint16] = 20
    VEHICLE_CMD_NAV_LAND: ClassVar[uint16] = 21
    VEHICLE_CMD_NAV_TAKEOFF: ClassVar[uint16] = 22
    VEHICLE_CMD_NAV_PRECLAND: ClassVar[uint16] = 23
    VEHICLE_CMD_DO_ORBIT: ClassVar[uint16] = 34
    VEHICLE_CMD_DO_FIGUREEIGHT: ClassVar[uint16] = 35
    VEHICLE_CMD_NAV_ROI: ClassVar[uint16] = 80
    VEHICLE_CMD_NAV_PATHPLANNING: ClassVar[uint16] = 81
    VEHICLE_CMD_NAV_VTOL_TAKEOFF: ClassVar[uint16] = 84
    VEHICLE_CMD_NAV_VTOL_LAND: ClassVar[uint16] = 85
    VEHICLE_CMD_NAV_GUIDED_LIMITS: ClassVar[uint16] = 90
    VEHICLE_CMD_NAV_GUIDED_MASTER: ClassVar[uint16] = 91
    VEHICLE_CMD_NAV_DELAY: ClassVar[uint16] = 93
    VEHICLE_CMD_NAV_LAST: ClassVar[uint16] = 95
    VEHICLE_CMD_CONDITION_DELAY: ClassVar[uint16] = 112
    VEHICLE_CMD_CONDITION_CHANGE_ALT: ClassVar[uint16] = 113
    VEHICLE_CMD_CONDITION_DISTANCE: ClassVar[uint16] = 114
    VEHICLE_CMD_CONDITION_YAW: ClassVar[uint16] = 115
    VEHICLE_CMD_CONDITION_LAST: ClassVar[uint16] = 159
    VEHICLE_CMD_CONDITION_GATE: ClassVar[uint16] = 4501
    VEHICLE_CMD_DO_SET_MODE: ClassVar[uint16] = 176
    VEHICLE_CMD_DO_JUMP: ClassVar[uint16] = 177
    VEHICLE_CMD_DO_CHANGE_SPEED: ClassVar[uint16] = 178
    VEHICLE_CMD_DO_SET_HOME: ClassVar[uint16] = 179
    VEHICLE_CMD_DO_SET_PARAMETER: ClassVar[uint16] = 180
    VEHICLE_CMD_DO_SET_RELAY: ClassVar[uint16] = 181
    VEHICLE_CMD_DO_REPEAT_RELAY: ClassVar[uint16] = 182
    VEHICLE_CMD_DO_REPEAT_SERVO: ClassVar[uint16] = 184
    VEHICLE_CMD_DO_FLIGHTTERMINATION: ClassVar[uint16] = 185
    VEHICLE_CMD_DO_CHANGE_ALTITUDE: ClassVar[uint16] = 186
    VEHICLE_CMD_DO_SET_ACTUATOR: ClassVar[uint16] = 187
    VEHICLE_CMD_DO_LAND_START: ClassVar[uint16] = 189
    VEHICLE_CMD_DO_GO_AROUND: ClassVar[uint16] = 191
    VEHICLE_CMD_DO_REPOSITION: ClassVar[uint16] = 192
    VEHICLE_CMD_DO_PAUSE_CONTINUE: ClassVar[uint16] = 193
    VEHICLE_CMD_DO_SET_ROI_LOCATION: ClassVar[uint16] = 195
    VEHICLE_CMD_DO_SET_ROI_WPNEXT_OFFSET: ClassVar[uint16] = 196
    VEHICLE_CMD_DO_SET_ROI_NONE: ClassVar[uint16] = 197
    VEHICLE_CMD_DO_CONTROL_VIDEO: ClassVar[uint16] = 200
    VEHICLE_CMD_DO_SET_ROI: ClassVar[uint16] = 201
    VEHICLE_CMD_DO_DIGICAM_CONTROL: ClassVar[uint16] = 203
    VEHICLE_CMD_DO_MOUNT_CONFIGURE: ClassVar[uint16] = 204
    VEHICLE_CMD_DO_MOUNT_CONTROL: ClassVar[uint16] = 205
    VEHICLE_CMD_DO_SET_CAM_TRIGG_DIST: ClassVar[uint16] = 206
    VEHICLE_CMD_DO_FENCE_ENABLE: ClassVar[uint16] = 207
    VEHICLE_CMD_DO_PARACHUTE: ClassVar[uint16] = 208
    VEHICLE_CMD_DO_MOTOR_TEST: ClassVar[uint16] = 209
    VEHICLE_CMD_DO_INVERTED_FLIGHT: ClassVar[uint16] = 210
    VEHICLE_CMD_DO_GRIPPER: ClassVar[uint16] = 211
    VEHICLE_CMD_DO_SET_CAM_TRIGG_INTERVAL: ClassVar[uint16] = 214
    VEHICLE_CMD_DO_MOUNT_CONTROL_QUAT: ClassVar[uint16] = 220
    VEHICLE_CMD_DO_GUIDED_MASTER: ClassVar[uint16] = 221
    VEHICLE_CMD_DO_GUIDED_LIMITS: ClassVar[uint16] = 222
    VEHICLE_CMD_DO_LAST: ClassVar[uint16] = 240
    VEHICLE_CMD_PREFLIGHT_CALIBRATION: ClassVar[uint16] = 241
    PREFLIGHT_CALIBRATION_TEMPERATURE_CALIBRATION: ClassVar[uint16] = 3
    VEHICLE_CMD_PREFLIGHT_SET_SENSOR_OFFSETS: ClassVar[uint16] = 242
    VEHICLE_CMD_PREFLIGHT_UAVCAN: ClassVar[uint16] = 243
    VEHICLE_CMD_PREFLIGHT_STORAGE: ClassVar[uint16] = 245
    VEHICLE_CMD_PREFLIGHT_REBOOT_SHUTDOWN: ClassVar[uint16] = 246
    VEHICLE_CMD_OBLIQUE_SURVEY: ClassVar[uint16] = 260
    VEHICLE_CMD_DO_SET_STANDARD_MODE: ClassVar[uint16] = 262
    VEHICLE_CMD_GIMBAL_DEVICE_INFORMATION: ClassVar[uint16] = 283
    VEHICLE_CMD_MISSION_START: ClassVar[uint16] = 300
    VEHICLE_CMD_ACTUATOR_TEST: ClassVar[uint16] = 310
    VEHICLE_CMD_CONFIGURE_ACTUATOR: ClassVar[uint16] = 311
    VEHICLE_CMD_COMPONENT_ARM_DISARM: ClassVar[uint16] = 400
    VEHICLE_CMD_RUN_PREARM_CHECKS: ClassVar[uint16] = 401
    VEHICLE_CMD_INJECT_FAILURE: ClassVar[uint16] = 420
    VEHICLE_CMD_START_RX_PAIR: ClassVar[uint16] = 500
    VEHICLE_CMD_REQUEST_MESSAGE: ClassVar[uint16] = 512
    VEHICLE_CMD_REQUEST_CAMERA_INFORMATION: ClassVar[uint16] = 521
    VEHICLE_CMD_SET_CAMERA_MODE: ClassVar[uint16] = 530
    VEHICLE_CMD_SET_CAMERA_ZOOM: ClassVar[uint16] = 531
    VEHICLE_CMD_SET_CAMERA_FOCUS: ClassVar[uint16] = 532
    VEHICLE_CMD_DO_GIMBAL_MANAGER_PITCHYAW: ClassVar[uint16] = 1000
    VEHICLE_CMD_DO_GIMBAL_MANAGER_CONFIGURE: ClassVar[uint16] = 1001
    VEHICLE_CMD_IMAGE_START_CAPTURE: ClassVar[uint16] = 2000
    VEHICLE_CMD_DO_TRIGGER_CONTROL: ClassVar[uint16] = 2003
    VEHICLE_CMD_VIDEO_START_CAPTURE: ClassVar[uint16] = 2500
    VEHICLE_CMD_VIDEO_STOP_CAPTURE: ClassVar[uint16] = 2501
    VEHICLE_CMD_LOGGING_START: ClassVar[uint16] = 2510
    VEHICLE_CMD_LOGGING_STOP: ClassVar[uint16] = 2511
    VEHICLE_CMD_CONTROL_HIGH_LATENCY: ClassVar[uint16] = 2600
    VEHICLE_CMD_DO_VTOL_TRANSITION: ClassVar[uint16] = 3000
    VEHICLE_CMD_ARM_AUTHORIZATION_REQUEST: ClassVar[uint16] = 3001
    VEHICLE_CMD_PAYLOAD_PREPARE_DEPLOY: ClassVar[uint16] = 30001
    VEHICLE_CMD_PAYLOAD_CONTROL_DEPLOY: ClassVar[uint16] = 30002
    VEHICLE_CMD_FIXED_MAG_CAL_YAW: ClassVar[uint16] = 42006
    VEHICLE_CMD_DO_WINCH: ClassVar[uint16] = 42600
    VEHICLE_CMD_EXTERNAL_POSITION_ESTIMATE: ClassVar[uint16] = 43003
    VEHICLE_CMD_PX4_INTERNAL_START: ClassVar[uint32] = 65537
    VEHICLE_CMD_SET_GPS_GLOBAL_ORIGIN: ClassVar[uint32] = 100000
    VEHICLE_CMD_SET_NAV_STATE: ClassVar[uint32] = 100001
    VEHICLE_MOUNT_MODE_RETRACT: ClassVar[uint8] = 0
    VEHICLE_MOUNT_MODE_NEUTRAL: ClassVar[uint8] = 1
    VEHICLE_MOUNT_MODE_MAVLINK_TARGETING: ClassVar[uint8] = 2
    VEHICLE_MOUNT_MODE_RC_TARGETING: ClassVar[uint8] = 3
    VEHICLE_MOUNT_MODE_GPS_POINT: ClassVar[uint8] = 4
    VEHICLE_MOUNT_MODE_ENUM_END: ClassVar[uint8] = 5
    VEHICLE_ROI_NONE: ClassVar[uint8] = 0
    VEHICLE_ROI_WPNEXT: ClassVar[uint8] = 1
    VEHICLE_ROI_WPINDEX: ClassVar[uint8] = 2
    VEHICLE_ROI_LOCATION: ClassVar[uint8] = 3
    VEHICLE_ROI_TARGET: ClassVar[uint8] = 4
    VEHICLE_ROI_ENUM_END: ClassVar[uint8] = 5
    PARACHUTE_ACTION_DISABLE: ClassVar[uint8] = 0
    PARACHUTE_ACTION_ENABLE: ClassVar[uint8] = 1
    PARACHUTE_ACTION_RELEASE: ClassVar[uint8] = 2
    FAILURE_UNIT_SENSOR_GYRO: ClassVar[uint8] = 0
    FAILURE_UNIT_SENSOR_ACCEL: ClassVar[uint8] = 1
    FAILURE_UNIT_SENSOR_MAG: ClassVar[uint8] = 2
    FAILURE_UNIT_SENSOR_BARO: ClassVar[uint8] = 3
    FAILURE_UNIT_SENSOR_GPS: ClassVar[uint8] = 4
    FAILURE_UNIT_SENSOR_OPTICAL_FLOW: ClassVar[uint8] = 5
    FAILURE_UNIT_SENSOR_VIO: ClassVar[uint8] = 6
    FAILURE_UNIT_SENSOR_DISTANCE_SENSOR: ClassVar[uint8] = 7
    FAILURE_UNIT_SENSOR_AIRSPEED: ClassVar[uint8] = 8
    FAILURE_UNIT_SYSTEM_BATTERY: ClassVar[uint8] = 100
    FAILURE_UNIT_SYSTEM_MOTOR: ClassVar[uint8] = 101
    FAILURE_UNIT_SYSTEM_SERVO: ClassVar[uint8] = 102
    FAILURE_UNIT_SYSTEM_AVOIDANCE: ClassVar[uint8] = 103
    FAILURE_UNIT_SYSTEM_RC_SIGNAL: ClassVar[uint8] = 104
    FAILURE_UNIT_SYSTEM_MAVLINK_SIGNAL: ClassVar[uint8] = 105
    FAILURE_TYPE_OK: ClassVar[uint8] = 0
    FAILURE_TYPE_OFF: ClassVar[uint8] = 1
    FAILURE_TYPE_STUCK: ClassVar[uint8] = 2
    FAILURE_TYPE_GARBAGE: ClassVar[uint8] = 3
    FAILURE_TYPE_WRONG: ClassVar[uint8] = 4
    FAILURE_TYPE_SLOW: ClassVar[uint8] = 5
    FAILURE_TYPE_DELAYED: ClassVar[uint8] = 6
    FAILURE_TYPE_INTERMITTENT: ClassVar[uint8] = 7
    SPEED_TYPE_AIRSPEED: ClassVar[uint8] = 0
    SPEED_TYPE_GROUNDSPEED: ClassVar[uint8] = 1
    SPEED_TYPE_CLIMB_SPEED: ClassVar[uint8] = 2
    SPEED_TYPE_DESCEND_SPEED: ClassVar[uint8] = 3
    ARMING_ACTION_DISARM: ClassVar[int8] = 0
    ARMING_ACTION_ARM: ClassVar[int8] = 1
    GRIPPER_ACTION_RELEASE: ClassVar[uint8] = 0
    GRIPPER_ACTION_GRAB: ClassVar[uint8] = 1
    ORB_QUEUE_LENGTH: ClassVar[uint8] = 8
    COMPONENT_MODE_EXECUTOR_START: ClassVar[uint16] = 1000

    timestamp: uint64 = 0
    param1: float32 = 0.0
    param2: float32 = 0.0
    param3: float32 = 0.0
    param4: float32 = 0.0
    param5: float64 = 0.0
    param6: float64 = 0.0
    param7: float32 = 0.0
    command: uint32 = 0
    target_system: uint8 = 0
    target_component: uint8 = 0
    source_system: uint8 = 0
    source_component: uint16 = 0
    confirmation: uint8 = 0
    from_external: bool = False


class VehicleCommandAck(Message, typename="px4_msgs/msg/VehicleCommandAck"):
    """VehicleCommandAck, as PX4 1.15 defines it."""

    VEHICLE_CMD_RESULT_ACCEPTED: ClassVar[uint8] = 0
    VEHICLE_CMD_RESULT_TEMPORARILY_REJECTED: ClassVar[uint8] = 1
    VEHICLE_CMD_RESULT_DENIED: ClassVar[uint8] = 2
    VEHICLE_CMD_RESULT_UNSUPPORTED: ClassVar[uint8] = 3
    VEHICLE_CMD_RESULT_FAILED: ClassVar[uint8] = 4
    VEHICLE_CMD_RESULT_IN_PROGRESS: ClassVar[uint8] = 5
    VEHICLE_CMD_RESULT_CANCELLED: ClassVar[uint8] = 6
    ARM_AUTH_DENIED_REASON_GENERIC: ClassVar[uint16] = 0
    ARM_AUTH_DENIED_REASON_NONE: ClassVar[uint16] = 1
    ARM_AUTH_DENIED_REASON_INVALID_WAYPOINT: ClassVar[uint16] = 2
    ARM_AUTH_DENIED_REASON_TIMEOUT: ClassVar[uint16] = 3
    ARM_AUTH_DENIED_REASON_AIRSPACE_IN_USE: ClassVar[uint16] = 4
    ARM_AUTH_DENIED_REASON_BAD_WEATHER: ClassVar[uint16] = 5
    ORB_QUEUE_LENGTH: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    command: uint32 = 0
    result: uint8 = 0
    result_param1: uint8 = 0
    result_param2: int32 = 0
    target_system: uint8 = 0
    target_component: uint16 = 0
    from_external: bool = False


class VehicleConstraints(Message, typename="px4_msgs/msg/VehicleConstraints"):
    """VehicleConstraints, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    speed_up: float32 = 0.0
    speed_down: float32 = 0.0
    want_takeoff: bool = False


class VehicleControlMode(Message, typename="px4_msgs/msg/VehicleControlMode"):
    """VehicleControlMode, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    flag_armed: bool = False
    flag_multicopter_position_control_enabled: bool = False
    flag_control_manual_enabled: bool = False
    flag_control_auto_enabled: bool = False
    flag_control_offboard_enabled: bool = False
    flag_control_position_enabled: bool = False
    flag_control_velocity_enabled: bool = False
    flag_control_altitude_enabled: bool = False
    flag_control_climb_rate_enabled: bool = False
    flag_control_acceleration_enabled: bool = False
    flag_control_attitude_enabled: bool = False
    flag_control_rates_enabled: bool = False
    flag_control_allocation_enabled: bool = False
    flag_control_termination_enabled: bool = False
    source_id: uint8 = 0


class VehicleGlobalPosition(Message, typename="px4_msgs/msg/VehicleGlobalPosition"):
    """VehicleGlobalPosition, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    lat: float64 = 0.0
    lon: float64 = 0.0
    alt: float32 = 0.0
    alt_ellipsoid: float32 = 0.0
    delta_alt: float32 = 0.0
    lat_lon_reset_counter: uint8 = 0
    alt_reset_counter: uint8 = 0
    eph: float32 = 0.0
    epv: float32 = 0.0
    terrain_alt: float32 = 0.0
    terrain_alt_valid: bool = False
    dead_reckoning: bool = False


class VehicleImu(Message, typename="px4_msgs/msg/VehicleImu"):
    """VehicleImu, as PX4 1.15 defines it."""

    CLIPPING_X: ClassVar[uint8] = 1
    CLIPPING_Y: ClassVar[uint8] = 2
    CLIPPING_Z: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    accel_device_id: uint32 = 0
    gyro_device_id: uint32 = 0
    delta_angle: Annotated[Floats, Array[float32, 3]] = DEFAULT
    delta_velocity: Annotated[Floats, Array[float32, 3]] = DEFAULT
    delta_angle_dt: uint16 = 0
    delta_velocity_dt: uint16 = 0
    delta_angle_clipping: uint8 = 0
    delta_velocity_clipping: uint8 = 0
    accel_calibration_count: uint8 = 0
    gyro_calibration_count: uint8 = 0


class VehicleImuStatus(Message, typename="px4_msgs/msg/VehicleImuStatus"):
    """VehicleImuStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    accel_device_id: uint32 = 0
    gyro_device_id: uint32 = 0
    accel_clipping: Annotated[Ints, Array[uint32, 3]] = DEFAULT
    gyro_clipping: Annotated[Ints, Array[uint32, 3]] = DEFAULT
    accel_error_count: uint32 = 0
    gyro_error_count: uint32 = 0
    accel_rate_hz: float32 = 0.0
    gyro_rate_hz: float32 = 0.0
    accel_raw_rate_hz: float32 = 0.0
    gyro_raw_rate_hz: float32 = 0.0
    accel_vibration_metric: float32 = 0.0
    gyro_vibration_metric: float32 = 0.0
    delta_angle_coning_metric: float32 = 0.0
    mean_accel: Annotated[Floats, Array[float32, 3]] = DEFAULT
    mean_gyro: Annotated[Floats, Array[float32, 3]] = DEFAULT
    var_accel: Annotated[Floats, Array[float32, 3]] = DEFAULT
    var_gyro: Annotated[Floats, Array[float32, 3]] = DEFAULT
    temperature_accel: float32 = 0.0
    temperature_gyro: float32 = 0.0


class VehicleLandDetected(Message, typename="px4_msgs/msg/VehicleLandDetected"):
    """VehicleLandDetected, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    freefall: bool = False
    ground_contact: bool = False
    maybe_landed: bool = False
    landed: bool = False
    in_ground_effect: bool = False
    in_descend: bool = False
    has_low_throttle: bool = False
    vertical_movement: bool = False
    horizontal_movement: bool = False
    rotational_movement: bool = False
    close_to_ground_or_skipped_check: bool = False
    at_rest: bool = False


class VehicleLocalPosition(Message, typename="px4_msgs/msg/VehicleLocalPosition"):
    """VehicleLocalPosition, as PX4 1.15 defines it."""

    DIST_BOTTOM_SENSOR_NONE: ClassVar[uint8] = 0
    DIST_BOTTOM_SENSOR_RANGE: ClassVar[uint8] = 1
    DIST_BOTTOM_SENSOR_FLOW: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    xy_valid: bool = False
    z_valid: bool = False
    v_xy_valid: bool = False
    v_z_valid: bool = False
    x: float32 = 0.0
    y: float32 = 0.0
    z: float32 = 0.0
    delta_xy: Annotated[Floats, Array[float32, 2]] = DEFAULT
    xy_reset_counter: uint8 = 0
    delta_z: float32 = 0.0
    z_reset_counter: uint8 = 0
    vx: float32 = 0.0
    vy: float32 = 0.0
    vz: float32 = 0.0
    z_deriv: float32 = 0.0
    delta_vxy: Annotated[Floats, Array[float32, 2]] = DEFAULT
    vxy_reset_counter: uint8 = 0
    delta_vz: float32 = 0.0
    vz_reset_counter: uint8 = 0
    ax: float32 = 0.0
    ay: float32 = 0.0
    az: float32 = 0.0
    heading: float32 = 0.0
    heading_var: float32 = 0.0
    unaided_heading: float32 = 0.0
    delta_heading: float32 = 0.0
    heading_reset_counter: uint8 = 0
    heading_good_for_control: bool = False
    tilt_var: float32 = 0.0
    xy_global: bool = False
    z_global: bool = False
    ref_timestamp: uint64 = 0
    ref_lat: float64 = 0.0
    ref_lon: float64 = 0.0
    ref_alt: float32 = 0.0
    dist_bottom: float32 = 0.0
    dist_bottom_valid: bool = False
    dist_bottom_sensor_bitfield: uint8 = 0
    eph: float32 = 0.0
    epv: float32 = 0.0
    evh: float32 = 0.0
    evv: float32 = 0.0
    dead_reckoning: bool = False
    vxy_max: float32 = 0.0
    vz_max: float32 = 0.0
    hagl_min: float32 = 0.0
    hagl_max: float32 = 0.0


class VehicleLocalPositionSetpoint(Message, typename="px4_msgs/msg/VehicleLocalPositionSetpoint"):
    """VehicleLocalPositionSetpoint, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    x: float32 = 0.0
    y: float32 = 0.0
    z: float32 = 0.0
    vx: float32 = 0.0
    vy: float32 = 0.0
    vz: float32 = 0.0
    acceleration: Annotated[Floats, Array[float32, 3]] = DEFAULT
    thrust: Annotated[Floats, Array[float32, 3]] = DEFAULT
    yaw: float32 = 0.0
    yawspeed: float32 = 0.0


class VehicleMagnetometer(Message, typename="px4_msgs/msg/VehicleMagnetometer"):
    """VehicleMagnetometer, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    magnetometer_ga: Annotated[Floats, Array[float32, 3]] = DEFAULT
    calibration_count: uint8 = 0


class VehicleOdometry(Message, typename="px4_msgs/msg/VehicleOdometry"):
    """VehicleOdometry, as PX4 1.15 defines it."""

    POSE_FRAME_UNKNOWN: ClassVar[uint8] = 0
    POSE_FRAME_NED: ClassVar[uint8] = 1
    POSE_FRAME_FRD: ClassVar[uint8] = 2
    VELOCITY_FRAME_UNKNOWN: ClassVar[uint8] = 0
    VELOCITY_FRAME_NED: ClassVar[uint8] = 1
    VELOCITY_FRAME_FRD: ClassVar[uint8] = 2
    VELOCITY_FRAME_BODY_FRD: ClassVar[uint8] = 3

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    pose_frame: uint8 = 0
    position: Annotated[Floats, Array[float32, 3]] = DEFAULT
    q: Annotated[Floats, Array[float32, 4]] = DEFAULT
    velocity_frame: uint8 = 0
    velocity: Annotated[Floats, Array[float32, 3]] = DEFAULT
    angular_velocity: Annotated[Floats, Array[float32, 3]] = DEFAULT
    position_variance: Annotated[Floats, Array[float32, 3]] = DEFAULT
    orientation_variance: Annotated[Floats, Array[float32, 3]] = DEFAULT
    velocity_variance: Annotated[Floats, Array[float32, 3]] = DEFAULT
    reset_counter: uint8 = 0
    quality: int8 = 0


class VehicleOpticalFlow(Message, typename="px4_msgs/msg/VehicleOpticalFlow"):
    """VehicleOpticalFlow, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    device_id: uint32 = 0
    pixel_flow: Annotated[Floats, Array[float32, 2]] = DEFAULT
    delta_angle: Annotated[Floats, Array[float32, 3]] = DEFAULT
    distance_m: float32 = 0.0
    integration_timespan_us: uint32 = 0
    quality: uint8 = 0
    max_flow_rate: float32 = 0.0
    min_ground_distance: float32 = 0.0
    max_ground_distance: float32 = 0.0


class VehicleOpticalFlowVel(Message, typename="px4_msgs/msg/VehicleOpticalFlowVel"):
    """VehicleOpticalFlowVel, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    vel_body: Annotated[Floats, Array[float32, 2]] = DEFAULT
    vel_ne: Annotated[Floats, Array[float32, 2]] = DEFAULT
    flow_rate_uncompensated: Annotated[Floats, Array[float32, 2]] = DEFAULT
    flow_rate_compensated: Annotated[Floats, Array[float32, 2]] = DEFAULT
    gyro_rate: Annotated[Floats, Array[float32, 3]] = DEFAULT
    gyro_bias: Annotated[Floats, Array[float32, 3]] = DEFAULT
    ref_gyro: Annotated[Floats, Array[float32, 3]] = DEFAULT


class VehicleRatesSetpoint(Message, typename="px4_msgs/msg/VehicleRatesSetpoint"):
    """VehicleRatesSetpoint, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    roll: float32 = 0.0
    pitch: float32 = 0.0
    yaw: float32 = 0.0
    thrust_body: Annotated[Floats, Array[float32, 3]] = DEFAULT
    reset_integral: bool = False


class VehicleRoi(Message, typename="px4_msgs/msg/VehicleRoi"):
    """VehicleRoi, as PX4 1.15 defines it."""

    ROI_NONE: ClassVar[uint8] = 0
    ROI_WPNEXT: ClassVar[uint8] = 1
    ROI_WPINDEX: ClassVar[uint8] = 2
    ROI_LOCATION: ClassVar[uint8] = 3
    ROI_TARGET: ClassVar[uint8] = 4
    ROI_ENUM_END: ClassVar[uint8] = 5

    timestamp: uint64 = 0
    mode: uint8 = 0
    lat: float64 = 0.0
    lon: float64 = 0.0
    alt: float32 = 0.0
    roll_offset: float32 = 0.0
    pitch_offset: float32 = 0.0
    yaw_offset: float32 = 0.0


class VehicleStatus(Message, typename="px4_msgs/msg/VehicleStatus"):
    """VehicleStatus, as PX4 1.15 defines it."""

    ARMING_STATE_DISARMED: ClassVar[uint8] = 1
    ARMING_STATE_ARMED: ClassVar[uint8] = 2
    ARM_DISARM_REASON_TRANSITION_TO_STANDBY: ClassVar[uint8] = 0
    ARM_DISARM_REASON_RC_STICK: ClassVar[uint8] = 1
    ARM_DISARM_REASON_RC_SWITCH: ClassVar[uint8] = 2
    ARM_DISARM_REASON_COMMAND_INTERNAL: ClassVar[uint8] = 3
    ARM_DISARM_REASON_COMMAND_EXTERNAL: ClassVar[uint8] = 4
    ARM_DISARM_REASON_MISSION_START: ClassVar[uint8] = 5
    ARM_DISARM_REASON_SAFETY_BUTTON: ClassVar[uint8] = 6
    ARM_DISARM_REASON_AUTO_DISARM_LAND: ClassVar[uint8] = 7
    ARM_DISARM_REASON_AUTO_DISARM_PREFLIGHT: ClassVar[uint8] = 8
    ARM_DISARM_REASON_KILL_SWITCH: ClassVar[uint8] = 9
    ARM_DISARM_REASON_LOCKDOWN: ClassVar[uint8] = 10
    ARM_DISARM_REASON_FAILURE_DETECTOR: ClassVar[uint8] = 11
    ARM_DISARM_REASON_SHUTDOWN: ClassVar[uint8] = 12
    ARM_DISARM_REASON_UNIT_TEST: ClassVar[uint8] = 13
    NAVIGATION_STATE_MANUAL: ClassVar[uint8] = 0
    NAVIGATION_STATE_ALTCTL: ClassVar[uint8] = 1
    NAVIGATION_STATE_POSCTL: ClassVar[uint8] = 2
    NAVIGATION_STATE_AUTO_MISSION: ClassVar[uint8] = 3
    NAVIGATION_STATE_AUTO_LOITER: ClassVar[uint8] = 4
    NAVIGATION_STATE_AUTO_RTL: ClassVar[uint8] = 5
    NAVIGATION_STATE_POSITION_SLOW: ClassVar[uint8] = 6
    NAVIGATION_STATE_FREE5: ClassVar[uint8] = 7
    NAVIGATION_STATE_FREE4: ClassVar[uint8] = 8
    NAVIGATION_STATE_FREE3: ClassVar[uint8] = 9
    NAVIGATION_STATE_ACRO: ClassVar[uint8] = 10
    NAVIGATION_STATE_FREE2: ClassVar[uint8] = 11
    NAVIGATION_STATE_DESCEND: ClassVar[uint8] = 12
    NAVIGATION_STATE_TERMINATION: ClassVar[uint8] = 13
    NAVIGATION_STATE_OFFBOARD: ClassVar[uint8] = 14
    NAVIGATION_STATE_STAB: ClassVar[uint8] = 15
    NAVIGATION_STATE_FREE1: ClassVar[uint8] = 16
    NAVIGATION_STATE_AUTO_TAKEOFF: ClassVar[uint8] = 17
    NAVIGATION_STATE_AUTO_LAND: ClassVar[uint8] = 18
    NAVIGATION_STATE_AUTO_FOLLOW_TARGET: ClassVar[uint8] = 19
    NAVIGATION_STATE_AUTO_PRECLAND: ClassVar[uint8] = 20
    NAVIGATION_STATE_ORBIT: ClassVar[uint8] = 21
    NAVIGATION_STATE_AUTO_VTOL_TAKEOFF: ClassVar[uint8] = 22
    NAVIGATION_STATE_EXTERNAL1: ClassVar[uint8] = 23
    NAVIGATION_STATE_EXTERNAL2: ClassVar[uint8] = 24
    NAVIGATION_STATE_EXTERNAL3: ClassVar[uint8] = 25
    NAVIGATION_STATE_EXTERNAL4: ClassVar[uint8] = 26
    NAVIGATION_STATE_EXTERNAL5: ClassVar[uint8] = 27
    NAVIGATION_STATE_EXTERNAL6: ClassVar[uint8] = 28
    NAVIGATION_STATE_EXTERNAL7: ClassVar[uint8] = 29
    NAVIGATION_STATE_EXTERNAL8: ClassVar[uint8] = 30
    NAVIGATION_STATE_MAX: ClassVar[uint8] = 31
    FAILURE_NONE: ClassVar[uint16] = 0
    FAILURE_ROLL: ClassVar[uint16] = 1
    FAILURE_PITCH: ClassVar[uint16] = 2
    FAILURE_ALT: ClassVar[uint16] = 4
    FAILURE_EXT: ClassVar[uint16] = 8
    FAILURE_ARM_ESC: ClassVar[uint16] = 16
    FAILURE_BATTERY: ClassVar[uint16] = 32
    FAILURE_IMBALANCED_PROP: ClassVar[uint16] = 64
    FAILURE_MOTOR: ClassVar[uint16] = 128
    HIL_STATE_OFF: ClassVar[uint8] = 0
    HIL_STATE_ON: ClassVar[uint8] = 1
    VEHICLE_TYPE_UNKNOWN: ClassVar[uint8] = 0
    VEHICLE_TYPE_ROTARY_WING: ClassVar[uint8] = 1
    VEHICLE_TYPE_FIXED_WING: ClassVar[uint8] = 2
    VEHICLE_TYPE_ROVER: ClassVar[uint8] = 3
    VEHICLE_TYPE_AIRSHIP: ClassVar[uint8] = 4
    FAILSAFE_DEFER_STATE_DISABLED: ClassVar[uint8] = 0
    FAILSAFE_DEFER_STATE_ENABLED: ClassVar[uint8] = 1
    FAILSAFE_DEFER_STATE_WOULD_FAILSAFE: ClassVar[uint8] = 2

    timestamp: uint64 = 0
    armed_time: uint64 = 0
    takeoff_time: uint64 = 0
    arming_state: uint8 = 0
    latest_arming_reason: uint8 = 0
    latest_disarming_reason: uint8 = 0
    nav_state_timestamp: uint64 = 0
    nav_state_user_intention: uint8 = 0
    nav_state: uint8 = 0
    executor_in_charge: uint8 = 0
    valid_nav_states_mask: uint32 = 0
    can_set_nav_states_mask: uint32 = 0
    failure_detector_status: uint16 = 0
    hil_state: uint8 = 0
    vehicle_type: uint8 = 0
    failsafe: bool = False
    failsafe_and_user_took_over: bool = False
    failsafe_defer_state: uint8 = 0
    gcs_connection_lost: bool = False
    gcs_connection_lost_counter: uint8 = 0
    high_latency_data_link_lost: bool = False
    is_vtol: bool = False
    is_vtol_tailsitter: bool = False
    in_transition_mode: bool = False
    in_transition_to_fw: bool = False
    system_type: uint8 = 0
    system_id: uint8 = 0
    component_id: uint8 = 0
    safety_button_available: bool = False
    safety_off: bool = False
    power_input_valid: bool = False
    usb_connected: bool = False
    open_drone_id_system_present: bool = False
    open_drone_id_system_healthy: bool = False
    parachute_system_present: bool = False
    parachute_system_healthy: bool = False
    avoidance_system_required: bool = False
    avoidance_system_valid: bool = False
    rc_calibration_in_progress: bool = False
    calibration_enabled: bool = False
    pre_flight_checks_pass: bool = False


class VehicleThrustSetpoint(Message, typename="px4_msgs/msg/VehicleThrustSetpoint"):
    """VehicleThrustSetpoint, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    xyz: Annotated[Floats, Array[float32, 3]] = DEFAULT


class VehicleTorqueSetpoint(Message, typename="px4_msgs/msg/VehicleTorqueSetpoint"):
    """VehicleTorqueSetpoint, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    xyz: Annotated[Floats, Array[float32, 3]] = DEFAULT


class VehicleTrajectoryBezier(Message, typename="px4_msgs/msg/VehicleTrajectoryBezier"):
    """VehicleTrajectoryBezier, as PX4 1.15 defines it."""

    POINT_0: ClassVar[uint8] = 0
    POINT_1: ClassVar[uint8] = 1
    POINT_2: ClassVar[uint8] = 2
    POINT_3: ClassVar[uint8] = 3
    POINT_4: ClassVar[uint8] = 4
    NUMBER_POINTS: ClassVar[uint8] = 5

    timestamp: uint64 = 0
    control_points: Annotated[list[TrajectoryBezier], Array[TrajectoryBezier, 5]] = DEFAULT
    bezier_order: uint8 = 0


class VehicleTrajectoryWaypoint(Message, typename="px4_msgs/msg/VehicleTrajectoryWaypoint"):
    """VehicleTrajectoryWaypoint, as PX4 1.15 defines it."""

    MAV_TRAJECTORY_REPRESENTATION_WAYPOINTS: ClassVar[uint8] = 0
    POINT_0: ClassVar[uint8] = 0
    POINT_1: ClassVar[uint8] = 1
    POINT_2: ClassVar[uint8] = 2
    POINT_3: ClassVar[uint8] = 3
    POINT_4: ClassVar[uint8] = 4
    NUMBER_POINTS: ClassVar[uint8] = 5

    timestamp: uint64 = 0
    type: uint8 = 0
    waypoints: Annotated[list[TrajectoryWaypoint], Array[TrajectoryWaypoint, 5]] = DEFAULT


class VelocityLimits(Message, typename="px4_msgs/msg/VelocityLimits"):
    """VelocityLimits, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    horizontal_velocity: float32 = 0.0
    vertical_velocity: float32 = 0.0
    yaw_rate: float32 = 0.0


class VtolVehicleStatus(Message, typename="px4_msgs/msg/VtolVehicleStatus"):
    """VtolVehicleStatus, as PX4 1.15 defines it."""

    VEHICLE_VTOL_STATE_UNDEFINED: ClassVar[uint8] = 0
    VEHICLE_VTOL_STATE_TRANSITION_TO_FW: ClassVar[uint8] = 1
    VEHICLE_VTOL_STATE_TRANSITION_TO_MC: ClassVar[uint8] = 2
    VEHICLE_VTOL_STATE_MC: ClassVar[uint8] = 3
    VEHICLE_VTOL_STATE_FW: ClassVar[uint8] = 4

    timestamp: uint64 = 0
    vehicle_vtol_state: uint8 = 0
    fixed_wing_system_failure: bool = False


class WheelEncoders(Message, typename="px4_msgs/msg/WheelEncoders"):
    """WheelEncoders, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    wheel_speed: Annotated[Floats, Array[float32, 2]] = DEFAULT
    wheel_angle: Annotated[Floats, Array[float32, 2]] = DEFAULT


class Wind(Message, typename="px4_msgs/msg/Wind"):
    """Wind, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    windspeed_north: float32 = 0.0
    windspeed_east: float32 = 0.0
    variance_north: float32 = 0.0
    variance_east: float32 = 0.0
    tas_innov: float32 = 0.0
    tas_innov_var: float32 = 0.0
    beta_innov: float32 = 0.0
    beta_innov_var: float32 = 0.0


class YawEstimatorStatus(Message, typename="px4_msgs/msg/YawEstimatorStatus"):
    """YawEstimatorStatus, as PX4 1.15 defines it."""

    timestamp: uint64 = 0
    timestamp_sample: uint64 = 0
    yaw_composite: float32 = 0.0
    yaw_variance: float32 = 0.0
    yaw_composite_valid: bool = False
    yaw: Annotated[Floats, Array[float32, 5]] = DEFAULT
    innov_vn: Annotated[Floats, Array[float32, 5]] = DEFAULT
    innov_ve: Annotated[Floats, Array[float32, 5]] = DEFAULT
    weight: Annotated[Floats, Array[float32, 5]] = DEFAULT
