"""The state machine of managed nodes, with rcl_lifecycle's states and transitions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.lifecycle.states import STATES, TRANSITIONS, StateMachine, TransitionCallbackReturn
from aionode.logging import get_logger
from aionode.rclpy._impl import messages as msg
from aionode.rclpy._impl.errors import RCLError
from aionode.rclpy._impl.services import ServiceHandle
from aionode.rclpy._impl.topics import PublisherHandle

if TYPE_CHECKING:
    from aionode.lifecycle.states import Transition
    from aionode.rclpy._impl.node import NodeHandle

__all__ = ["LifecycleStateMachine", "TransitionCallbackReturn"]

logger = get_logger("rcl_lifecycle")

Description = tuple[int, str, int, str, int, str]


def described(transition: Transition) -> Description:
    """Return a transition as rclpy's extension does: numbers and names."""
    start, goal = transition.start, transition.goal
    return (
        transition.transition_id,
        transition.label,
        start.state_id,
        start.label,
        goal.state_id,
        goal.label,
    )


class LifecycleStateMachine:
    """The state of one node, its services, and the topic on which changes are published.

    Args:
        node: The node.
        enable_communication_interface: Whether there are services.

    Attributes:
        service_change_state, service_get_state, service_get_available_states,
            service_get_available_transitions, service_get_transition_graph: The services' handles,
            or None.

    Raises:
        TypeError: `enable_communication_interface` is not a bool.
    """

    def __init__(self, node: NodeHandle, enable_communication_interface: bool) -> None:
        if not isinstance(enable_communication_interface, bool):
            raise TypeError(
                "enable_communication_interface must be a bool, not "
                f"{type(enable_communication_interface).__name__}"
            )
        self.initialized = True
        self._machine = StateMachine()
        self._events = PublisherHandle(
            node, msg.TransitionEvent, "~/transition_event", msg.TEN_MESSAGES
        )

        def serve(srv_type: Any, name: str) -> ServiceHandle | None:
            if not enable_communication_interface:
                return None
            return ServiceHandle(node, srv_type, f"~/{name}", msg.TEN_MESSAGES)

        self.service_change_state = serve(msg.ChangeState, "change_state")
        self.service_get_state = serve(msg.GetState, "get_state")
        self.service_get_available_states = serve(msg.GetAvailableStates, "get_available_states")
        self.service_get_available_transitions = serve(
            msg.GetAvailableTransitions, "get_available_transitions"
        )
        self.service_get_transition_graph = serve(
            msg.GetAvailableTransitions, "get_transition_graph"
        )

    @property
    def current_state(self) -> tuple[int, str]:
        """The state: number and name."""
        state = self._machine.state
        return state.state_id, state.label

    @property
    def available_states(self) -> list[tuple[int, str]]:
        """All states."""
        return [(state.state_id, state.label) for state in STATES]

    @property
    def available_transitions(self) -> list[Description]:
        """The transitions that are possible now."""
        return [described(each) for each in self._machine.available()]

    @property
    def transition_graph(self) -> list[Description]:
        """All transitions."""
        return [described(each) for each in TRANSITIONS]

    def _possible(self, transition: Transition | None, wanted: str | int) -> Transition:
        """Return a transition that was found; without one warn as rcl does, and raise."""
        if transition is None:
            state = self._machine.state
            logger.warning(f"No transition matching {wanted} found for current state {state.label}")
            raise RCLError(f"Transition {wanted!r} is not possible in state {state}")
        return transition

    def get_transition_by_label(self, label: str) -> int:
        """Return the number of the transition of this name that is possible now.

        Raises:
            RCLError: there is none.
        """
        return self._possible(self._machine.find(label), label).transition_id

    def trigger_transition_by_id(self, transition_id: int, publish: bool) -> None:
        """Change the state.

        Raises:
            RCLError: the transition is not possible now.
        """
        found = self._machine.find(transition_id=transition_id)
        transition = self._possible(found, transition_id)
        self._machine.state = transition.goal
        if publish:
            event = msg.TransitionEvent()
            for state, message in (
                (transition.start, event.start_state),
                (transition.goal, event.goal_state),
            ):
                message.id, message.label = state.state_id, state.label
            self._events.publish(event)

    def trigger_transition_by_label(self, label: str, publish: bool) -> None:
        """Change the state.

        Raises:
            RCLError: the transition is not possible now.
        """
        self.trigger_transition_by_id(self.get_transition_by_label(label), publish)

    def destroy(self) -> None:
        """Publish no more."""
        self.initialized = False
        self._events.destroy_when_not_in_use()
