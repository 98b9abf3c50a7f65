"""Messages of actionlib_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, Sequence, uint8

__all__ = ["GoalID", "GoalStatus", "GoalStatusArray"]


class GoalID(Message, typename="actionlib_msgs/msg/GoalID"):
    """A goal of a ROS 1 action: its id, and when it was asked for."""

    stamp: Time = DEFAULT
    id: str = ""


class GoalStatus(Message, typename="actionlib_msgs/msg/GoalStatus"):
    """The state of a ROS 1 action's goal, as one of the constants, with a word on why."""

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
    """The states of all goals of a ROS 1 action server."""

    header: Header = DEFAULT
    status_list: Annotated[list[GoalStatus], Sequence[GoalStatus]] = DEFAULT
