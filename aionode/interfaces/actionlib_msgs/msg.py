"""Messages of actionlib_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, Sequence, uint8

__all__ = ["GoalID", "GoalStatus", "GoalStatusArray"]


class GoalID(Message, typename="actionlib_msgs/msg/GoalID"):
    """GoalID."""

    stamp: Time = DEFAULT
    id: str = ""


class GoalStatus(Message, typename="actionlib_msgs/msg/GoalStatus"):
    """GoalStatus."""

    PENDING: ClassVar[uint8] = 0
    ACTIVE: ClassVar[uint8] = 1
    PREEMPTED: ClassVar[uint8] = 2
    SUCCEEDED: ClassVar[uint8] = 3
    ABORTED: ClassVar[uint8] = 4
    REJECTED: ClassVar[uint8] = 5
    PREEMPTING: ClassVar[uint8] = 6
    RECALLING: ClassVar[uint8] = 7
    RECALLED: ClassVar[uint8] = 8
    LOST: ClassVar[uint8] = 9

    goal_id: GoalID = DEFAULT
    status: uint8 = 0
    text: str = ""


class GoalStatusArray(Message, typename="actionlib_msgs/msg/GoalStatusArray"):
    """GoalStatusArray."""

    header: Header = DEFAULT
    status_list: Annotated[list[GoalStatus], Sequence[GoalStatus]] = DEFAULT
