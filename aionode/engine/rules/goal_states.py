"""The states of a goal, and the transitions between them: `goal.py` draws them."""

from __future__ import annotations

from enum import Enum, IntEnum

from aionode.errors import GoalTransitionError

__all__ = ["TRANSITIONS", "GoalEvent", "GoalStatus", "is_cancelable", "next_status"]


class GoalStatus(IntEnum):
    """The state of a goal, with the numbers of action_msgs/msg/GoalStatus.

    The names of that message work too: ``GoalStatus.STATUS_SUCCEEDED``.
    """

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6
    STATUS_UNKNOWN = 0
    STATUS_ACCEPTED = 1
    STATUS_EXECUTING = 2
    STATUS_CANCELING = 3
    STATUS_SUCCEEDED = 4
    STATUS_CANCELED = 5
    STATUS_ABORTED = 6

    @classmethod
    def _missing_(cls, value: object) -> GoalStatus | None:
        """Map numbers that a later version of ROS may send to UNKNOWN."""
        return cls.UNKNOWN if isinstance(value, int) else None

    @property
    def is_active(self) -> bool:
        """Whether the goal has been accepted and has not ended."""
        return self in {GoalStatus.ACCEPTED, GoalStatus.EXECUTING, GoalStatus.CANCELING}


class GoalEvent(IntEnum):
    """The events in the life of a goal, with the numbers of rcl_action."""

    EXECUTE = 0
    CANCEL_GOAL = 1
    SUCCEED = 2
    ABORT = 3
    CANCELED = 4

    __str__ = Enum.__str__  # as rclpy prints it: GoalEvent.SUCCEED


TRANSITIONS: dict[tuple[GoalStatus, GoalEvent], GoalStatus] = {
    (GoalStatus.ACCEPTED, GoalEvent.EXECUTE): GoalStatus.EXECUTING,
    (GoalStatus.ACCEPTED, GoalEvent.CANCEL_GOAL): GoalStatus.CANCELING,
    (GoalStatus.EXECUTING, GoalEvent.CANCEL_GOAL): GoalStatus.CANCELING,
    (GoalStatus.EXECUTING, GoalEvent.SUCCEED): GoalStatus.SUCCEEDED,
    (GoalStatus.EXECUTING, GoalEvent.ABORT): GoalStatus.ABORTED,
    (GoalStatus.CANCELING, GoalEvent.SUCCEED): GoalStatus.SUCCEEDED,
    (GoalStatus.CANCELING, GoalEvent.ABORT): GoalStatus.ABORTED,
    (GoalStatus.CANCELING, GoalEvent.CANCELED): GoalStatus.CANCELED,
}
"""Every allowed transition; anything else is an error."""


def next_status(status: GoalStatus, event: GoalEvent, goal_id: str = "") -> GoalStatus:
    """Return the state after `event`.

    Raises:
        GoalTransitionError: `event` cannot happen in `status` (a RuntimeError).
    """
    after = TRANSITIONS.get((status, event))
    if after is None:
        fits = [other_event.name for state, other_event in TRANSITIONS if state is status]
        raise GoalTransitionError(goal_id, status.name, event.name, fits)
    return after


def is_cancelable(status: GoalStatus) -> bool:
    """Return whether a goal in this state can be canceled."""
    return (status, GoalEvent.CANCEL_GOAL) in TRANSITIONS
