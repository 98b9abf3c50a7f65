"""The states of managed nodes; see `aionode.engine.rules.lifecycle_states`."""

from aionode.engine.rules.lifecycle_states import (
    ACTIVE,
    ERROR_PROCESSING,
    FINALIZED,
    INACTIVE,
    STATES,
    TRANSITIONS,
    UNCONFIGURED,
    State,
    StateMachine,
    Transition,
    TransitionCallbackReturn,
)

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
