"""The state machine of managed nodes, with rcl_lifecycle's states and transitions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.engine.rules.lifecycle_answers import fill_event
from aionode.engine.rules.lifecycle_states import StateMachine, TransitionCallbackReturn
from aionode.logging import get_logger
from aionode.qos import QoSProfile
from rclpy._impl.errors import RCLError
from rclpy._impl.topics import PublisherHandle
from rosidl_generator_py import message_class, service_class

if TYPE_CHECKING:
    from aionode.engine.rules.lifecycle_states import Transition
    from rclpy._impl.node import NodeHandle

__all__ = [
    "TEN_MESSAGES",
    "ChangeState",
    "GetAvailableStates",
    "GetAvailableTransitions",
    "GetState",
    "LifecycleState",
    "LifecycleStateMachine",
    "TransitionCallbackReturn",
    "TransitionDescription",
    "TransitionEvent",
]

ChangeState = service_class("lifecycle_msgs/srv/ChangeState")
GetAvailableStates = service_class("lifecycle_msgs/srv/GetAvailableStates")
GetAvailableTransitions = service_class("lifecycle_msgs/srv/GetAvailableTransitions")
GetState = service_class("lifecycle_msgs/srv/GetState")
LifecycleState = message_class("lifecycle_msgs/msg/State")
TransitionDescription = message_class("lifecycle_msgs/msg/TransitionDescription")
TransitionEvent = message_class("lifecycle_msgs/msg/TransitionEvent")

TEN_MESSAGES = QoSProfile(depth=10)
"""QoS of the services and topics of managed nodes."""

logger = get_logger("rcl_lifecycle")


class LifecycleStateMachine:
    """The state of one node, and the topic on which its changes are published.

    Args:
        node: The node.

    Attributes:
        machine: The state, by aionode's rules.
        initialized: Whether the node is there.
        service_change_state, service_get_state, service_get_available_states,
            service_get_available_transitions, service_get_transition_graph: The services' handles,
            or None without them.
    """

    service_change_state: Any = None
    service_get_state: Any = None
    service_get_available_states: Any = None
    service_get_available_transitions: Any = None
    service_get_transition_graph: Any = None

    def __init__(self, node: NodeHandle) -> None:
        self.initialized = True
        self.machine = StateMachine()
        self._events = PublisherHandle(node, TransitionEvent, "~/transition_event", TEN_MESSAGES)

    @property
    def current_state(self) -> tuple[int, str]:
        """The state: number and name."""
        state = self.machine.state
        return state.state_id, state.label

    def _possible(self, transition: Transition | None, wanted: str | int) -> Transition:
        """Return a transition if one was found; otherwise warn as rcl does, and raise."""
        if transition is None:
            state = self.machine.state
            logger.warning(f"No transition matching {wanted} found for current state {state.label}")
            raise RCLError(f"Transition {wanted!r} is not possible in state {state}")
        return transition

    def get_transition_by_label(self, label: str) -> int:
        """Return the number of the transition with this name that is possible now.

        Raises:
            RCLError: there is none.
        """
        return self._possible(self.machine.find(label), label).transition_id

    def trigger_transition_by_id(self, transition_id: int, publish: bool) -> Transition:
        """Change the state; return the transition.

        Raises:
            RCLError: the transition is not possible now.
        """
        transition = self._possible(self.machine.find(transition_id=transition_id), transition_id)
        self.machine.state = transition.goal
        if publish:
            event = fill_event(TransitionEvent(), transition.start, transition.goal)
            self._events.publish(event)
        return transition

    def trigger_transition_by_label(self, label: str, publish: bool) -> None:
        """Change the state.

        Raises:
            RCLError: the transition is not possible now.
        """
        self.trigger_transition_by_id(self.get_transition_by_label(label), publish)

    def destroy(self) -> None:
        """Stop publishing."""
        self.initialized = False
        self._events.destroy_when_not_in_use()
