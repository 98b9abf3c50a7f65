"""Messages of py_trees_ros_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.diagnostic_msgs.msg import KeyValue as DiagnosticMsgsKeyValue
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.message import DEFAULT, Message, Sequence, float32, float64, int64, uint8

__all__ = [
    "ActivityItem",
    "Behaviour",
    "BehaviourTree",
    "KeyValue",
    "PublisherDetails",
    "ServiceDetails",
    "SnapshotStreamParameters",
    "Statistics",
    "SubscriberDetails",
]


class ActivityItem(Message, typename="py_trees_ros_interfaces/msg/ActivityItem"):
    """ActivityItem, as py_trees_ros defines it."""

    READ: ClassVar[str] = "READ"
    INITIALISED: ClassVar[str] = "INITIALISED"
    WRITE: ClassVar[str] = "WRITE"
    ACCESSED: ClassVar[str] = "ACCESSED"
    ACCESS_DENIED: ClassVar[str] = "ACCESS_DENIED"
    NO_KEY: ClassVar[str] = "NO_KEY"
    NO_OVERWRITE: ClassVar[str] = "NO_OVERWRITE"
    UNSET: ClassVar[str] = "UNSET"

    key: str = ""
    client_name: str = ""
    activity_type: str = ""
    previous_value: str = ""
    current_value: str = ""


class KeyValue(Message, typename="py_trees_ros_interfaces/msg/KeyValue"):
    """KeyValue, as py_trees_ros defines it."""

    key: str = ""
    value: str = ""


class Behaviour(Message, typename="py_trees_ros_interfaces/msg/Behaviour"):
    """Behaviour, as py_trees_ros defines it."""

    INVALID: ClassVar[uint8] = 1
    RUNNING: ClassVar[uint8] = 2
    SUCCESS: ClassVar[uint8] = 3
    FAILURE: ClassVar[uint8] = 4
    UNKNOWN_TYPE: ClassVar[uint8] = 0
    BEHAVIOUR: ClassVar[uint8] = 1
    SEQUENCE: ClassVar[uint8] = 2
    SELECTOR: ClassVar[uint8] = 3
    PARALLEL: ClassVar[uint8] = 4
    CHOOSER: ClassVar[uint8] = 5
    DECORATOR: ClassVar[uint8] = 6
    BLACKBOX_LEVEL_DETAIL: ClassVar[uint8] = 1
    BLACKBOX_LEVEL_COMPONENT: ClassVar[uint8] = 2
    BLACKBOX_LEVEL_BIG_PICTURE: ClassVar[uint8] = 3
    BLACKBOX_LEVEL_NOT_A_BLACKBOX: ClassVar[uint8] = 4
    BLACKBOARD_ACCESS_READ: ClassVar[str] = "r"
    BLACKBOARD_ACCESS_WRITE: ClassVar[str] = "w"
    BLACKBOARD_ACCESS_EXCLUSIVE_WRITE: ClassVar[str] = "x"

    name: str = ""
    class_name: str = ""
    own_id: UUID = DEFAULT
    parent_id: UUID = DEFAULT
    tip_id: UUID = DEFAULT
    child_ids: Annotated[list[UUID], Sequence[UUID]] = DEFAULT
    current_child_id: UUID = DEFAULT
    type: uint8 = 0
    additional_detail: str = ""
    blackbox_level: uint8 = 0
    status: uint8 = 0
    message: str = ""
    is_active: bool = False
    blackboard_access: Annotated[list[KeyValue], Sequence[KeyValue]] = DEFAULT


class Statistics(Message, typename="py_trees_ros_interfaces/msg/Statistics"):
    """Statistics, as py_trees_ros defines it."""

    count: int64 = 0
    stamp: Time = DEFAULT
    tick_duration: float32 = 0.0
    tick_duration_average: float32 = 0.0
    tick_duration_variance: float32 = 0.0
    tick_interval: float32 = 0.0
    tick_interval_average: float32 = 0.0
    tick_interval_variance: float32 = 0.0


class BehaviourTree(Message, typename="py_trees_ros_interfaces/msg/BehaviourTree"):
    """BehaviourTree, as py_trees_ros defines it."""

    behaviours: Annotated[list[Behaviour], Sequence[Behaviour]] = DEFAULT
    changed: bool = False
    blackboard_on_visited_path: Annotated[
        list[DiagnosticMsgsKeyValue], Sequence[DiagnosticMsgsKeyValue]
    ] = DEFAULT
    blackboard_activity: Annotated[list[ActivityItem], Sequence[ActivityItem]] = DEFAULT
    statistics: Statistics = DEFAULT


class PublisherDetails(Message, typename="py_trees_ros_interfaces/msg/PublisherDetails"):
    """PublisherDetails, as py_trees_ros defines it."""

    topic_name: str = ""
    message_type: str = ""
    latched: bool = False


class ServiceDetails(Message, typename="py_trees_ros_interfaces/msg/ServiceDetails"):
    """ServiceDetails, as py_trees_ros defines it."""

    service_name: str = ""
    service_type: str = ""


class SnapshotStreamParameters(
    Message, typename="py_trees_ros_interfaces/msg/SnapshotStreamParameters"
):
    """SnapshotStreamParameters, as py_trees_ros defines it."""

    snapshot_period: float64 = 0.0
    blackboard_data: bool = False
    blackboard_activity: bool = False


class SubscriberDetails(Message, typename="py_trees_ros_interfaces/msg/SubscriberDetails"):
    """SubscriberDetails, as py_trees_ros defines it."""

    topic_name: str = ""
    message_type: str = ""
    latched: bool = False
