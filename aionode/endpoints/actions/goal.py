"""The states of goals; see `aionode.engine.rules.goal`."""

from aionode.engine.rules.goal import (
    ALL_GOALS,
    TRANSITIONS,
    CancelCode,
    CancelResponse,
    GoalEvent,
    GoalKey,
    GoalResponse,
    GoalStatus,
    alive_id,
    goals_to_cancel,
    is_cancelable,
    is_sign,
    left_id,
    lost_id,
    next_status,
    reason_id,
)

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
    "goals_to_cancel",
    "is_cancelable",
    "is_sign",
    "left_id",
    "lost_id",
    "next_status",
    "reason_id",
]
