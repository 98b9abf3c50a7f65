"""Messages of action_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.message import DEFAULT, Message, Sequence, int8

__all__ = ["GoalInfo", "GoalStatus", "GoalStatusArray"]


class GoalInfo(Message, typename="action_msgs/msg/GoalInfo"):
    """A goal of an action: its id, and when its server accepted it."""

    goal_id: UUID = DEFAULT
    stamp: Time = DEFAULT


class GoalStatus(Message, typename="action_msgs/msg/GoalStatus"):
    """The state of a goal; `status` is one of the constants."""

    STATUS_UNKNOWN: ClassVar[int8] = 0
    STATUS_ACCEPTED: ClassVar[int8] = 1
    STATUS_EXECUTING: ClassVar[int8] = 2
    STATUS_CANCELING: ClassVar[int8] = 3
    STATUS_SUCCEEDED: ClassVar[int8] = 4
    STATUS_CANCELED: ClassVar[int8] = 5
    STATUS_ABORTED: ClassVar[int8] = 6

    goal_info: GoalInfo = DEFAULT
    status: int8 = 0


class GoalStatusArray(Message, typename="action_msgs/msg/GoalStatusArray"):
    """The states of all goals that an action server knows, sent whenever one changes."""

    status_list: Annotated[list[GoalStatus], Sequence[GoalStatus]] = DEFAULT
