"""Messages of rmf_workcell_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Message, Sequence, int32, uint8

__all__ = [
    "Asset",
    "Trait",
    "WorkcellConfiguration",
    "WorkcellRequest",
    "WorkcellResult",
    "WorkcellState",
]


class Asset(Message, typename="rmf_workcell_msgs/msg/Asset"):
    """Asset, as Open-RMF defines it."""

    guid: str = ""
    type: str = ""


class Trait(Message, typename="rmf_workcell_msgs/msg/Trait"):
    """Trait, as Open-RMF defines it."""

    key: str = ""
    value: Annotated[list[str], Sequence[str]] = DEFAULT


class WorkcellConfiguration(Message, typename="rmf_workcell_msgs/msg/WorkcellConfiguration"):
    """WorkcellConfiguration, as Open-RMF defines it."""

    time: Time = DEFAULT
    guid: str = ""
    type: str = ""
    assets: Annotated[list[Asset], Sequence[Asset]] = DEFAULT
    traits: Annotated[list[Trait], Sequence[Trait]] = DEFAULT


class WorkcellRequest(Message, typename="rmf_workcell_msgs/msg/WorkcellRequest"):
    """WorkcellRequest, as Open-RMF defines it."""

    time: Time = DEFAULT
    request_guid: str = ""
    target_guid: str = ""


class WorkcellResult(Message, typename="rmf_workcell_msgs/msg/WorkcellResult"):
    """WorkcellResult, as Open-RMF defines it."""

    ACKNOWLEDGED: ClassVar[uint8] = 0
    SUCCESS: ClassVar[uint8] = 1
    FAILED: ClassVar[uint8] = 2

    time: Time = DEFAULT
    request_guid: str = ""
    source_guid: str = ""
    status: uint8 = 0


class WorkcellState(Message, typename="rmf_workcell_msgs/msg/WorkcellState"):
    """WorkcellState, as Open-RMF defines it."""

    IDLE: ClassVar[int32] = 0
    BUSY: ClassVar[int32] = 1
    OFFLINE: ClassVar[int32] = 2

    time: Time = DEFAULT
    guid: str = ""
    mode: int32 = 0
    request_guid_queue: Annotated[list[str], Sequence[str]] = DEFAULT
