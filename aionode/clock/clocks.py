"""Clocks: they tell the time, let one await it, and can be driven by a simulation."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from aionode.clock.agenda import Agenda
from aionode.clock.base import Alarm, MachineTime, TimeBase
from aionode.clock.jumps import ClockChange, JumpHandle, Jumps, JumpThreshold, TimeJump
from aionode.clock.values import S_TO_NS, ClockType, Time, expect_clock_type, time_at
from aionode.errors import EntityDestroyedError, TimeSourceChangedError, brief
from aionode.settle import one_turn

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Clock", "ROSClock", "SteadyClock"]

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
        self._agenda = Agenda()  # what waits for ROS time while that is set from outside
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
            await one_turn()
            return
        duration_ns = round(duration_sec * S_TO_NS)  # cut off, it would be too short
        if self._active:
            await self._sleep(self._override_ns + duration_ns, self._agenda.add)
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
            await one_turn()
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
            return self._agenda.add(when_ns, callback)
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
        self._agenda.fire(time.nanoseconds)

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
            raise EntityDestroyedError(repr(self), "slept on")


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
