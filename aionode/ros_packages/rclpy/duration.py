"""Durations."""

from __future__ import annotations

from typing import Any

from aionode import clock as core
from rclpy._impl import messages as msg
from rclpy._impl.typesupport import expect_message

__all__ = ["Duration", "Infinite"]


class Duration(core.Duration):
    """A duration in nanoseconds, which may be negative.

    Raises:
        OverflowError: it does not fit into 64 bits.
    """

    __slots__ = ()

    def __neg__(self) -> Duration:
        result: Duration = of_core(super().__neg__())
        return result

    def __add__(self, other: core.Duration) -> Duration:
        result: Duration = of_core(super().__add__(other))
        return result

    def __sub__(self, other: core.Duration) -> Duration:
        result: Duration = of_core(super().__sub__(other))
        return result

    def __mul__(self, factor: float) -> Duration:
        result: Duration = of_core(super().__mul__(factor))
        return result

    __rmul__ = __mul__

    def get_c_duration(self) -> Duration:
        """Return the duration in the form of the extension module: itself."""
        return self

    def to_msg(self) -> Any:
        """Return it as a `builtin_interfaces/msg/Duration`."""
        sec, nanosec = divmod(self.nanoseconds, core.S_TO_NS)
        return msg.Duration(sec=sec, nanosec=nanosec)

    @classmethod
    def from_msg(cls, msg: Any) -> Duration:
        """Return the duration of a `builtin_interfaces/msg/Duration`.

        Raises:
            TypeError: `msg` has another type.
        """
        expect_message(msg, "builtin_interfaces/msg/Duration")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec)


def of_core(duration: Any) -> Any:
    """Return aionode's duration as one of this module; return other values unchanged."""
    if isinstance(duration, core.Duration):
        return Duration(nanoseconds=duration.nanoseconds)
    return duration


Infinite = Duration(nanoseconds=core.CONST_INFINITE_NS)
