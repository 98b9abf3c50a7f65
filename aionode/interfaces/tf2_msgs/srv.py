"""Services of tf2_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType

__all__ = ["FrameGraph"]


class FrameGraph(ServiceType, typename="tf2_msgs/srv/FrameGraph"):
    """Ask for the tree of coordinate frames."""

    class Request(Message):
        """The request of FrameGraph."""

    class Response(Message):
        """The tree, as YAML."""

        frame_yaml: str = ""
