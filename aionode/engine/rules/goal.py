"""The life cycle of a goal: states, transitions, and which goals cancel requests select.

`TRANSITIONS` holds every transition. The server looks up each change there first, so no goal can
end twice, or be canceled after its end::

    ACCEPTED --EXECUTE--> EXECUTING --SUCCEED--> SUCCEEDED
        |                  |     |
   CANCEL_GOAL    CANCEL_GOAL   ABORT----------> ABORTED
        |                  |                        ^
        +---> CANCELING <--+------ABORT-------------+
                  |------SUCCEED--> SUCCEEDED
                  +------CANCELED-> CANCELED

A rejected goal has no state, since it is not kept. ``UNKNOWN`` is what a server reports for a goal
that it does not know (any more).

`ALL_GOALS` is the goal id of cancel requests that do not name a goal. aionode clients call
``get_result`` with the ids of `reason_id`, `alive_id` and `left_id` for purposes other than the
result, and ``cancel_goal`` with that of `lost_id`.

The states are in `goal_states.py`, and the selection by cancel requests in `cancel_selection.py`.
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
    "MAX_REJECTIONS",
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


MAX_REJECTIONS = 100
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
    """Return the id with which a client calls ``get_result`` as a sign of life.

    Like `reason_id`, this needs no endpoint beyond ROS's own, so any access control rule that lets
    a client use the action also permits it. Applying it twice gives the id of the goal.
    """
    return bytes(byte ^ 0x55 for byte in goal_id)


def left_id(goal_id: bytes) -> bytes:
    """Return the id with which a client calls ``get_result`` before it leaves without the goal.

    Applying it twice gives the id of the goal.
    """
    return bytes(byte ^ 0xAA for byte in goal_id)


def lost_id(goal_id: bytes) -> bytes:
    """Return the id with which a client cancels a goal whose owner is lost.

    It is used for goals sent on behalf of someone else, as by a gateway, if the server refused to
    cancel by the goal's own id. Servers other than aionode's answer that they do not know the goal.
    Applying it twice gives the id of the goal.
    """
    return bytes(byte ^ 0x33 for byte in goal_id)


def is_sign(asked_id: bytes, goals: Container[bytes]) -> bool:
    """Return whether a call of ``get_result`` with this id is only a sign of life."""
    return alive_id(asked_id) in goals or left_id(asked_id) in goals
