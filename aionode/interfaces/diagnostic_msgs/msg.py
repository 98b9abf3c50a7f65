"""diagnostic_msgs."""

from typing import Annotated, ClassVar

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, Sequence, byte


class KeyValue(Message, typename="diagnostic_msgs/msg/KeyValue"):
    """KeyValue."""

    key: str = ""
    value: str = ""


class DiagnosticStatus(Message, typename="diagnostic_msgs/msg/DiagnosticStatus"):
    """DiagnosticStatus."""

    OK: ClassVar[byte] = bytes((0,))
    WARN: ClassVar[byte] = bytes((1,))
    ERROR: ClassVar[byte] = bytes((2,))
    STALE: ClassVar[byte] = bytes((3,))
    level: byte = b"\0"
    name: str = ""
    message: str = ""
    hardware_id: str = ""
    values: Annotated[list[KeyValue], Sequence[KeyValue]] = DEFAULT


class DiagnosticArray(Message, typename="diagnostic_msgs/msg/DiagnosticArray"):
    """DiagnosticArray."""

    header: Header = DEFAULT
    status: Annotated[list[DiagnosticStatus], Sequence[DiagnosticStatus]] = DEFAULT
