"""Services of action_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.action_msgs.msg import GoalInfo
from aionode.message import DEFAULT, Message, Sequence, ServiceType, int8

__all__ = ["CancelGoal"]


class CancelGoal(ServiceType, typename="action_msgs/srv/CancelGoal"):
    """CancelGoal."""

    class Request(Message):
        """The request of CancelGoal."""

        goal_info: GoalInfo = DEFAULT

    class Response(Message):
        """The response of CancelGoal."""

        ERROR_NONE: ClassVar[int8] = 0
        ERROR_REJECTED: ClassVar[int8] = 1
        ERROR_UNKNOWN_GOAL_ID: ClassVar[int8] = 2
        ERROR_GOAL_TERMINATED: ClassVar[int8] = 3

        return_code: int8 = 0
        goals_canceling: Annotated[list[GoalInfo], Sequence[GoalInfo]] = DEFAULT
