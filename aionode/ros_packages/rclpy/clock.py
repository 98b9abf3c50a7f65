"""Clocks with blocking sleeps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode import clock as core
from aionode.clock import (
    ClockChange,
    ClockType,
    JumpHandle,
    JumpThreshold,
    MachineTime,
    TimeJump,
)
from rclpy._impl.destroyable import Wakeup
from rclpy._impl.timers import ClockHandle
from rclpy.duration import Duration
from rclpy.exceptions import NotInitializedException
from rclpy.time import Time
from rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from rclpy.context import Context

__all__ = [
    "BaseClock",
    "Clock",
    "ClockChange",
    "JumpHandle",
    "JumpThreshold",
    "ROSClock",
    "TimeJump",
]

SWITCHES = (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)

MAX_STEP_S = 1.0
"""Interval at which a sleep on the system clock checks whether that clock was set."""

steady_ns = MachineTime().steady_ns


class Clock(ClockHandle):
    """Shows the time. With ROS_TIME, a `ROSClock` is created.

    Jump callbacks are called in the thread that sets the clock, which is the one that spins its
    node.

    Raises:
        TypeError: `clock_type` is not a `ClockType`.
    """

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> Clock:  # noqa: PYI034  # may be a ROSClock
        """Create a `ROSClock` for ROS time."""
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        return object.__new__(ROSClock if clock_type is ClockType.ROS_TIME else cls)

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> None:
        super().__init__(clock_type)

    @property
    def handle(self) -> ClockHandle:
        """The handle: the clock itself."""
        return self

    def now(self) -> Time:
        """Return the time."""
        return Time(nanoseconds=self.now_ns(), clock_type=self.clock_type)

    def sleep_until(self, until: core.Time, context: Context | None = None) -> bool:  # type: ignore[override] # blocks
        """Block the thread until the clock shows `until`, or the context is shut down.

        A ROS time clock is set by a callback, so another thread has to spin meanwhile.

        Args:
            until: A time of this type of clock.
            context: The context; the default one by default.

        Returns:
            Whether the time has come; False if the context was shut down, or ROS time switched on
            or off.

        Raises:
            NotInitializedException: the context is not initialised.
            ValueError: `until` belongs to another type of clock.
        """
        context = get_default_context() if context is None else context
        if not context.ok() or context.handle is None:
            raise NotInitializedException
        if until.clock_type != self.clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        wakeup = Wakeup()
        switched = False

        def on_jump(jump: TimeJump) -> None:
            nonlocal switched
            switched = switched or jump.clock_change in SWITCHES
            wakeup.wake()

        threshold = JumpThreshold(
            min_forward=Duration(nanoseconds=1), min_backward=None, on_clock_change=True
        )
        context.handle.signal.add(wakeup)
        try:
            with self.create_jump_callback(threshold, post_callback=on_jump):
                while context.ok() and not switched:
                    left_ns = until.nanoseconds - self.now_ns()
                    if left_ns <= 0:
                        break
                    timeout_sec = None
                    if not self.ros_time_is_active:
                        timeout_sec = left_ns / 1e9
                        if self.clock_type is not ClockType.STEADY_TIME:
                            timeout_sec = min(timeout_sec, MAX_STEP_S)
                    wakeup.wait(timeout_sec)
        finally:
            context.handle.signal.remove(wakeup)
        return context.ok() and not switched and self.now_ns() >= until.nanoseconds

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Block the thread for a duration; see `sleep_until`."""
        return self.sleep_until(self.now() + rel_time, context)


class ROSClock(Clock):
    """A clock that shows ROS time: the system's until ROS time is switched on."""

    def __new__(cls, **_: Any) -> ROSClock:  # noqa: PYI034  # as in Clock
        """Create a clock of ROS time."""
        return object.__new__(cls)

    def __init__(self, **_: Any) -> None:
        super().__init__(clock_type=ClockType.ROS_TIME)


BaseClock = Clock
"""The base of this class and the asynchronous one in rclpy of Lyrical, which are one class here."""
