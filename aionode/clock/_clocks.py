"""Clocks, which can be read and awaited, and callbacks for their jumps."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from enum import Enum, IntEnum
from typing import TYPE_CHECKING

from aionode._process.concurrency import checkpoint, running_loop
from aionode.clock._time_base import Alarm, MachineTime, TimeBase
from aionode.clock._values import S_TO_NS, ClockType, Duration, Time, expect_clock_type, time_at
from aionode.clock.timer_heap import TimerHeap
from aionode.errors import EntityDestroyedError, TimeSourceChangedError, brief

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType
    from typing import Self

__all__ = [
    "Clock",
    "ClockChange",
    "JumpHandle",
    "JumpThreshold",
    "Jumps",
    "ROSClock",
    "SteadyClock",
    "TimeJump",
]


class ClockChange(IntEnum):
    """Whether the source of a clock's time changed; the values are rcl's."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4

    __str__ = Enum.__str__  # as rclpy prints it: ClockChange.ROS_TIME_ACTIVATED


SWITCHES = (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)


class TimeJump:
    """One jump of a clock.

    Attributes:
        clock_change: Whether the source of time changed.
        delta: How far the time jumped, negative for a jump back; zero if the source changed.

    Raises:
        ValueError: `clock_change` is not a `ClockChange`.
    """

    __slots__ = ("clock_change", "delta")

    def __init__(self, clock_change: ClockChange, delta: Duration) -> None:
        self.clock_change = ClockChange(clock_change)
        self.delta = delta

    def __repr__(self) -> str:
        return f"TimeJump(clock_change={self.clock_change.name}, delta={self.delta!r})"


class JumpThreshold:
    """Which jumps trigger the callbacks.

    Args:
        min_forward: The shortest jump forward to report, a positive duration, or None for none.
        min_backward: The shortest jump back to report, a negative duration, or None for none.
        on_clock_change: Whether to report that ROS time was switched on or off.

    Raises:
        ValueError: A duration has the wrong sign, or no jump would be reported.
    """

    __slots__ = ("min_backward", "min_forward", "on_clock_change")

    def __init__(
        self,
        *,
        min_forward: Duration | None,
        min_backward: Duration | None,
        on_clock_change: bool = True,
    ) -> None:
        if min_forward is not None and min_forward.nanoseconds <= 0:
            raise ValueError(f"JumpThreshold: min_forward is {min_forward}; it must be positive")
        if min_backward is not None and min_backward.nanoseconds >= 0:
            raise ValueError(f"JumpThreshold: min_backward is {min_backward}; it must be negative")
        if min_forward is None and min_backward is None and not on_clock_change:
            raise ValueError("JumpThreshold: at least one of the thresholds must be enabled")
        self.min_forward = min_forward
        self.min_backward = min_backward
        self.on_clock_change = on_clock_change

    def is_met_by(self, jump: TimeJump) -> bool:
        """Return whether `jump` has to be reported."""
        if jump.clock_change in SWITCHES:
            return self.on_clock_change
        if jump.delta.nanoseconds > 0:
            return self.min_forward is not None and jump.delta >= self.min_forward
        return self.min_backward is not None and jump.delta <= self.min_backward


class JumpHandle:
    """A pair of jump callbacks of a clock; `unregister()`, or leaving ``with``, removes them."""

    __slots__ = ("_jumps", "post_callback", "pre_callback", "threshold")

    def __init__(
        self,
        jumps: Jumps,
        threshold: JumpThreshold,
        pre_callback: Callable[[], None] | None,
        post_callback: Callable[[TimeJump], None] | None,
    ) -> None:
        if pre_callback is None and post_callback is None:
            raise ValueError("jump callback: one of pre_callback and post_callback must be given")
        for name, callback in (("pre_callback", pre_callback), ("post_callback", post_callback)):
            if callback is not None and not callable(callback):
                raise ValueError(f"jump callback: {name} is {brief(callback)}; it must be callable")
        self._jumps = jumps
        self.threshold = threshold
        self.pre_callback = pre_callback
        self.post_callback = post_callback

    def unregister(self) -> None:
        """Remove the callbacks; calling it again has no effect."""
        self._jumps.remove(self)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.unregister()


