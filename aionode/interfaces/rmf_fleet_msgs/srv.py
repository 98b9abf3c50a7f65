"""Services of rmf_fleet_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.message import Message, ServiceType, uint32

__all__ = ["LiftClearance"]


class LiftClearance(ServiceType, typename="rmf_fleet_msgs/srv/LiftClearance"):
    """LiftClearance, as Open-RMF defines it."""

    class Request(Message):
        """The request of LiftClearance."""

        robot_name: str = ""
        lift_name: str = ""

    class Response(Message):
        """The response of LiftClearance."""

        DECISION_CLEAR: ClassVar[uint32] = 1
        DECISION_CROWDED: ClassVar[uint32] = 2

        decision: uint32 = 0
