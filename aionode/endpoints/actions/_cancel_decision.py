"""Decides whether an action server cancels a goal on request."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from aionode.endpoints.actions.common import awaited
from aionode.engine.rules.goal import CancelResponse
from aionode.errors import brief

__all__ = ["OWNER_LOST", "agrees", "ends_for_lost_owner"]

OWNER_LOST: Final = "the client on whose behalf it was sent is lost"


async def agrees(
    cancel_callback: Callable[[Any], Any] | None, goal: Any, warn: Callable[[str], None]
) -> bool:
    """Return whether `cancel_callback` agrees to cancel a goal; False without one, as in rclpy."""
    if cancel_callback is None:
        return False
    answer = await awaited(cancel_callback(goal))
    if not isinstance(answer, CancelResponse):
        warn(f"cancel_callback returned {brief(answer)}, not a CancelResponse; rejected")
    return answer is CancelResponse.ACCEPT


def ends_for_lost_owner(
    on_client_lost: str | None, cancel_callback: Callable[[Any], Any] | None
) -> bool:
    """Return whether to cancel a goal because the party it was sent for is gone.

    Its client asks for this after an ordinary request was rejected; see `lost_id`. A rejection by
    `cancel_callback` stands, unless ``on_client_lost="cancel"`` overrides it.
    """
    if on_client_lost is None:
        return cancel_callback is None
    return on_client_lost == "cancel"
