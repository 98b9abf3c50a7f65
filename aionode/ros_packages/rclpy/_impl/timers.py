"""Handles of clocks, timers and guard conditions, which are local to the process."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

from aionode.clock import Clock, ClockType, Duration, JumpThreshold
from aionode.engine.rules.schedule import ClockedSchedule
from rclpy._impl.destroyable import Destroyable
from rclpy._impl.errors import RCLError, TimerCancelledError

if TYPE_CHECKING:
    from aionode.engine.causes import CauseLog
    from rclpy._impl.context import ContextHandle

__all__ = ["ClockHandle", "GuardConditionHandle", "TimerHandle"]

ANY_JUMP = JumpThreshold(min_forward=Duration(nanoseconds=1), min_backward=Duration(nanoseconds=-1))


class ClockHandle(Destroyable, Clock):
    """A clock: aionode's clock as a handle."""

    def __new__(cls, *_: Any, **__: Any) -> Self:
        """Create a clock of this class for each clock type; `Clock` has one for ROS time."""
        return object.__new__(cls)

    def __init__(self, clock_type: int) -> None:
        Destroyable.__init__(self)
        Clock.__init__(self, ClockType(clock_type))


class GuardConditionHandle(Destroyable):
    """A condition that any thread triggers, and that is reset when taken."""

    def __init__(self, context: ContextHandle) -> None:
        super().__init__()
        context.refuse_if_over("guard_condition")
        self._triggered = False  # set by any thread, reset by the one that takes it

    def trigger_guard_condition(self) -> None:
        """Trigger the guard condition, from any thread."""
        self._triggered = True
        self.signal.notify()

    def ready(self) -> bool:
        """Return whether it is triggered."""
        return self._triggered and not self._unwanted

    def take(self) -> bool:
        """Reset it; return whether it was triggered."""
        triggered, self._triggered = self._triggered, False
        return triggered


class TimerHandle(Destroyable, ClockedSchedule):
    """The due times of a timer, by the rules of rcl."""

    def __init__(
        self,
        clock: ClockHandle,
        context: ContextHandle,
        period_ns: int,
        autostart: bool = True,
    ) -> None:
        Destroyable.__init__(self)
        refuse_negative(period_ns)
        context.refuse_if_over("timer")
        self.causes: CauseLog | None = context.io.context.causes
        ClockedSchedule.__init__(
            self,
            clock,
            period_ns,
            autostart=autostart,
            jumps=ANY_JUMP,
        )

    def wake(self) -> None:
        """Wake those who wait for the timer."""
        self.signal.notify()

    def _switch(self, old_now_ns: int, new_now_ns: int) -> None:
        """Keep the rest of the period; before the first ROS time there is nothing to keep."""
        if old_now_ns and new_now_ns:
            super()._switch(old_now_ns, new_now_ns)

    @property
    def waits_for_jump(self) -> bool:
        """Whether its clock is set externally: then time passes only when it is set."""
        return self.clock.ros_time_is_active

    def ready(self) -> bool:
        """Return whether it is due."""
        return not self._unwanted and self.schedule.is_ready(self.clock.now_ns())

    is_timer_ready = ready

    def due_in_ns(self) -> int | None:
        """Return the time until the call, in real time; None if that is unknown."""
        if self._unwanted or self.waits_for_jump:
            return None
        return self.time_until_next_call()

    def call_timer_with_info(self) -> dict[str, int]:
        """Record a call; return its expected and actual time, in nanoseconds.

        Raises:
            TimerCancelledError: it is cancelled.
        """
        now_ns = self.clock.now_ns()
        try:
            expected_ns = self.schedule.call(now_ns)
        except RuntimeError as error:
            raise TimerCancelledError("Failed to call timer: timer is canceled") from error
        return {"expected_call_time": expected_ns, "actual_call_time": now_ns}

    def call_timer(self) -> None:
        """Record a call."""
        self.call_timer_with_info()

    def cancel_timer(self) -> None:
        """Stop calling until it is reset."""
        self.schedule.cancel()

    def is_timer_canceled(self) -> bool:
        """Return whether it is cancelled."""
        return self.schedule.canceled

    def reset_timer(self) -> None:
        """Start a new period now, even if it was cancelled."""
        self.schedule.reset(self.clock.now_ns())
        self.wake()

    def get_timer_period(self) -> int:
        """Return the period in nanoseconds."""
        return self.schedule.period_ns

    def change_timer_period(self, period_ns: int) -> None:
        """Change the period, from the next call on.

        Raises:
            RCLError: it is negative.
        """
        refuse_negative(period_ns)
        self.schedule.change_period(period_ns)

    def time_since_last_call(self) -> int:
        """Return the nanoseconds since the last call, or since the start."""
        return self.schedule.since_last_ns(self.clock.now_ns())

    def time_until_next_call(self) -> int | None:
        """Return nanoseconds until the next call, negative if it is late; None if cancelled."""
        return self.schedule.until_next_ns(self.clock.now_ns())

    def _destroy(self) -> None:
        if hasattr(self, "_jumps"):
            self.close()
        self.wake()


def refuse_negative(period_ns: int) -> None:
    """Raise RCLError for a negative period."""
    if period_ns < 0:
        raise RCLError("timer period must be non-negative")
