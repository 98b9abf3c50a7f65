"""Actions of tf2_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.interfaces.geometry_msgs.msg import TransformStamped
from aionode.interfaces.tf2_msgs.msg import TF2Error
from aionode.message import DEFAULT, ActionType, Message

__all__ = ["LookupTransform"]


class LookupTransform(ActionType, typename="tf2_msgs/action/LookupTransform"):
    """Ask a transform server for the transform between two frames."""

    class Goal(Message):
        """Which transform to look up.

        Attributes:
            target_frame: The frame to express things in.
            source_frame: The frame they are in.
            source_time: When; all zeros mean the latest.
            timeout: How long to wait for it.
            target_time: When to look at the target frame; only if `advanced`.
            fixed_frame: The frame that stands still between both times; only if `advanced`.
            advanced: Whether the two frames are looked up at different times.
        """

        target_frame: str = ""
        source_frame: str = ""
        source_time: Time = DEFAULT
        timeout: Duration = DEFAULT
        target_time: Time = DEFAULT
        fixed_frame: str = ""
        advanced: bool = False

    class Result(Message):
        """The transform, or why there is none."""

        transform: TransformStamped = DEFAULT
        error: TF2Error = DEFAULT

    class Feedback(Message):
        """Nothing: there is no feedback."""
