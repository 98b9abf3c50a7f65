"""Messages of audio_common_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Bytes, Message, Sequence, uint8, uint32

__all__ = ["AudioData", "AudioDataStamped", "AudioInfo"]


class AudioData(Message, typename="audio_common_msgs/msg/AudioData"):
    """AudioData, as audio_common defines it."""

    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class AudioDataStamped(Message, typename="audio_common_msgs/msg/AudioDataStamped"):
    """AudioDataStamped, as audio_common defines it."""

    header: Header = DEFAULT
    audio: AudioData = DEFAULT


class AudioInfo(Message, typename="audio_common_msgs/msg/AudioInfo"):
    """AudioInfo, as audio_common defines it."""

    channels: uint8 = 0
    sample_rate: uint32 = 0
    sample_format: str = ""
    bitrate: uint32 = 0
    coding_format: str = ""
