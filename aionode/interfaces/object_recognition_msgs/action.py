"""Actions of object_recognition_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.object_recognition_msgs.msg import RecognizedObjectArray
from aionode.message import DEFAULT, ActionType, Floats, Message, Sequence, float32

__all__ = ["ObjectRecognition"]


class ObjectRecognition(ActionType, typename="object_recognition_msgs/action/ObjectRecognition"):
    """ObjectRecognition, as object_recognition defines it."""

    class Goal(Message):
        """The goal of ObjectRecognition."""

        use_roi: bool = False
        filter_limits: Annotated[Floats, Sequence[float32]] = DEFAULT

    class Result(Message):
        """The result of ObjectRecognition."""

        recognized_objects: RecognizedObjectArray = DEFAULT

    class Feedback(Message):
        """The feedback of ObjectRecognition."""
