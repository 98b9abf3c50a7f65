"""Messages of rmf_task_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.interfaces.rmf_dispenser_msgs.msg import DispenserRequestItem
from aionode.message import DEFAULT, Message, Sequence, float64, int8, uint8, uint32, uint64

__all__ = [
    "ApiRequest",
    "ApiResponse",
    "Assignment",
    "Behavior",
    "BehaviorParameter",
    "BidNotice",
    "BidProposal",
    "BidResponse",
    "Clean",
    "Delivery",
    "DispatchAck",
    "DispatchCommand",
    "DispatchState",
    "DispatchStates",
    "Loop",
    "Priority",
    "Station",
    "TaskDescription",
    "TaskProfile",
    "TaskSummary",
    "TaskType",
    "Tasks",
    "Tow",
]


class ApiRequest(Message, typename="rmf_task_msgs/msg/ApiRequest"):
    """ApiRequest, as Open-RMF defines it."""

    json_msg: str = ""
    request_id: str = ""


class ApiResponse(Message, typename="rmf_task_msgs/msg/ApiResponse"):
    """ApiResponse, as Open-RMF defines it."""

    TYPE_UNINITIALIZED: ClassVar[uint8] = 0
    TYPE_ACKNOWLEDGE: ClassVar[uint8] = 1
    TYPE_RESPONDING: ClassVar[uint8] = 2

    type: uint8 = 0
    json_msg: str = ""
    request_id: str = ""


class Assignment(Message, typename="rmf_task_msgs/msg/Assignment"):
    """Assignment, as Open-RMF defines it."""

    is_assigned: bool = False
    fleet_name: str = ""
    expected_robot_name: str = ""


class BehaviorParameter(Message, typename="rmf_task_msgs/msg/BehaviorParameter"):
    """BehaviorParameter, as Open-RMF defines it."""

    name: str = ""
    value: str = ""


class Behavior(Message, typename="rmf_task_msgs/msg/Behavior"):
    """Behavior, as Open-RMF defines it."""

    name: str = ""
    parameters: Annotated[list[BehaviorParameter], Sequence[BehaviorParameter]] = DEFAULT


class BidNotice(Message, typename="rmf_task_msgs/msg/BidNotice"):
    """BidNotice, as Open-RMF defines it."""

    request: str = ""
    task_id: str = ""
    time_window: Duration = DEFAULT


class BidProposal(Message, typename="rmf_task_msgs/msg/BidProposal"):
    """BidProposal, as Open-RMF defines it."""

    fleet_name: str = ""
    expected_robot_name: str = ""
    prev_cost: float64 = 0.0
    new_cost: float64 = 0.0
    finish_time: Time = DEFAULT


class BidResponse(Message, typename="rmf_task_msgs/msg/BidResponse"):
    """BidResponse, as Open-RMF defines it."""

    task_id: str = ""
    has_proposal: bool = False
    proposal: BidProposal = DEFAULT
    errors: Annotated[list[str], Sequence[str]] = DEFAULT


class Clean(Message, typename="rmf_task_msgs/msg/Clean"):
    """Clean, as Open-RMF defines it."""

    start_waypoint: str = ""


class Delivery(Message, typename="rmf_task_msgs/msg/Delivery"):
    """Delivery, as Open-RMF defines it."""

    task_id: str = ""
    items: Annotated[list[DispenserRequestItem], Sequence[DispenserRequestItem]] = DEFAULT
    pickup_place_name: str = ""
    pickup_dispenser: str = ""
    pickup_behavior: Behavior = DEFAULT
    dropoff_place_name: str = ""
    dropoff_ingestor: str = ""
    dropoff_behavior: Behavior = DEFAULT


class DispatchAck(Message, typename="rmf_task_msgs/msg/DispatchAck"):
    """DispatchAck, as Open-RMF defines it."""

    dispatch_id: uint64 = 0
    success: bool = False
    errors: Annotated[list[str], Sequence[str]] = DEFAULT


class DispatchCommand(Message, typename="rmf_task_msgs/msg/DispatchCommand"):
    """DispatchCommand, as Open-RMF defines it."""

    TYPE_AWARD: ClassVar[uint8] = 1
    TYPE_REMOVE: ClassVar[uint8] = 2

    fleet_name: str = ""
    task_id: str = ""
    dispatch_id: uint64 = 0
    timestamp: Time = DEFAULT
    type: uint8 = 0


class DispatchState(Message, typename="rmf_task_msgs/msg/DispatchState"):
    """DispatchState, as Open-RMF defines it."""

    STATUS_UNINITIALIZED: ClassVar[uint8] = 0
    STATUS_QUEUED: ClassVar[uint8] = 1
    STATUS_SELECTED: ClassVar[uint8] = 2
    STATUS_DISPATCHED: ClassVar[uint8] = 3
    STATUS_FAILED_TO_ASSIGN: ClassVar[uint8] = 4
    STATUS_CANCELED_IN_FLIGHT: ClassVar[uint8] = 5

    task_id: str = ""
    status: int8 = 0
    assignment: Assignment = DEFAULT
    errors: Annotated[list[str], Sequence[str]] = DEFAULT


class DispatchStates(Message, typename="rmf_task_msgs/msg/DispatchStates"):
    """DispatchStates, as Open-RMF defines it."""

    active: Annotated[list[DispatchState], Sequence[DispatchState]] = DEFAULT
    finished: Annotated[list[DispatchState], Sequence[DispatchState]] = DEFAULT


class Loop(Message, typename="rmf_task_msgs/msg/Loop"):
    """Loop, as Open-RMF defines it."""

    task_id: str = ""
    robot_type: str = ""
    num_loops: uint32 = 0
    start_name: str = ""
    finish_name: str = ""


class Priority(Message, typename="rmf_task_msgs/msg/Priority"):
    """Priority, as Open-RMF defines it."""

    value: uint64 = 0


class Station(Message, typename="rmf_task_msgs/msg/Station"):
    """Station, as Open-RMF defines it."""

    task_id: str = ""
    robot_type: str = ""
    place_name: str = ""


class TaskType(Message, typename="rmf_task_msgs/msg/TaskType"):
    """TaskType, as Open-RMF defines it."""

    TYPE_STATION: ClassVar[uint32] = 0
    TYPE_LOOP: ClassVar[uint32] = 1
    TYPE_DELIVERY: ClassVar[uint32] = 2
    TYPE_CHARGE_BATTERY: ClassVar[uint32] = 3
    TYPE_CLEAN: ClassVar[uint32] = 4
    TYPE_PATROL: ClassVar[uint32] = 5

    type: uint32 = 0


class TaskDescription(Message, typename="rmf_task_msgs/msg/TaskDescription"):
    """TaskDescription, as Open-RMF defines it."""

    start_time: Time = DEFAULT
    priority: Priority = DEFAULT
    task_type: TaskType = DEFAULT
    station: Station = DEFAULT
    loop: Loop = DEFAULT
    delivery: Delivery = DEFAULT
    clean: Clean = DEFAULT


class TaskProfile(Message, typename="rmf_task_msgs/msg/TaskProfile"):
    """TaskProfile, as Open-RMF defines it."""

    task_id: str = ""
    submission_time: Time = DEFAULT
    description: TaskDescription = DEFAULT


class TaskSummary(Message, typename="rmf_task_msgs/msg/TaskSummary"):
    """TaskSummary, as Open-RMF defines it."""

    STATE_QUEUED: ClassVar[uint32] = 0
    STATE_ACTIVE: ClassVar[uint32] = 1
    STATE_COMPLETED: ClassVar[uint32] = 2
    STATE_FAILED: ClassVar[uint32] = 3
    STATE_CANCELED: ClassVar[uint32] = 4
    STATE_PENDING: ClassVar[uint32] = 5

    fleet_name: str = ""
    task_id: str = ""
    task_profile: TaskProfile = DEFAULT
    state: uint32 = 0
    status: str = ""
    submission_time: Time = DEFAULT
    start_time: Time = DEFAULT
    end_time: Time = DEFAULT
    robot_name: str = ""


class Tasks(Message, typename="rmf_task_msgs/msg/Tasks"):
    """Tasks, as Open-RMF defines it."""

    tasks: Annotated[list[TaskSummary], Sequence[TaskSummary]] = DEFAULT


class Tow(Message, typename="rmf_task_msgs/msg/Tow"):
    """Tow, as Open-RMF defines it."""

    task_id: str = ""
    object_type: str = ""
    is_object_id_known: bool = False
    object_id: str = ""
    pickup_place_name: str = ""
    is_dropoff_place_known: bool = False
    dropoff_place_name: str = ""
