"""Which goals a cancel request selects, by goal id and time of acceptance."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, NamedTuple

from aionode.engine.rules.goal_states import GoalStatus, is_cancelable

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["ALL_GOALS", "CancelCode", "GoalKey", "goals_to_cancel"]

ALL_GOALS = bytes(16)
"""The goal id of cancel requests that do not name a goal."""


class CancelCode(IntEnum):
    """The answer of a server to a cancel request, as in action_msgs/srv/CancelGoal."""

    NONE = 0
    REJECTED = 1
    UNKNOWN_GOAL_ID = 2
    GOAL_TERMINATED = 3


class GoalKey(NamedTuple):
    """The properties of a goal by which cancel requests select it.

    Attributes:
        goal_id: The 16 bytes of the id; all zero in a request that does not name a goal.
        stamp_ns: When the goal was accepted; 0 in a request without a time.
        status: The state of the goal.
    """

    goal_id: bytes
    stamp_ns: int
    status: GoalStatus = GoalStatus.UNKNOWN


def goals_to_cancel(goals: Iterable[GoalKey], asked: GoalKey) -> tuple[CancelCode, list[bytes]]:
    """Return the ids of the goals that a cancel request selects, and a code.

    ======== ========= ===============================================
    id       time      meaning
    ======== ========= ===============================================
    given    0         that goal
    0        0         all goals
    0        given     all accepted at that time or before
    given    given     that goal, and all accepted then or before
    ======== ========= ===============================================

    Only goals that can still be canceled are selected. If a request names one goal that cannot be
    canceled, the code says why.
    """
    if asked.goal_id != ALL_GOALS and asked.stamp_ns == 0:
        for goal in goals:
            if goal.goal_id == asked.goal_id:
                if is_cancelable(goal.status):
                    return CancelCode.NONE, [goal.goal_id]
                return CancelCode.GOAL_TERMINATED, []  # rcl answers this even while CANCELING
        return CancelCode.UNKNOWN_GOAL_ID, []
    everything = asked.goal_id == ALL_GOALS and asked.stamp_ns == 0
    meant = [
        goal.goal_id
        for goal in goals
        if is_cancelable(goal.status)
        and (everything or goal.stamp_ns <= asked.stamp_ns or goal.goal_id == asked.goal_id)
    ]
    return CancelCode.NONE, meant
