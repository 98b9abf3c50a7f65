"""The state machine of managed nodes, with rcl_lifecycle's states and transitions."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Any, NamedTuple

from aionode.rclpy._impl import messages as msg
from aionode.rclpy._impl.errors import RCLError
from aionode.rclpy._impl.services import ServiceHandle
from aionode.rclpy._impl.topics import PublisherHandle

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.rclpy._impl.node import NodeHandle

__all__ = ["LifecycleStateMachine", "Transition", "TransitionCallbackReturn"]

STATES = {
    0: "unknown",
    1: "unconfigured",
    2: "inactive",
    3: "active",
    4: "finalized",
    10: "configuring",
    11: "cleaningup",
    12: "shuttingdown",
    13: "activating",
    14: "deactivating",
    15: "errorprocessing",
}

UNCONFIGURED, INACTIVE, ACTIVE, FINALIZED = 1, 2, 3, 4
CONFIGURING, CLEANINGUP, SHUTTINGDOWN, ACTIVATING, DEACTIVATING, ERRORPROCESSING = range(10, 16)

OUTCOMES = ("transition_success", "transition_failure", "transition_error")


class TransitionCallbackReturn(IntEnum):
    """What a callback of a transition returns."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99

    def to_label(self) -> str:
        """Return the label of the transition that follows."""
        return f"transition_{self.name.lower()}"


class Transition(NamedTuple):
    """One transition.

    Attributes:
        id: Its number.
        label: Its name.
        start: The state in which it begins.
        goal: The state that follows.
    """

    id: int
    label: str
    start: int
    goal: int

    def described(self) -> tuple[int, str, int, str, int, str]:
        """Return it with the names of its states, as rclpy's extension does."""
        return (self.id, self.label, self.start, STATES[self.start], self.goal, STATES[self.goal])


def transitions() -> Iterator[Transition]:
    """Yield all transitions, in rcl's order."""
    # For each: how it begins, and the states that follow success, failure and error.
    for number, label, start, between, outcomes in (
        (1, "configure", UNCONFIGURED, CONFIGURING, (INACTIVE, UNCONFIGURED, ERRORPROCESSING)),
        (2, "cleanup", INACTIVE, CLEANINGUP, (UNCONFIGURED, INACTIVE, ERRORPROCESSING)),
        (3, "activate", INACTIVE, ACTIVATING, (ACTIVE, INACTIVE, ERRORPROCESSING)),
        (4, "deactivate", ACTIVE, DEACTIVATING, (INACTIVE, ACTIVE, ERRORPROCESSING)),
    ):
        yield Transition(number, label, start, between)
        for offset, (outcome, goal) in enumerate(zip(OUTCOMES, outcomes, strict=True)):
            yield Transition(10 * number + offset, outcome, between, goal)
    for number, start in ((5, UNCONFIGURED), (6, INACTIVE), (7, ACTIVE)):
        yield Transition(number, "shutdown", start, SHUTTINGDOWN)
    for first, between, outcomes in (
        (50, SHUTTINGDOWN, (FINALIZED, FINALIZED, ERRORPROCESSING)),
        (60, ERRORPROCESSING, (UNCONFIGURED, FINALIZED, FINALIZED)),
    ):
        for offset, (outcome, goal) in enumerate(zip(OUTCOMES, outcomes, strict=True)):
            yield Transition(first + offset, outcome, between, goal)


TRANSITIONS = tuple(transitions())


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
        self._state = UNCONFIGURED
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
        return self._state, STATES[self._state]

    @property
    def available_states(self) -> list[tuple[int, str]]:
        """All states."""
        return list(STATES.items())

    @property
    def available_transitions(self) -> list[tuple[int, str, int, str, int, str]]:
        """The transitions that are possible now."""
        return [each.described() for each in TRANSITIONS if each.start == self._state]

    @property
    def transition_graph(self) -> list[tuple[int, str, int, str, int, str]]:
        """All transitions."""
        return [each.described() for each in TRANSITIONS]

    def get_transition_by_label(self, label: str) -> int:
        """Return the number of the transition of this name that is possible now.

        Raises:
            RCLError: there is none.
        """
        for transition in TRANSITIONS:
            if transition.start == self._state and transition.label == label:
                return transition.id
        raise RCLError(
            f"Transition with label '{label}' is not possible in state {STATES[self._state]}"
        )

    def trigger_transition_by_id(self, transition_id: int, publish: bool) -> None:
        """Change the state.

        Raises:
            RCLError: the transition is not possible now.
        """
        for transition in TRANSITIONS:
            if transition.start == self._state and transition.id == transition_id:
                break
        else:
            raise RCLError(
                f"Transition {transition_id} is not possible in state {STATES[self._state]}"
            )
        self._state = transition.goal
        if publish:
            event = msg.TransitionEvent()
            event.start_state.id, event.start_state.label = (
                transition.start,
                STATES[transition.start],
            )
            event.goal_state.id, event.goal_state.label = transition.goal, STATES[transition.goal]
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
