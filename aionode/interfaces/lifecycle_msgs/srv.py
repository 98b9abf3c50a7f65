"""Services of lifecycle_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.lifecycle_msgs.msg import State, Transition, TransitionDescription
from aionode.message import DEFAULT, Message, Sequence, ServiceType

__all__ = ["ChangeState", "GetAvailableStates", "GetAvailableTransitions", "GetState"]


class ChangeState(ServiceType, typename="lifecycle_msgs/srv/ChangeState"):
    """Have a managed node change its state."""

    class Request(Message):
        """Which transition to make; by `label` if `id` is 0."""

        transition: Transition = DEFAULT

    class Response(Message):
        """Whether the node is in the new state."""

        success: bool = False


class GetAvailableStates(ServiceType, typename="lifecycle_msgs/srv/GetAvailableStates"):
    """Which states a managed node has."""

    class Request(Message):
        """The request of GetAvailableStates."""

    class Response(Message):
        """All its states."""

        available_states: Annotated[list[State], Sequence[State]] = DEFAULT


class GetAvailableTransitions(ServiceType, typename="lifecycle_msgs/srv/GetAvailableTransitions"):
    """Which transitions a managed node can make."""

    class Request(Message):
        """The request of GetAvailableTransitions."""

    class Response(Message):
        """The transitions."""

        available_transitions: Annotated[
            list[TransitionDescription], Sequence[TransitionDescription]
        ] = DEFAULT


class GetState(ServiceType, typename="lifecycle_msgs/srv/GetState"):
    """In which state a managed node is."""

    class Request(Message):
        """The request of GetState."""

    class Response(Message):
        """The state."""

        current_state: State = DEFAULT
