"""Services of tf2_web_republisher_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.message import DEFAULT, Message, Sequence, ServiceType, float32

__all__ = ["RepublishTFs"]


class RepublishTFs(ServiceType, typename="tf2_web_republisher_interfaces/srv/RepublishTFs"):
    """RepublishTFs, as tf2_web_republisher defines it."""

    class Request(Message):
        """The request of RepublishTFs."""

        source_frames: Annotated[list[str], Sequence[str]] = DEFAULT
        target_frame: str = ""
        angular_thres: float32 = 0.0
        trans_thres: float32 = 0.0
        rate: float32 = 0.0
        timeout: Duration = DEFAULT

    class Response(Message):
        """The response of RepublishTFs."""

        topic_name: str = ""
