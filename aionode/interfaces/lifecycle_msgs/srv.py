"""lifecycle_msgs."""

from typing import Annotated

from aionode.interfaces.lifecycle_msgs.msg import State, Transition, TransitionDescription
from aionode.message import DEFAULT, Message, Sequence, ServiceType


class ChangeState(ServiceType, typename="lifecycle_msgs/srv/ChangeState"):
    """ChangeState."""

    class Request(Message):
        """Request."""

        transition: Transition = DEFAULT

    class Response(Message):
        """Response."""

        success: bool = False


class GetAvailableStates(ServiceType, typename="lifecycle_msgs/srv/GetAvailableStates"):
    """GetAvailableStates."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        available_states: Annotated[list[State], Sequence[State]] = DEFAULT


class GetAvailableTransitions(ServiceType, typename="lifecycle_msgs/srv/GetAvailableTransitions"):
    """GetAvailableTransitions."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        available_transitions: Annotated[
            list[TransitionDescription], Sequence[TransitionDescription]
        ] = DEFAULT


class GetState(ServiceType, typename="lifecycle_msgs/srv/GetState"):
    """GetState."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        current_state: State = DEFAULT
