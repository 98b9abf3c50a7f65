"""States and transitions as messages, and the answers to queries about a managed node."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.engine.rules.lifecycle_states import STATES, TRANSITIONS

if TYPE_CHECKING:
    from aionode.engine.rules.lifecycle_states import State, StateMachine, Transition

__all__ = ["StateAnswers", "fill_event", "fill_state"]


class StateAnswers:
    """The callbacks of the four read-only services.

    Args:
        machine: The state machine.
        state_class: The class of lifecycle_msgs/msg/State.
        description_class: The class of lifecycle_msgs/msg/TransitionDescription.
    """

    def __init__(self, machine: StateMachine, state_class: Any, description_class: Any) -> None:
        self._machine = machine
        self._state_class = state_class
        self._description_class = description_class

    def get_state(self, request: Any, response: Any) -> Any:  # noqa: ARG002  # it has no fields
        """Answer ``~/get_state``."""
        fill_state(response.current_state, self._machine.state)
        return response

    def get_available_states(self, request: Any, response: Any) -> Any:  # noqa: ARG002  # as above
        """Answer ``~/get_available_states`` with all states."""
        response.available_states = [fill_state(self._state_class(), state) for state in STATES]
        return response

    def get_available_transitions(self, request: Any, response: Any) -> Any:  # noqa: ARG002  # as above
        """Answer ``~/get_available_transitions`` with those possible now."""
        response.available_transitions = [
            self._described(transition) for transition in self._machine.available()
        ]
        return response

    def get_transition_graph(self, request: Any, response: Any) -> Any:  # noqa: ARG002  # as above
        """Answer ``~/get_transition_graph`` with all transitions."""
        response.available_transitions = [self._described(transition) for transition in TRANSITIONS]
        return response

    def _described(self, transition: Transition) -> Any:
        message = self._description_class()
        message.transition.id = transition.transition_id
        message.transition.label = transition.label
        return fill_event(message, transition.start, transition.goal)


def fill_state(message: Any, state: State) -> Any:
    """Set the fields of a State message, and return it."""
    message.id = state.state_id
    message.label = state.label
    return message


def fill_event(message: Any, start: State, goal: State) -> Any:
    """Set the two states of a TransitionEvent or TransitionDescription, and return it."""
    fill_state(message.start_state, start)
    fill_state(message.goal_state, goal)
    return message
