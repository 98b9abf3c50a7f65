"""Actions of tf2_web_republisher_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import TransformStamped
from aionode.message import DEFAULT, ActionType, Message, Sequence, float32

__all__ = ["TFSubscription"]


class TFSubscription(ActionType, typename="tf2_web_republisher_interfaces/action/TFSubscription"):
    """TFSubscription, as tf2_web_republisher defines it."""

    class Goal(Message):
        """The goal of TFSubscription."""

        source_frames: Annotated[list[str], Sequence[str]] = DEFAULT
        target_frame: str = ""
        angular_thres: float32 = 0.0
        trans_thres: float32 = 0.0
        rate: float32 = 0.0

    class Result(Message):
        """The result of TFSubscription."""

    class Feedback(Message):
        """The feedback of TFSubscription."""

        transforms: Annotated[list[TransformStamped], Sequence[TransformStamped]] = DEFAULT
