"""Services of action_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.action_msgs.msg import GoalInfo
from aionode.message import DEFAULT, Message, Sequence, ServiceType, int8

__all__ = ["CancelGoal"]


class CancelGoal(ServiceType, typename="action_msgs/srv/CancelGoal"):
    """Ask an action server to cancel goals."""

    class Request(Message):
        """Which goals to cancel.

        An id without a stamp means that goal, a stamp without an id every goal accepted up to then,
        both mean that goal and those goals, and neither means all goals. All zeros count as no id
        or stamp.
        """

        goal_info: GoalInfo = DEFAULT

    class Response(Message):
        """Whether the request was accepted, and which goals are being canceled."""

        ERROR_NONE: ClassVar[int8] = 0
        ERROR_REJECTED: ClassVar[int8] = 1
        ERROR_UNKNOWN_GOAL_ID: ClassVar[int8] = 2
        ERROR_GOAL_TERMINATED: ClassVar[int8] = 3

        return_code: int8 = 0
        goals_canceling: Annotated[list[GoalInfo], Sequence[GoalInfo]] = DEFAULT
