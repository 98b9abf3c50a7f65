"""visualization_msgs."""

from typing import Annotated

from aionode.interfaces.visualization_msgs.msg import InteractiveMarker
from aionode.message import DEFAULT, Message, Sequence, ServiceType, uint64


class GetInteractiveMarkers(ServiceType, typename="visualization_msgs/srv/GetInteractiveMarkers"):
    """GetInteractiveMarkers."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        sequence_number: uint64 = 0
        markers: Annotated[list[InteractiveMarker], Sequence[InteractiveMarker]] = DEFAULT
