"""Handles of clocks, timers and guard conditions, which nothing outside the process reaches."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.clock import Clock, ClockChange, ClockType, Duration, JumpThreshold, MachineTime
from aionode.rclpy._impl.destroyable import Destroyable
from aionode.rclpy._impl.errors import RCLError, TimerCancelledError

if TYPE_CHECKING:
    from aionode.clock import JumpHandle, TimeJump
    from aionode.rclpy._impl.context import ContextHandle

__all__ = ["ClockHandle", "GuardConditionHandle", "TimerHandle"]

SWITCHES = (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)

ANY_JUMP = JumpThreshold(min_forward=Duration(nanoseconds=1), min_backward=Duration(nanoseconds=-1))

steady_ns = MachineTime().steady_ns


class ClockHandle(Destroyable):
    """A clock.

    Attributes:
        clock: aionode's clock, which shows the time.
    """

    def __init__(self, clock_type: int) -> None:
        super().__init__()
        self.clock = Clock(ClockType(clock_type))

    def get_now(self) -> Any:
        """Return the time, with an attribute `nanoseconds`."""
        return self.clock.now()


class GuardConditionHandle(Destroyable):
    """A condition that any thread triggers; whoever takes it resets it."""

    def __init__(self, context: ContextHandle) -> None:
        super().__init__()
        context.refuse_if_over("guard_condition")
        self._triggered = False

    def trigger_guard_condition(self) -> None:
        """Trigger it."""
        self._triggered = True
        self.signal.notify()

    def ready(self) -> bool:
        """Return whether it is triggered."""
        return self._triggered and not self._unwanted

    def take(self) -> bool:
        """Reset it; return whether it was triggered."""
        triggered, self._triggered = self._triggered, False
        return triggered


class TimerHandle(Destroyable):
    """When a timer is due next, by the rules of rcl: calls are on a grid, missed ones are skipped.

    On a clock of ROS time, a jump back begins a new period, and switching ROS time on or off keeps
    what was left of the period.
    """

    def __init__(
        self,
        clock: ClockHandle,
        context: ContextHandle,
        period_ns: int,
        autostart: bool = True,
    ) -> None:
        super().__init__()
        if period_ns < 0:
            raise RCLError("timer period must be non-negative")
        context.refuse_if_over("timer")
        self._clock = clock
        self._period_ns = period_ns
        now_ns = self._now_ns()
        self._last_ns = now_ns
        self._next_ns = now_ns + period_ns
        self._credit_ns = 0
        self._cancelled = not autostart
        self._jumps: JumpHandle | None = None
        if clock.clock.clock_type is ClockType.ROS_TIME:
            self._jumps = clock.clock.create_jump_callback(
                ANY_JUMP, pre_callback=self._before_jump, post_callback=self._after_jump
            )

    def _now_ns(self) -> int:
        return self._clock.clock.now_ns()

    def _before_jump(self) -> None:
        now_ns = self._now_ns()
        if now_ns:
            self._credit_ns = self._next_ns - now_ns

    def _after_jump(self, jump: TimeJump) -> None:
        now_ns = self._now_ns()
        if jump.clock_change in SWITCHES:
            if now_ns and self._credit_ns:
                self._next_ns = now_ns + self._credit_ns
                self._last_ns = self._next_ns - self._period_ns
        elif now_ns < self._last_ns:
            self._next_ns = now_ns + self._period_ns
            self._last_ns = now_ns
        self.signal.notify()

    @property
    def waits_for_jump(self) -> bool:
        """Whether its clock is set by hand: time passes only when it is set."""
        return self._clock.clock.ros_time_is_active

    def ready(self) -> bool:
        """Return whether it is due."""
        return not (self._cancelled or self._unwanted) and self._now_ns() >= self._next_ns

    is_timer_ready = ready

    def due_in_ns(self) -> int | None:
        """Return how long it is until the call, in real time; None if that is not known."""
        if self._cancelled or self._unwanted or self.waits_for_jump:
            return None
        return self._next_ns - self._now_ns()

    def call_timer_with_info(self) -> dict[str, int]:
        """Note a call; return when it was expected and when it was, in nanoseconds.

        Raises:
            TimerCancelledError: it is cancelled.
        """
        if self._cancelled:
            raise TimerCancelledError("Failed to call timer: timer is canceled")
        now_ns = self._now_ns()
        expected_ns = self._next_ns
        self._last_ns = now_ns
        self._next_ns += self._period_ns
        if self._next_ns < now_ns:
            if self._period_ns == 0:
                self._next_ns = now_ns
            else:
                late_ns = now_ns - self._next_ns
                self._next_ns += (1 + (late_ns - 1) // self._period_ns) * self._period_ns
        return {"expected_call_time": expected_ns, "actual_call_time": now_ns}

    def call_timer(self) -> None:
        """Note a call."""
        self.call_timer_with_info()

    def cancel_timer(self) -> None:
        """Call no more, until it is reset."""
        self._cancelled = True

    def is_timer_canceled(self) -> bool:
        """Return whether it is cancelled."""
        return self._cancelled

    def reset_timer(self) -> None:
        """Begin a new period now, also if it was cancelled."""
        self._next_ns = self._now_ns() + self._period_ns
        self._cancelled = False
        self.signal.notify()

    def get_timer_period(self) -> int:
        """Return the period in nanoseconds."""
        return self._period_ns

    def change_timer_period(self, period_ns: int) -> None:
        """Change the period, from the next call on.

        Raises:
            RCLError: it is negative.
        """
        if period_ns < 0:
            raise RCLError("timer period must be non-negative")
        self._period_ns = period_ns

    def time_since_last_call(self) -> int:
        """Return nanoseconds since the last call, or since the beginning."""
        return self._now_ns() - self._last_ns

    def time_until_next_call(self) -> int | None:
        """Return nanoseconds until the next call, negative if it is late; None if cancelled."""
        return None if self._cancelled else self._next_ns - self._now_ns()

    def _destroy(self) -> None:
        if getattr(self, "_jumps", None) is not None:
            self._jumps.unregister()  # type: ignore[union-attr]
        self.signal.notify()
