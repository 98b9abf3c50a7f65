"""Services of lifecycle_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.lifecycle_msgs.msg import State, Transition, TransitionDescription
from aionode.message import DEFAULT, Message, Sequence, ServiceType

__all__ = ["ChangeState", "GetAvailableStates", "GetAvailableTransitions", "GetState"]


class ChangeState(ServiceType, typename="lifecycle_msgs/srv/ChangeState"):
    """ChangeState."""

    class Request(Message):
        """The request of ChangeState."""

        transition: Transition = DEFAULT

    class Response(Message):
        """The response of ChangeState."""

        success: bool = False


class GetAvailableStates(ServiceType, typename="lifecycle_msgs/srv/GetAvailableStates"):
    """GetAvailableStates."""

    class Request(Message):
        """The request of GetAvailableStates."""

    class Response(Message):
        """The response of GetAvailableStates."""

        available_states: Annotated[list[State], Sequence[State]] = DEFAULT


class GetAvailableTransitions(ServiceType, typename="lifecycle_msgs/srv/GetAvailableTransitions"):
    """GetAvailableTransitions."""

    class Request(Message):
        """The request of GetAvailableTransitions."""

    class Response(Message):
        """The response of GetAvailableTransitions."""

        available_transitions: Annotated[
            list[TransitionDescription], Sequence[TransitionDescription]
        ] = DEFAULT


class GetState(ServiceType, typename="lifecycle_msgs/srv/GetState"):
    """GetState."""

    class Request(Message):
        """The request of GetState."""

    class Response(Message):
        """The response of GetState."""

        current_state: State = DEFAULT
