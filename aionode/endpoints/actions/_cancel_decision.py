"""Whether an action server cancels a goal when it is asked to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from aionode.endpoints.actions.common import awaited
from aionode.engine.rules.goal import CancelResponse
from aionode.errors import brief

__all__ = ["OWNER_LOST", "agrees", "ends_for_lost_owner"]

OWNER_LOST: Final = "the one for whom its client sent it is lost"


async def agrees(
    cancel_callback: Callable[[Any], Any] | None, goal: Any, warn: Callable[[str], None]
) -> bool:
    """Return whether a `cancel_callback` accepts to cancel a goal; without one, as in rclpy, no."""
    if cancel_callback is None:
        return False
    answer = await awaited(cancel_callback(goal))
    if not isinstance(answer, CancelResponse):
        warn(
            f"cancel_callback returned {brief(answer)}, no CancelResponse; the request is rejected"
        )
    return answer is CancelResponse.ACCEPT


def ends_for_lost_owner(
    on_client_lost: str | None, cancel_callback: Callable[[Any], Any] | None
) -> bool:
    """Return whether a goal is cancelled because nobody is there any more for whom it was sent.

    Its client asks so after an ordinary request was rejected: see `lost_id`. A `cancel_callback`
    has rejected it then, which counts unless ``on_client_lost="cancel"`` has the last word.
    """
    if on_client_lost is None:
        return cancel_callback is None
    return on_client_lost == "cancel"
