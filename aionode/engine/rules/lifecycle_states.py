"""The states and transitions of a managed node: a table, and a state machine using it.

Numbers, names and order are those of `rcl_lifecycle`. A requested transition, such as `configure`,
leads to a transition state (`configuring`) in which the node's callback runs. The callback's result
is itself a transition, such as `transition_success`, and leads to the next primary state.
"""

from __future__ import annotations

from enum import Enum
from typing import Final, NamedTuple

__all__ = [
    "ACTIVE",
    "ERROR_PROCESSING",
    "FINALIZED",
    "INACTIVE",
    "STATES",
    "TRANSITIONS",
    "UNCONFIGURED",
    "State",
    "StateMachine",
    "Transition",
    "TransitionCallbackReturn",
]


class State(NamedTuple):
    """A state of a managed node, with rclpy's attribute names."""

    label: str
    state_id: int

    def __str__(self) -> str:
        return f"{self.label} [{self.state_id}]"


class Transition(NamedTuple):
    """A transition from one state to another."""

    transition_id: int
    label: str
    start: State
    goal: State

    def __str__(self) -> str:
        return f"{self.label} [{self.transition_id}]"


class TransitionCallbackReturn(Enum):
    """The result of a transition callback, with rclpy's values."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99

    def to_label(self) -> str:
        """Return the label of the transition that this result causes."""
        return f"transition_{self.name.lower()}"


UNKNOWN: Final = State("unknown", 0)
UNCONFIGURED: Final = State("unconfigured", 1)
INACTIVE: Final = State("inactive", 2)
ACTIVE: Final = State("active", 3)
FINALIZED: Final = State("finalized", 4)
CONFIGURING: Final = State("configuring", 10)
CLEANING_UP: Final = State("cleaningup", 11)
SHUTTING_DOWN: Final = State("shuttingdown", 12)
ACTIVATING: Final = State("activating", 13)
DEACTIVATING: Final = State("deactivating", 14)
ERROR_PROCESSING: Final = State("errorprocessing", 15)

STATES: Final = (
    UNKNOWN,
    UNCONFIGURED,
    INACTIVE,
    ACTIVE,
    FINALIZED,
    CONFIGURING,
    CLEANING_UP,
    SHUTTING_DOWN,
    ACTIVATING,
    DEACTIVATING,
    ERROR_PROCESSING,
)


def _outcomes(
    first_id: int, state: State, success: State, failure: State, error: State
) -> tuple[Transition, ...]:
    """Return the three transitions that a callback's result can cause."""
    return (
        Transition(first_id, "transition_success", state, success),
        Transition(first_id + 1, "transition_failure", state, failure),
        Transition(first_id + 2, "transition_error", state, error),
    )


TRANSITIONS: Final = (
    Transition(1, "configure", UNCONFIGURED, CONFIGURING),
    *_outcomes(10, CONFIGURING, INACTIVE, UNCONFIGURED, ERROR_PROCESSING),
    Transition(2, "cleanup", INACTIVE, CLEANING_UP),
    *_outcomes(20, CLEANING_UP, UNCONFIGURED, INACTIVE, ERROR_PROCESSING),
    Transition(3, "activate", INACTIVE, ACTIVATING),
    *_outcomes(30, ACTIVATING, ACTIVE, INACTIVE, ERROR_PROCESSING),
    Transition(4, "deactivate", ACTIVE, DEACTIVATING),
    *_outcomes(40, DEACTIVATING, INACTIVE, ACTIVE, ERROR_PROCESSING),
    Transition(5, "shutdown", UNCONFIGURED, SHUTTING_DOWN),
    Transition(6, "shutdown", INACTIVE, SHUTTING_DOWN),
    Transition(7, "shutdown", ACTIVE, SHUTTING_DOWN),
    *_outcomes(50, SHUTTING_DOWN, FINALIZED, FINALIZED, ERROR_PROCESSING),
    *_outcomes(60, ERROR_PROCESSING, UNCONFIGURED, FINALIZED, FINALIZED),
)
"""All transitions, in the order in which `rcl_lifecycle` lists them."""


class StateMachine:
    """The current state and its transitions; no callbacks, messages or time.

    Attributes:
        state: The current state.
    """

    def __init__(self) -> None:
        self.state = UNCONFIGURED

    @property
    def in_transition(self) -> bool:
        """Whether a transition is in progress, i.e. its callback has not returned."""
        return self.state.state_id >= CONFIGURING.state_id

    def available(self) -> list[Transition]:
        """Return the transitions that start in the current state."""
        return [transition for transition in TRANSITIONS if transition.start == self.state]

    def find(self, label: str = "", transition_id: int = 0) -> Transition | None:
        """Return an available transition by its label or, if that is empty, by its id.

        This is how `rcl_lifecycle` interprets a `ChangeState` request.
        """
        for transition in self.available():
            if label == transition.label if label else transition_id == transition.transition_id:
                return transition
        return None

    def begin(self, transition: Transition) -> None:
        """Enter the transition state of an available transition.

        Raises:
            ValueError: the transition does not start in the current state.
        """
        if transition.start != self.state:
            raise ValueError(f"{transition} starts in {transition.start}, not in {self.state}")
        self.state = transition.goal

    def finish(self, result: TransitionCallbackReturn) -> None:
        """Leave a transition state according to the result of its callback.

        Raises:
            ValueError: no transition is in progress.
        """
        outcome = self.find(result.to_label())
        if outcome is None:
            raise ValueError(f"no transition is in progress in {self.state}")
        self.state = outcome.goal
