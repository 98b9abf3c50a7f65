"""Points in time."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from aionode import clock as core
from aionode.clock import ClockType
from rclpy._impl import messages as msg
from rclpy._impl.typesupport import expect_message
from rclpy.constants import S_TO_NS
from rclpy.duration import Duration, of_core

__all__ = ["S_TO_NS", "Duration", "Time"]


class Time(core.Time):
    """A point in time on one type of clock; those of different types cannot be mixed.

    Raises:
        TypeError: `clock_type` is not a `ClockType`.
        ValueError: a part is negative.
        OverflowError: it does not fit into 64 bits.
    """

    __slots__ = ()

    def __add__(self, other: core.Duration) -> Time:
        result: Time = own(super().__add__(other))
        return result

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        return own(super().__sub__(other))

    def to_msg(self) -> Any:
        """Return it as a `builtin_interfaces/msg/Time`, which has no clock type."""
        sec, nanosec = divmod(self.nanoseconds, S_TO_NS)
        return msg.Time(sec=sec, nanosec=nanosec)

    def to_datetime(self) -> datetime:
        """Return it as a local time without time zone; as in rclpy of Lyrical.

        Raises:
            TypeError: It is a time of the steady clock.
        """
        if self.clock_type not in (ClockType.ROS_TIME, ClockType.SYSTEM_TIME):
            raise TypeError("Time object's clock type should be either ROS_TIME or SYSTEM_TIME")
        return datetime.fromtimestamp(self.nanoseconds / S_TO_NS)  # noqa: DTZ006  # as rclpy does

    @classmethod
    def from_msg(cls, msg: Any, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        """Return the time of a `builtin_interfaces/msg/Time`.

        Raises:
            TypeError: `msg` has another type.
            ValueError: it holds a negative time.
        """
        expect_message(msg, "builtin_interfaces/msg/Time")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec, clock_type=clock_type)


def own(value: Any) -> Any:
    """Return aionode's time or duration as rclpy's; return other values unchanged."""
    if isinstance(value, core.Time):
        return Time(nanoseconds=value.nanoseconds, clock_type=value.clock_type)
    return of_core(value)
