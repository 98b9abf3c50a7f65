"""Telling those who ask when a clock leaps, or changes where it has its time from."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

from aionode.clock.values import Duration
from aionode.errors import brief

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType
    from typing import Self

__all__ = ["ClockChange", "JumpHandle", "JumpThreshold", "Jumps", "TimeJump"]


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
