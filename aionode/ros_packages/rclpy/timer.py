"""Timers, and rates based on them."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

from aionode.clock import ClockType
from rclpy._entities import HandleOwner, in_use, wait_until
from rclpy._impl.destroyable import Signal, Wakeup
from rclpy._impl.timers import TimerHandle
from rclpy.clock import Clock
from rclpy.exceptions import InvalidHandle, ROSInterruptException
from rclpy.time import Time
from rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.callback_groups import CallbackGroup
    from rclpy.context import Context

__all__ = [
    "BaseTimer",
    "Clock",
    "Rate",
    "Timer",
    "TimerInfo",
]


class TimerInfo:
    """The scheduled and actual time of a call, for callback parameters annotated with this class.

    Raises:
        TypeError: `clock_type` is not a `ClockType`.
        ValueError: a time is negative.
    """

    def __init__(
        self,
        *,
        expected_call_time: int = 0,
        actual_call_time: int = 0,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        if expected_call_time < 0 or actual_call_time < 0:
            raise ValueError("call time values must not be negative")
        self._expected_call_time = Time(nanoseconds=expected_call_time, clock_type=clock_type)
        self._actual_call_time = Time(nanoseconds=actual_call_time, clock_type=clock_type)

    @property
    def expected_call_time(self) -> Time:
        """When it was due."""
        return self._expected_call_time

    @property
    def actual_call_time(self) -> Time:
        """When it was taken by the executor."""
        return self._actual_call_time


class Timer(HandleOwner[TimerHandle]):
    """Calls its callback periodically. Created by `Node.create_timer`.

    Attributes:
        callback: The function that is called.
        callback_group: Its group.
    """

    def __init__(
        self,
        callback: Callable[..., object] | None,
        callback_group: CallbackGroup | None,
        timer_period_ns: int,
        clock: Clock,
        *,
        context: Context | None = None,
        autostart: bool = True,
    ) -> None:
        self._context = get_default_context() if context is None else context
        self._clock = clock
        if self._context.handle is None:
            raise RuntimeError("Context must be initialized before create a _rclpy.Timer.")
        with self._context.handle as context_handle:
            self._handle = TimerHandle(clock, context_handle, int(timer_period_ns), autostart)
        self.callback = callback
        self.callback_group = callback_group
        self._executor_event = False
        self._inspected: tuple[Any, str | None] | None = None

    @property
    def __timer(self) -> TimerHandle:
        """The handle, under the name that programs know."""
        return self._handle

    @property
    def clock(self) -> Clock:
        """The clock that it follows."""
        return self._clock

    @property
    def timer_period_ns(self) -> int:
        """The period in nanoseconds; a new one applies from the next call on."""
        with self._handle:
            return self._handle.get_timer_period()

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        with self._handle:
            self._handle.change_timer_period(int(value))

    is_ready = in_use(TimerHandle.is_timer_ready)
    is_canceled = in_use(TimerHandle.is_timer_canceled)
    cancel = in_use(TimerHandle.cancel_timer)
    reset = in_use(TimerHandle.reset_timer)
    time_since_last_call = in_use(TimerHandle.time_since_last_call)
    time_until_next_call = in_use(TimerHandle.time_until_next_call)

    def info(self, called: dict[str, int]) -> TimerInfo:
        """Return the handle's information about a call, in the timer's clock."""
        return TimerInfo(**called, clock_type=self._clock.clock_type)

    def info_argument(self, callback: Callable[..., object]) -> str | None:
        """Return the parameter of `callback` that takes a `TimerInfo`, or None."""
        if self._inspected is None or self._inspected[0] is not callback:
            name = None
            for parameter in inspect.signature(callback).parameters.values():
                if parameter.annotation in (TimerInfo, "TimerInfo"):
                    name = parameter.name
                    break
            self._inspected = callback, name
        return self._inspected[1]


class Rate:
    """Lets a thread sleep until the next tick, while another spins. Created by `create_rate`."""

    def __init__(self, timer: Timer, *, context: Context) -> None:
        self._timer = timer
        self._context = context
        self._is_shutdown = False
        self._is_destroyed = False
        # The number of ticks, and of those that have ended a sleep: one while nobody sleeps ends
        # the next sleep. No lock and no count of sleepers, as a signal handler may sleep, or raise.
        self._ticks = 0
        self._slept = 0
        self._signal = Signal()
        self._timer.callback = self._tick
        context.on_shutdown(self._on_shutdown)

    def _tick(self) -> None:
        self._ticks += 1
        self._signal.notify()

    def _on_shutdown(self) -> None:
        self._is_shutdown = True
        self.destroy()

    def destroy(self) -> None:
        """Wake the sleeping threads. Use `Node.destroy_rate`."""
        self._is_destroyed = True
        self._tick()

    def sleep(self) -> None:
        """Sleep until the next tick, or until a signal shuts the context down.

        Raises:
            ROSInterruptException: the context is shut down, unless by a signal during this sleep.
            RuntimeError: the rate is destroyed.
            InvalidHandle: its timer is destroyed.
        """
        self._refuse_if_shut_down()
        if self._is_destroyed:
            raise RuntimeError("Rate cannot sleep because it has been destroyed")
        if not self._timer.handle.is_valid:
            self.destroy()
            raise InvalidHandle("Rate cannot sleep because the timer has been destroyed")
        if not self._context.ok():
            raise ROSInterruptException
        slept, wakeup = self._slept, Wakeup()
        try:
            self._signal.add(wakeup)
            wait_until(lambda: self._ticks > slept, self._context, None, wakeup)
        finally:
            self._signal.remove(wakeup)
        self._slept = self._ticks
        self._refuse_if_shut_down()

    def _refuse_if_shut_down(self) -> None:
        if self._is_shutdown:
            self.destroy()
            raise ROSInterruptException


BaseTimer = Timer
"""The base of this class and the asynchronous one in rclpy of Lyrical, which are one class here."""
