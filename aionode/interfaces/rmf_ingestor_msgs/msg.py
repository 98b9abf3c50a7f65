"""Messages of rmf_ingestor_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Message, Sequence, float32, int32, uint8

__all__ = ["IngestorRequest", "IngestorRequestItem", "IngestorResult", "IngestorState"]


class IngestorRequestItem(Message, typename="rmf_ingestor_msgs/msg/IngestorRequestItem"):
    """IngestorRequestItem, as Open-RMF defines it."""

    type_guid: str = ""
    quantity: int32 = 0
    compartment_name: str = ""


class IngestorRequest(Message, typename="rmf_ingestor_msgs/msg/IngestorRequest"):
    """IngestorRequest, as Open-RMF defines it."""

    time: Time = DEFAULT
    request_guid: str = ""
    target_guid: str = ""
    transporter_type: str = ""
    items: Annotated[list[IngestorRequestItem], Sequence[IngestorRequestItem]] = DEFAULT


class IngestorResult(Message, typename="rmf_ingestor_msgs/msg/IngestorResult"):
    """IngestorResult, as Open-RMF defines it."""

    ACKNOWLEDGED: ClassVar[uint8] = 0
    SUCCESS: ClassVar[uint8] = 1
    FAILED: ClassVar[uint8] = 2

    time: Time = DEFAULT
    request_guid: str = ""
    source_guid: str = ""
    status: uint8 = 0


class IngestorState(Message, typename="rmf_ingestor_msgs/msg/IngestorState"):
    """IngestorState, as Open-RMF defines it."""

    IDLE: ClassVar[int32] = 0
    BUSY: ClassVar[int32] = 1
    OFFLINE: ClassVar[int32] = 2

    time: Time = DEFAULT
    guid: str = ""
    mode: int32 = 0
    request_guid_queue: Annotated[list[str], Sequence[str]] = DEFAULT
    seconds_remaining: float32 = 0.0
