"""Messages of bond.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, float32

__all__ = ["Constants", "Status"]


class Constants(Message, typename="bond/msg/Constants"):
    """Constants, as bond_core defines it."""

    DEAD_PUBLISH_PERIOD: ClassVar[float32] = 0.05
    DEFAULT_CONNECT_TIMEOUT: ClassVar[float32] = 10.0
    DEFAULT_HEARTBEAT_TIMEOUT: ClassVar[float32] = 4.0
    DEFAULT_DISCONNECT_TIMEOUT: ClassVar[float32] = 2.0
    DEFAULT_HEARTBEAT_PERIOD: ClassVar[float32] = 1.0
    DISABLE_HEARTBEAT_TIMEOUT_PARAM: ClassVar[str] = "/bond_disable_heartbeat_timeout"


class Status(Message, typename="bond/msg/Status"):
    """Status, as bond_core defines it."""

    header: Header = DEFAULT
    id: str = ""
    instance_id: str = ""
    active: bool = False
    heartbeat_timeout: float32 = 0.0
    heartbeat_period: float32 = 0.0
