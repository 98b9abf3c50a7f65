"""Messages of rmf_fleet_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import (
    DEFAULT,
    Ints,
    Message,
    Sequence,
    float32,
    float64,
    uint8,
    uint32,
    uint64,
)

__all__ = [
    "BeaconState",
    "ChargingAssignment",
    "ChargingAssignments",
    "ClosedLanes",
    "DeliveryAlert",
    "DeliveryAlertAction",
    "DeliveryAlertCategory",
    "DeliveryAlertTier",
    "DestinationRequest",
    "Dock",
    "DockParameter",
    "DockSummary",
    "FleetState",
    "InterruptRequest",
    "LaneRequest",
    "LaneStates",
    "Location",
    "ModeParameter",
    "ModeRequest",
    "MutexGroupAssignment",
    "MutexGroupManualRelease",
    "MutexGroupRequest",
    "MutexGroupStates",
    "PathRequest",
    "PauseRequest",
    "RobotMode",
    "RobotState",
    "SpeedLimitRequest",
    "SpeedLimitedLane",
]


class BeaconState(Message, typename="rmf_fleet_msgs/msg/BeaconState"):
    """BeaconState, as Open-RMF defines it."""

    id: str = ""
    online: bool = False
    category: str = ""
    activated: bool = False
    level: str = ""


class ChargingAssignment(Message, typename="rmf_fleet_msgs/msg/ChargingAssignment"):
    """ChargingAssignment, as Open-RMF defines it."""

    MODE_CHARGE: ClassVar[uint8] = 0
    MODE_WAIT: ClassVar[uint8] = 1

    robot_name: str = ""
    waypoint_name: str = ""
    mode: uint8 = 0


class ChargingAssignments(Message, typename="rmf_fleet_msgs/msg/ChargingAssignments"):
    """ChargingAssignments, as Open-RMF defines it."""

    fleet_name: str = ""
    assignments: Annotated[list[ChargingAssignment], Sequence[ChargingAssignment]] = DEFAULT


class ClosedLanes(Message, typename="rmf_fleet_msgs/msg/ClosedLanes"):
    """ClosedLanes, as Open-RMF defines it."""

    fleet_name: str = ""
    closed_lanes: Annotated[Ints, Sequence[uint64]] = DEFAULT


class DeliveryAlertCategory(Message, typename="rmf_fleet_msgs/msg/DeliveryAlertCategory"):
    """DeliveryAlertCategory, as Open-RMF defines it."""

    MISSING: ClassVar[uint32] = 0
    WRONG: ClassVar[uint32] = 1
    OBSTRUCTED: ClassVar[uint32] = 2
    CANCELLED: ClassVar[uint32] = 3

    value: uint32 = 0


class DeliveryAlertTier(Message, typename="rmf_fleet_msgs/msg/DeliveryAlertTier"):
    """DeliveryAlertTier, as Open-RMF defines it."""

    WARNING: ClassVar[uint32] = 0
    ERROR: ClassVar[uint32] = 1

    value: uint32 = 0


class DeliveryAlertAction(Message, typename="rmf_fleet_msgs/msg/DeliveryAlertAction"):
    """DeliveryAlertAction, as Open-RMF defines it."""

    WAITING: ClassVar[uint32] = 0
    CANCEL: ClassVar[uint32] = 1
    OVERRIDE: ClassVar[uint32] = 2
    RESUME: ClassVar[uint32] = 3

    value: uint32 = 0


class DeliveryAlert(Message, typename="rmf_fleet_msgs/msg/DeliveryAlert"):
    """DeliveryAlert, as Open-RMF defines it."""

    id: str = ""
    category: DeliveryAlertCategory = DEFAULT
    tier: DeliveryAlertTier = DEFAULT
    task_id: str = ""
    action: DeliveryAlertAction = DEFAULT
    message: str = ""


class Location(Message, typename="rmf_fleet_msgs/msg/Location"):
    """Location, as Open-RMF defines it."""

    t: Time = DEFAULT
    x: float32 = 0.0
    y: float32 = 0.0
    yaw: float32 = 0.0
    obey_approach_speed_limit: bool = False
    approach_speed_limit: float32 = 0.0
    level_name: str = ""
    index: uint64 = 0


class DestinationRequest(Message, typename="rmf_fleet_msgs/msg/DestinationRequest"):
    """DestinationRequest, as Open-RMF defines it."""

    fleet_name: str = ""
    robot_name: str = ""
    destination: Location = DEFAULT
    task_id: str = ""


class DockParameter(Message, typename="rmf_fleet_msgs/msg/DockParameter"):
    """DockParameter, as Open-RMF defines it."""

    start: str = ""
    finish: str = ""
    path: Annotated[list[Location], Sequence[Location]] = DEFAULT


class Dock(Message, typename="rmf_fleet_msgs/msg/Dock"):
    """Dock, as Open-RMF defines it."""

    fleet_name: str = ""
    params: Annotated[list[DockParameter], Sequence[DockParameter]] = DEFAULT


class DockSummary(Message, typename="rmf_fleet_msgs/msg/DockSummary"):
    """DockSummary, as Open-RMF defines it."""

    docks: Annotated[list[Dock], Sequence[Dock]] = DEFAULT


class RobotMode(Message, typename="rmf_fleet_msgs/msg/RobotMode"):
    """RobotMode, as Open-RMF defines it."""

    MODE_IDLE: ClassVar[uint32] = 0
    MODE_CHARGING: ClassVar[uint32] = 1
    MODE_MOVING: ClassVar[uint32] = 2
    MODE_PAUSED: ClassVar[uint32] = 3
    MODE_WAITING: ClassVar[uint32] = 4
    MODE_EMERGENCY: ClassVar[uint32] = 5
    MODE_GOING_HOME: ClassVar[uint32] = 6
    MODE_DOCKING: ClassVar[uint32] = 7
    MODE_ADAPTER_ERROR: ClassVar[uint32] = 8
    MODE_CLEANING: ClassVar[uint32] = 9

    mode: uint32 = 0
    mode_request_id: uint64 = 0


class RobotState(Message, typename="rmf_fleet_msgs/msg/RobotState"):
    """RobotState, as Open-RMF defines it."""

    name: str = ""
    model: str = ""
    task_id: str = ""
    seq: uint64 = 0
    mode: RobotMode = DEFAULT
    battery_percent: float32 = 0.0
    location: Location = DEFAULT
    path: Annotated[list[Location], Sequence[Location]] = DEFAULT


class FleetState(Message, typename="rmf_fleet_msgs/msg/FleetState"):
    """FleetState, as Open-RMF defines it."""

    name: str = ""
    robots: Annotated[list[RobotState], Sequence[RobotState]] = DEFAULT


class InterruptRequest(Message, typename="rmf_fleet_msgs/msg/InterruptRequest"):
    """InterruptRequest, as Open-RMF defines it."""

    TYPE_INTERRUPT: ClassVar[uint8] = 0
    TYPE_RESUME: ClassVar[uint8] = 1

    fleet_name: str = ""
    robot_name: str = ""
    interrupt_id: str = ""
    labels: Annotated[list[str], Sequence[str]] = DEFAULT
    type: uint8 = 0


class LaneRequest(Message, typename="rmf_fleet_msgs/msg/LaneRequest"):
    """LaneRequest, as Open-RMF defines it."""

    fleet_name: str = ""
    open_lanes: Annotated[Ints, Sequence[uint64]] = DEFAULT
    close_lanes: Annotated[Ints, Sequence[uint64]] = DEFAULT


class SpeedLimitedLane(Message, typename="rmf_fleet_msgs/msg/SpeedLimitedLane"):
    """SpeedLimitedLane, as Open-RMF defines it."""

    lane_index: uint64 = 0
    speed_limit: float64 = 0.0


class LaneStates(Message, typename="rmf_fleet_msgs/msg/LaneStates"):
    """LaneStates, as Open-RMF defines it."""

    fleet_name: str = ""
    closed_lanes: Annotated[Ints, Sequence[uint64]] = DEFAULT
    speed_limits: Annotated[list[SpeedLimitedLane], Sequence[SpeedLimitedLane]] = DEFAULT


class ModeParameter(Message, typename="rmf_fleet_msgs/msg/ModeParameter"):
    """ModeParameter, as Open-RMF defines it."""

    name: str = ""
    value: str = ""


class ModeRequest(Message, typename="rmf_fleet_msgs/msg/ModeRequest"):
    """ModeRequest, as Open-RMF defines it."""

    fleet_name: str = ""
    robot_name: str = ""
    mode: RobotMode = DEFAULT
    task_id: str = ""
    parameters: Annotated[list[ModeParameter], Sequence[ModeParameter]] = DEFAULT


class MutexGroupAssignment(Message, typename="rmf_fleet_msgs/msg/MutexGroupAssignment"):
    """MutexGroupAssignment, as Open-RMF defines it."""

    group: str = ""
    claimant: uint64 = 0
    claim_time: Time = DEFAULT


class MutexGroupManualRelease(Message, typename="rmf_fleet_msgs/msg/MutexGroupManualRelease"):
    """MutexGroupManualRelease, as Open-RMF defines it."""

    release_mutex_groups: Annotated[list[str], Sequence[str]] = DEFAULT
    fleet: str = ""
    robot: str = ""


class MutexGroupRequest(Message, typename="rmf_fleet_msgs/msg/MutexGroupRequest"):
    """MutexGroupRequest, as Open-RMF defines it."""

    MODE_RELEASE: ClassVar[uint32] = 0
    MODE_LOCK: ClassVar[uint32] = 1

    group: str = ""
    claimant: uint64 = 0
    claim_time: Time = DEFAULT
    mode: uint32 = 0


class MutexGroupStates(Message, typename="rmf_fleet_msgs/msg/MutexGroupStates"):
    """MutexGroupStates, as Open-RMF defines it."""

    assignments: Annotated[list[MutexGroupAssignment], Sequence[MutexGroupAssignment]] = DEFAULT


class PathRequest(Message, typename="rmf_fleet_msgs/msg/PathRequest"):
    """PathRequest, as Open-RMF defines it."""

    fleet_name: str = ""
    robot_name: str = ""
    path: Annotated[list[Location], Sequence[Location]] = DEFAULT
    task_id: str = ""


class PauseRequest(Message, typename="rmf_fleet_msgs/msg/PauseRequest"):
    """PauseRequest, as Open-RMF defines it."""

    TYPE_PAUSE_IMMEDIATELY: ClassVar[uint32] = 0
    TYPE_PAUSE_AT_CHECKPOINT: ClassVar[uint32] = 1
    TYPE_RESUME: ClassVar[uint32] = 2

    fleet_name: str = ""
    robot_name: str = ""
    mode_request_id: uint64 = 0
    type: uint32 = 0
    at_checkpoint: uint32 = 0


class SpeedLimitRequest(Message, typename="rmf_fleet_msgs/msg/SpeedLimitRequest"):
    """SpeedLimitRequest, as Open-RMF defines it."""

    fleet_name: str = ""
    speed_limits: Annotated[list[SpeedLimitedLane], Sequence[SpeedLimitedLane]] = DEFAULT
    remove_limits: Annotated[Ints, Sequence[uint64]] = DEFAULT
