"""Services of tf2_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType

__all__ = ["FrameGraph"]


class FrameGraph(ServiceType, typename="tf2_msgs/srv/FrameGraph"):
    """FrameGraph."""

    class Request(Message):
        """The request of FrameGraph."""

    class Response(Message):
        """The response of FrameGraph."""

        frame_yaml: str = ""
