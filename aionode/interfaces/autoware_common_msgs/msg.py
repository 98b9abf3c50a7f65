"""Messages of autoware_common_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.message import Message, uint16

__all__ = ["ResponseStatus"]


class ResponseStatus(Message, typename="autoware_common_msgs/msg/ResponseStatus"):
    """ResponseStatus, as Autoware defines it."""

    UNKNOWN: ClassVar[uint16] = 50000
    SERVICE_UNREADY: ClassVar[uint16] = 50001
    SERVICE_TIMEOUT: ClassVar[uint16] = 50002
    TRANSFORM_ERROR: ClassVar[uint16] = 50003
    PARAMETER_ERROR: ClassVar[uint16] = 50004
    DEPRECATED: ClassVar[uint16] = 60000
    NO_EFFECT: ClassVar[uint16] = 60001

    success: bool = False
    code: uint16 = 0
    message: str = ""
