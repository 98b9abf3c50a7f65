"""Services of robot_controllers_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.robot_controllers_msgs.msg import ControllerState
from aionode.message import DEFAULT, Message, Sequence, ServiceType

__all__ = ["QueryControllerStates"]


class QueryControllerStates(
    ServiceType, typename="robot_controllers_msgs/srv/QueryControllerStates"
):
    """QueryControllerStates, as robot_controllers defines it."""

    class Request(Message):
        """The request of QueryControllerStates."""

        updates: Annotated[list[ControllerState], Sequence[ControllerState]] = DEFAULT

    class Response(Message):
        """The response of QueryControllerStates."""

        state: Annotated[list[ControllerState], Sequence[ControllerState]] = DEFAULT
