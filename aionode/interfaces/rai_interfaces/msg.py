"""Messages of rai_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.vision_msgs.msg import Detection2D
from aionode.message import DEFAULT, Ints, Message, Sequence, int16, int64, uint16

__all__ = ["AudioMessage", "HRIMessage", "RAIDetectionArray"]


class AudioMessage(Message, typename="rai_interfaces/msg/AudioMessage"):
    """AudioMessage, as RAI defines it."""

    audio: Annotated[Ints, Sequence[int16]] = DEFAULT
    sample_rate: uint16 = 0
    channels: uint16 = 0


class HRIMessage(Message, typename="rai_interfaces/msg/HRIMessage"):
    """HRIMessage, as RAI defines it."""

    header: Header = DEFAULT
    text: str = ""
    images: Annotated[list[Image], Sequence[Image]] = DEFAULT
    audios: Annotated[list[AudioMessage], Sequence[AudioMessage]] = DEFAULT
    communication_id: str = ""
    seq_no: int64 = 0
    seq_end: bool = False


class RAIDetectionArray(Message, typename="rai_interfaces/msg/RAIDetectionArray"):
    """RAIDetectionArray, as RAI defines it."""

    header: Header = DEFAULT
    detections: Annotated[list[Detection2D], Sequence[Detection2D]] = DEFAULT
    detection_classes: Annotated[list[str], Sequence[str]] = DEFAULT
