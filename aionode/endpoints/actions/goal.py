"""The life of a goal: its states, the transitions between them, and what cancel requests select.

`TRANSITIONS` holds every transition. The server looks each change up there first, so no goal can
end twice, or be cancelled after its end::

    ACCEPTED --EXECUTE--> EXECUTING --SUCCEED--> SUCCEEDED
        |                  |     |
   CANCEL_GOAL    CANCEL_GOAL   ABORT----------> ABORTED
        |                  |                        ^
        +---> CANCELING <--+------ABORT-------------+
                  |------SUCCEED--> SUCCEEDED
                  +------CANCELED-> CANCELED

A rejected goal has no state, since it is not kept. ``UNKNOWN`` is what a server reports for a goal
that it does not know, or no longer knows.
"""

from __future__ import annotations

from enum import Enum, IntEnum
from typing import TYPE_CHECKING, NamedTuple

from aionode.errors import GoalTransitionError

if TYPE_CHECKING:
    from collections.abc import Container, Iterable

__all__ = [
    "ALL_GOALS",
    "TRANSITIONS",
    "CancelCode",
    "CancelResponse",
    "GoalEvent",
    "GoalKey",
    "GoalResponse",
    "GoalStatus",
    "alive_id",
    "candidates",
    "is_cancelable",
    "is_sign",
    "left_id",
    "next_status",
    "reason_id",
]

ALL_GOALS = bytes(16)
"""The goal id of cancel requests that do not name a goal."""


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
        """Take numbers that a later version of ROS may send for UNKNOWN."""
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


class GoalResponse(Enum):
    """The answer of a `goal_callback` to a new goal."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """The answer of a `cancel_callback` to a request to cancel a goal."""

    REJECT = 1
    ACCEPT = 2


class CancelCode(IntEnum):
    """The answer of a server to a cancel request, as in action_msgs/srv/CancelGoal."""

    NONE = 0
    REJECTED = 1
    UNKNOWN_GOAL_ID = 2
    GOAL_TERMINATED = 3


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


# Cancelling


class GoalKey(NamedTuple):
    """The properties of a goal by which a cancel request selects it.

    Attributes:
        goal_id: The 16 bytes of the id; all zero in a request that does not name a goal.
        stamp_ns: When the goal was accepted; 0 in a request that gives no time.
        status: The state of the goal.
    """

    goal_id: bytes
    stamp_ns: int
    status: GoalStatus = GoalStatus.UNKNOWN


def candidates(goals: Iterable[GoalKey], asked: GoalKey) -> tuple[CancelCode, list[bytes]]:
    """Return the ids of the goals that a cancel request selects, and the code if none is refused.

    ======== ========= ===============================================
    id       time      meaning
    ======== ========= ===============================================
    given    0         that goal
    0        0         all goals
    0        given     all accepted at that time or before
    given    given     that goal, and all accepted then or before
    ======== ========= ===============================================

    Only goals that can still be cancelled are selected. For a request for one goal that cannot be,
    the code tells why.
    """
    if asked.goal_id != ALL_GOALS and asked.stamp_ns == 0:
        for goal in goals:
            if goal.goal_id == asked.goal_id:
                if is_cancelable(goal.status):
                    return CancelCode.NONE, [goal.goal_id]
                return CancelCode.GOAL_TERMINATED, []  # as rcl answers while CANCELING too
        return CancelCode.UNKNOWN_GOAL_ID, []
    everything = asked.goal_id == ALL_GOALS and asked.stamp_ns == 0
    meant = [
        goal.goal_id
        for goal in goals
        if is_cancelable(goal.status)
        and (everything or goal.stamp_ns <= asked.stamp_ns or goal.goal_id == asked.goal_id)
    ]
    return CancelCode.NONE, meant


def is_cancelable(status: GoalStatus) -> bool:
    """Return whether a goal in this state can be cancelled."""
    return (status, GoalEvent.CANCEL_GOAL) in TRANSITIONS


# Why a goal was aborted


def reason_id(goal_id: bytes) -> bytes:
    """Return the id under which an aionode server tells why a goal was aborted.

    A ROS result has no field for it. An aionode client therefore calls ``get_result`` once more,
    with all bits of the id inverted, and gets the reason as a service error. No goal has such an
    id (it is not a version 4 UUID), so other servers answer that they do not know it. This needs
    no endpoint that ROS does not have, and works over every transport.
    """
    return bytes(byte ^ 0xFF for byte in goal_id)


# Whether the client of a goal is alive


def alive_id(goal_id: bytes) -> bytes:
    """Return the id with which a client calls ``get_result`` as a sign that it is alive.

    As for `reason_id`, this needs no endpoint that ROS does not have. So every rule of access
    control that lets a client use the action lets its signs pass. Twice it is the id of the goal.
    """
    return bytes(byte ^ 0x55 for byte in goal_id)


def left_id(goal_id: bytes) -> bytes:
    """Return the id with which a client calls ``get_result`` before it ends without the goal.

    Twice it is the id of the goal.
    """
    return bytes(byte ^ 0xAA for byte in goal_id)


def is_sign(asked_id: bytes, goals: Container[bytes]) -> bool:
    """Return whether a call of ``get_result`` with this id only tells that a client is alive."""
    return alive_id(asked_id) in goals or left_id(asked_id) in goals
