"""Messages of diagnostic_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, Sequence, byte

__all__ = ["DiagnosticArray", "DiagnosticStatus", "KeyValue"]


class KeyValue(Message, typename="diagnostic_msgs/msg/KeyValue"):
    """A name and a value, both as text."""

    key: str = ""
    value: str = ""


class DiagnosticStatus(Message, typename="diagnostic_msgs/msg/DiagnosticStatus"):
    """The health of one part of a robot.

    Attributes:
        level: One of the constants, a byte.
        name: What reports; ``/`` makes groups.
        message: One line on how it is.
        hardware_id: Which piece of hardware, such as a serial number.
        values: Measured values, as text.
    """

    OK: ClassVar[byte] = b"\x00"
    WARN: ClassVar[byte] = b"\x01"
    ERROR: ClassVar[byte] = b"\x02"
    STALE: ClassVar[byte] = b"\x03"

    level: byte = b"\x00"
    name: str = ""
    message: str = ""
    hardware_id: str = ""
    values: Annotated[list[KeyValue], Sequence[KeyValue]] = DEFAULT


class DiagnosticArray(Message, typename="diagnostic_msgs/msg/DiagnosticArray"):
    """What several parts of a robot report about their health at one time."""

    header: Header = DEFAULT
    status: Annotated[list[DiagnosticStatus], Sequence[DiagnosticStatus]] = DEFAULT
