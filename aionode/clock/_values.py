"""Points in time and durations, in whole nanoseconds."""

from __future__ import annotations

import math
from enum import Enum, IntEnum
from typing import TYPE_CHECKING, overload

from aionode.errors import brief

if TYPE_CHECKING:
    from aionode.interfaces.builtin_interfaces import msg as builtin_msg

__all__ = ["CONST_INFINITE_NS", "S_TO_NS", "ClockType", "Duration", "Infinite", "Time"]

S_TO_NS = 1_000_000_000
CONST_INFINITE_NS = 2**63 - 1  # the largest int64, which ROS treats as infinite


def expect_clock_type(value: object, subject: str) -> None:
    """Raise `TypeError` unless `value` is a `ClockType`."""
    if not isinstance(value, ClockType):
        raise TypeError(f"{subject}: clock_type is {brief(value)}; it must be a ClockType")


def total_ns(seconds: float, nanoseconds: float) -> int:
    """Return the sum in nanoseconds, truncating fractions like rclpy."""
    return int(seconds * S_TO_NS) + int(nanoseconds)


class ClockType(IntEnum):
    """The kind of clock that a time was read from, with rcl's values."""

    UNINITIALIZED = 0
    ROS_TIME = 1
    SYSTEM_TIME = 2
    STEADY_TIME = 3

    __str__ = Enum.__str__  # as rclpy prints it: ClockType.ROS_TIME


class Duration:
    """A duration, which may be negative.

    Raises:
        OverflowError: It does not fit a signed 64-bit number of nanoseconds (292 years).
    """

    __slots__ = ("_ns",)

    def __init__(self, *, seconds: float = 0, nanoseconds: float = 0) -> None:
        ns = total_ns(seconds, nanoseconds)
        if not -(2**63) <= ns < 2**63:
            raise OverflowError(
                f"Duration: {ns} ns do not fit 64 bits; the longest is {CONST_INFINITE_NS} ns"
            )
        self._ns = ns

    @property
    def nanoseconds(self) -> int:
        """The duration in nanoseconds."""
        return self._ns

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self._ns})"

    def __str__(self) -> str:
        return "Infinite" if self._ns == CONST_INFINITE_NS else f"{self._ns} nanoseconds"

    def __hash__(self) -> int:
        return hash((Duration, self._ns))

    def __neg__(self) -> Duration:
        return Duration(nanoseconds=-self._ns)

    def __add__(self, other: Duration) -> Duration:
        if isinstance(other, Duration):
            return Duration(nanoseconds=self._ns + other._ns)
        return NotImplemented

    def __sub__(self, other: Duration) -> Duration:
        if isinstance(other, Duration):
            return Duration(nanoseconds=self._ns - other._ns)
        return NotImplemented

    def __mul__(self, factor: float) -> Duration:
        """Multiply by a number; infinity gives `Infinite`, and whole numbers are exact."""
        if isinstance(factor, int):
            return Duration(nanoseconds=self._ns * factor)
        if not isinstance(factor, float):
            return NotImplemented
        if math.isfinite(factor):
            return Duration(nanoseconds=int(self._ns * factor))
        if factor == math.inf:
            return Infinite
        raise ValueError(f"Duration: cannot be multiplied by {factor}; use a finite number or +inf")

    __rmul__ = __mul__

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Duration):
            return self._ns == other._ns
        return NotImplemented

    def __lt__(self, other: object) -> bool:
        if isinstance(other, Duration):
            return self._ns < other._ns
        return NotImplemented

    def __le__(self, other: object) -> bool:
        if isinstance(other, Duration):
            return self._ns <= other._ns
        return NotImplemented

    def __gt__(self, other: object) -> bool:
        if isinstance(other, Duration):
            return self._ns > other._ns
        return NotImplemented

    def __ge__(self, other: object) -> bool:
        if isinstance(other, Duration):
            return self._ns >= other._ns
        return NotImplemented

    def to_msg(self) -> builtin_msg.Duration:
        """Return the duration as a `builtin_interfaces/msg/Duration`."""
        from aionode.interfaces.builtin_interfaces.msg import Duration as Msg

        sec, nanosec = divmod(self._ns, S_TO_NS)
        return Msg(sec=sec, nanosec=nanosec)

    @classmethod
    def from_msg(cls, msg: builtin_msg.Duration) -> Duration:
        """Return the duration of a `builtin_interfaces/msg/Duration`.

        Raises:
            TypeError: `msg` has another type.
        """
        from aionode.interfaces.builtin_interfaces.msg import Duration as Msg

        expect_message(msg, Msg, "Duration")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec)


