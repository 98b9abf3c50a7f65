"""Messages of tf2_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import TransformStamped
from aionode.message import DEFAULT, Message, Sequence, uint8

__all__ = ["TF2Error", "TFMessage"]


class TF2Error(Message, typename="tf2_msgs/msg/TF2Error"):
    """Why a transform was not found: one of the constants, and a text."""

    NO_ERROR: ClassVar[uint8] = 0
    LOOKUP_ERROR: ClassVar[uint8] = 1
    CONNECTIVITY_ERROR: ClassVar[uint8] = 2
    EXTRAPOLATION_ERROR: ClassVar[uint8] = 3
    INVALID_ARGUMENT_ERROR: ClassVar[uint8] = 4
    TIMEOUT_ERROR: ClassVar[uint8] = 5
    TRANSFORM_ERROR: ClassVar[uint8] = 6

    error: uint8 = 0
    error_string: str = ""


class TFMessage(Message, typename="tf2_msgs/msg/TFMessage"):
    """Transforms between coordinate frames, as ``/tf`` and ``/tf_static`` carry them."""

    transforms: Annotated[list[TransformStamped], Sequence[TransformStamped]] = DEFAULT