class Jumps:
    """The jump callbacks of one clock, called in order of registration."""

    __slots__ = ("_handles",)

    def __init__(self) -> None:
        self._handles: dict[JumpHandle, None] = {}

    def add(
        self,
        threshold: JumpThreshold,
        pre_callback: Callable[[], None] | None,
        post_callback: Callable[[TimeJump], None] | None,
    ) -> JumpHandle:
        """Register a pair of callbacks."""
        handle = JumpHandle(self, threshold, pre_callback, post_callback)
        self._handles[handle] = None
        return handle

    def remove(self, handle: JumpHandle) -> None:
        """Remove a pair of callbacks."""
        self._handles.pop(handle, None)

    def make(self, change: ClockChange, delta_ns: int, move: Callable[[], None]) -> None:
        """Jump: call the matching pre callbacks, `move` the clock, call the post callbacks.

        An exception in a callback propagates, and the callbacks after it are not called.
        """
        if not self._handles:
            move()
            return
        jump = TimeJump(change, Duration(nanoseconds=delta_ns))
        concerned = [handle for handle in self._handles if handle.threshold.is_met_by(jump)]
        for handle in concerned:
            if handle.pre_callback is not None and handle in self._handles:
                handle.pre_callback()
        move()
        for handle in concerned:
            if handle.post_callback is not None and handle in self._handles:
                handle.post_callback(jump)


MACHINE_TIME = MachineTime()


