"""Guard conditions, which any thread may trigger."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rclpy._entities import HandleOwner, in_use
from rclpy._impl.timers import GuardConditionHandle
from rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.callback_groups import CallbackGroup
    from rclpy.context import Context

__all__ = ["GuardCondition"]


class GuardCondition(HandleOwner[GuardConditionHandle]):
    """Makes an executor call `callback` after `trigger`. Created by `Node.create_guard_condition`.

    Attributes:
        callback: The function to call; None to only wake the executor.
        callback_group: Its group.
    """

    def __init__(
        self,
        callback: Callable[[], object] | None,
        callback_group: CallbackGroup | None,
        context: Context | None = None,
    ) -> None:
        self._context = get_default_context() if context is None else context
        if self._context.handle is None:
            raise RuntimeError("Context must be initialized a GuardCondition can be created")
        self._handle = GuardConditionHandle(self._context.handle)
        self.callback = callback
        self.callback_group = callback_group
        self._executor_event = False  # whether an executor has a task for it that has not started

    trigger = in_use(GuardConditionHandle.trigger_guard_condition)
