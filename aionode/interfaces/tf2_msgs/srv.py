"""tf2_msgs."""

from aionode.message import Message, ServiceType


class FrameGraph(ServiceType, typename="tf2_msgs/srv/FrameGraph"):
    """FrameGraph."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        frame_yaml: str = ""