Infinite = Duration(nanoseconds=CONST_INFINITE_NS)


class Time:
    """A point in time on one type of clock; times of different types cannot be mixed.

    Raises:
        TypeError: `clock_type` is not a `ClockType`.
        ValueError: A part is negative.
        OverflowError: The sum does not fit a signed 64-bit number of nanoseconds.
    """

    __slots__ = ("_clock_type", "_ns")

    def __init__(
        self,
        *,
        seconds: float = 0,
        nanoseconds: float = 0,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
    ) -> None:
        expect_clock_type(clock_type, "Time")
        if seconds < 0 or nanoseconds < 0:
            raise ValueError(
                f"Time: seconds={seconds}, nanoseconds={nanoseconds}; neither may be negative"
            )
        ns = total_ns(seconds, nanoseconds)
        if ns >= 2**63:
            raise OverflowError(
                f"Time: {ns} ns do not fit 64 bits; the latest is {CONST_INFINITE_NS} ns"
            )
        self._ns = ns
        self._clock_type = clock_type

    @property
    def nanoseconds(self) -> int:
        """Nanoseconds since the epoch of the clock."""
        return self._ns

    @property
    def clock_type(self) -> ClockType:
        """The type of clock this time belongs to."""
        return self._clock_type

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """Return whole seconds, and the remaining nanoseconds."""
        return divmod(self._ns, S_TO_NS)

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self._ns}, clock_type={self._clock_type.name})"

    def __hash__(self) -> int:
        return hash((self._ns, self._clock_type))

    def __add__(self, other: Duration) -> Time:
        if isinstance(other, Duration):
            return Time(nanoseconds=self._ns + other.nanoseconds, clock_type=self._clock_type)
        return NotImplemented

    __radd__ = __add__

    @overload
    def __sub__(self, other: Time) -> Duration: ...
    @overload
    def __sub__(self, other: Duration) -> Time: ...
    def __sub__(self, other: Time | Duration) -> Time | Duration:
        if isinstance(other, Time):
            return Duration(nanoseconds=self._ns - self._same(other, "subtract"))
        if isinstance(other, Duration):
            return Time(nanoseconds=self._ns - other.nanoseconds, clock_type=self._clock_type)
        return NotImplemented

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Time):
            return self._ns == self._same(other, "compare")
        return NotImplemented

    def __lt__(self, other: object) -> bool:
        if isinstance(other, Time):
            return self._ns < self._same(other, "compare")
        return NotImplemented

    def __le__(self, other: object) -> bool:
        if isinstance(other, Time):
            return self._ns <= self._same(other, "compare")
        return NotImplemented

    def __gt__(self, other: object) -> bool:
        if isinstance(other, Time):
            return self._ns > self._same(other, "compare")
        return NotImplemented

    def __ge__(self, other: object) -> bool:
        if isinstance(other, Time):
            return self._ns >= self._same(other, "compare")
        return NotImplemented

    def _same(self, other: Time, action: str) -> int:
        """Return the nanoseconds of `other`, if its clock type is the same."""
        if self._clock_type is not other._clock_type:
            mine, theirs = self._clock_type.name, other._clock_type.name
            raise TypeError(
                f"Time: cannot {action} times with different clock types, {mine} and {theirs}"
            )
        return other._ns

    def to_msg(self) -> builtin_msg.Time:
        """Return the time as a `builtin_interfaces/msg/Time`, which has no clock type."""
        from aionode.interfaces.builtin_interfaces.msg import Time as Msg

        sec, nanosec = divmod(self._ns, S_TO_NS)
        return Msg(sec=sec, nanosec=nanosec)

    @classmethod
    def from_msg(cls, msg: builtin_msg.Time, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        """Return the time of a `builtin_interfaces/msg/Time`, on a clock of `clock_type`.

        Raises:
            TypeError: `msg` has another type.
            ValueError: It holds a negative time.
        """
        from aionode.interfaces.builtin_interfaces.msg import Time as Msg

        expect_message(msg, Msg, "Time")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec, clock_type=clock_type)


def time_at(ns: int, clock_type: ClockType) -> Time:
    """Create a `Time` without checking the value; for clocks, whose values always fit."""
    time = Time.__new__(Time)
    time._ns = ns
    time._clock_type = clock_type
    return time


def expect_message(msg: object, expected: type, name: str) -> None:
    """Raise `TypeError` unless `msg` is of the message class `expected`."""
    if not isinstance(msg, expected):
        given = type(msg).__name__
        raise TypeError(f"{name}.from_msg: got a {given}; pass a builtin_interfaces/msg/{name}")
