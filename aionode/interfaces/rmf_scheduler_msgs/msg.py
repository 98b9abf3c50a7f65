"""Messages of rmf_scheduler_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.message import DEFAULT, Bytes, Message, Sequence, int8, int64, uint8

__all__ = ["Payload", "Schedule", "ScheduleState", "Trigger", "TriggerState"]


class Payload(Message, typename="rmf_scheduler_msgs/msg/Payload"):
    """Payload, as Open-RMF defines it."""

    PAYLOAD_TYPE_SERIALIZED_MESSAGE: ClassVar[uint8] = 1

    type: uint8 = 0
    topic: str = ""
    message_type: str = ""
    data: Annotated[Bytes, Sequence[uint8, 2097152]] = DEFAULT


class Schedule(Message, typename="rmf_scheduler_msgs/msg/Schedule"):
    """Schedule, as Open-RMF defines it."""

    name: str = ""
    created_at: int64 = 0
    schedule: str = ""
    start_at: int64 = 0
    finish_at: int64 = 9223372036854775807
    group: str = "default"
    payload: Payload = DEFAULT


class ScheduleState(Message, typename="rmf_scheduler_msgs/msg/ScheduleState"):
    """ScheduleState, as Open-RMF defines it."""

    CREATED: ClassVar[int8] = 1
    STARTED: ClassVar[int8] = 2
    FINISHED: ClassVar[int8] = 3
    CANCELLED: ClassVar[int8] = 4
    FAILED: ClassVar[int8] = -1

    name: str = ""
    last_modified: int64 = 0
    last_ran: int64 = 0
    next_run: int64 = 0
    status: int8 = 0


class Trigger(Message, typename="rmf_scheduler_msgs/msg/Trigger"):
    """Trigger, as Open-RMF defines it."""

    name: str = ""
    created_at: int64 = 0
    at: int64 = 0
    group: str = "default"
    payload: Payload = DEFAULT


class TriggerState(Message, typename="rmf_scheduler_msgs/msg/TriggerState"):
    """TriggerState, as Open-RMF defines it."""

    STARTED: ClassVar[int8] = 2
    FINISHED: ClassVar[int8] = 3
    CANCELLED: ClassVar[int8] = 4
    FAILED: ClassVar[int8] = -1

    name: str = ""
    last_modified: int64 = 0
    last_ran: int64 = 0
    status: int8 = 0
