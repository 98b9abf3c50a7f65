"""Messages of lifecycle_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.message import DEFAULT, Message, uint8, uint64

__all__ = ["State", "Transition", "TransitionDescription", "TransitionEvent"]


class State(Message, typename="lifecycle_msgs/msg/State"):
    """A state of a managed node: a number, one of the constants, and its name."""

    PRIMARY_STATE_UNKNOWN: ClassVar[uint8] = 0
    PRIMARY_STATE_UNCONFIGURED: ClassVar[uint8] = 1
    PRIMARY_STATE_INACTIVE: ClassVar[uint8] = 2
    PRIMARY_STATE_ACTIVE: ClassVar[uint8] = 3
    PRIMARY_STATE_FINALIZED: ClassVar[uint8] = 4
    TRANSITION_STATE_CONFIGURING: ClassVar[uint8] = 10
    TRANSITION_STATE_CLEANINGUP: ClassVar[uint8] = 11
    TRANSITION_STATE_SHUTTINGDOWN: ClassVar[uint8] = 12
    TRANSITION_STATE_ACTIVATING: ClassVar[uint8] = 13
    TRANSITION_STATE_DEACTIVATING: ClassVar[uint8] = 14
    TRANSITION_STATE_ERRORPROCESSING: ClassVar[uint8] = 15

    id: uint8 = 0
    label: str = ""


class Transition(Message, typename="lifecycle_msgs/msg/Transition"):
    """A transition of a managed node between states: a number, one of the constants, and its name."""

    TRANSITION_CREATE: ClassVar[uint8] = 0
    TRANSITION_CONFIGURE: ClassVar[uint8] = 1
    TRANSITION_CLEANUP: ClassVar[uint8] = 2
    TRANSITION_ACTIVATE: ClassVar[uint8] = 3
    TRANSITION_DEACTIVATE: ClassVar[uint8] = 4
    TRANSITION_UNCONFIGURED_SHUTDOWN: ClassVar[uint8] = 5
    TRANSITION_INACTIVE_SHUTDOWN: ClassVar[uint8] = 6
    TRANSITION_ACTIVE_SHUTDOWN: ClassVar[uint8] = 7
    TRANSITION_DESTROY: ClassVar[uint8] = 8
    TRANSITION_ON_CONFIGURE_SUCCESS: ClassVar[uint8] = 10
    TRANSITION_ON_CONFIGURE_FAILURE: ClassVar[uint8] = 11
    TRANSITION_ON_CONFIGURE_ERROR: ClassVar[uint8] = 12
    TRANSITION_ON_CLEANUP_SUCCESS: ClassVar[uint8] = 20
    TRANSITION_ON_CLEANUP_FAILURE: ClassVar[uint8] = 21
    TRANSITION_ON_CLEANUP_ERROR: ClassVar[uint8] = 22
    TRANSITION_ON_ACTIVATE_SUCCESS: ClassVar[uint8] = 30
    TRANSITION_ON_ACTIVATE_FAILURE: ClassVar[uint8] = 31
    TRANSITION_ON_ACTIVATE_ERROR: ClassVar[uint8] = 32
    TRANSITION_ON_DEACTIVATE_SUCCESS: ClassVar[uint8] = 40
    TRANSITION_ON_DEACTIVATE_FAILURE: ClassVar[uint8] = 41
    TRANSITION_ON_DEACTIVATE_ERROR: ClassVar[uint8] = 42
    TRANSITION_ON_SHUTDOWN_SUCCESS: ClassVar[uint8] = 50
    TRANSITION_ON_SHUTDOWN_FAILURE: ClassVar[uint8] = 51
    TRANSITION_ON_SHUTDOWN_ERROR: ClassVar[uint8] = 52
    TRANSITION_ON_ERROR_SUCCESS: ClassVar[uint8] = 60
    TRANSITION_ON_ERROR_FAILURE: ClassVar[uint8] = 61
    TRANSITION_ON_ERROR_ERROR: ClassVar[uint8] = 62
    TRANSITION_CALLBACK_SUCCESS: ClassVar[uint8] = 97
    TRANSITION_CALLBACK_FAILURE: ClassVar[uint8] = 98
    TRANSITION_CALLBACK_ERROR: ClassVar[uint8] = 99

    id: uint8 = 0
    label: str = ""


class TransitionDescription(Message, typename="lifecycle_msgs/msg/TransitionDescription"):
    """A transition of a managed node, with its start and goal states."""

    transition: Transition = DEFAULT
    start_state: State = DEFAULT
    goal_state: State = DEFAULT


class TransitionEvent(Message, typename="lifecycle_msgs/msg/TransitionEvent"):
    """A transition that a managed node made; `timestamp` is in ns.

    From ROS 2 Lyrical on, this type is a different one: see the page on interfaces.
    """

    timestamp: uint64 = 0
    transition: Transition = DEFAULT
    start_state: State = DEFAULT
    goal_state: State = DEFAULT
