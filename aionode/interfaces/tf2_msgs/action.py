"""Actions of tf2_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.interfaces.geometry_msgs.msg import TransformStamped
from aionode.interfaces.tf2_msgs.msg import TF2Error
from aionode.message import DEFAULT, ActionType, Message

__all__ = ["LookupTransform"]


class LookupTransform(ActionType, typename="tf2_msgs/action/LookupTransform"):
    """LookupTransform."""

    class Goal(Message):
        """The goal of LookupTransform."""

        target_frame: str = ""
        source_frame: str = ""
        source_time: Time = DEFAULT
        timeout: Duration = DEFAULT
        target_time: Time = DEFAULT
        fixed_frame: str = ""
        advanced: bool = False

    class Result(Message):
        """The result of LookupTransform."""

        transform: TransformStamped = DEFAULT
        error: TF2Error = DEFAULT

    class Feedback(Message):
        """The feedback of LookupTransform."""