class Clock:
    """A clock that can be read and awaited.

    A clock of type ROS_TIME follows the system clock until ROS time is switched on. From then on it
    moves only when it is set, as a node with `use_sim_time` does for each `/clock` message.

    Args:
        clock_type: The kind of time. With ROS_TIME a `ROSClock` is created.
        time_base: The source of time; by default the machine's clocks.

    Raises:
        TypeError: `clock_type` is not a `ClockType`.
        ValueError: It is UNINITIALIZED.
    """

    def __new__(  # noqa: PYI034  # may return a ROSClock
        cls,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
        *,
        time_base: TimeBase | None = None,  # noqa: ARG004  # for __init__
    ) -> Clock:
        """Create a `ROSClock` for ROS time, like rclpy."""
        return super().__new__(ROSClock if clock_type is ClockType.ROS_TIME else cls)

    def __init__(
        self, clock_type: ClockType = ClockType.SYSTEM_TIME, *, time_base: TimeBase | None = None
    ) -> None:
        expect_clock_type(clock_type, "Clock")
        if clock_type is ClockType.UNINITIALIZED:
            raise ValueError(
                "Clock: clock_type is UNINITIALIZED; use ROS_TIME, SYSTEM_TIME or STEADY_TIME"
            )
        self._clock_type = clock_type
        self._base = MACHINE_TIME if time_base is None else time_base
        steady = clock_type is ClockType.STEADY_TIME
        self._read_base = self._base.steady_ns if steady else self._base.system_ns
        self._read = self._read_base
        self._active = False
        self._destroyed = False
        self._override_ns = 0
        self._timer_heap = TimerHeap()  # alarms while ROS time is switched on
        self._jumps = Jumps()
        # Sleeps in order of arrival; each is set to True when due, or to False by `destroy`.
        self._sleepers: dict[asyncio.Future[bool], None] = {}

    @property
    def clock_type(self) -> ClockType:
        """The kind of time that this clock shows."""
        return self._clock_type

    def __repr__(self) -> str:
        return f"Clock(clock_type={self._clock_type.name})"

    # Reading and awaiting the time

    def now(self) -> Time:
        """Return the current time of this clock."""
        return time_at(self._read(), self._clock_type)

    def now_ns(self) -> int:
        """Return the current time of this clock in nanoseconds."""
        return self._read()

    async def sleep(self, duration_sec: float) -> None:
        """Wait until `duration_sec` seconds have passed on this clock, never less.

        Zero or less waits for one iteration of the event loop. While ROS time is switched on, time
        passes only when the clock is set. Setting the machine's clock has no effect.

        Raises:
            EntityDestroyedError: The clock was destroyed with its node before or during the sleep
                (a RuntimeError); its ``__cause__`` is the node's error, if it failed.
            asyncio.CancelledError: It was destroyed during a sleep of one of the node's own tasks:
                a callback, or the body of ``async with node``.
            TimeSourceChangedError: ROS time was switched on or off meanwhile.
            OverflowError: `duration_sec` is infinite.
        """
        self._refuse_if_destroyed()
        if duration_sec <= 0:
            await checkpoint()
            return
        duration_ns = round(duration_sec * S_TO_NS)  # truncating would sleep too short
        if self._active:
            await self._sleep(self._override_ns + duration_ns, self._timer_heap.add)
        else:
            await self._sleep(self._base.steady_ns() + duration_ns, self._base.call_at)

    async def sleep_until(self, until: Time) -> None:
        """Wait until this clock shows `until` or later; at least one iteration of the event loop.

        Raises:
            ValueError: `until` belongs to another type of clock.
            EntityDestroyedError: The clock was destroyed with its node before or during the sleep
                (a RuntimeError); its ``__cause__`` is the node's error, if it failed.
            asyncio.CancelledError: It was destroyed during a sleep of one of the node's own tasks:
                a callback, or the body of ``async with node``.
            TimeSourceChangedError: ROS time was switched on or off meanwhile.
        """
        self._refuse_if_destroyed()
        if until.clock_type is not self._clock_type:
            raise ValueError(
                f"sleep_until: {until!r}: its clock type does not match that of this clock, "
                f"{self._clock_type.name}"
            )
        if self._read() >= until.nanoseconds:
            await checkpoint()
        while self._read() < until.nanoseconds:  # repeats if the machine's clock was set back
            await self._sleep(until.nanoseconds, self.call_at)

    def _end_of_wait(self) -> BaseException:
        """Return the exception for a sleep ended by `destroy`; a node's own tasks get another."""
        return EntityDestroyedError(repr(self))

    async def _sleep(
        self, when_ns: int, call_at: Callable[[int, Callable[[], None]], Alarm]
    ) -> None:
        sleeper: asyncio.Future[bool] = running_loop().create_future()

        def wake() -> None:
            if not sleeper.done():
                sleeper.set_result(True)

        alarm = call_at(when_ns, wake)
        self._sleepers[sleeper] = None
        try:
            if not await sleeper:
                raise self._end_of_wait()
        finally:
            del self._sleepers[sleeper]
            alarm.cancel()

    @property
    def follows_machine(self) -> bool:
        """Whether alarms fire by themselves rather than when the time is set."""
        return not self._active and isinstance(self._base, MachineTime)

    def call_at(self, when_ns: int, callback: Callable[[], None]) -> Alarm:
        """Call `callback` when this clock shows `when_ns`.

        For timers, which must read the clock again in the callback, in case the machine's clock was
        set back meanwhile. An alarm stays with its source of time, so it must be scheduled again
        when ROS time is switched on or off.
        """
        if self._active:
            return self._timer_heap.add(when_ns, callback)
        if self._clock_type is ClockType.STEADY_TIME:
            return self._base.call_at(when_ns, callback)
        left_ns = when_ns - self._base.system_ns()
        return self._base.call_at(self._base.steady_ns() + left_ns, callback)

    def call_every(
        self, when_ns: int, period_ns: int, callback: Callable[[], None]
    ) -> Alarm | None:
        """Call `callback` when this clock shows `when_ns`, and then after each `period_ns`.

        As with `call_at`, the callback must read the clock again. Returns None if only `call_at` is
        available: the time is not the machine's, or the system has no such alarms, or none left.
        """
        if not self.follows_machine:
            return None
        from aionode.clock._timerfd import PeriodicAlarm  # with the first timer

        system = self._clock_type is not ClockType.STEADY_TIME
        with suppress(OSError, NotImplementedError):
            return PeriodicAlarm(when_ns, period_ns, callback, system=system)
        return None

    # ROS time

    @property
    def ros_time_is_active(self) -> bool:
        """Whether ROS time is switched on: the time is set externally, as in a simulation."""
        return self._active

    def set_ros_time_active(self, enabled: bool) -> None:
        """Switch ROS time on or off; called by the node for `use_sim_time`.

        While on, the clock shows the time it was last set to, or 0 if it never was. A switch raises
        TimeSourceChangedError in pending sleeps. Without a change it does nothing.

        Raises:
            TypeError: This clock is not of type ROS_TIME.
        """
        self._expect_ros_time()
        if bool(enabled) is self._active:
            return
        change = ClockChange.ROS_TIME_ACTIVATED if enabled else ClockChange.ROS_TIME_DEACTIVATED

        def switch() -> None:
            self._active = enabled
            self._read = self._read_override if enabled else self._read_base

        self._jumps.make(change, 0, switch)
        for sleeper in self._sleepers:
            if not sleeper.done():
                sleeper.set_exception(TimeSourceChangedError(active=enabled))

    # rclpy's API, for code that drives a clock without a node
    _set_ros_time_is_active = set_ros_time_active

    def set_ros_time_override(self, time: Time) -> None:
        """Set the time that this clock shows while ROS time is switched on.

        This wakes sleeps and timers that are due then.

        Raises:
            TypeError: `time` is not a `Time`, or this clock is not of type ROS_TIME.
        """
        self._expect_ros_time()
        if not isinstance(time, Time):
            raise TypeError(f"set_ros_time_override: got {brief(time)}; pass a Time")
        if not self._active:
            self._override_ns = time.nanoseconds
            return
        before_ns = self._override_ns

        def move() -> None:
            self._override_ns = time.nanoseconds

        self._jumps.make(ClockChange.ROS_TIME_NO_CHANGE, time.nanoseconds - before_ns, move)
        self._timer_heap.fire(time.nanoseconds)

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], None] | None = None,
        post_callback: Callable[[TimeJump], None] | None = None,
    ) -> JumpHandle:
        """Call callbacks before and after each jump of ROS time that meets `threshold`.

        They must not block. If one raises, those registered after it are not called.

        Raises:
            ValueError: Neither callback is given, or one is not callable.
        """
        return self._jumps.add(threshold, pre_callback, post_callback)

    def _read_override(self) -> int:
        return self._override_ns

    def _expect_ros_time(self) -> None:
        if self._clock_type is not ClockType.ROS_TIME:
            raise TypeError(
                f"{self!r}: only a clock of type ROS_TIME can be set; create one with ROSClock()"
            )

    # End

    def destroy(self) -> None:
        """End all sleeps and refuse later ones. The time can still be read."""
        self._destroyed = True
        for sleeper in self._sleepers:
            if not sleeper.done():
                sleeper.set_result(False)

    def _refuse_if_destroyed(self) -> None:
        if self._destroyed:
            raise EntityDestroyedError(repr(self), "sleep")


class ROSClock(Clock):
    """A clock that shows ROS time: the system's until ROS time is switched on."""

    def __init__(
        self, clock_type: ClockType = ClockType.ROS_TIME, *, time_base: TimeBase | None = None
    ) -> None:
        super().__init__(clock_type, time_base=time_base)


class SteadyClock(Clock):
    """A monotonic clock with an arbitrary zero: for durations, not for stamps."""

    def __init__(
        self, clock_type: ClockType = ClockType.STEADY_TIME, *, time_base: TimeBase | None = None
    ) -> None:
        super().__init__(clock_type, time_base=time_base)
