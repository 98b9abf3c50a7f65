"""Services of visualization_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.visualization_msgs.msg import InteractiveMarker
from aionode.message import DEFAULT, Message, Sequence, ServiceType, uint64

__all__ = ["GetInteractiveMarkers"]


class GetInteractiveMarkers(ServiceType, typename="visualization_msgs/srv/GetInteractiveMarkers"):
    """Ask a server for its interactive markers."""

    class Request(Message):
        """The request of GetInteractiveMarkers."""

    class Response(Message):
        """All its markers, and the number of the last update they contain."""

        sequence_number: uint64 = 0
        markers: Annotated[list[InteractiveMarker], Sequence[InteractiveMarker]] = DEFAULT
