"""The life of a goal: its states, their transitions, and the goals that cancel requests select.

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

`ALL_GOALS` is the goal id of cancel requests that do not name a goal. An aionode client calls
``get_result`` with the ids of `reason_id`, `alive_id` and `left_id` for more than the result, and
``cancel_goal`` with that of `lost_id`.

The states are in `_goal_states.py`, and the goals of a cancel request in `_cancel_selection.py`.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING

from aionode.engine.rules.cancel_selection import (
    ALL_GOALS,
    CancelCode,
    GoalKey,
    goals_to_cancel,
)
from aionode.engine.rules.goal_states import (
    TRANSITIONS,
    GoalEvent,
    GoalStatus,
    is_cancelable,
    next_status,
)

if TYPE_CHECKING:
    from collections.abc import Container

__all__ = [
    "ALL_GOALS",
    "MOST_REJECTIONS",
    "TRANSITIONS",
    "CancelCode",
    "CancelResponse",
    "GoalEvent",
    "GoalKey",
    "GoalResponse",
    "GoalStatus",
    "alive_id",
    "goals_to_cancel",
    "is_cancelable",
    "is_sign",
    "left_id",
    "lost_id",
    "next_status",
    "reason_id",
]


class GoalResponse(Enum):
    """The answer of a `goal_callback` to a new goal."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """The answer of a `cancel_callback` to a request to cancel a goal."""

    REJECT = 1
    ACCEPT = 2


# Why a goal was rejected or aborted


MOST_REJECTIONS = 100
"""Most rejected goals whose reason a server keeps: their clients ask for it at once."""


def reason_id(goal_id: bytes) -> bytes:
    """Return the id under which an aionode server tells why a goal was rejected or aborted.

    A ROS response or result has no field for it. An aionode client therefore calls ``get_result``
    once more, with all bits of the id inverted, and gets the reason as a service error. No goal has
    such an id (it is not a version 4 UUID), so other servers answer that they do not know it. This
    needs no endpoint that ROS does not have, and works over every transport.
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


def lost_id(goal_id: bytes) -> bytes:
    """Return the id with which a client cancels a goal whose owner is lost.

    It has sent the goal for somebody else, as a gateway does, and the server has rejected to cancel
    it by its own id. Servers that are not aionode's answer that they do not know the goal. Twice it
    is the id of the goal.
    """
    return bytes(byte ^ 0x33 for byte in goal_id)


def is_sign(asked_id: bytes, goals: Container[bytes]) -> bool:
    """Return whether a call of ``get_result`` with this id only tells that a client is alive."""
    return alive_id(asked_id) in goals or left_id(asked_id) in goals
