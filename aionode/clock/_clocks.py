"""Clocks, and callbacks for their jumps.

Telling those who ask when a clock leaps, or changes where it has its time from.

Clocks: they tell the time, let one await it, and can be driven by a simulation.
"""

from __future__ import annotations

import asyncio
from enum import IntEnum
from typing import TYPE_CHECKING

from aionode._concurrency import checkpoint
from aionode.clock._time_base import Alarm, MachineTime, TimeBase
from aionode.clock._timer_heap import TimerHeap
from aionode.clock._values import S_TO_NS, ClockType, Duration, Time, expect_clock_type, time_at
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
    """What happened to the source of a clock's time; the numbers are rcl's."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


SWITCHES = (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)


class TimeJump:
    """One leap of a clock.

    Attributes:
        clock_change: Whether the source of time changed.
        delta: How far the time leapt, negative for a leap back; zero when the source changed.

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
    """Which leaps matter.

    Args:
        min_forward: The shortest leap forwards that counts, a positive duration, or None for none.
        min_backward: The shortest leap back that counts, a negative duration, or None for none.
        on_clock_change: Whether switching ROS time on or off counts.

    Raises:
        ValueError: A duration has the wrong sign, or nothing counts.
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
        """Whether `jump` counts."""
        if jump.clock_change in SWITCHES:
            return self.on_clock_change
        if jump.delta.nanoseconds > 0:
            return self.min_forward is not None and jump.delta >= self.min_forward
        return self.min_backward is not None and jump.delta <= self.min_backward


class JumpHandle:
    """A pair of callbacks on a clock; `unregister()`, or leaving it as a context, removes them."""

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
        """Make sure that the callbacks are not called any more; twice does no harm."""
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
    """The jump callbacks of one clock, called in the order in which they came."""

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
        """Forget a pair of callbacks."""
        self._handles.pop(handle, None)

    def make(self, change: ClockChange, delta_ns: int, move: Callable[[], None]) -> None:
        """Leap: call those who care before, `move` the clock, call them after.

        An exception of a callback comes out, and the callbacks after it are not called.
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
    """Tells the time and lets one await it.

    A clock of type ROS_TIME follows the system clock until ROS time is switched on; from then on it
    stands still except when it is set, which a node with `use_sim_time` does on each `/clock`
    message.

    Args:
        clock_type: Which time it tells. With ROS_TIME a `ROSClock` is made.
        time_base: Where the time comes from; the machine's clocks unless a test brings its own.

    Raises:
        TypeError: `clock_type` is not a `ClockType`.
        ValueError: It is UNINITIALIZED.
    """

    def __new__(  # noqa: PYI034  # what it makes need not be a Self
        cls,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
        *,
        time_base: TimeBase | None = None,  # noqa: ARG004  # for __init__
    ) -> Clock:
        """Make a `ROSClock` where ROS time is asked for, as rclpy does."""
        return super().__new__(ROSClock if clock_type is ClockType.ROS_TIME else cls)

    def __init__(
        self, clock_type: ClockType = ClockType.SYSTEM_TIME, *, time_base: TimeBase | None = None
    ) -> None:
        expect_clock_type(clock_type, "Clock")
        if clock_type is ClockType.UNINITIALIZED:
            raise ValueError(
                "Clock: clock_type is UNINITIALIZED; choose ROS, SYSTEM or STEADY time"
            )
        self._clock_type = clock_type
        self._base = MACHINE_TIME if time_base is None else time_base
        steady = clock_type is ClockType.STEADY_TIME
        self._read_base = self._base.steady_ns if steady else self._base.system_ns
        self._read = self._read_base
        self._active = False
        self._destroyed = False
        self._override_ns = 0
        self._timer_heap = TimerHeap()  # what waits for ROS time while that is set from outside
        self._jumps = Jumps()
        self._sleepers: dict[asyncio.Future[None], None] = {}  # in the order they came

    @property
    def clock_type(self) -> ClockType:
        """Which time this clock tells."""
        return self._clock_type

    def __repr__(self) -> str:
        return f"Clock(clock_type={self._clock_type.name})"

    # Telling and awaiting the time.

    def now(self) -> Time:
        """Return the current time of this clock."""
        return time_at(self._read(), self._clock_type)

    def now_ns(self) -> int:
        """Return the current time of this clock in nanoseconds."""
        return self._read()

    async def sleep(self, duration_sec: float) -> None:
        """Return when `duration_sec` seconds have passed on this clock, never earlier.

        Zero and less let everything else that is ready run once. With ROS time switched on, only
        setting the clock lets time pass. Setting the machine's clock makes no difference.

        Raises:
            EntityDestroyedError: The clock, or its node, was destroyed before (a RuntimeError).
            asyncio.CancelledError: It was destroyed meanwhile.
            TimeSourceChangedError: ROS time was switched on or off meanwhile.
            OverflowError: `duration_sec` is infinite.
        """
        self._refuse_if_destroyed()
        if duration_sec <= 0:
            await checkpoint()
            return
        duration_ns = round(duration_sec * S_TO_NS)  # cut off, it would be too short
        if self._active:
            await self._sleep(self._override_ns + duration_ns, self._timer_heap.add)
        else:
            await self._sleep(self._base.steady_ns() + duration_ns, self._base.call_at)

    async def sleep_until(self, until: Time) -> None:
        """Return when this clock shows `until` or later; if it does already, after one turn.

        Raises:
            ValueError: `until` belongs to another type of clock.
            EntityDestroyedError: The clock, or its node, was destroyed before (a RuntimeError).
            asyncio.CancelledError: It was destroyed meanwhile.
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
        while self._read() < until.nanoseconds:  # again when the machine's clock was set back
            await self._sleep(until.nanoseconds, self.call_at)

    async def _sleep(
        self, when_ns: int, call_at: Callable[[int, Callable[[], None]], Alarm]
    ) -> None:
        sleeper = asyncio.get_running_loop().create_future()

        def wake() -> None:
            if not sleeper.done():
                sleeper.set_result(None)

        alarm = call_at(when_ns, wake)
        self._sleepers[sleeper] = None
        try:
            await sleeper
        finally:
            del self._sleepers[sleeper]
            alarm.cancel()

    @property
    def follows_machine(self) -> bool:
        """Whether alarms ring by themselves, and not because somebody sets the time."""
        return not self._active and isinstance(self._base, MachineTime)

    def call_at(self, when_ns: int, callback: Callable[[], None]) -> Alarm:
        """Have `callback` called when this clock shows `when_ns`.

        For timers, which look at the clock again then: it may show less if the machine's clock was
        set back meanwhile. The alarm stays with the source of time it was set on, so it has to be
        set anew when ROS time is switched on or off.
        """
        if self._active:
            return self._timer_heap.add(when_ns, callback)
        if self._clock_type is ClockType.STEADY_TIME:
            return self._base.call_at(when_ns, callback)
        left_ns = when_ns - self._base.system_ns()
        return self._base.call_at(self._base.steady_ns() + left_ns, callback)

    # ROS time.

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the time is set from outside, as in a simulation."""
        return self._active

    def set_ros_time_active(self, enabled: bool) -> None:
        """Switch ROS time on or off: called by the node, for `use_sim_time`.

        Switched on, the clock shows the time it was last set to, 0 if it never was. Who sleeps on
        the clock gets a `TimeSourceChangedError`. Switching to what is already so does nothing.

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

    # rclpy's name, which code that drives a clock without a node uses.
    _set_ros_time_is_active = set_ros_time_active

    def set_ros_time_override(self, time: Time) -> None:
        """Set the time that this clock shows while ROS time is switched on.

        Sleepers and timers whose time has come then are woken.

        Raises:
            TypeError: `time` is not a `Time`, or this clock is not of type ROS_TIME.
        """
        self._expect_ros_time()
        if not isinstance(time, Time):
            raise TypeError(f"set_ros_time_override: got {brief(time)}; a Time is needed")
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
        """Have callbacks called before and after each leap of ROS time that meets `threshold`.

        They must not block. If one raises, those registered after it are not called.

        Raises:
            ValueError: Neither callback is given, or one cannot be called.
        """
        return self._jumps.add(threshold, pre_callback, post_callback)

    def _read_override(self) -> int:
        return self._override_ns

    def _expect_ros_time(self) -> None:
        if self._clock_type is not ClockType.ROS_TIME:
            raise TypeError(
                f"{self!r}: only a clock of type ROS_TIME can be set; make one with ROSClock()"
            )

    # The end.

    def destroy(self) -> None:
        """Cancel all sleeps; later ones are refused. The time can still be told."""
        self._destroyed = True
        for sleeper in self._sleepers:
            sleeper.cancel()

    def _refuse_if_destroyed(self) -> None:
        if self._destroyed:
            raise EntityDestroyedError(repr(self), "sleep")


class ROSClock(Clock):
    """A clock that tells ROS time: the system's until it is driven from outside."""

    def __init__(
        self, clock_type: ClockType = ClockType.ROS_TIME, *, time_base: TimeBase | None = None
    ) -> None:
        super().__init__(clock_type, time_base=time_base)


class SteadyClock(Clock):
    """A clock that never goes back and whose zero means nothing: for spans, not for stamps."""

    def __init__(
        self, clock_type: ClockType = ClockType.STEADY_TIME, *, time_base: TimeBase | None = None
    ) -> None:
        super().__init__(clock_type, time_base=time_base)
